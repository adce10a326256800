//! Uplift in joints too thin for SPH particles.

use super::{
    joint_faces::{
        NearBlocks, NeighbourPart, Poses, add_pressure, covered_polygon, neighbour_parts,
    },
    joint_rim::{Contiguity, RimEdge, RimParams, RimPressure, RimSample, find_rim, propagate},
    kernel_deficit::KernelDeficit,
};
use crate::{
    geometry::{Form, Load, Pose, Shape, outer},
    psm::{area_of, corners},
    rock::{Period, contact::Placed},
    sph::{Scheme, Setup, Side},
};
use glam::DVec3;
use std::sync::Arc;

/// Height, spacings, that finds blocks in contact too thin for the heights of [`KernelDeficit`].
const THIN_BLOCK_HEIGHT: f64 = 0.25;

/// Adds the load of the water in joints to blocks in SPH water. Where blocks are closer than the support of the kernel
/// function, the water between them exerts only a part of its pressure, and none in contact: [`KernelDeficit`] is the
/// missing part. The joint has the pressure of its rim: between two levels it falls linearly from one to the other, as dam
/// engineers assume for uplift. The field of a joint is the mean of the [`RimPressure`]s of its two blocks; blocks without
/// a rim take the fields of their neighbours.
#[derive(Debug)]
pub(crate) struct JointSeal {
    shapes: Vec<Arc<Shape>>,
    /// Blocks whose loads are requested.
    loaded: Vec<bool>,
    period: Option<Period>,
    /// Particle spacing, m.
    spacing: f64,
    deficit: KernelDeficit,
    /// ρ g, Pa/m.
    weight: DVec3,
    /// In a plane scene: y of the particles, m.
    row: Option<f64>,
    /// Corners of the domain, infinite along periodic axes, m.
    domain: [DVec3; 2],
}

/// The closed joints of all blocks at one time.
#[derive(Debug, Default)]
pub(crate) struct SealedJoints {
    joints: Vec<Joint>,
    edge_losses: Vec<EdgeLoss>,
    /// Samples on the rims of each block.
    rims: Vec<Vec<RimSample>>,
}

/// A closed patch of a face.
#[derive(Debug)]
struct Joint {
    between: Contiguity,
    corners: Vec<DVec3>,
    /// Outward normal times the closed fraction.
    normal: DVec3,
}

/// A segment of the edge of a joint, where the deficit is smaller.
#[derive(Debug)]
struct EdgeLoss {
    between: Contiguity,
    /// Midpoint, m.
    place: DVec3,
    /// Force on the block per pressure at `place`, m².
    loss: DVec3,
}

/// A face and the parts over it: the largest patch that each part closes, and the mean closed fraction of that patch.
struct ClosedFace {
    patches: Vec<Vec<DVec3>>,
    fractions: Vec<f64>,
}

impl JointSeal {
    /// A seal for blocks of these shapes in the water of `setup`; `requested` marks the blocks whose loads are needed.
    pub fn new(
        shapes: Vec<Arc<Shape>>,
        period: Option<Period>,
        setup: &Setup,
        requested: &[bool],
    ) -> Self {
        // In the other schemes, penalty forces act in joints too.
        let has_boundary_particles = setup.scheme == Scheme::Delta;
        Self {
            shapes,
            loaded: requested
                .iter()
                .map(|requested| *requested && has_boundary_particles)
                .collect(),
            period,
            spacing: setup.spacing,
            deficit: KernelDeficit::new(setup),
            weight: setup.density * setup.gravity,
            domain: [domain_corner(setup, 0), domain_corner(setup, 1)],
            row: setup.plane.then_some(setup.origin.y + 0.5 * setup.size.y),
        }
    }

    /// The closed joints of the `wet` blocks at `poses`.
    pub fn find_joints(&self, poses: &[Pose], wet: &[bool]) -> SealedJoints {
        let mut sealed = SealedJoints {
            rims: vec![Vec::new(); poses.len()],
            ..SealedJoints::default()
        };
        let all = Poses {
            poses,
            period: self.period,
        };
        let radius = |block: usize| self.shapes[block].radius();
        let near = NearBlocks::new(radius, all, self.deficit.max_height());
        for block in (0..poses.len()).filter(|block| self.loaded[*block] && wet[*block]) {
            self.add_joints_of(&mut sealed, (all, &near), block);
        }
        sealed
    }

