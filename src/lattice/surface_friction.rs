//! Wall model on the exact surfaces of solids at rest, such as terrain.

use super::{
    BlockFace, Grid, Lattice, Setup, WallCell,
    boundary::cell_pass,
    buffers::storage,
    cell_kernels::CellDispatch,
    fluid::Dispatch,
    surface::Surface,
    surface_faces::{NearCell, SlopingCell, SurfaceFaces, TOP},
    wall_model::{marks, model_share},
};
use crate::{
    Error, Result,
    gpu::{
        buffers::{filled, zeroed},
        kernel::largest_binding,
        readback::Readback,
    },
};
use bytemuck::Zeroable;

/// In place of the scalar of a share.
const NO_PLACE: u32 = u32::MAX;

/// These faces on a device.
#[derive(Debug)]
pub(super) struct SurfacePart {
    cells: wgpu::Buffer,
    slopes: wgpu::Buffer,
    /// Of each cell the scalar of the fractions that takes its share.
    places: wgpu::Buffer,
    near: wgpu::Buffer,
    slip_sums: wgpu::Buffer,
    /// Which of them had a block nearby in the last step; only with blocks.
    blocks: Option<wgpu::Buffer>,
    count: u32,
    near_count: u32,
}

impl SurfacePart {
    /// Those of a setup, none without faces.
    ///
    /// # Errors
    /// [`Error::Limit`] if a binding does not hold them.
    pub fn new(
        device: &wgpu::Device,
        setup: &Setup,
        grid: &Grid,
        faces: &SurfaceFaces,
        surface: Option<&Surface>,
    ) -> Result<Option<Self>> {
        let Some(surface) = surface.filter(|_| !faces.cells.is_empty()) else {
            return Ok(None);
        };
        let wants = size_of_val(&faces.slopes[..]) as u64;
        let has = largest_binding(&device.limits());
        if wants > has {
            return Err(Error::Limit {
                name: "bytes of one storage binding (sloping surfaces of solids)".into(),
                wants,
                has,
                remedy: "use a larger cell, no wall model, or another adapter".into(),
            });
        }
        let mut places = vec![NO_PLACE; faces.cells.len()];
        for (n, cell, _) in faces.cut() {
            places[n] = surface.plane(grid, grid.padded_cell(cell), 1) as u32;
        }
        let list = |label, contents| storage(device, label, contents);
        let usage = wgpu::BufferUsages::STORAGE | wgpu::BufferUsages::COPY_SRC;
        let slopes = bytemuck::cast_slice(&faces.slopes);
        let near = if faces.near.is_empty() {
            &[NearCell::zeroed()]
        } else {
            &faces.near[..]
        };
        Ok(Some(Self {
            cells: list("cells at surfaces", bytemuck::cast_slice(&faces.cells)),
            slopes: filled(device, "sloping surfaces", slopes, usage),
            places: list("places of shares", bytemuck::cast_slice(&places)),
            near: list("cells near surfaces", bytemuck::cast_slice(near)),
            slip_sums: zeroed(device, "sums at surfaces", 16),
            blocks: setup
                .solid_operator
                .map(|_| zeroed(device, "surfaces with blocks", 4 * faces.cells.len() as u64)),
            count: faces.cells.len() as u32,
            near_count: faces.near.len() as u32,
        }))
    }

    /// Bytes of its buffers.
    pub fn bytes(&self) -> u64 {
        let kept = [
            &self.cells,
            &self.slopes,
            &self.places,
            &self.near,
            &self.slip_sums,
        ];
        kept.into_iter()
            .chain(&self.blocks)
            .map(wgpu::Buffer::size)
            .sum()
    }
}

