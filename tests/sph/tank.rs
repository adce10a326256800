//! A tank of water with walls of boundary particles, on a device.

use glam::{DMat3, DVec3};
use kit::Rig;
use riprap::{
    geometry::Pose,
    sph::{Body, ExchangeResult, Setup, Side, SphSolver, Water},
};

pub struct Tank {
    pub rig: Rig,
    pub particles: SphSolver,
    pub poses: Vec<Pose>,
}

/// The pose of a body at rest.
pub fn resting(centre: DVec3) -> Pose {
    Pose {
        centre,
        deformation: DMat3::IDENTITY,
        velocity: DVec3::ZERO,
        deformation_rate: DMat3::ZERO,
    }
}

/// The points (i + ½) Δx of a box of whole spacings; a planar setup has one row in the middle.
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

impl Tank {
    /// Water at rest at `positions` with the given pressures.
    pub fn new(
        setup: Setup,
        poses: Vec<Pose>,
        positions: &[DVec3],
        pressure: impl Fn(DVec3) -> f64,
    ) -> Self {
        let still = vec![DVec3::ZERO; positions.len()];
        let pressures: Vec<f64> = positions.iter().map(|x| pressure(*x)).collect();
        Self::moving(setup, poses, positions, &still, &pressures)
    }

    /// Water in motion.
    pub fn moving(
        setup: Setup,
        poses: Vec<Pose>,
        positions: &[DVec3],
        velocities: &[DVec3],
        pressures: &[f64],
    ) -> Self {
        let rig = Rig::new();
        let Rig { device, queue } = &rig;
        let particles = SphSolver::new(device, queue, setup, positions, velocities, pressures);
        Self {
            particles: particles.unwrap(),
            poses,
            rig,
        }
    }

    pub fn advance(&mut self, time: f64) -> ExchangeResult {
        let Rig { device, queue } = &self.rig;
        let done = self.particles.advance(device, queue, &self.poses, time);
        self.rig.wait(done).unwrap()
    }

    pub fn water(&mut self) -> Water {
        let Rig { device, queue } = &self.rig;
        let water = self.particles.water(device, queue);
        self.rig.wait(water).unwrap()
    }
}
