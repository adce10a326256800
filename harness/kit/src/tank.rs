//! A tank full of water, for timing.

use crate::gpu::is_software;
use glam::{DQuat, DVec3};
use riprap::{
    Result,
    geometry::Pose,
    sph::{Body, NeighbourSearch, Setup, Side, SphSolver},
    wgpu,
};
use std::collections::HashMap;

/// Water at rest or in motion, with the numbers of its pairs.
#[derive(Debug)]
pub struct Tank {
    /// The water on the device.
    pub particles: SphSolver,
    /// Particles of the water.
    pub count: usize,
    /// Neighbours per particle, boundary particles included.
    pub neighbours: f64,
    /// Pairs evaluated by the sums of a step, once for each of their ends: in the sums of momentum and continuity, and in the
    /// pressure of boundary particles.
    pub pairs: f64,
}

impl Tank {
    /// A cube of water, `edge` particles long, open above.
    pub fn fill(
        device: &wgpu::Device,
        queue: &wgpu::Queue,
        edge: u32,
        neighbours: NeighbourSearch,
    ) -> Result<Self> {
        let (mut setup, positions) = tank(edge);
        setup.neighbours = neighbours;
        let (water, walls) = pairs(&setup, &positions);
        let pairs = [water, walls];
        Self::begin((device, queue), setup, &positions, pairs)
    }

    /// The same tank with a column of half its width after a dam break; `pairs` are not counted yet.
    pub fn dam(
        device: &wgpu::Device,
        queue: &wgpu::Queue,
        edge: u32,
        neighbours: NeighbourSearch,
    ) -> Result<Self> {
        let (mut setup, mut positions) = tank(edge);
        setup.neighbours = neighbours;
        positions.retain(|x| x.x < 0.5 * setup.size.x);
        Self::begin((device, queue), setup, &positions, [0.0; 2])
    }

    fn begin(
        (device, queue): (&wgpu::Device, &wgpu::Queue),
        mut setup: Setup,
        positions: &[DVec3],
        pairs: [f64; 2],
    ) -> Result<Self> {
        setup.batched_neighbours = !is_software(&device.adapter_info());
        let still = vec![DVec3::ZERO; positions.len()];
        let pressure = |x: &DVec3| setup.density * 9.81 * (setup.size.z - x.z);
        let pressures: Vec<f64> = positions.iter().map(pressure).collect();
        let particles = SphSolver::new(device, queue, setup, positions, &still, &pressures)?;
        let mut tank = Self {
            particles,
            count: positions.len(),
            neighbours: 0.0,
            pairs: 0.0,
        };
        tank.meets(pairs);
        Ok(tank)
    }

    fn meets(&mut self, [water, walls]: [f64; 2]) {
        self.neighbours = (water + walls) / self.count as f64;
        self.pairs = 2.0 * water + 3.0 * walls;
    }

    /// Counts the pairs at the present positions of the particles.
    pub async fn count(&mut self, device: &wgpu::Device, queue: &wgpu::Queue) -> Result<()> {
        let water = self.particles.water(device, queue).await?;
        let setup = self.particles.setup();
        let reach = 2.0 * setup.smoothing * setup.spacing;
        let cell = |x: DVec3| (x / reach).floor().to_array().map(|n| n as i32);
        let mut cells: HashMap<[i32; 3], Vec<(DVec3, usize)>> = HashMap::new();
        let boundary = setup.bodies.iter().flat_map(|body| &body.boundary);
        let all = water.positions.iter().map(|x| (*x, 0));
        for (x, kind) in all.chain(boundary.map(|x| (*x, 1))) {
            cells.entry(cell(x)).or_default().push((x, kind));
        }
        let mut pairs = [0.0; 2];
        for x in &water.positions {
            let own = cell(*x);
            for n in 0..27 {
                let beside = [n % 3, n / 3 % 3, n / 9];
                let beside = std::array::from_fn(|axis| own[axis] + beside[axis] - 1);
                for (y, kind) in cells.get(&beside).into_iter().flatten() {
                    if x.distance_squared(*y) < reach * reach && x != y {
                        pairs[*kind] += 1.0;
                    }
                }
            }
        }
        self.meets(pairs);
        Ok(())
    }

    /// Takes about `steps` steps; returns their number and how many of them sorted.
    pub async fn advance(
        &mut self,
        device: &wgpu::Device,
        queue: &wgpu::Queue,
        steps: u32,
    ) -> Result<[u32; 2]> {
        let poses = [resting(DVec3::ZERO)];
        let time = self.particles.step_limit() * f64::from(steps) * 0.999;
        let done = self.particles.advance(device, queue, &poses, time).await?;
        Ok([done.steps, done.sorts])
    }
}

/// A cube of water, `edge` particles long, that fills a tank open above.
fn tank(edge: u32) -> (Setup, Vec<DVec3>) {
    let mut setup = Setup::tank(DVec3::ONE, 1.0 / f64::from(edge), 45.0);
    setup.faces[2][1] = Side::Open;
    setup.bodies = vec![walls(&setup)];
    let water = lattice(&setup, [0; 3], [edge as i32; 3]);
    (setup, water)
}

/// The pose of a body at rest.
pub fn resting(centre: DVec3) -> Pose {
    Pose::at_rest(centre, DQuat::IDENTITY)
}

/// The points (i + ½) Δx of a box of whole spacings; a planar setup has one row in its middle.
pub fn lattice(setup: &Setup, low: [i32; 3], high: [i32; 3]) -> Vec<DVec3> {
    let mut points = Vec::new();
    let [mut low, mut high] = [low, high];
    if setup.plane {
        (low[1], high[1]) = (0, 1);
    }
    for k in low[2]..high[2] {
        for j in low[1]..high[1] {
            for i in low[0]..high[0] {
                let index = [i, j, k].map(|n| f64::from(n) + 0.5);
                let mut point = setup.origin + setup.spacing * DVec3::from(index);
                if setup.plane {
                    point.y = setup.origin.y + 0.5 * setup.size.y;
                }
                points.push(point);
            }
        }
    }
    points
}

/// Boundary particles behind the walls of the domain.
pub fn walls(setup: &Setup) -> Body {
    let layers = setup.layers() as i32;
    let cells = (setup.size / setup.spacing)
        .round()
        .to_array()
        .map(|n| n as i32);
    let mut low = [-layers; 3];
    let mut high = cells.map(|n| n + layers);
    for axis in 0..3 {
        if setup.faces[axis][0] == Side::Periodic {
            (low[axis], high[axis]) = (0, cells[axis]);
        }
        if setup.faces[axis][0] == Side::Open {
            low[axis] = 0;
        }
        if setup.faces[axis][1] == Side::Open {
            high[axis] = cells[axis];
        }
    }
    let end = setup.origin + setup.size;
    let outside = |x: &DVec3| {
        let axes = if setup.plane { &[0, 2][..] } else { &[0, 1, 2] };
        axes.iter()
            .any(|&axis| x[axis] < setup.origin[axis] || x[axis] > end[axis])
    };
    let mut boundary = lattice(setup, low, high);
    boundary.retain(outside);
    Body {
        boundary,
        ..Body::default()
    }
}

/// Pairs of water with water and of water with walls, for particles on the lattice, counted at each end in the water.
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
