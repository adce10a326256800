//! Turbulence that velocity faces feed (Kraichnan 1970; Smirnov, Shi & Celik 2001).

use super::{
    Face, Grid, Lattice, MovingCell, Setup,
    boundary::cell_pass,
    buffers::{inlet_velocities, moving_side, storage},
    cell_kernels::CellDispatch,
    fluid::{Dispatch, in_plane},
};
use crate::{
    Error, Result,
    gpu::{
        buffers::{filled, zeroed},
        readback::Readback,
    },
    random::uniform,
};
use bytemuck::{Pod, Zeroable};
use std::f64::consts::{PI, TAU};

/// Sizes of the eddies of a face.
const SIZES: usize = 22;
/// Modes of a face: of each size three in directions normal to each other, so that all components are alike.
const MODES: usize = 3 * SIZES;
/// Units of the distance that the mean flow has travelled, a cell.
const PER_CELL: f64 = 65536.0;
/// Shortest wave, cells.
const SHORTEST: f64 = 5.0;

/// Isotropic turbulence that a velocity face adds to its velocities: von Kármán's spectrum in Fourier modes, which the mean normal velocity
/// of the face carries in unchanged (Taylor's hypothesis). It has no net flow through the face.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SyntheticTurbulence {
    /// RMS of each component over the mean normal velocity of the face.
    pub intensity: f64,
    /// Integral length of the eddies, cells, from 1; waves are 5 to 8 of these lengths long.
    pub length: f64,
    /// Chooses phases and directions.
    pub seed: u64,
}

/// A wave of [`SyntheticTurbulence`] at unit intensity: a cos p + b sin p with p = k·x + phase.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FourierMode {
    /// Wave numbers, radians a cell.
    pub k: [f64; 3],
    /// Amplitudes, normal to sin k.
    pub a: [f64; 3],
    /// Those of the sine, normal to both.
    pub b: [f64; 3],
    /// Radians.
    pub phase: f64,
}

/// A mode as it lies in `kernels/lattice/synthetic_turbulence.wgsl`.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
pub struct FaceMode {
    /// Of the cosine.
    pub a: [f32; 3],
    /// Turns a cell along the lower axis of the face.
    pub lower: u32,
    /// Of the sine.
    pub b: [f32; 3],
    /// Turns a cell along the upper axis.
    pub upper: u32,
    /// Mean normal velocity over the face, of the cosine and the sine of the phase in its first cell.
    pub mean: [f32; 2],
    /// Turns for the unit of the distance in the normal direction.
    pub normal: u32,
    /// In the first cell at the start.
    pub phase: u32,
}

/// A face with its modes, as it lies there.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
pub struct TurbulentFace {
    /// At unit intensity.
    pub modes: [FaceMode; MODES],
    /// Normal to the face.
    pub axis: u32,
    /// Distance of the mean flow in a step, signed.
    pub advance: u32,
    /// RMS of each component.
    pub intensity: f32,
    /// Not used.
    pub pad: u32,
}

/// Radians as 32-bit parts of a turn, wrapped.
fn turns(radians: f64) -> u32 {
    (radians / TAU * 4_294_967_296.0).round() as i64 as u32
}

fn radians(turns: u32) -> f64 {
    f64::from(turns as i32) / 4_294_967_296.0 * TAU
}

impl SyntheticTurbulence {
    /// Whether a face can have it.
    ///
    /// # Errors
    /// [`Error::Argument`] of what `name` has.
    pub(super) fn check(&self, name: &str) -> Result<()> {
        let refuse = |key: &str, message: String| {
            Err(Error::argument(format!("{name}.turbulence.{key}"), message))
        };
        if !(self.intensity > 0.0 && self.intensity <= 1.0) {
            let message = format!("is {}; an intensity lies above 0, up to 1", self.intensity);
            return refuse("intensity", message);
        }
        if !(self.length >= 1.0 && self.length <= 1e6) {
            let message = format!(
                "is {} cells; the lattice carries eddies from 1 cell on, to 1e6",
                self.length
            );
            return refuse("length", message);
        }
        Ok(())
    }

