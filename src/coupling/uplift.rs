//! Uplift on blocks in a lattice: the load of the water in closed joints, linear between their rims.
//!
//! Water in a closed joint has the pressure of its rim. The lattice reaches it only in the long term, when the initial
//! content of full cells has diffused out, and only as part of the total load. For single faces and for factors of safety,
//! a plane p = p̄ + g·(x − x̄) is fitted by least squares to the pressures on the wet faces at the rim, less the
//! hydrostatic pressure, and acts on the dry area of the block. It is clamped to the range on these faces. The rim of a
//! joint consists of the wet part of its own face and the wet faces that share an edge with the closed part. A joint
//! without wet neighbours has the rim of all joints of the block, through which its water is connected.
//!
//! ```text
//!  p_heel  ┌───────┐          Each wet face contributes its mean pressure and, if it is fully wet, the slope along it
//!  ──────▶ │ block │ p_toe    from its moment. The faces at heel and toe determine the line between p_heel and p_toe.
//!  ────────┴───────┴───────
//!           ╲▁▁▁▁▁▁
//! ```

use super::{
    Coupled, FluidLoad,
    joint_faces::covered_polygon,
    pressure_plane::{AreaMoments, CutLine, PressurePlane, PressureSample, fit, limited},
};
use crate::{
    geometry::{Form, Part, Pose, Shape, corners, min_max, outer},
    psm::FaceLoad,
    rock::contact::Placed,
};
use glam::{DMat3, DVec3};

/// Heights over a face, cells, at which another block leaves no cell of fluid in between.
const CLOSED_HEIGHTS: [f64; 3] = [0.0, 0.25, 1.0];
/// Fraction of a face that may lie outside the domain, or be dry without a joint: the rounding of contacts and of counts
/// of cells.
const AREA_TOLERANCE: f64 = 0.1;
/// Smallest closed area, as a fraction of the area of the face.
const MIN_FRACTION: f64 = 0.01;

/// Fraction of an area below which it is rounding.
const ROUNDING: f64 = 1e-9;

/// A face with its closed and its open area.
#[derive(Clone, Debug)]
struct JointFace<'a> {
    load: &'a FaceLoad,
    corners: Vec<DVec3>,
    closed: AreaMoments,
    /// The remaining area, without seams between the parts of the block.
    open: AreaMoments,
}

/// The surroundings of a block.
#[derive(Clone, Copy, Debug)]
struct Surroundings<'a> {
    /// The parts of neighbouring blocks.
    neighbours: &'a [&'a Placed],
    /// Edge of a lattice cell, m.
    cell: f64,
    /// Body force on the fluid, N/m³.
    weight: DVec3,
}

/// The faces of a block with closed joints, and the pressure in the joint of each, r from the centroid of the block.
struct UpliftDiagram<'a> {
    faces: Vec<(JointFace<'a>, PressurePlane)>,
}