impl Lattice {
    /// A pass over the cells of exact surfaces, or over the fluid near these.
    fn surface_pass(
        &self,
        device: &wgpu::Device,
        part: &SurfacePart,
        (file, entry): (&str, &'static str),
        odd: u32,
        invocations: u32,
    ) -> Result<Dispatch> {
        let mut buffers = vec![
            ("wall_cells", &part.cells),
            ("slopes", &part.slopes),
            ("share_places", &part.places),
            ("near_cells", &part.near),
            ("all_slip_sums", &part.slip_sums),
        ];
        buffers.extend(part.blocks.as_ref().map(|blocks| ("wall_blocks", blocks)));
        if file == "mark_blocks" {
            buffers.extend(self.psm_planes());
        }
        let dispatch = CellDispatch {
            program: &self.cell_program(file),
            entry,
            pass: cell_pass(odd, 0, &(0..invocations as usize)),
            buffers: &buffers,
            constants: &[],
            invocations,
        };
        self.cell_dispatch(device, &dispatch)
    }

    /// The passes that evaluate the law at exact surfaces in a step of the given parity, and set the eddy viscosity near these.
    pub(super) fn surface_laws(&self, device: &wgpu::Device, odd: u32) -> Result<Vec<Dispatch>> {
        let Some(part) = &self.buffers.sloping_surface else {
            return Ok(Vec::new());
        };
        let pass = |entry, count| {
            let kernel = ("surface_friction", entry);
            self.surface_pass(device, part, kernel, odd, count)
        };
        let mut passes = vec![pass("surface_law", part.count)?];
        if part.near_count > 0 {
            passes.push(pass("surface_viscosity", part.near_count)?);
        }
        Ok(passes)
    }

    /// All passes of the wall model at exact surfaces in a step of the given parity, after those that reflect populations.
    pub(super) fn surface_passes(&self, device: &wgpu::Device, odd: u32) -> Result<Vec<Dispatch>> {
        let mut passes = self.surface_laws(device, odd)?;
        if let Some(part) = &self.buffers.sloping_surface {
            for entry in ["surface_slip", "surface_friction"] {
                let kernel = ("surface_friction", entry);
                passes.push(self.surface_pass(device, part, kernel, odd, part.count)?);
            }
        }
        Ok(passes)
    }

    /// The pass that passes the shares of the law on to the cells that exact surfaces cut.
    pub(super) fn surface_shares(&self, device: &wgpu::Device) -> Result<Option<Dispatch>> {
        let pass = |part: &SurfacePart| {
            let kernel = ("surface_friction", "surface_shares");
            self.surface_pass(device, part, kernel, 0, part.count)
        };
        self.buffers.sloping_surface.as_ref().map(pass).transpose()
    }

    /// The pass that finds the surfaces with blocks nearby for the next step.
    pub(super) fn mark_surface(&self, device: &wgpu::Device) -> Result<Option<Dispatch>> {
        let part = self.buffers.sloping_surface.as_ref();
        let part = part.filter(|part| part.blocks.is_some());
        let mark = |part: &SurfacePart| {
            let kernel = ("mark_blocks", "mark_blocks");
            self.surface_pass(device, part, kernel, 0, part.count)
        };
        part.map(mark).transpose()
    }

    /// The faces of exact surfaces where the wall model acts, without those near a block, with its results in the last step; none
    /// without it.
    ///
    /// # Errors
    /// If the device fails.
    pub async fn surface_faces(
        &self,
        device: &wgpu::Device,
        queue: &wgpu::Queue,
    ) -> Result<Vec<BlockFace>> {
        let Some(part) = &self.buffers.sloping_surface else {
            return Ok(Vec::new());
        };
        let mut readback = Readback::default();
        let count = part.count as usize;
        let slopes: Vec<SlopingCell> = readback.read(device, queue, &part.slopes, count).await?;
        let blocked = marks(&mut readback, device, queue, part.blocks.as_ref(), count).await?;
        let cells = &self.geometry.surface_faces.cells;
        let each = cells.iter().zip(&slopes).zip(&blocked);
        let tops = each.filter(|((_, slope), blocked)| slope.slope & TOP != 0 && !**blocked);
        let face = |((cell, slope), _): ((&WallCell, &SlopingCell), &bool)| {
            let face = slope.slope & 7;
            let u = glam::Vec3::from(slope.u);
            let stress = slope.friction * slope.friction / u.length().max(1e-30) * u;
            let rise = slope.normal[face as usize / 2].abs();
            BlockFace {
                cell: cell.cell,
                face,
                friction: slope.friction,
                share: model_share(slope.friction, self.setup.nu),
                stress: stress.to_array(),
                fraction: slope.cells() as f32 - 0.5 - slope.distance / rise,
                normal: slope.normal,
                area: slope.area,
            }
        };
        Ok(tops.map(face).collect())
    }
}