    /// Its waves for a face normal to `axis`.
    pub fn modes(&self, axis: usize) -> [FourierMode; MODES] {
        let draw = |what: i64, m: usize| uniform(self.seed, &[what, m as i64]);
        // Wave numbers: equal ratios from that of 8 lengths to that of 5 cells.
        let (first, last) = (PI / (4.0 * self.length), TAU / SHORTEST);
        let ratio = (last / first).powf(1.0 / (SIZES - 1) as f64);
        let size = |m: usize| first * ratio.powi(m as i32);
        // E dk of von Kármán's spectrum; dk grows as k does.
        let energy = |m: usize| {
            let x = size(m) * self.length / 0.747;
            x.powi(4) / (1.0 + x * x).powf(17.0 / 6.0) * size(m)
        };
        let total: f64 = (0..SIZES).map(energy).sum();
        std::array::from_fn(|m| {
            let (group, member) = (m / 3, m % 3);
            // Of one mode each component has the variance A² (1 - d²)/2, d being the direction of sin k: of three, A² each.
            let amplitude = (energy(group) / total).sqrt();
            let direction = frame(|n| draw(n, group))[member];
            // sin k along the direction, with the wave number as the kernel has it.
            let k: [f64; 3] = std::array::from_fn(|i| {
                let unit = if i == axis { PER_CELL } else { 1.0 };
                let k = (size(group).sin() * direction[i]).asin();
                unit * radians(turns(k / unit))
            });
            let along = unit(k.map(f64::sin));
            let other = unit_vector(draw(4, m), draw(5, m));
            let a = unit(cross(along, other));
            let b = cross(along, a);
            FourierMode {
                k,
                a: a.map(|a| amplitude * a),
                b: b.map(|b| amplitude * b),
                phase: radians(turns(TAU * draw(6, m))),
            }
        })
    }

    /// The modes of a face whose cells have these places along its axes.
    fn face_modes(&self, axis: usize, places: &[[u32; 2]]) -> [FaceMode; MODES] {
        let (lower, upper) = in_plane(axis);
        self.modes(axis).map(|mode| {
            let [l, u] = [turns(mode.k[lower]), turns(mode.k[upper])];
            let (mut cos, mut sin) = (0.0, 0.0);
            for [x, y] in places {
                let p = radians(l.wrapping_mul(*x).wrapping_add(u.wrapping_mul(*y)));
                cos += p.cos();
                sin += p.sin();
            }
            let count = places.len().max(1) as f64;
            let (cos, sin) = (cos / count, sin / count);
            let (a, b) = (mode.a[axis], mode.b[axis]);
            FaceMode {
                a: mode.a.map(|a| a as f32),
                lower: l,
                b: mode.b.map(|b| b as f32),
                upper: u,
                mean: [a * cos + b * sin, b * cos - a * sin].map(|mean| mean as f32),
                normal: turns(mode.k[axis] / PER_CELL),
                phase: turns(mode.phase),
            }
        })
    }
}

/// A direction of a sphere for two numbers from 0 to 1.
fn unit_vector(height: f64, turn: f64) -> [f64; 3] {
    let z = 2.0 * height - 1.0;
    let r = (1.0 - z * z).sqrt();
    let (sin, cos) = (TAU * turn).sin_cos();
    [r * cos, r * sin, z]
}

/// Three directions normal to each other, of four drawn numbers.
fn frame(draw: impl Fn(i64) -> f64) -> [[f64; 3]; 3] {
    let pole = unit_vector(draw(0), draw(1));
    let x = unit(cross(pole, unit_vector(draw(2), draw(3))));
    [x, cross(pole, x), pole]
}

fn cross(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [0, 1, 2].map(|i| {
        let (j, k) = ((i + 1) % 3, (i + 2) % 3);
        a[j] * b[k] - a[k] * b[j]
    })
}

/// A vector over its length; one of no length has no direction, and becomes 0.
fn unit(v: [f64; 3]) -> [f64; 3] {
    let length = v.iter().map(|a| a * a).sum::<f64>().sqrt();
    v.map(|a| a / length.max(1e-300))
}

/// The turbulence of a face on the device.
#[derive(Debug)]
pub(super) struct Inlet {
    axis: usize,
    side: usize,
    /// The place on the face of each of its cells.
    places: Vec<[u32; 2]>,
    /// Its cells among the moving cells.
    cells: wgpu::Buffer,
    mean_velocity: wgpu::Buffer,
    uniform: wgpu::Buffer,
    travelled: wgpu::Buffer,
}

impl Inlet {
    /// Those of a setup.
    pub(super) fn all(
        device: &wgpu::Device,
        setup: &Setup,
        grid: &Grid,
        moving: &[MovingCell],
    ) -> Vec<Self> {
        let faces = (0..3).flat_map(|axis| [(axis, 0), (axis, 1)]);
        let made = faces.filter_map(|(axis, side)| {
            let turbulence = setup.turbulence[axis][side]?;
            let (lower, upper) = in_plane(axis);
            let on_face = |cell: &MovingCell| moving_side(cell, axis) == Some(side);
            let all = (0_u32..).zip(moving).filter(|(_, cell)| on_face(cell));
            let (listed, places): (Vec<u32>, Vec<[u32; 2]>) = all
                .map(|(n, cell)| {
                    let at = grid.padded_cell(cell.cell);
                    (n, [at[lower], at[upper]])
                })
                .unzip();
            // Solids may close a face entirely.
            if listed.is_empty() {
                return None;
            }
            let content = TurbulentFace {
                modes: turbulence.face_modes(axis, &places),
                axis: axis as u32,
                advance: 0,
                intensity: 0.0,
                pad: 0,
            };
            let usage = wgpu::BufferUsages::UNIFORM | wgpu::BufferUsages::COPY_DST;
            let bytes = 12 * listed.len() as u64;
            Some(Self {
                axis,
                side,
                cells: storage(device, "turbulent cells", bytemuck::cast_slice(&listed)),
                mean_velocity: zeroed(device, "mean velocity", bytes),
                uniform: filled(
                    device,
                    "turbulent face",
                    bytemuck::bytes_of(&content),
                    usage,
                ),
                travelled: zeroed(device, "travelled", 8),
                places,
            })
        });
        made.collect()
    }