impl<'a> UpliftDiagram<'a> {
    /// The diagram from the `loads` on all faces of a block at `pose`. `None` for a block that has no closed joints, contains
    /// spheres, or extends beyond the domain.
    fn of(
        loads: &'a [FaceLoad],
        shape: &Shape,
        pose: &Pose,
        surroundings: Surroundings<'_>,
    ) -> Option<Self> {
        let Surroundings { cell, weight, .. } = surroundings;
        let parts = shape.parts();
        let sphere = |part: &Part| matches!(part.form, Form::Sphere { .. });
        if loads.is_empty() || parts.iter().any(sphere) {
            return None;
        }
        let own: Vec<Placed> = parts.iter().map(|part| Placed::of(part, pose)).collect();
        let face = |load: &'a FaceLoad| {
            let part = &parts[load.face.part];
            let own = own.iter().enumerate();
            let siblings = own.filter(|(n, _)| *n != load.face.part);
            let siblings: Vec<&Placed> = siblings.map(|(_, part)| part).collect();
            JointFace::of(load, part, pose, (surroundings, &siblings))
        };
        let faces: Vec<JointFace<'_>> = loads.iter().filter_map(face).collect();
        let all_known = faces.len() == loads.len();
        if !all_known || !faces.iter().any(JointFace::is_closed) {
            return None;
        }
        let centre = pose.centre;
        let closed: Vec<&JointFace<'_>> = faces.iter().filter(|face| face.is_closed()).collect();
        let sample = |face: &&JointFace<'_>| face.sample(centre, surroundings);
        let plane = |samples: &[PressureSample], over: &[&JointFace<'_>]| {
            let dry = over.iter().flat_map(|face| face.closed_places(centre));
            let plane = limited(fit(samples, cell)?, samples, dry);
            Some(PressurePlane {
                gradient: plane.gradient + weight,
                ..plane
            })
        };
        let all: Vec<PressureSample> = faces_at_rim(&faces, &closed).iter().map(sample).collect();
        let of_block = plane(&all, &closed)?;
        let of_face = |face: &JointFace<'_>| {
            let adjacent = wet_neighbours(&faces, &[face]);
            let samples: Vec<PressureSample> = match face.cut() {
                None if adjacent.len() < 2 => return None,
                None => adjacent.iter().map(sample).collect(),
                // The wet part of the face ends at the rim. Of its neighbours, only those next to the closed part are at the rim.
                Some(cut) => {
                    let at_rim =
                        |other: &&&JointFace<'_>| face.shares_closed_corner(other, cut, centre);
                    let others = adjacent.iter().filter(|other| !std::ptr::eq(**other, face));
                    let others = others.filter(at_rim).map(sample);
                    others.chain(sample(&face).at_cut(cut, cell)).collect()
                }
            };
            plane(&samples, &[face])
        };
        let plane_of = |face: &JointFace<'_>| {
            let own = face.is_closed().then(|| of_face(face)).flatten();
            own.unwrap_or(of_block)
        };
        let planes: Vec<PressurePlane> = faces.iter().map(plane_of).collect();
        Some(Self {
            faces: faces.into_iter().zip(planes).collect(),
        })
    }

    /// Force (N) and torque (N m) on the wet faces and of the joint pressure on the dry ones.
    fn wrench(&self) -> [DVec3; 2] {
        let add = |[force, torque]: [DVec3; 2], (face, plane): &(JointFace<'_>, PressurePlane)| {
            let joint = face.joint_load(plane);
            [
                force + face.load.force + joint.force,
                torque + face.load.moment + joint.moment,
            ]
        };
        self.faces.iter().fold([DVec3::ZERO; 2], add)
    }
}

/// Load of the water in the closed joints of a face.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct JointLoad {
    /// Area without a cell of fluid next to it, m².
    pub area: f64,
    /// Force, N; without shear.
    pub force: DVec3,
    /// Moment about the centroid of the block, N m.
    pub moment: DVec3,
}

impl Coupled<'_> {
    /// The loads of the water in closed joints on the faces of a block, in the order of [`Coupled::face_loads`]; empty
    /// if [`Coupled::wrench_with_uplift`] is `None`.
    pub fn joint_loads(&self, block: usize) -> Vec<JointLoad> {
        let load = |diagram: UpliftDiagram<'_>| {
            let faces = diagram.faces.iter();
            faces.map(|(face, plane)| face.joint_load(plane)).collect()
        };
        self.with_uplift_diagram(block, load).unwrap_or_default()
    }

    /// Force (N) and torque about its centroid (N m) of the fluid on a block with closed joints, buoyancy included: the
    /// loads on its wet faces, and in the joints the pressure of their rim, linear between the adjacent faces. `None`
    /// unless a probe requests the loads on faces, before the first exchange, and for a block that has no closed joints,
    /// contains spheres, or extends beyond the domain.
    pub fn wrench_with_uplift(&self, block: usize) -> Option<[DVec3; 2]> {
        let [force, torque] = self.with_uplift_diagram(block, |diagram| diagram.wrench())?;
        let shape = &self.setup().setup.blocks[block].shape;
        let centre = self.blocks().pose(block).centre;
        let weight = self.coupling.ambient.body_force(centre);
        let FluidLoad { buoyancy, .. } = self.cell_load()[block];
        // As in the load on a block: relative pressures lack the body force on the displaced fluid.
        let displaced = weight * shape.volume();
        Some([
            force + displaced + buoyancy.force,
            torque + buoyancy.torque(),
        ])
    }

    /// Evaluates the uplift diagram of a block, if it has one.
    fn with_uplift_diagram<T>(
        &self,
        block: usize,
        evaluate: impl FnOnce(UpliftDiagram<'_>) -> T,
    ) -> Option<T> {
        let shape = &self.setup().setup.blocks[block].shape;
        let pose = self.blocks().pose(block);
        let cell = self.solid_cells().frame().units.cell;
        let weight = self.coupling.ambient.body_force(pose.centre);
        let neighbours = self.neighbour_parts(block, cell);
        let surroundings = Surroundings {
            neighbours: &neighbours.iter().collect::<Vec<&Placed>>(),
            cell,
            weight,
        };
        let diagram = UpliftDiagram::of(self.face_loads(block), shape, &pose, surroundings);
        diagram.map(evaluate)
    }
}

