//! Blocks that move away from the poses of their last tile search: skipped cells have not changed.

use glam::{DQuat, DVec3};
use kit::Rig;
use riprap::{
    geometry::{Polyhedron, Pose, Shape},
    gpu::{kernel::submit_pass, readback::Readback},
    lattice::{Lattice, Setup, SolidOperator},
    psm::{Frame, PLANES, SolidBlock, SolidCells},
    units::Units,
};
use std::{
    collections::{BTreeMap, BTreeSet},
    sync::Arc,
};

/// Three blocks in a periodic box.
struct World {
    rig: Rig,
    lattice: Lattice,
    immersed: SolidCells,
}

impl World {
    fn new(brick: [u32; 3], lanes: u32, lane_axis: usize) -> Self {
        let rig = Rig::new();
        let mut setup = Setup::periodic([70, 24, 16], 0.02);
        setup.brick = brick;
        (setup.lanes, setup.lane_axis) = (lanes, lane_axis);
        setup.solid_operator = Some(SolidOperator::Holdych);
        let lattice = Lattice::new(&rig.device, setup).unwrap();
        let units = Units {
            cell: 1.0,
            time_step: 1.0,
            density: 1.0,
        };
        let frame = Frame {
            origin: DVec3::ZERO,
            units,
        };
        let shapes: [Shape; 3] = [
            Polyhedron::cuboid(DVec3::new(7.0, 3.0, 1.5))
                .unwrap()
                .into(),
            Shape::sphere(4.5).unwrap(),
            Polyhedron::cuboid(DVec3::new(9.0, 9.0, 9.0))
                .unwrap()
                .into(),
        ];
        let submerged = |shape| SolidBlock::new(Arc::new(shape));
        let blocks = shapes.map(submerged).into();
        let immersed = SolidCells::new(&rig.device, &lattice, frame, blocks).unwrap();
        Self {
            rig,
            lattice,
            immersed,
        }
    }

    /// Sum of the shares and velocity in all cells of each saturated brick, by the index of the brick.
    fn saturation(&mut self, poses: &[Pose]) -> BTreeMap<u32, Vec<f32>> {
        let (device, queue) = (&self.rig.device, &self.rig.queue);
        let placed = self.immersed.place(device, queue, &mut self.lattice, poses);
        placed.unwrap();
        submit_pass(device, queue, |pass| self.immersed.record_cells(pass));
        let buffer = self.lattice.psm_planes().next().unwrap().1;
        let bricks = self.immersed.bricks();
        let grid = self.lattice.grid();
        let plane = (grid.brick.iter().product::<u32>() * grid.lanes) as usize;
        let mut readback = Readback::default();
        let count = bricks.len() * PLANES * plane;
        let read = readback.read(device, queue, buffer, count);
        let all = self.rig.wait(read).unwrap();
        let slots = bricks.iter().zip(all.chunks(PLANES * plane));
        slots
            .map(|(brick, slot)| (*brick, slot[..4 * plane].to_vec()))
            .collect()
    }
}

/// Poses through a periodic boundary, with rotations so fast that corners move farther than centres.
fn poses(step: u32) -> Vec<Pose> {
    let t = f64::from(step);
    let pose = |at: DVec3, velocity: DVec3, turn: f64| {
        let rotation = DQuat::from_axis_angle(DVec3::new(0.6, 0.0, 0.8), turn * t);
        Pose::rigid(at + velocity * t, rotation, velocity, DVec3::Z * turn)
    };
    vec![
        pose(
            DVec3::new(61.3, 6.0, 9.0),
            DVec3::new(0.21, 0.05, -0.03),
            0.03,
        ),
        pose(
            DVec3::new(20.4, 12.7, 8.1),
            DVec3::new(-0.12, 0.0, 0.14),
            0.0,
        ),
        pose(
            DVec3::new(32.0, 13.0, 8.0),
            DVec3::new(-0.1, 0.02, 0.0),
            0.02,
        ),
    ]
}

#[test]
fn blocks_that_move_have_the_cells_of_blocks_that_are_put_there() {
    for (brick, lanes, axis) in [
        ([64, 1, 1], 1, 2),
        ([16, 2, 2], 4, 2),
        ([8, 4, 1], 4, 2),
        ([32, 1, 1], 4, 1),
        ([4, 4, 2], 1, 2),
    ] {
        let [mut moving, mut put_there] = [0, 1].map(|_| World::new(brick, lanes, axis));
        let (mut steps_on, mut bricks) = (0, 0);
        for step in 0..24 {
            let searches = moving.immersed.work().searches;
            let found = moving.saturation(&poses(step));
            if moving.immersed.work().searches > searches {
                continue;
            }
            steps_on += 1;
            put_there.immersed.tile(&[None; 3]);
            let put = put_there.saturation(&poses(step));
            bricks += put.len();
            let all: BTreeSet<u32> = put.keys().chain(found.keys()).copied().collect();
            for number in all {
                // Both lists include bricks that a block may reach later.
                let [found, put] = [&found, &put].map(|bricks| bricks.get(&number));
                let nothing = |cells: &Vec<f32>| cells.iter().all(|x| *x == 0.0);
                let same = match (found, put) {
                    (Some(found), Some(put)) => found == put,
                    (one, other) => one.or(other).is_none_or(nothing),
                };
                assert!(same, "{brick:?}, step {step}: brick {number}");
            }
        }
        assert!(steps_on > 12 && bricks > 100, "{steps_on} {bricks}");
    }
}
