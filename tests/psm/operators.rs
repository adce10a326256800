//! Blocks placed in the fluid by [`SolidCells`], compared with the twin with exact solid fractions.

use crate::{
    effective::{effective_polyhedron, together},
    fixture::Subject,
};
use glam::{DMat3, DQuat, DVec3};
use kit::{
    twin::of_setup::{limit, walled},
    twin::{Solid, tightness},
};
use riprap::{
    geometry::{HalfSpace, Load, Polyhedron, Pose},
    gpu::{kernel::submit_pass, readback::Readback},
    lattice::{Face, Setup, SolidOperator, SolidWeight, Storage},
    psm::{Frame, SolidBlock, SolidCells},
    units::Units,
};
use std::{collections::BTreeSet, sync::Arc};

/// An axis-aligned box, whose share of a cell is a product, in lattice units.
#[derive(Clone, Copy)]
struct Cuboid {
    centre: DVec3,
    size: DVec3,
    velocity: DVec3,
    spin: DVec3,
}

impl Cuboid {
    fn pose(&self) -> Pose {
        Pose::rigid(self.centre, DQuat::IDENTITY, self.velocity, self.spin)
    }

    /// Fraction of the cell at `centre` that lies inside.
    fn share(&self, centre: DVec3) -> f64 {
        let low = (centre - 0.5).max(self.centre - 0.5 * self.size);
        let high = (centre + 0.5).min(self.centre + 0.5 * self.size);
        (high - low).max(DVec3::ZERO).element_product()
    }

    /// The effective fractions for the weight of the solid.
    fn effective(&self, centre: DVec3, weight: SolidWeight) -> [f64; 2] {
        let share = self.share(centre);
        if weight == SolidWeight::Standard {
            return [share; 2];
        }
        let axes = [DVec3::X, DVec3::Y, DVec3::Z];
        let faces = axes.into_iter().flat_map(|axis| {
            let distance = 0.5 * self.size.dot(axis);
            [axis, -axis].map(|normal| HalfSpace { normal, distance })
        });
        effective_polyhedron(&faces.collect::<Vec<_>>(), centre - self.centre, share)
    }

    /// Whether the box of half width `reach` around `centre` lies inside.
    fn holds(&self, centre: DVec3, reach: f64) -> bool {
        ((centre - self.centre).abs() + reach)
            .cmple(0.5 * self.size)
            .all()
    }

    fn touches(&self, centre: DVec3, reach: f64) -> bool {
        ((centre - self.centre).abs() - reach)
            .cmplt(0.5 * self.size)
            .all()
    }

    /// Whether a side of the cell at `centre` lies on the surface of the box, with its middle in one of the faces.
    fn borders(&self, centre: DVec3) -> bool {
        let over = (centre - self.centre).abs() - 0.5 * self.size;
        let on = |axis: usize| {
            let [b, c] = [(axis + 1) % 3, (axis + 2) % 3];
            (over[axis] - 0.5).abs() < 1e-3 && over[b] < 0.0 && over[c] < 0.0
        };
        (0..3).any(on)
    }

    fn velocity_at(&self, x: DVec3) -> DVec3 {
        self.velocity + self.spin.cross(x - self.centre)
    }
}

/// Centres of a cell and of its images across periodic boundaries.
fn images(cells: [usize; 3], periodic: [bool; 3], cell: usize) -> Vec<DVec3> {
    let [nx, ny, _] = cells;
    let at = DVec3::from_array([cell % nx, cell / nx % ny, cell / (nx * ny)].map(|n| n as f64));
    let shifts = |axis: usize| match periodic[axis] {
        true => vec![-1.0, 0.0, 1.0],
        false => vec![0.0],
    };
    let period = DVec3::from_array(cells.map(|n| n as f64));
    let mut all = Vec::new();
    for z in shifts(2) {
        for y in shifts(1) {
            for x in shifts(0) {
                all.push(at + 0.5 + DVec3::new(x, y, z) * period);
            }
        }
    }
    all
}