impl<'a> JointFace<'a> {
    /// `None` if a face extends beyond the domain and is not closed. `siblings` are the other parts of its block.
    fn of(
        load: &'a FaceLoad,
        part: &Part,
        pose: &Pose,
        (surroundings, siblings): (Surroundings<'_>, &[&Placed]),
    ) -> Option<Self> {
        let Form::Convex(shape) = &part.form else {
            return None;
        };
        let corners = corners(shape, load.face.face, part.offset, pose);
        let whole = AreaMoments::of(&corners, pose.centre);
        let heights = CLOSED_HEIGHTS.map(|height| height * surroundings.cell);
        let covered_by = |parts: &[&Placed]| {
            let each = parts.iter().map(|other| {
                let (corners, _) = covered_polygon(&corners, load.face.normal, other, heights);
                AreaMoments::of(&corners, pose.centre)
            });
            each.fold(AreaMoments::ZERO, |sum, one| sum.plus(&one))
        };
        // Limited because parts may overlap and a gap may be wet.
        let dry = (whole.area - load.wetted).max(0.0);
        let seams = covered_by(siblings).limited(dry);
        let closed = covered_by(surroundings.neighbours).limited(dry - seams.area);
        if load.inside + seams.area + closed.area < (1.0 - AREA_TOLERANCE) * whole.area {
            return None;
        }
        Some(Self {
            load,
            corners,
            open: whole.plus(&closed.plus(&seams).times(-1.0)),
            closed,
        })
    }

    /// The line between the open and the closed part. `None` if one of them is the whole face, or surrounds the other.
    fn cut(&self) -> Option<CutLine> {
        let whole = self.open.plus(&self.closed);
        let min_area = MIN_FRACTION * whole.area;
        if self.open.area < min_area || self.closed.area < min_area {
            return None;
        }
        let [open, closed] = [&self.open, &self.closed].map(|part| part.first / part.area);
        let along = (closed - open).try_normalize()?;
        let [low, high] = min_max(self.corners.iter().map(|x| along.dot(*x)));
        // The centroids of two adjacent parts are half of their total extent apart.
        let adjacent = (closed - open).length() > 0.4 * (high - low);
        let place = open.lerp(closed, self.open.area / whole.area);
        adjacent.then_some(CutLine { place, along })
    }

    /// The corners of the closed part, from `centre`: those behind the cut line, and a place on the line.
    fn closed_places(&self, centre: DVec3) -> Vec<DVec3> {
        let corners = self.corners.iter().map(|x| x - centre);
        match self.cut() {
            None => corners.collect(),
            Some(CutLine { place, along }) => corners
                .filter(|x| along.dot(*x - place) > 0.0)
                .chain([place])
                .collect(),
        }
    }

    fn is_closed(&self) -> bool {
        self.closed.area > MIN_FRACTION * self.load.face.area
    }

    /// Whether two faces have an edge in common.
    fn shares_edge(&self, other: &Self) -> bool {
        let tolerance = 1e-6 * self.load.face.area.sqrt();
        let shared = |x: &&DVec3| other.corners.iter().any(|y| x.distance(*y) < tolerance);
        self.corners.iter().filter(shared).count() >= 2
    }

    /// Whether a face that has an edge in common with this one touches a corner of its closed part.
    fn shares_closed_corner(&self, other: &Self, cut: CutLine, centre: DVec3) -> bool {
        let tolerance = 1e-6 * self.load.face.area.sqrt();
        let behind = |x: &&DVec3| cut.along.dot(**x - centre - cut.place) > 0.0;
        let mut corners = self.corners.iter().filter(behind);
        corners.any(|x| other.corners.iter().any(|y| x.distance(*y) < tolerance))
    }

    /// The pressure on its wet part less the hydrostatic pressure, r from `centre`.
    fn sample(&self, centre: DVec3, surroundings: Surroundings<'_>) -> PressureSample {
        let Surroundings { cell, weight, .. } = surroundings;
        let load = self.load;
        let normal = load.face.normal;
        let force = -load.force.dot(normal) - load.shifted();
        // Couple of the forces at the feet of the cells about their mean: n × ∫ t × (τ − p n) = −∫ p t, t in the face.
        let couple = load.moment - (load.acts_at() - centre).cross(load.force);
        let foot = load.foot - centre;
        let over = AreaMoments {
            area: load.wetted,
            first: load.wetted * foot,
            second: (load.spread + outer(foot, foot)) * load.wetted,
        };
        let first = force * foot - normal.cross(couple);
        PressureSample {
            over,
            force: force - weight.dot(over.first),
            first: first - over.second * weight,
            cells: (DMat3::IDENTITY - outer(normal, normal)) * (cell * cell / 12.0),
        }
    }

    /// The load of a joint pressure on the dry area.
    fn joint_load(&self, pressure: &PressurePlane) -> JointLoad {
        let dry_fraction = 1.0 - self.load.wetted / self.open.area.max(f64::MIN_POSITIVE);
        let dry_fraction = if dry_fraction < ROUNDING {
            0.0
        } else {
            dry_fraction
        };
        let over = self.closed.plus(&self.open.times(dry_fraction));
        let normal = self.load.face.normal;
        let force = pressure.value * over.area + pressure.gradient.dot(over.first);
        let first = pressure.value * over.first + over.second * pressure.gradient;
        JointLoad {
            area: over.area,
            force: -force * normal,
            moment: normal.cross(first),
        }
    }
}

/// The wet `faces` that are among the `closed` ones or share an edge with one of them.
fn wet_neighbours<'a>(
    faces: &'a [JointFace<'a>],
    closed: &[&JointFace<'_>],
) -> Vec<&'a JointFace<'a>> {
    let wet = |face: &&JointFace<'_>| face.load.wetted > MIN_FRACTION * face.load.face.area;
    let adjacent = |face: &&JointFace<'_>| {
        let mut closed = closed.iter();
        closed.any(|closed| std::ptr::eq(*closed, *face) || closed.shares_edge(face))
    };
    faces.iter().filter(wet).filter(adjacent).collect()
}

