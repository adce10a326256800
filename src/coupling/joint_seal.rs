//! Uplift in joints too thin for SPH particles.

use super::{
    joint_faces::{
        NearBlocks, NeighbourPart, Poses, add_pressure, covered_polygon, neighbour_parts,
    },
    joint_rim::{Contiguity, RimEdge, RimParams, RimPressure, RimSample, find_rim, propagate},
    kernel_deficit::KernelDeficit,
};
use crate::{
    geometry::{Form, Load, Pose, Shape, area_of, corners, outer},
    rock::{Periods, contact::Placed},
    sph::{Body, Scheme, Setup, Side},
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
    /// Whether each block deforms.
    deforms: Vec<bool>,
    periods: Option<Periods>,
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
        periods: Option<Periods>,
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
            deforms: setup.bodies.iter().map(Body::deforms).collect(),
            periods,
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
            periods: self.periods.as_ref(),
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
            let dyad = outer(force, edge.place - poses[block].centre);
            load.moment += match self.deforms.get(block) {
                // The pressures on the faces, which strain the block, lack nothing along edges.
                Some(true) => (dyad - dyad.transpose()) * 0.5,
                _ => dyad,
            };
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
mod tests;
