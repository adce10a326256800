//! The passes that complete the populations of cells at walls and open faces.

use super::{
    CellPass, Face, Grid, LINKS_OF_ROW, Lattice, Link, OpenFace, Setup,
    buffers::{storage, wall_velocities},
    cell_kernels::CellDispatch,
    check::finite,
    fluid::{Dispatch, face_name},
    stages::LAST_STAGE,
};
use crate::{Error, Result, gpu::Processor};
use std::ops::Range;

impl Lattice {
    /// All boundary passes of a step of the given parity, in their order: see [`super::stages::Stages`].
    pub(super) fn boundary_passes(&self, device: &wgpu::Device, odd: u32) -> Result<Vec<Dispatch>> {
        let mut passes = Vec::new();
        let limit = device.limits().max_storage_buffer_binding_size as usize;
        let geometry = &self.geometry;
        let program = self.cell_program("links");
        for (links, of_row, of_invocation) in [
            (
                &geometry.link_rows,
                LINKS_OF_ROW,
                self.links_of_invocation(),
            ),
            (&geometry.links, 1, 1),
        ] {
            for links in links.chunks(limit / size_of::<Link>()) {
                let list = storage(device, "links", bytemuck::cast_slice(links));
                let invocations = links.len() * (of_row / of_invocation);
                for half in self.halves() {
                    let dispatch = CellDispatch {
                        program: &program,
                        entry: "reflect",
                        pass: cell_pass(odd, half, &(0..invocations)),
                        buffers: &[("links", &list)],
                        constants: &[
                            ("LINKS_OF_ROW", of_row as f64),
                            ("LINKS_OF_INVOCATION", of_invocation as f64),
                        ],
                        invocations: invocations as u32,
                    };
                    passes.push(self.cell_dispatch(device, &dispatch)?);
                }
            }
        }
        passes.extend(self.wall_passes(device, odd)?);
        passes.extend(self.surface_passes(device, odd)?);
        let moving = storage(
            device,
            "moving cells",
            bytemuck::cast_slice(&geometry.moving),
        );
        passes.extend(self.turbulence_passes(device, &moving, odd)?);
        for stage in 0..=LAST_STAGE {
            for (kind, cells) in [
                (OpenKind::Pressure, &geometry.pressure),
                (OpenKind::Outflow, &geometry.outflow),
            ] {
                for range in geometry.stages.turns(cells, stage) {
                    for half in self.halves() {
                        let pass = cell_pass(odd, half, &range);
                        passes.push(self.open_pass(device, kind, kind.apply(), pass)?);
                    }
                }
            }
            for range in geometry.stages.turns(&geometry.moving, stage) {
                for half in self.halves() {
                    let pass = cell_pass(odd, half, &range);
                    passes.push(self.moving_pass(device, &moving, pass)?);
                }
            }
        }
        passes.extend(self.store_outflow_pass(device, odd)?);
        Ok(passes)
    }

    /// Links of a row that an invocation processes. Software adapters execute invocations one after another: each processes a
    /// row. On GPUs adjacent invocations access adjacent cells.
    fn links_of_invocation(&self) -> usize {
        match self.setup.processor {
            Some(Processor::Cpu) => LINKS_OF_ROW,
            Some(Processor::Gpu) | None => 1,
        }
    }

    /// The pass that stores the data of outflow faces for the next step, if there are any; the present state must be complete.
    pub(super) fn store_outflow_pass(
        &self,
        device: &wgpu::Device,
        odd: u32,
    ) -> Result<Option<Dispatch>> {
        let count = self.geometry.outflow.len();
        if count == 0 {
            return Ok(None);
        }
        let pass = cell_pass(odd, 0, &(0..count));
        let store = self.open_pass(device, OpenKind::Outflow, "store_outflow", pass)?;
        Ok(Some(store))
    }

    /// Moving walls and inlets.
    fn moving_pass(
        &self,
        device: &wgpu::Device,
        list: &wgpu::Buffer,
        pass: CellPass,
    ) -> Result<Dispatch> {
        let dispatch = CellDispatch {
            program: &self.cell_program("moving_wall"),
            entry: "move_wall",
            pass,
            buffers: &[("moving_cells", list)],
            constants: &[],
            invocations: pass.end - pass.first,
        };
        self.cell_dispatch(device, &dispatch)
    }

