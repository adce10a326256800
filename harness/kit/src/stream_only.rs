//! Streaming without collision: what a step of a layout costs at the least.

use riprap::{
    Error,
    gpu::kernel::{Kernel, Shader},
    lattice::{BrickKind, Lattice, collide_stream, constants},
    wgpu,
};

/// The populations of a lattice that streams and never collides.
pub struct StreamOnly {
    passes: [(Kernel, wgpu::BindGroup); 2],
    groups: u32,
    step: usize,
}

impl StreamOnly {
    /// Takes a periodic lattice without solids after an even number of steps, with the state that it has.
    ///
    /// # Errors
    /// [`Error::Argument`] if it has walls or solids, whose reflections belong to the collision.
    pub fn new(device: &wgpu::Device, lattice: Lattice) -> Result<Self, Error> {
        let setup = lattice.setup();
        if !setup.is_all_fluid() {
            let message = "streaming alone wants a periodic box without solids";
            return Err(Error::argument("faces", message));
        }
        let buffers = lattice.population_buffers();
        // The layout of the fused kernel, and another text in place of its collision.
        let text = include_str!("kernels/stream_only.wgsl");
        let program = collide_stream(setup, buffers.len() as u32, BrickKind::All);
        let shader = Shader::new(device, program.text("collide_stream", text).link()?);
        let names: Vec<String> = (0..buffers.len())
            .map(|n| format!("populations_{n}"))
            .collect();
        let named: Vec<_> = names.iter().map(String::as_str).zip(buffers).collect();
        let groups = lattice.grid().bricks().iter().product();
        let pass = |odd| {
            let family = constants(setup, lattice.grid(), odd);
            let mut constants = shader.linked().constants_of(&family);
            constants.push(("BRICKS", f64::from(groups)));
            let kernel = shader.kernel(device, "stream_only", &constants)?;
            let bind = kernel.bind(device, &named)?;
            Ok::<_, Error>((kernel, bind))
        };
        Ok(Self {
            passes: [pass(false)?, pass(true)?],
            groups,
            step: 0,
        })
    }

    /// Records one step into the caller's pass.
    pub fn record(&mut self, pass: &mut wgpu::ComputePass<'_>) {
        let (kernel, bind) = &self.passes[self.step % 2];
        kernel.record(pass, bind, self.groups);
        self.step += 1;
    }
}