    /// Bytes of its buffers.
    pub(super) fn bytes(&self) -> u64 {
        let buffers = [
            &self.cells,
            &self.mean_velocity,
            &self.uniform,
            &self.travelled,
        ];
        buffers.into_iter().map(wgpu::Buffer::size).sum()
    }
}

impl Lattice {
    /// What turbulent faces add to the velocities of the coming step.
    pub(super) fn turbulence_passes(
        &self,
        device: &wgpu::Device,
        moving: &wgpu::Buffer,
        odd: u32,
    ) -> Result<Vec<Dispatch>> {
        let program = self.cell_program("synthetic_turbulence");
        let inlets = self.buffers.inlets.iter();
        let dispatch = |inlet: &Inlet| {
            let dispatch = CellDispatch {
                program: &program,
                entry: "feed_turbulence",
                pass: cell_pass(odd, 0, &(0..inlet.places.len())),
                buffers: &[
                    ("moving_cells", moving),
                    ("turbulent_cells", &inlet.cells),
                    ("mean_velocity", &inlet.mean_velocity),
                    ("turbulent_face", &inlet.uniform),
                    ("travelled", &inlet.travelled),
                ],
                constants: &[],
                invocations: inlet.places.len() as u32,
            };
            self.cell_dispatch(device, &dispatch)
        };
        inlets.map(dispatch).collect()
    }

    /// Gives turbulent faces the mean velocities of the setup.
    pub(super) fn write_mean_velocities(&self, queue: &wgpu::Queue) {
        for inlet in &self.buffers.inlets {
            let (axis, side) = (inlet.axis, inlet.side);
            let (Face::Velocity(velocities), Some(turbulence)) = (
                &self.setup.faces[axis][side],
                self.setup.turbulence[axis][side],
            ) else {
                continue;
            };
            let (lower, _) = in_plane(axis);
            let row = self.grid.cells[lower];
            let of = |[x, y]: &[u32; 2]| velocities[(x + row * y) as usize];
            let normal = inlet.places.iter().map(|place| f64::from(of(place)[axis]));
            let normal = normal.sum::<f64>() / inlet.places.len() as f64;
            let open = inlet_velocities(&self.setup, &self.grid, axis, side);
            let of = |[x, y]: &[u32; 2]| open[(x + row * y) as usize];
            let mean: Vec<[f32; 3]> = inlet.places.iter().map(of).collect();
            let advance = (normal * PER_CELL).round() as i64 as u32;
            let intensity = (turbulence.intensity * normal.abs()) as f32;
            queue.write_buffer(&inlet.mean_velocity, 0, bytemuck::cast_slice(&mean));
            let words = [advance, intensity.to_bits()];
            let at = std::mem::offset_of!(TurbulentFace, advance) as u64;
            queue.write_buffer(&inlet.uniform, at, bytemuck::cast_slice(&words));
        }
    }

    /// Has the mean flow through each turbulent face have come so far.
    pub(super) fn set_travelled(&self, queue: &wgpu::Queue, travelled: &[u32]) {
        let travelled = travelled.iter().chain(std::iter::repeat(&0));
        for (inlet, &distance) in self.buffers.inlets.iter().zip(travelled) {
            let both = [distance; 2];
            queue.write_buffer(&inlet.travelled, 0, bytemuck::cast_slice(&both));
        }
    }

    /// How far the mean flow has come through each turbulent face before the coming step, when the present one is complete.
    pub(super) async fn travelled(
        &self,
        device: &wgpu::Device,
        queue: &wgpu::Queue,
    ) -> Result<Vec<u32>> {
        let mut readback = Readback::default();
        let mut all = Vec::with_capacity(self.buffers.inlets.len());
        for inlet in &self.buffers.inlets {
            let both: Vec<u32> = readback.read(device, queue, &inlet.travelled, 2).await?;
            all.push(both[1 - self.parity()]);
        }
        Ok(all)
    }
}
