//! The boundary passes of a step on every adapter, by kind of boundary and axis: both faces normal to an axis of a cube.
//!
//! An iteration is the boundary passes of several lattices in one submission; the rest of their steps is not timed.

mod common;

use common::{Adapter, on_adapters};
use criterion::Throughput;
use kit::subject::sheared_noise;
use riprap::{
    Error,
    gpu::kernel::submit_pass,
    lattice::{Face, Lattice},
    wgpu,
};

/// Cells per axis.
const N: u32 = 64;
/// Lattices whose passes are submitted together.
const LATTICES: usize = 4;
/// Speed in lattice units: a Mach number of 0.07.
const SPEED: f32 = 0.04;

/// The boundary of both faces normal to an axis.
type Kind = fn(axis: usize) -> Face;

const KINDS: [(&str, Kind); 5] = [
    ("walls", |_| Face::Wall([0.0; 3])),
    ("moving walls", |axis| {
        Face::Wall(along((axis + 1) % 3).map(f64::from))
    }),
    // The flow enters through one face and leaves through the other.
    ("inlets", |axis| {
        Face::Velocity(vec![along(axis); (N * N) as usize])
    }),
    ("pressure", |_| Face::Pressure { density: 1.0 }),
    ("outflow", |_| Face::Outflow { density: 1.0 }),
];

fn along(axis: usize) -> [f32; 3] {
    [0, 1, 2].map(|a| if a == axis { SPEED } else { 0.0 })
}

fn main() -> Result<(), Error> {
    on_adapters("million cells of the faces a second", |adapter| {
        for (kind, face) in KINDS {
            for (axis, name) in ["x", "y", "z"].into_iter().enumerate() {
                let mut lattices = (0..LATTICES)
                    .map(|_| lattice(adapter, axis, face))
                    .collect::<Result<Vec<_>, _>>()?;
                let work = Throughput::Elements(LATTICES as u64 * 2 * u64::from(N * N));
                let (device, queue) = (adapter.device.clone(), adapter.queue.clone());
                let rest = |lattices: &mut Vec<Lattice>| {
                    submit_pass(&device, &queue, |pass| {
                        let each = lattices.iter_mut();
                        each.for_each(|lattice| lattice.record(pass));
                    });
                    Ok(())
                };
                let passes = |lattices: &mut Vec<Lattice>, pass: &mut wgpu::ComputePass<'_>| {
                    for lattice in lattices {
                        lattice.record_boundaries(pass);
                    }
                };
                let variant = format!("{kind} across {name}");
                adapter.prepared("boundary", &variant, work, &mut lattices, rest, passes);
            }
        }
        Ok(())
    })
}

fn lattice(adapter: &Adapter<'_>, axis: usize, face: Kind) -> Result<Lattice, Error> {
    let mut setup = adapter.setup(N);
    setup.faces[axis] = [face(axis), face(axis)];
    let state = sheared_noise(&setup)?;
    let mut lattice = Lattice::new(&adapter.device, setup)?;
    lattice.start(&adapter.device, &adapter.queue, &state, true)?;
    Ok(lattice)
}
