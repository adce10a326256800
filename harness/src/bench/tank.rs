//! A cube of water in a tank that it fills, to be timed.

use glam::{DMat3, DVec3};
use riprap::{
    Result,
    bodies::Pose,
    particles::{Body, Neighbours, Particles, Setup, Side},
    wgpu,
};

/// Water at rest, with what its steps meet.
#[derive(Debug)]
pub struct Tank {
    /// The water on the device.
    pub particles: Particles,
    /// Particles of the water.
    pub count: usize,
    /// Neighbours of a particle, those in walls included.
    pub neighbours: f64,
    /// Pairs that the sums of a step meet, each once for each of its ends: the sums of momentum and continuity, and
    /// the pressure of walls.
    pub pairs: f64,
}

impl Tank {
    /// A cube of water, `edge` particles long, open above.
    ///
    /// # Errors
    /// If the device does not hold it.
    pub fn fill(
        device: &wgpu::Device,
        queue: &wgpu::Queue,
        edge: u32,
        neighbours: Neighbours,
    ) -> Result<Self> {
        let (mut setup, positions) = tank(edge);
        setup.neighbours = neighbours;
        let still = vec![DVec3::ZERO; positions.len()];
        let pressure = |x: &DVec3| setup.density * 9.81 * (setup.size.z - x.z);
        let pressures: Vec<f64> = positions.iter().map(pressure).collect();
        let (water, walls) = pairs(&setup, &positions);
        let particles = Particles::new(device, queue, setup, &positions, &still, &pressures)?;
        Ok(Self {
            particles,
            count: positions.len(),
            neighbours: (water + walls) / positions.len() as f64,
            pairs: 2.0 * water + 3.0 * walls,
        })
    }

    /// Takes about `steps` steps and says how many.
    ///
    /// # Errors
    /// If the device is lost.
    pub async fn advance(
        &mut self,
        device: &wgpu::Device,
        queue: &wgpu::Queue,
        steps: u32,
    ) -> Result<u32> {
        let poses = [Pose {
            centre: DVec3::ZERO,
            deformation: DMat3::IDENTITY,
            velocity: DVec3::ZERO,
            deformation_rate: DMat3::ZERO,
        }];
        let time = self.particles.limit() * f64::from(steps) * 0.999;
        let done = self.particles.advance(device, queue, &poses, time).await?;
        Ok(done.steps)
    }
}

/// A cube of water, `edge` particles long, in a tank that it fills, open above.
fn tank(edge: u32) -> (Setup, Vec<DVec3>) {
    let spacing = 1.0 / f64::from(edge);
    let mut setup = Setup::tank(DVec3::ONE, spacing, 45.0);
    setup.faces[2][1] = Side::Open;
    let layers = setup.layers() as i32;
    let (mut shell, mut water) = (Vec::new(), Vec::new());
    let edge = edge as i32;
    for k in -layers..edge {
        for j in -layers..edge + layers {
            for i in -layers..edge + layers {
                let place = spacing * (DVec3::new(i.into(), j.into(), k.into()) + 0.5);
                let inside = [i, j, k].iter().all(|n| (0..edge).contains(n));
                if inside { &mut water } else { &mut shell }.push(place);
            }
        }
    }
    setup.bodies = vec![Body {
        shell,
        ..Body::default()
    }];
    (setup, water)
}

/// Pairs of water with water and of water with walls, of particles on the lattice, each for its end in the water.
fn pairs(setup: &Setup, positions: &[DVec3]) -> (f64, f64) {
    let reach = (2.0 * setup.smoothing).ceil() as i32;
    let mut offsets = Vec::new();
    for k in -reach..=reach {
        for j in -reach..=reach {
            for i in -reach..=reach {
                let r = DVec3::new(i.into(), j.into(), k.into());
                if r.length_squared() < 4.0 * setup.smoothing.powi(2) && (i, j, k) != (0, 0, 0) {
                    offsets.push(r * setup.spacing);
                }
            }
        }
    }
    let (mut water, mut walls) = (0.0, 0.0);
    for x in positions {
        for offset in &offsets {
            let y = *x + *offset;
            let inside = y.cmpge(DVec3::ZERO).all() && y.cmplt(setup.size).all();
            *if inside {
                &mut water
            } else if y.z < setup.size.z {
                &mut walls
            } else {
                continue;
            } += 1.0;
        }
    }
    (water, walls)
}