/// The solid of several boxes in a cell.
fn solid_of(boxes: &[Cuboid], centres: &[DVec3], weight: SolidWeight) -> Solid {
    let mut flux = DVec3::ZERO;
    let mut parts = Vec::new();
    let mut solid = Solid::default();
    let mut met = BTreeSet::new();
    let each = boxes.iter().enumerate();
    for ((number, block), &x) in each.flat_map(|b| centres.iter().map(move |x| (b, x))) {
        let share = block.share(x);
        if share > 0.0 || block.borders(x) {
            met.insert(number);
        }
        let effective = block.effective(x, weight);
        parts.push((share, effective));
        solid.shares += effective[0];
        flux += effective[0] * block.velocity_at(x);
        solid.deep |= block.holds(x, 2.5);
        solid.beside |= block.touches(x, 1.5);
    }
    let filled: f64 = parts.iter().map(|(share, _)| share).sum();
    solid.fraction = together(&parts);
    solid.beside &= solid.shares == 0.0;
    if met.len() > 1 && !solid.deep {
        solid.tight = tightness(filled);
        solid.shared = true;
    }
    if solid.shares > 0.0 {
        solid.velocity = (flux / solid.shares).to_array();
    }
    if solid.tight > 0.0 {
        // In a closed joint, each box that touches the cell has the weight one.
        let mut all = solid.shares;
        for (block, &x) in boxes
            .iter()
            .flat_map(|b| centres.iter().map(move |x| (b, x)))
        {
            if block.share(x) == 0.0 && block.borders(x) {
                flux += solid.tight * block.velocity_at(x);
                all += solid.tight;
            }
        }
        solid.velocity = (flux / all).to_array();
    }
    solid
}

/// The loads that the twin computes in its next step.
fn exact_loads(subject: &Subject, boxes: &[Cuboid], periodic: [bool; 3]) -> Vec<Load> {
    let twin = &subject.twin;
    let nu_t = twin.nu_t();
    let balance = twin.slip_balance(&nu_t);
    let mut loads = vec![Load::default(); boxes.len()];
    for cell in (0..twin.domain.cell_count()).filter(|&cell| !twin.domain.solid[cell]) {
        let solid = twin.solid_at(cell);
        let tau = twin.config.tau_eff(nu_t[cell]);
        for (load, block) in loads.iter_mut().zip(boxes) {
            for x in images(twin.domain.cells, periodic, cell) {
                let share = block.share(x);
                if share == 0.0 {
                    continue;
                }
                let r = x - block.centre;
                // If blocks meet, their mean velocity is used.
                let tight = twin.blocks.as_ref().unwrap().1[cell].tight;
                let own = block.velocity_at(x);
                let velocity = own.lerp(solid.velocity.into(), tight).to_array();
                let weight = solid.weight(&twin.config, tau);
                let [effective, _] = block.effective(x, subject.setup.weight());
                let force =
                    DVec3::from_array(twin.force_on(cell, effective, velocity, (tau, balance)));
                let held = weight * effective / solid.shares;
                load.force += force;
                load.moment += DMat3::from_cols(force * r.x, force * r.y, force * r.z);
                load.entrained += held;
                load.missing += share - held;
                load.entrained_moment += held * r;
                load.missing_moment += (share - held) * r;
            }
        }
    }
    loads
}

/// Largest difference of two loads; moments relative to the length of a block.
fn distance(a: &Load, b: &Load, length: f64) -> f64 {
    let moments = [
        (a.moment - b.moment)
            .to_cols_array()
            .map(DVec3::splat)
            .into_iter()
            .fold(0.0, |m: f64, v| m.max(v.x.abs())),
        (a.entrained_moment - b.entrained_moment)
            .abs()
            .max_element(),
        (a.missing_moment - b.missing_moment).abs().max_element(),
    ];
    let sums = [
        (a.force - b.force).abs().max_element(),
        (a.entrained - b.entrained).abs(),
        (a.missing - b.missing).abs(),
    ];
    sums.into_iter()
        .chain(moments.map(|m| m / length))
        .fold(0.0, f64::max)
}

