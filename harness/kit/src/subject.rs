//! Subjects of measurements: a lattice that steps, one that only streams, a copy, or pure arithmetic.

use super::{
    copy::{Copy, Method},
    gpu,
};
use riprap::{
    Error,
    gpu::{
        kernel::{Kernel, Shader},
        link::Program,
        timer::{self, Timer},
    },
    lattice::{BrickKind, Grid, Lattice, Setup, State, collide_stream, constants},
    wgpu::{self, util::DeviceExt},
};

/// Work that can be recorded repeatedly.
pub enum Subject<'a> {
    /// Steps of a fluid.
    Steps(Box<Lattice>),
    /// Steps without collision.
    Streaming(Box<StreamOnly>),
    /// Copies of a stretch of memory.
    Copying(&'a Copy, Method),
    /// Pure arithmetic.
    Computing(&'a Arithmetic),
    /// Work recorded by the caller in a compute pass.
    Recording(Recording<'a>),
    /// Work recorded by the caller outside of passes.
    Encoding(Encoding<'a>),
}

/// Records one repetition.
pub type Recording<'a> = Box<dyn FnMut(&mut wgpu::ComputePass<'_>) + 'a>;
/// Records one repetition.
pub type Encoding<'a> = Box<dyn FnMut(&mut wgpu::CommandEncoder) + 'a>;

impl Subject<'_> {
    /// Records `turns` repetitions; returns whether they are between timestamps.
    pub fn record(
        &mut self,
        encoder: &mut wgpu::CommandEncoder,
        timer: Option<&mut Timer>,
        turns: u32,
    ) -> bool {
        if let Self::Copying(copy, Method::Buffer) = self {
            (0..turns).for_each(|_| copy.record_buffers(encoder));
            return false;
        }
        if let Self::Encoding(encode) = self {
            (0..turns).for_each(|_| encode(encoder));
            return false;
        }
        let timed = timer.is_some();
        let mut pass = encoder.begin_compute_pass(&timer::pass(timer, "turns"));
        for _ in 0..turns {
            match self {
                Self::Steps(lattice) => lattice.record(&mut pass),
                Self::Streaming(lattice) => lattice.record(&mut pass),
                Self::Copying(copy, method) => copy.record(*method, &mut pass),
                Self::Computing(arithmetic) => arithmetic.record(&mut pass),
                Self::Recording(record) => record(&mut pass),
                // Recorded outside of passes.
                Self::Encoding(_) => {}
            }
        }
        timed
    }
}

/// The populations of a lattice that streams without collision: the minimal cost of a step of a layout.
pub struct StreamOnly {
    passes: [(Kernel, wgpu::BindGroup); 2],
    groups: u32,
    step: usize,
}

impl StreamOnly {
    /// Takes a periodic lattice without walls and solids, whose reflections are part of the collision, after an even number of
    /// steps, with its present state.
    pub fn new(device: &wgpu::Device, lattice: Lattice) -> Result<Self, Error> {
        let setup = lattice.setup();
        if !setup.is_all_fluid() {
            let message = "streaming alone wants a periodic box without solids";
            return Err(Error::argument("faces", message));
        }
        let buffers = lattice.population_buffers();
        // The layout of the fused kernel, with another text in place of its collision.
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

/// Iterations of the arithmetic loop: few, since drivers may end long loops.
const TURNS: u32 = 64;
/// Floating-point operations per iteration: 32 products and 32 sums of four components.
pub const FLOPS: u64 = 2 * 32 * 4;
/// Workgroups of 64 on a GPU: large GPUs hold 270 000 invocations, and this is fifteen times as many. A dispatch has at
/// most 65535.
const GROUPS: u32 = 65_535;
/// The same on a CPU, whose cores process one workgroup at a time.
const CPU_GROUPS: u32 = 4096;

/// The arithmetic ceiling of an adapter: products and sums of vectors in registers only.
pub struct Arithmetic {
    kernel: Kernel,
    bind: wgpu::BindGroup,
    groups: u32,
}

/// The program of the kernel `multiply_add`.
pub fn program() -> Program {
    Program::new("multiply_add").text("multiply_add", include_str!("kernels/multiply_add.wgsl"))
}

impl Arithmetic {
    /// The kernel and its factors.
    pub fn new(device: &wgpu::Device) -> Result<Self, Error> {
        let groups = match gpu::is_software(&device.adapter_info()) {
            true => CPU_GROUPS,
            false => GROUPS,
        };
        let linked = program().link()?;
        let kernel = Kernel::new(
            device,
            &linked,
            "multiply_add",
            &[("TURNS", f64::from(TURNS))],
        )?;
        // Values stay finite: x ← 0.5 x + 0.5 converges to 1.
        let factors = device.create_buffer_init(&wgpu::util::BufferInitDescriptor {
            label: Some("factors"),
            contents: bytemuck::cast_slice(&[0.5f32; 8]),
            usage: wgpu::BufferUsages::STORAGE,
        });
        let sums = device.create_buffer(&wgpu::BufferDescriptor {
            label: Some("sums"),
            size: u64::from(groups) * 64 * 16,
            usage: wgpu::BufferUsages::STORAGE,
            mapped_at_creation: false,
        });
        let bind = kernel.bind(device, &[("factors", &factors), ("sums", &sums)])?;
        Ok(Self {
            kernel,
            bind,
            groups,
        })
    }

    /// Floating-point operations of a dispatch.
    pub fn flops(&self) -> f64 {
        f64::from(self.groups) * 64.0 * f64::from(TURNS) * FLOPS as f64
    }

    /// Records a dispatch.
    pub fn record(&self, pass: &mut wgpu::ComputePass<'_>) {
        self.kernel.record(pass, &self.bind, self.groups);
    }
}

/// A flow that moves in every cell: waves along each axis and noise. At rest, or where symmetry keeps a component at 0,
/// denormal numbers would slow a CPU down.
pub fn sheared_noise(setup: &Setup) -> Result<State, Error> {
    let grid = Grid::new(setup)?;
    let mut state = State::rest(grid.cell_count());
    for (n, cell) in grid.domain().enumerate() {
        let wave = |axis: usize| {
            let turns = (f64::from(cell[axis]) + 0.5) / f64::from(grid.cells[axis]);
            (std::f64::consts::TAU * turns).sin()
        };
        let noise = |k: usize| f64::from(hash(4 * n + k)) / f64::from(u32::MAX) - 0.5;
        state.excess[n] = (1e-3 * noise(3)) as f32;
        for a in 0..3 {
            // 0.04 is a Mach number of 0.07.
            state.velocity[a][n] = (0.04 * wave((a + 1) % 3) + 0.01 * noise(a)) as f32;
        }
    }
    Ok(state)
}

/// A pseudorandom number: the finaliser of MurmurHash3 (Appleby 2011).
fn hash(n: usize) -> u32 {
    let mut n = n as u32;
    n = (n ^ (n >> 16)).wrapping_mul(0x85eb_ca6b);
    n = (n ^ (n >> 13)).wrapping_mul(0xc2b2_ae35);
    n ^ (n >> 16)
}