    /// Adds the closed joints of a block.
    fn add_joints_of(
        &self,
        sealed: &mut SealedJoints,
        (all, near): (Poses<'_>, &NearBlocks<'_>),
        block: usize,
    ) {
        let max_height = self.deficit.max_height();
        let poses = all.poses;
        let within = (near.near(block), max_height);
        let neighbours = neighbour_parts(|n| &*self.shapes[n], all, block, within);
        if neighbours.is_empty() {
            return;
        }
        let parts = self.shapes[block].parts().iter();
        let own: Vec<_> = parts.map(|part| Placed::of(part, &poses[block])).collect();
        let solids = own.iter();
        let solids = solids.chain(neighbours.iter().map(|neighbour| &neighbour.part));
        for (part, placed) in self.shapes[block].parts().iter().zip(&own) {
            let Form::Convex(shape) = &part.form else {
                continue;
            };
            for (face, plane) in placed.faces.iter().enumerate() {
                let polygon = corners(shape, face, part.offset, &poses[block]);
                let over = parts_over(&polygon, plane.normal, &neighbours, max_height);
                if over.is_empty() {
                    continue;
                }
                let closed = self.close_face(sealed, block, (&polygon, plane.normal), &over);
                let rims = &mut sealed.rims[block];
                let params = RimParams {
                    spacing: self.spacing,
                    row: self.row,
                    deficit: &self.deficit,
                };
                let rim = find_rim(rims, &closed.patches, plane.normal, solids.clone(), params);
                let losses = edge_losses(&closed.patches, &rim);
                sealed
                    .edge_losses
                    .extend(losses.map(|(edge, loss)| EdgeLoss {
                        between: Contiguity::of(block, over[edge.patch]),
                        place: edge.place,
                        loss: closed.fractions[edge.patch] * loss,
                    }));
                let rims = &mut sealed.rims[block];
                // The pressure outside the domain is unknown, not zero.
                let [low, high] = self.domain;
                rims.retain(|at| at.place.cmpge(low).all() && at.place.cmple(high).all());
            }
        }
    }

    /// Adds the patches of a face of a block that the parts over it close.
    fn close_face(
        &self,
        sealed: &mut SealedJoints,
        block: usize,
        (polygon, normal): (&[DVec3], DVec3),
        over: &[&NeighbourPart],
    ) -> ClosedFace {
        let covered = |height: f64| {
            let patches = over.iter();
            let patches =
                patches.map(|other| covered_polygon(polygon, normal, &other.part, [height]));
            patches.collect::<Vec<_>>()
        };
        let thin = covered(THIN_BLOCK_HEIGHT * self.spacing);
        let mut largest = thin.clone();
        let mut areas = vec![0.0; over.len()];
        let heights = self.deficit.heights;
        for height in heights {
            let patches = covered(height).into_iter().zip(&thin);
            let patches =
                patches.map(|(far, thin)| if far.1 < thin.1 { thin.clone() } else { far });
            let patches: Vec<_> = patches.collect();
            let area: f64 = patches.iter().map(|(_, area)| area).sum();
            // Overlapping blocks do not close the face twice.
            let fraction = (area_of(polygon).1.length() / area).min(1.0);
            for (n, (patch, other)) in patches.into_iter().zip(over).enumerate() {
                let largest = &mut largest[n];
                areas[n] += fraction * patch.1 / heights.len() as f64;
                if patch.1 > largest.1 {
                    largest.clone_from(&patch);
                }
                if patch.1 > 0.0 {
                    sealed.joints.push(Joint {
                        between: Contiguity::of(block, other),
                        corners: patch.0,
                        normal: fraction / heights.len() as f64 * normal,
                    });
                }
            }
        }
        let fraction = |(area, (_, largest)): (&f64, &(Vec<DVec3>, f64))| {
            area / largest.max(f64::MIN_POSITIVE)
        };
        ClosedFace {
            fractions: areas.iter().zip(&largest).map(fraction).collect(),
            patches: largest.into_iter().map(|(patch, _)| patch).collect(),
        }
    }

