//! The sums of the device for blocks in a fluid, and the loads that follow from them.

use super::{FACE_LAYERS, FACE_LOAD, FaceLoad, Frame, SolidCells, WRENCH, face_sums::FaceSums};
use crate::{
    Error, Result,
    geometry::{Form, Load, Placed, PlaneFace, Window, corners, plane_faces},
};
use glam::DVec3;

/// Gap between the parts of a block, cells, below which there is a seam: `SEAM_GAP` of the kernel.
const SEAM_GAP: f64 = 1e-3;

impl SolidCells {
    /// Records the sums of the action of the fluid on the blocks, after [`crate::lattice::Lattice::record_psm`].
    pub fn record_loads(&self, pass: &mut wgpu::ComputePass<'_>) {
        self.kernels.record(pass, 3..5);
    }

    /// The sums, [`WRENCH`] f32 for each block with loads: see [`SolidCells::loads`]. [`SolidCells::place`]
    /// replaces the buffer if it has to grow.
    pub fn wrenches(&self) -> &wgpu::Buffer {
        self.kernels.buffer("wrenches")
    }

    /// Number of sums in [`SolidCells::wrenches`].
    pub fn wrench_count(&self) -> usize {
        WRENCH * self.loaded
    }

    /// The loads on all blocks from the numbers of [`SolidCells::wrenches`]: the action of the fluid on the solid
    /// in its cells, without the contributions of a body force in these cells and of the weight of the water, and with the inertia of
    /// the fluid in them. [`Ambient`](crate::coupling::Ambient) and [`InteriorInertia`](crate::coupling::InteriorInertia) convert
    /// it to the load on rock. Blocks without loads have zero.
    ///
    /// # Errors
    /// If there are too few numbers.
    pub fn loads(&self, wrenches: &[f32]) -> Result<Vec<Load>> {
        if wrenches.len() < self.wrench_count() {
            let message = format!("{} numbers, not {}", wrenches.len(), self.wrench_count());
            return Err(Error::argument("wrenches", message));
        }
        let load = |&place: &usize| match wrenches.get(WRENCH * place..WRENCH * (place + 1)) {
            Some(wrench) if place < self.loaded => self.frame.load(wrench),
            _ => Load::default(),
        };
        Ok(self.number.iter().map(load).collect())
    }

    /// Records the sums of the action of the fluid on single faces, after [`crate::lattice::Lattice::record_psm`]; nothing unless
    /// a block requests them.
    pub fn record_faces(&self, pass: &mut wgpu::ComputePass<'_>) {
        if let Some(faces) = &self.face_sums {
            faces.record(pass);
        }
    }

    /// The sums, [`FACE_LOAD`] f32 for each of [`FACE_LAYERS`] layers of cells along each face of the blocks that request them: see
    /// [`SolidCells::face_loads`]. `None` unless requested; [`SolidCells::place`] replaces the buffer if it has to grow.
    pub fn face_sums(&self) -> Option<&wgpu::Buffer> {
        self.face_sums.as_ref().map(FaceSums::loads)
    }

    /// Number of sums in [`SolidCells::face_sums`].
    pub fn face_sum_count(&self) -> usize {
        self.face_sums.as_ref().map_or(0, FaceSums::count)
    }

    /// The loads on the faces of all blocks at their last placement, from the numbers of
    /// [`SolidCells::face_sums`]; none for blocks that did not request them and for spheres. Tractions are
    /// extrapolated to a face from two layers of cells; if other solids are in one of the layers, they are those of the first layer,
    /// without the contribution of a body force over the distance to the face.
    ///
    /// # Errors
    /// If there are too few numbers.
    pub fn face_loads(&self, sums: &[f32]) -> Result<Vec<Vec<FaceLoad>>> {
        let mut loads = vec![Vec::new(); self.blocks.len()];
        let Some(faces) = &self.face_sums else {
            return Ok(loads);
        };
        if sums.len() < faces.count() || self.poses.is_empty() {
            let message = format!("{} numbers, not {}", sums.len(), faces.count());
            return Err(Error::argument("face_sums", message));
        }
        let mut sums = sums.chunks_exact(FACE_LAYERS * FACE_LOAD);
        for &block in &faces.requested {
            let (shape, pose) = (&self.blocks[block].shape, &self.poses[block]);
            let parts = shape.parts().iter().enumerate();
            let its = parts.flat_map(|(number, part)| plane_faces(number, part, pose));
            let window = self.window(self.imaged(block));
            let placed: Vec<_> = shape.parts().iter().map(|p| Placed::of(p, pose)).collect();
            let load = |(face, sums): (PlaneFace, _)| {
                let part = &shape.parts()[face.part];
                let corners = match &part.form {
                    Form::Convex(of) => corners(of, face.face, part.offset, pose),
                    Form::Sphere { .. } => Vec::new(),
                };
                let corners = window.clipped(corners);
                let over = self.frame.units.cell * SEAM_GAP * face.normal;
                let seam = |(number, other): (usize, &Placed)| {
                    let raised = corners.iter().map(|x| x + over).collect();
                    let seam = match number == face.part {
                        true => Vec::new(),
                        false => other.clipped(raised),
                    };
                    (!seam.is_empty()).then_some(seam)
                };
                let seams: Vec<_> = placed.iter().enumerate().filter_map(seam).collect();
                let polygons = (&corners[..], &seams[..]);
                FaceLoad::new(&self.frame, (face, pose.centre), polygons, sums)
            };
            loads[block] = its.zip(&mut sums).map(load).collect();
        }
        let given = self.number.iter();
        Ok(given
            .map(|&place| std::mem::take(&mut loads[place]))
            .collect())
    }

    /// The domain, infinite along the axes along which a block is `imaged`.
    fn window(&self, imaged: [bool; 3]) -> Window {
        let (cells, _) = self.domain();
        let Frame { origin, units } = self.frame;
        let size = units.cell * DVec3::from_array(cells.map(f64::from));
        let or = |at: DVec3, end: f64| {
            DVec3::from_array([0, 1, 2].map(|axis| if imaged[axis] { end } else { at[axis] }))
        };
        Window {
            low: or(origin, f64::NEG_INFINITY),
            high: or(origin + size, f64::INFINITY),
        }
    }
}
