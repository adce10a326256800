//! The passes that complete the populations of cells at walls and open faces.

use super::{
    CellPass, Face, Grid, Lattice, Link, OpenFace, Setup,
    cell_kernels::CellDispatch,
    fluid::{Dispatch, storage},
    stages::LAST_STAGE,
};
use crate::Result;
use std::ops::Range;

impl Lattice {
    /// All of a step of the given parity, in their order: see [`super::stages::Stages`].
    pub(super) fn boundary_passes(&self, device: &wgpu::Device, odd: u32) -> Result<Vec<Dispatch>> {
        let mut passes = Vec::new();
        let limit = device.limits().max_storage_buffer_binding_size as usize;
        let geometry = &self.geometry;
        let program = self.cell_program("links");
        for links in geometry.links.chunks(limit / size_of::<Link>()) {
            let list = storage(device, "links", bytemuck::cast_slice(links));
            for half in self.halves() {
                let dispatch = CellDispatch {
                    program: &program,
                    entry: "reflect",
                    pass: cell_pass(odd, half, &(0..links.len())),
                    buffers: &[("links", &list)],
                    constants: &[],
                    invocations: links.len() as u32,
                };
                passes.push(self.cell_dispatch(device, &dispatch)?);
            }
        }
        passes.extend(self.wall_passes(device, odd)?);
        let moving = storage(
            device,
            "moving cells",
            bytemuck::cast_slice(&geometry.moving),
        );
        for stage in 0..=LAST_STAGE {
            for (face, (_, _, cells)) in geometry.open.iter().enumerate() {
                let range = geometry.stages.range(cells, stage);
                for half in self.halves() {
                    let pass = cell_pass(odd, half, &range);
                    passes.extend(self.open_pass(device, face, Action::Apply, pass)?);
                }
            }
            let range = geometry.stages.range(&geometry.moving, stage);
            for half in self.halves() {
                let pass = cell_pass(odd, half, &range);
                passes.extend(self.moving_pass(device, &moving, pass)?);
            }
        }
        passes.extend(self.remember_passes(device, odd)?);
        Ok(passes)
    }

    /// What outflow faces carry from the present state, which is complete, to the next step.
    pub(super) fn remember_passes(&self, device: &wgpu::Device, odd: u32) -> Result<Vec<Dispatch>> {
        let mut passes = Vec::new();
        for (face, (axis, side, cells)) in self.geometry.open.iter().enumerate() {
            if let Face::Outflow { .. } = self.setup.faces[*axis][*side] {
                let pass = cell_pass(odd, 0, &(0..cells.len()));
                passes.extend(self.open_pass(device, face, Action::Remember, pass)?);
            }
        }
        Ok(passes)
    }

    /// Moving walls and inlets.
    fn moving_pass(
        &self,
        device: &wgpu::Device,
        list: &wgpu::Buffer,
        pass: CellPass,
    ) -> Result<Option<Dispatch>> {
        if pass.first >= pass.end {
            return Ok(None);
        }
        let dispatch = CellDispatch {
            program: &self.cell_program("moving_wall"),
            entry: "move_wall",
            pass,
            buffers: &[("moving_cells", list)],
            constants: &[],
            invocations: pass.end - pass.first,
        };
        Ok(Some(self.cell_dispatch(device, &dispatch)?))
    }

    /// One pass over cells of a pressure or outflow face.
    fn open_pass(
        &self,
        device: &wgpu::Device,
        face: usize,
        action: Action,
        pass: CellPass,
    ) -> Result<Option<Dispatch>> {
        let (axis, side, _) = self.geometry.open[face];
        let (file, apply) = match self.setup.faces[axis][side] {
            Face::Pressure { .. } => ("pressure_face", "hold_pressure"),
            Face::Outflow { .. } => ("outflow", "flow_out"),
            _ => return Ok(None),
        };
        if pass.first >= pass.end {
            return Ok(None);
        }
        let (list, carried) = &self.buffers.open_faces[face];
        let dispatch = CellDispatch {
            program: &self.cell_program(file),
            entry: match action {
                Action::Apply => apply,
                Action::Remember => "remember",
            },
            pass,
            buffers: &[
                ("face_cells", list),
                ("carried", carried),
                ("open_face", &self.buffers.open_face_uniforms[face]),
            ],
            constants: &[],
            invocations: pass.end - pass.first,
        };
        Ok(Some(self.cell_dispatch(device, &dispatch)?))
    }
}

impl OpenFace {
    /// That of a face of a setup.
    pub(super) fn of(setup: &Setup, grid: &Grid, axis: usize, side: usize) -> Self {
        // Sound that crosses the domain is reflected by about 3 hold × its wave length: with
        // 0.4 / length a pulse of a tenth of the domain loses 1 %. The integral takes some
        // twenty passages of sound, slow enough not to ring.
        let length = f64::from(grid.cells[axis]);
        let hold = 0.4 / length;
        let mut normal = [0.0; 3];
        normal[axis] = if side == 0 { -1.0 } else { 1.0 };
        let density = match setup.faces[axis][side] {
            Face::Pressure { density } | Face::Outflow { density } => density as f32,
            _ => 1.0,
        };
        Self {
            normal,
            density,
            hold: hold as f32,
            integral: (0.05 * hold / length) as f32,
            ..Self::default()
        }
    }
}

/// The pass over a range of cells, which writes one half of the words of 16-bit storage.
pub(super) fn cell_pass(odd: u32, half: u32, range: &Range<usize>) -> CellPass {
    CellPass {
        odd,
        half,
        first: range.start as u32,
        end: range.end as u32,
    }
}

/// What a pass over an open face does.
#[derive(Clone, Copy)]
enum Action {
    /// Writes what enters.
    Apply,
    /// Keeps what the next step needs.
    Remember,
}