/// The wet faces at the rims of closed joints, or all wet faces if the joints have no rim.
fn faces_at_rim<'a>(
    faces: &'a [JointFace<'a>],
    closed: &[&JointFace<'_>],
) -> Vec<&'a JointFace<'a>> {
    let adjacent = wet_neighbours(faces, closed);
    if adjacent.is_empty() {
        wet_neighbours(faces, &faces.iter().collect::<Vec<_>>())
    } else {
        adjacent
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::{PlaneFace, Polyhedron};
    use glam::{DQuat, Vec3Swizzles};

    const CELL: f64 = 0.125;

    fn at(x: f64, y: f64, z: f64) -> Pose {
        let centre = DVec3::new(x, y, z);
        Pose::at_rest(centre, DQuat::IDENTITY)
    }

    /// The load of a pressure on a face of a cube of 1 m, 8 cells wide, that is wet above the height `low` (m).
    fn wet(face: PlaneFace, low: f64, pressure: impl Fn(DVec3) -> f64) -> FaceLoad {
        let n = face.normal;
        let [u, v] = [n.zxy(), n.yzx()];
        let mut places = Vec::new();
        for i in 0..8 {
            for j in 0..8 {
                let [a, b] = [i, j].map(|k| (f64::from(k) + 0.5) * CELL - 0.5);
                places.push(0.5 * n + a * u + b * v);
            }
        }
        places.retain(|x| x.z > low);
        let count = places.len().max(1) as f64;
        let foot = places.iter().sum::<DVec3>() / count;
        let squares = |x: &DVec3| outer(*x - foot, *x - foot);
        let forces = places.iter().map(|x| -pressure(*x) * CELL * CELL * n);
        FaceLoad {
            face,
            inside: 1.0,
            centre: face.centre,
            wetted: places.len() as f64 * CELL * CELL,
            force: forces.clone().sum(),
            moment: places.iter().zip(forces).map(|(x, f)| x.cross(f)).sum(),
            foot,
            spread: places.iter().map(squares).sum::<DMat3>() * (1.0 / count),
            slope: DVec3::ZERO,
            height: 0.5 * CELL,
            cells: places.len() as u32,
        }
    }

    /// A cube that protrudes from its socket by two cells, with a high pressure on its upstream side and suction on its top:
    /// the pressure on its top must not enter the joints at its sides.
    #[test]
    fn joints_of_a_protruding_block_have_the_pressures_of_its_sides() {
        let cube = Polyhedron::cuboid(DVec3::ONE).unwrap();
        let shape = Shape::from(cube.clone());
        let part = |size: DVec3, x, y, z| {
            let shape = Shape::from(Polyhedron::cuboid(size).unwrap());
            Placed::of(&shape.parts()[0], &at(x, y, z))
        };
        let bed = DVec3::new(1.0, 1.0, 0.75);
        let socket = [
            part(bed, -1.0, 0.0, -0.125),
            part(bed, 1.0, 0.0, -0.125),
            part(bed, 0.0, -1.0, -0.125),
            part(bed, 0.0, 1.0, -0.125),
            part(DVec3::ONE, 0.0, 0.0, -1.0),
        ];
        let along = |x: DVec3| 0.25 - 1.5 * x.x;
        let loads: Vec<FaceLoad> = (0..6)
            .map(|face| {
                let normal = cube.faces()[face].normal;
                let plane = PlaneFace {
                    part: 0,
                    face,
                    centre: 0.5 * normal,
                    normal,
                    area: 1.0,
                };
                match normal.z {
                    z if z > 0.5 => wet(plane, -1.0, |_| -1.0),
                    z if z < -0.5 => wet(plane, 1.0, along),
                    _ => wet(plane, 0.25, along),
                }
            })
            .collect();
        let others: Vec<&Placed> = socket.iter().collect();
        let surroundings = Surroundings {
            neighbours: &others,
            cell: CELL,
            weight: DVec3::ZERO,
        };
        let diagram = UpliftDiagram::of(&loads, &shape, &at(0.0, 0.0, 0.0), surroundings).unwrap();
        for (face, plane) in diagram.faces.iter().filter(|(face, _)| face.is_closed()) {
            let normal = face.load.face.normal;
            let joint = face.joint_load(plane);
            let mean = -joint.force.dot(normal) / joint.area;
            if normal.z < -0.5 {
                assert!((-1.0..1.0).contains(&mean), "{normal}: {mean}");
                continue;
            }
            let exact = along(0.5 * normal);
            assert!((mean - exact).abs() < 0.02, "{normal}: {mean}, {exact}");
            for z in [-0.5, 0.25] {
                let there = plane.at(0.5 * normal + z * DVec3::Z);
                assert!(
                    (there - exact).abs() < 0.1,
                    "{normal}, {z}: {there}, {exact}"
                );
            }
        }
    }
}