    /// Adds the loads of the water in closed joints, given the pressures (Pa) at [`SealedJoints::rim_places`].
    pub fn add_loads(
        &self,
        mut sealed: SealedJoints,
        pressures: &[f64],
        poses: &[Pose],
        loads: &mut [Load],
    ) {
        let samples = sealed.rims.iter_mut().flatten();
        for (sample, pressure) in samples.zip(pressures) {
            sample.pressure = *pressure;
        }
        let rims = sealed.rims.iter();
        let at_rims: Vec<_> = rims
            .map(|rim| RimPressure::fit(rim, self.deficit.support, self.weight))
            .collect();
        let joints: Vec<_> = sealed.joints.iter().map(|joint| joint.between).collect();
        // A block with a dry rim has a known field: none.
        let unknown = |block: usize| self.loaded[block] && sealed.rims[block].is_empty();
        let propagated = propagate(&at_rims, unknown, &joints);
        let pressure_between = |between: &Contiguity| {
            let Contiguity {
                block,
                other,
                offset,
            } = *between;
            let fields = match [block, other].map(|block| at_rims[block]) {
                [None, None] => [propagated[block], propagated[other]],
                known => known,
            };
            let count = fields.iter().flatten().count();
            move |x: DVec3| match fields {
                [None, None] => 0.0,
                [own, other] => {
                    let own = own.map_or(0.0, |own| own.at(x));
                    let other = other.map_or(0.0, |other| other.at(x - offset));
                    (own + other) / count as f64
                }
            }
        };
        for joint in &sealed.joints {
            let pressure = pressure_between(&joint.between);
            let block = joint.between.block;
            let centre = poses[block].centre;
            add_pressure(
                &mut loads[block],
                &joint.corners,
                joint.normal,
                centre,
                pressure,
            );
        }
        for edge in &sealed.edge_losses {
            let pressure = pressure_between(&edge.between);
            let force = pressure(edge.place) * edge.loss;
            let block = edge.between.block;
            let load = &mut loads[block];
            load.force += force;
            load.moment += outer(force, edge.place - poses[block].centre);
        }
    }
}

impl SealedJoints {
    /// Places on the rims (m) whose pressures [`JointSeal::add_loads`] needs.
    pub fn rim_places(&self) -> Vec<DVec3> {
        let samples = self.rims.iter().flatten();
        samples.map(|sample| sample.place).collect()
    }
}

/// The edges of patches with their losses. The losses of a patch are limited to its area; those of slivers are negligible.
fn edge_losses<'a>(
    patches: &[Vec<DVec3>],
    rim: &'a [RimEdge],
) -> impl Iterator<Item = (&'a RimEdge, DVec3)> {
    let mut losses = vec![0.0; patches.len()];
    for edge in rim {
        losses[edge.patch] += edge.loss.length();
    }
    let limit = |(patch, loss): (&Vec<DVec3>, f64)| {
        (area_of(patch).1.length() / loss.max(f64::MIN_POSITIVE)).min(1.0)
    };
    let limits: Vec<f64> = patches.iter().zip(losses).map(limit).collect();
    rim.iter()
        .map(move |edge| (edge, limits[edge.patch] * edge.loss))
}

/// The lower (0) or the upper (1) corner of the domain, infinite along periodic axes, m.
fn domain_corner(setup: &Setup, end: usize) -> DVec3 {
    DVec3::from([0, 1, 2].map(|axis| match (setup.faces[axis][end], end) {
        (Side::Periodic, 0) => f64::NEG_INFINITY,
        (Side::Periodic, _) => f64::INFINITY,
        (_, 0) => setup.origin[axis],
        _ => setup.origin[axis] + setup.size[axis],
    }))
}