    /// One pass over cells of pressure or outflow faces.
    fn open_pass(
        &self,
        device: &wgpu::Device,
        kind: OpenKind,
        entry: &'static str,
        pass: CellPass,
    ) -> Result<Dispatch> {
        let open = &self.buffers.open;
        let (file, cells) = match kind {
            OpenKind::Pressure => ("pressure_face", &open.pressure),
            OpenKind::Outflow => ("outflow", &open.outflow),
        };
        let dispatch = CellDispatch {
            program: &self.cell_program(file),
            entry,
            pass,
            buffers: &[
                ("face_cells", cells),
                ("outflow_state", &open.outflow_state),
                ("open_faces", &open.faces),
            ],
            constants: &[],
            invocations: pass.end - pass.first,
        };
        self.cell_dispatch(device, &dispatch)
    }

    /// Sets the density of a pressure or outflow face, in lattice units; it holds from the next submission on.
    ///
    /// # Errors
    /// If there is no such face, it has no density, or the density is not positive and finite.
    pub fn set_face_density(
        &mut self,
        queue: &wgpu::Queue,
        axis: usize,
        side: usize,
        density: f64,
    ) -> Result<()> {
        let refused = |message: String| Err(Error::argument(face_name(axis, side), message));
        let faces = self.setup.faces.get_mut(axis);
        let face = faces.and_then(|faces| faces.get_mut(side));
        let Some(Face::Pressure { density: old } | Face::Outflow { density: old }) = face else {
            return refused("this face is not open, or there is none".into());
        };
        if !(density > 0.0 && (density as f32).is_finite()) {
            return refused(format!(
                "its density is {density}; give a number greater than 0"
            ));
        }
        *old = density;
        let content = OpenFace::of(&self.setup, &self.grid, axis, side);
        let place = ((2 * axis + side) * size_of::<OpenFace>()) as u64;
        let faces = &self.buffers.open.faces;
        queue.write_buffer(faces, place, bytemuck::bytes_of(&content));
        Ok(())
    }

    /// Sets the velocities of the cells of a velocity face, in lattice units, lower axis fastest;
    /// they hold from the next submission on.
    ///
    /// # Errors
    /// If there is no such face, it is not a velocity face, the number of cells differs, or a velocity is not finite.
    pub fn set_face_velocity(
        &mut self,
        queue: &wgpu::Queue,
        axis: usize,
        side: usize,
        velocity: Vec<[f32; 3]>,
    ) -> Result<()> {
        let faces = self.setup.faces.get_mut(axis);
        let Some(face) = faces.and_then(|faces| faces.get_mut(side)) else {
            let message =
                format!("there is no side {side} of axis {axis}; axes are 0 to 2, sides 0 and 1");
            return Err(Error::argument("faces", message));
        };
        match face {
            Face::Velocity(old) if old.len() == velocity.len() => {
                finite(&face_name(axis, side), velocity.as_flattened())?;
                *old = velocity;
            }
            _ => {
                let message = format!("this face takes no list of {} velocities", velocity.len());
                return Err(Error::argument(face_name(axis, side), message));
            }
        }
        if let Some(buffer) = &self.buffers.wall_velocity {
            let table = wall_velocities(&self.setup, &self.grid, &self.geometry.moving);
            queue.write_buffer(buffer, 0, bytemuck::cast_slice(&table));
        }
        self.write_mean_velocities(queue);
        Ok(())
    }
}

impl OpenFace {
    /// The parameters of a face of a setup.
    pub(super) fn of(setup: &Setup, grid: &Grid, axis: usize, side: usize) -> Self {
        // Sound that crosses the domain is reflected by about 3 hold × its wave length: with
        // 0.4 / length a pulse of a tenth of the domain loses 1 %. The integral takes some
        // twenty passages of sound, slow enough not to ring.
        let length = f64::from(grid.cells[axis]);
        let hold = 0.4 / length;
        let mut normal = [0.0; 3];
        normal[axis] = if side == 0 { -1.0 } else { 1.0 };
        let density = match setup.faces[axis][side] {
            Face::Pressure { density } | Face::Outflow { density } => density,
            _ => 1.0,
        };
        // The given density is that of the middle of the face.
        let mut gradient = setup.open_face_gradient;
        gradient[axis] = 0.0;
        let middle = |a: usize| 0.5 * f64::from(grid.cells[a] - 1);
        let density = density - (0..3).map(|a| gradient[a] * middle(a)).sum::<f64>();
        Self {
            normal,
            density: density as f32,
            gradient: gradient.map(|g| g as f32),
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

/// Kinds of open faces.
#[derive(Clone, Copy)]
enum OpenKind {
    Pressure,
    Outflow,
}

impl OpenKind {
    /// Entry point of the kernel that writes the entering populations.
    fn apply(self) -> &'static str {
        match self {
            Self::Pressure => "hold_pressure",
            Self::Outflow => "apply_outflow",
        }
    }
}
