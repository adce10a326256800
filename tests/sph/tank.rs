//! A tank of water with walls of shell particles, on a device.

use crate::rig::Rig;
use glam::{DMat3, DVec3};
use riprap::{
    bodies::Pose,
    particles::{Body, Exchange, Particles, Setup, Side, Water},
};

pub struct Tank {
    pub rig: Rig,
    pub particles: Particles,
    pub poses: Vec<Pose>,
}

/// A body that rests at a place.
pub fn resting(centre: DVec3) -> Pose {
    Pose {
        centre,
        deformation: DMat3::IDENTITY,
        velocity: DVec3::ZERO,
        deformation_rate: DMat3::ZERO,
    }
}

/// The points (i + ½) Δx of a box of whole spacings, `y` only in the middle of a plane setup.
pub fn lattice(setup: &Setup, low: [i32; 3], high: [i32; 3]) -> Vec<DVec3> {
    let mut points = Vec::new();
    let [mut low, mut high] = [low, high];
    if setup.plane {
        (low[1], high[1]) = (0, 1);
    }
    for k in low[2]..high[2] {
        for j in low[1]..high[1] {
            for i in low[0]..high[0] {
                let place = [i, j, k].map(|n| f64::from(n) + 0.5);
                let mut point = setup.origin + setup.spacing * DVec3::from(place);
                if setup.plane {
                    point.y = setup.origin.y + 0.5 * setup.size.y;
                }
                points.push(point);
            }
        }
    }
    points
}

/// Shell particles behind the walls of the domain.
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
    let mut shell = lattice(setup, low, high);
    shell.retain(outside);
    Body {
        shell,
        ..Body::default()
    }
}

impl Tank {
    /// Water at `positions` with the pressures `pressure`, at rest.
    pub fn new(
        setup: Setup,
        poses: Vec<Pose>,
        positions: &[DVec3],
        pressure: impl Fn(DVec3) -> f64,
    ) -> Self {
        let rig = Rig::new();
        let still = vec![DVec3::ZERO; positions.len()];
        let pressures: Vec<f64> = positions.iter().map(|x| pressure(*x)).collect();
        let particles = Particles::new(
            &rig.device,
            &rig.queue,
            setup,
            positions,
            &still,
            &pressures,
        )
        .unwrap();
        Self {
            rig,
            particles,
            poses,
        }
    }

    pub fn ask(&mut self, places: &[DVec3]) {
        let Rig { device, queue } = &self.rig;
        self.particles.ask(device, queue, places, &[]).unwrap();
    }

    pub fn advance(&mut self, time: f64) -> Exchange {
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