/// The `parts` that may lie within `max_height` (m) over a polygon.
fn parts_over<'a>(
    polygon: &[DVec3],
    normal: DVec3,
    parts: &'a [NeighbourPart],
    max_height: f64,
) -> Vec<&'a NeighbourPart> {
    let middle = polygon.iter().sum::<DVec3>() / polygon.len() as f64;
    let distances = polygon.iter().map(|x| (x - middle).length());
    let radius = distances.fold(0.0, f64::max);
    let may_cover = |NeighbourPart { part, .. }: &&NeighbourPart| {
        let r = part.centre - middle;
        let height = normal.dot(r);
        let lateral = (r - height * normal).length() <= radius + part.radius;
        lateral && height >= -part.radius && height <= max_height + part.radius
    };
    parts.iter().filter(may_cover).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::Polyhedron;
    use glam::DQuat;
    use std::f64::consts::PI;

    fn at(x: f64, y: f64, z: f64) -> Pose {
        let centre = DVec3::new(x, y, z);
        Pose::rigid(centre, DQuat::IDENTITY, DVec3::ZERO, DVec3::ZERO)
    }

    fn cuboid(x: f64, y: f64, z: f64) -> Arc<Shape> {
        Arc::new(Polyhedron::cuboid(DVec3::new(x, y, z)).unwrap().into())
    }

    fn tank() -> Setup {
        let mut setup = Setup::tank(DVec3::new(40.0, 40.0, 20.0), 0.1, 10.0);
        setup.origin = DVec3::new(-20.0, -20.0, -0.6);
        setup.gravity = DVec3::Z * -10.0;
        setup
    }

    /// The loads of joints on all blocks, for hydrostatic water with 10 kPa/m below the level `level` (m).
    fn loads(
        shapes: Vec<Arc<Shape>>,
        poses: &[Pose],
        period: Option<Period>,
        level: impl Fn(DVec3) -> f64,
    ) -> Vec<Load> {
        let setup = tank();
        let requested = vec![true; shapes.len()];
        let seal = JointSeal::new(shapes, period, &setup, &requested);
        let sealed = seal.find_joints(poses, &vec![true; poses.len()]);
        let pressure = |x: &DVec3| (1e4 * (level(*x) - x.z)).max(0.0);
        let pressures: Vec<f64> = sealed.rim_places().iter().map(pressure).collect();
        let mut loads = vec![Load::default(); poses.len()];
        seal.add_loads(sealed, &pressures, poses, &mut loads);
        loads
    }

    /// A dam on its base: uplift between two levels, its moment, and none in a gap with room for water.
    #[test]
    fn uplift_falls_linearly_from_heel_to_toe() {
        let shapes = vec![cuboid(4.0, 1.0, 3.0), cuboid(20.0, 3.0, 1.0)];
        let heights = KernelDeficit::new(&tank()).heights;
        for gap in [0.0, 0.04, 0.12, 0.25] {
            let higher = heights.iter().filter(|height| **height > gap).count();
            let fraction = higher as f64 / heights.len() as f64;
            let poses = [at(0.0, 0.0, 1.5 + gap), at(0.0, 0.0, -0.5)];
            // 30 kPa at the heel and none at a dry toe.
            for (down, mean) in [(1.0, 20e3), (0.0, 15e3)] {
                let found = loads(shapes.clone(), &poses, None, |x: DVec3| {
                    3.0 + (down - 3.0) * (0.25 * x.x + 0.5).clamp(0.0, 1.0)
                });
                let uplift = 4.0 * (mean - 1e4 * gap) * fraction;
                assert!(
                    (found[0].force - DVec3::Z * uplift).length() < 0.05 * uplift.max(1.0),
                    "{} {uplift}",
                    found[0].force
                );
                // ∫ p x dx about the middle.
                let torque = 2.0 * (30e3 - mean) * 16.0 / 12.0 * fraction;
                let torque_found = found[0].torque();
                assert!(
                    (torque_found.y.abs() - torque).abs() < 0.1 * torque.max(1.0),
                    "{torque_found}"
                );
            }
        }
    }

    /// A dam of two blocks on a floor of two, all as wide as the period: only heel and toe are rims, also with a gap below a
    /// spacing.
    #[test]
    fn joints_that_continue_across_the_period_have_no_rim() {
        let period = Period {
            origin: DVec3::ZERO,
            size: DVec3::new(f64::INFINITY, 1.0, f64::INFINITY),
        };
        let shapes = vec![
            cuboid(2.0, 1.0, 3.0),
            cuboid(2.0, 1.0, 3.0),
            cuboid(10.0, 1.0, 1.0),
            cuboid(10.0, 1.0, 1.0),
        ];
        for gap in [0.0, 0.01] {
            // The blocks have different offsets along the period.
            let poses = [
                at(-1.0, 0.5, 1.5 + gap),
                at(1.0, 2.0, 1.5 + gap),
                at(-5.0, 0.3, -0.5),
                at(5.0, 0.5, -0.5),
            ];
            let level = |x: DVec3| {
                // Water on both sides; any rim inside the dam or its floor would be dry.
                let inside = x.x.abs() < 2.0;
                if inside { -9.0 } else { 3.0 }
            };
            let found = loads(shapes.clone(), &poses, Some(period), level);
            let both = found[0].force + found[1].force;
            assert!((both.z / 12e4 - 1.0).abs() < 0.05, "{gap}: {both}");
            assert!(both.x.abs() < 1e-6 * both.z, "{gap}: {both}");
        }
    }

    /// Buoyancy of every block inside a mass of 5 × 5 × 5 blocks, also of the inner ones, which have no rim.
    #[test]
    fn pressure_propagates_through_the_joints_of_a_mass() {
        let (mut poses, mut inside) = (Vec::new(), Vec::new());
        for n in 0..125 {
            let place = [n / 25, n / 5 % 5, n % 5];
            let [x, y, z] = place.map(f64::from);
            poses.push(at(x, y, 2.0 + z));
            inside.push(place.iter().all(|k| (1..4).contains(k)));
        }
        let found = loads(vec![cuboid(1.0, 1.0, 1.0); 125], &poses, None, |_| 15.0);
        let buoyancy = DVec3::Z * 1e4;
        for (load, _) in found.iter().zip(&inside).filter(|(_, inside)| **inside) {
            assert!((load.force - buoyancy).length() < 1.0, "{}", load.force);
            assert!(load.torque().length() < 1.0, "{}", load.torque());
        }
    }

    /// Three columns on a floor between water and a dry side: joints between blocks with dry rims stay dry.
    #[test]
    fn pressure_does_not_propagate_to_blocks_with_dry_rims() {
        let column = || cuboid(2.0, 2.0, 3.0);
        let shapes = vec![column(), column(), column(), cuboid(20.0, 1.8, 1.0)];
        let poses = [
            at(-2.0, 0.0, 1.5),
            at(0.0, 0.0, 1.5),
            at(2.0, 0.0, 1.5),
            at(0.0, 0.0, -0.5),
        ];
        let level = |x: DVec3| if x.x < -2.5 { 3.0 } else { -9.0 };
        let found = loads(shapes, &poses, None, level);
        assert!(found[0].force.z > 1e4, "{}", found[0].force);
        assert!(found[2].force.x.abs() < 1e-9, "{}", found[2].force);
    }

    /// A slope above the water, and one that the water line crosses.
    #[test]
    fn dry_joints_have_no_pressure() {
        let shapes = vec![cuboid(2.0, 1.0, 1.0), cuboid(20.0, 3.0, 1.0)];
        let poses = [at(0.0, 0.0, 0.5), at(0.0, 0.0, -0.5)];
        let dry = loads(shapes.clone(), &poses, None, |_| -3.0);
        assert_eq!(dry, [Load::default(); 2]);
        // A slope of 30°; the water line crosses the middle of the joint.
        let rotation = DQuat::from_rotation_y(PI / 6.0);
        let poses = poses.map(|pose| {
            let centre = rotation * pose.centre;
            Pose::rigid(centre, rotation, DVec3::ZERO, DVec3::ZERO)
        });
        let half = loads(shapes, &poses, None, |_| 0.0);
        // The lower side receives a surplus next to the floor, at half a metre of depth.
        let lateral = 5e3 * KernelDeficit::new(&tank()).edge_loss(0.0);
        let expected = rotation * DVec3::new(-lateral, 0.0, 2.5e3);
        assert!(
            (half[0].force - expected).length() < 25.0,
            "{}",
            half[0].force
        );
    }

    #[test]
    fn forces_of_a_half_covered_joint_are_opposite_and_reduced_by_flush_edges() {
        let shapes = vec![cuboid(1.0, 1.0, 1.0), cuboid(1.0, 1.0, 1.0)];
        let poses = [at(0.0, 0.0, 1.0), at(0.5, 0.0, 0.0)];
        let found = loads(shapes, &poses, None, |_| 1.5);
        // Two edges are flush; beyond the other two, one of the blocks extends.
        let loss = KernelDeficit::new(&tank()).edge_loss(0.0);
        let normal = 1e4 * (0.5 - 2.0 * 0.5 * loss);
        // The sides next to the joint receive a surplus, which the lateral force balances.
        let expected = DVec3::new(-2.0 * 1e4 * loss, 0.0, normal);
        assert!(
            (found[0].force - expected).length() < 1.0,
            "{}",
            found[0].force
        );
        assert!(
            (found[1].force + expected).length() < 1.0,
            "{}",
            found[1].force
        );
    }
}