fn assert_equal_to_twin(name: &str, setup: &Setup, boxes: &[Cuboid], limit: f64) {
    let mut subject = Subject::new(setup);
    let periodic = setup.periodic_axes();
    let (device, queue) = (subject.rig.device.clone(), subject.rig.queue.clone());
    let units = Units {
        cell: 1.0,
        time_step: 1.0,
        density: 1.0,
    };
    let frame = Frame {
        origin: DVec3::ZERO,
        units,
    };
    let submerged =
        |block: &Cuboid| SolidBlock::new(Arc::new(Polyhedron::cuboid(block.size).unwrap().into()));
    let blocks = boxes.iter().map(submerged).collect();
    let mut immersed = SolidCells::new(&device, &subject.lattice, frame, blocks).unwrap();
    let mut boxes = boxes.to_vec();
    for step in 1..=3 {
        let poses: Vec<Pose> = boxes.iter().map(Cuboid::pose).collect();
        immersed
            .place(&device, &queue, &mut subject.lattice, &poses)
            .unwrap();
        submit_pass(&device, &queue, |pass| {
            immersed.record_cells(pass);
            subject.lattice.record_psm(pass);
            immersed.record_loads(pass);
            subject.lattice.record_rest(pass);
        });
        let mut readback = Readback::default();
        let read = readback.read(
            &device,
            &queue,
            immersed.wrenches(),
            immersed.wrench_count(),
        );
        let found = immersed.loads(&subject.rig.wait(read).unwrap()).unwrap();

        let cells = subject.twin.domain.cells;
        let twin = &mut subject.twin;
        let (_, solids) = twin.blocks.as_mut().unwrap();
        for (cell, solid) in solids.iter_mut().enumerate() {
            *solid = solid_of(&boxes, &images(cells, periodic, cell), setup.weight());
        }
        let exact = exact_loads(&subject, &boxes, periodic);
        for ((found, exact), block) in found.iter().zip(&exact).zip(&boxes) {
            let off = distance(found, exact, block.size.max_element());
            // Sums over some hundred cells of numbers of order 0.01 to 1.
            let most = limit * (1.0 + block.size.element_product());
            println!("{name}, step {step}: loads {off:e} of {}", exact.force);
            assert!(off < most, "{name}, step {step}: {found:?}, not {exact:?}");
        }
        subject.twin.step();
        let populations = subject.population_error();
        println!("{name}, step {step}: populations {populations:e}");
        assert!(populations < limit, "{name}, step {step}: {populations:e}");
        for block in &mut boxes {
            block.centre += block.velocity;
        }
    }
}

/// One block over a periodic corner, thick enough to have deep cells, and one that overlaps it.
#[test]
fn blocks_across_periodic_borders_that_overlap() {
    let mut setup = Setup::periodic([11, 9, 8], 0.02);
    setup.brick = [4, 4, 2];
    setup.lanes = 4;
    setup.solid_operator = Some(SolidOperator::Holdych);
    setup.wale = Some(0.5);
    let boxes = [
        Cuboid {
            centre: DVec3::new(0.25, 8.5, 0.375),
            size: DVec3::new(6.25, 6.5, 6.75),
            velocity: DVec3::new(0.01, -0.0125, 0.005),
            spin: DVec3::new(0.001, -0.002, 0.0015),
        },
        Cuboid {
            centre: DVec3::new(4.0, 6.75, 2.0),
            size: DVec3::new(2.5, 2.0, 1.75),
            velocity: DVec3::new(-0.02, 0.0, 0.01),
            spin: DVec3::new(0.0, 0.004, 0.0),
        },
    ];
    assert_equal_to_twin("periodic", &setup, &boxes, limit(&setup));
    setup.solid_weight = Some(SolidWeight::Standard);
    assert_equal_to_twin("standard weight", &setup, &boxes, limit(&setup));
}

/// Blocks that extend through walls and through a static solid, next to a velocity face.
#[test]
fn blocks_through_walls_and_solids() {
    let mut setup = walled(2, Storage::F16);
    setup.brick = [4, 4, 2];
    setup.solid_operator = Some(SolidOperator::Superposition);
    assert!(matches!(setup.faces[0][0], Face::Velocity(_)));
    let boxes = [
        Cuboid {
            centre: DVec3::new(3.125, 1.5, 4.5),
            size: DVec3::new(3.5, 2.25, 2.5),
            velocity: DVec3::new(0.01, 0.005, -0.01),
            spin: DVec3::new(0.0, 0.0, 0.002),
        },
        Cuboid {
            centre: DVec3::new(5.5, 4.0, -0.25),
            size: DVec3::new(2.25, 3.0, 3.25),
            velocity: DVec3::new(-0.01, 0.0, 0.0),
            spin: DVec3::ZERO,
        },
    ];
    assert_equal_to_twin("walls", &setup, &boxes, limit(&setup));
}
