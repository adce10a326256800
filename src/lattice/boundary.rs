//! The passes that complete the populations of cells at walls and open faces.

use super::{
    Face, Lattice, Link,
    fluid::{Dispatch, storage},
    stages::LAST_STAGE,
};
use crate::Result;
use std::ops::Range;

impl Lattice {
    /// All of a step, in their order: see [`super::stages::Stages`].
    pub(super) fn boundary_passes(
        &self,
        device: &wgpu::Device,
        odd: bool,
    ) -> Result<Vec<Dispatch>> {
        let mut passes = Vec::new();
        let limit = device.limits().max_storage_buffer_binding_size as usize;
        let geometry = &self.geometry;
        let program = self.cell_program("links");
        for links in geometry.links.chunks(limit / size_of::<Link>()) {
            let list = storage(device, "links", bytemuck::cast_slice(links));
            for &half in self.halves() {
                let extra: (&[_], &[_]) = (&[("links", &list)], &[("HALF", half)]);
                let n = links.len() as u32;
                passes.push(self.cell_dispatch(device, &program, "reflect", odd, extra, n)?);
            }
        }
        let moving = storage(
            device,
            "moving cells",
            bytemuck::cast_slice(&geometry.moving),
        );
        for stage in 0..=LAST_STAGE {
            for (face, (_, _, cells)) in geometry.open.iter().enumerate() {
                let range = geometry.stages.range(cells, stage);
                for &half in self.halves() {
                    passes.extend(self.open_pass(device, odd, face, Pass::Apply(half), &range)?);
                }
            }
            let range = geometry.stages.range(&geometry.moving, stage);
            for &half in self.halves() {
                passes.extend(self.moving_pass(device, odd, &moving, half, &range)?);
            }
        }
        passes.extend(self.remember_passes(device, odd)?);
        Ok(passes)
    }

    /// What outflow faces carry from the present state, which is complete, to the next step.
    pub(super) fn remember_passes(
        &self,
        device: &wgpu::Device,
        odd: bool,
    ) -> Result<Vec<Dispatch>> {
        let mut passes = Vec::new();
        for (face, (axis, side, cells)) in self.geometry.open.iter().enumerate() {
            if let Face::Outflow { .. } = self.setup.faces[*axis][*side] {
                let all = 0..cells.len();
                passes.extend(self.open_pass(device, odd, face, Pass::Remember, &all)?);
            }
        }
        Ok(passes)
    }

    /// Moving walls and inlets.
    fn moving_pass(
        &self,
        device: &wgpu::Device,
        odd: bool,
        list: &wgpu::Buffer,
        half: f64,
        range: &Range<usize>,
    ) -> Result<Option<Dispatch>> {
        if range.is_empty() {
            return Ok(None);
        }
        let program = self.cell_program("moving_wall");
        let numbers = [
            ("HALF", half),
            ("FROM", range.start as f64),
            ("TO", range.end as f64),
        ];
        let extra: (&[_], &[_]) = (&[("moving_cells", list)], &numbers);
        let n = range.len() as u32;
        let pass = self.cell_dispatch(device, &program, "move_wall", odd, extra, n)?;
        Ok(Some(pass))
    }

    /// One pass over cells of a pressure or outflow face.
    fn open_pass(
        &self,
        device: &wgpu::Device,
        odd: bool,
        face: usize,
        pass: Pass,
        range: &Range<usize>,
    ) -> Result<Option<Dispatch>> {
        let (axis, side, _) = self.geometry.open[face];
        let (file, apply, density) = match self.setup.faces[axis][side] {
            Face::Pressure { density } => ("pressure_face", "hold_pressure", density),
            Face::Outflow { density } => ("outflow", "flow_out", density),
            _ => return Ok(None),
        };
        if range.is_empty() {
            return Ok(None);
        }
        let (entry, half) = match pass {
            Pass::Apply(half) => (apply, half),
            Pass::Remember => ("remember", 0.0),
        };
        // Sound that crosses the domain is reflected by about 3 hold × its wave length: with
        // 0.4 / length a pulse of a tenth of the domain loses 1 %. The integral takes some
        // twenty passages of sound, slow enough not to ring.
        let length = f64::from(self.grid.cells[axis]);
        let hold = 0.4 / length;
        let integral = 0.05 * hold / length;
        let mut normal = [0.0; 3];
        normal[axis] = if side == 0 { -1.0 } else { 1.0 };
        let numbers = [
            ("HALF", half),
            ("FROM", range.start as f64),
            ("TO", range.end as f64),
            ("FACE_DENSITY", density),
            ("HOLD", hold),
            ("INTEGRAL", integral),
            ("NORMAL_X", normal[0]),
            ("NORMAL_Y", normal[1]),
            ("NORMAL_Z", normal[2]),
        ];
        let (list, carried) = &self.buffers.open_faces[face];
        let buffers = [("face_cells", list), ("carried", carried)];
        let (extra, n) = ((&buffers[..], &numbers[..]), range.len() as u32);
        let program = self.cell_program(file);
        let dispatch = self.cell_dispatch(device, &program, entry, odd, extra, n)?;
        Ok(Some(dispatch))
    }
}

/// What a pass over an open face does.
#[derive(Clone, Copy)]
enum Pass {
    /// Writes what enters, with 16-bit storage one half of each word.
    Apply(f64),
    /// Keeps what the next step needs.
    Remember,
}
