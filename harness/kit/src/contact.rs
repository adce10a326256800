//! Blocks for the contact laws and for parry, both made from the same vertices, and pairs of them with a known gap.

pub use crate::Random;
use glam::{DMat3, DQuat, DVec3};
use parry3d_f64::{math::Pose, query, shape::ConvexPolyhedron};
use riprap::{geometry::HalfSpace, rock::contact::Placed};

/// A convex block in its own frame, in the representations of the library and of parry.
#[derive(Clone, Debug)]
pub struct Solid {
    /// Half-spaces whose intersection is the block.
    pub faces: Vec<HalfSpace>,
    /// Its vertices.
    pub vertices: Vec<DVec3>,
    /// The same block for parry.
    pub oracle: ConvexPolyhedron,
}

impl Solid {
    /// The convex hull of points in general position that enclose the origin.
    pub fn hull(points: &[DVec3]) -> Self {
        let oracle =
            ConvexPolyhedron::from_convex_hull(points).expect("points in general position");
        let vertices = oracle.points().to_vec();
        let faces = loops(&oracle).map(|corners| {
            let fan = corners[1..].windows(2);
            let normal = fan
                .map(|pair| (pair[0] - corners[0]).cross(pair[1] - corners[0]))
                .sum::<DVec3>()
                .normalize();
            let heights = vertices.iter().map(|v| normal.dot(*v));
            HalfSpace {
                normal,
                distance: heights.fold(f64::NEG_INFINITY, f64::max),
            }
        });
        Self {
            faces: faces.collect(),
            vertices: vertices.clone(),
            oracle,
        }
    }

    /// Whether the corners of each face lie in its plane: the oracle merges triangles that are nearly parallel.
    pub fn has_plane_faces(&self) -> bool {
        let mut faces = loops(&self.oracle).zip(&self.faces);
        faces.all(|(corners, face)| corners.iter().all(|x| face.height(*x) > -1e-12))
    }

    /// A box with the given edges.
    pub fn cuboid(edges: DVec3) -> Self {
        let corner = |k: u32| {
            let sign = |bit: u32| if k >> bit & 1 == 1 { 0.5 } else { -0.5 };
            edges * DVec3::new(sign(0), sign(1), sign(2))
        };
        let mut solid = Self::hull(&(0..8).map(corner).collect::<Vec<_>>());
        let axes = [DVec3::X, DVec3::Y, DVec3::Z];
        let faces = axes.iter().flat_map(|axis| {
            let distance = 0.5 * edges.dot(*axis);
            [*axis, -*axis].map(|normal| HalfSpace { normal, distance })
        });
        solid.faces = faces.collect();
        solid
    }

    /// A cube with edges of 1.
    pub fn cube() -> Self {
        Self::cuboid(DVec3::ONE)
    }

    /// Any tetrahedron around the origin that is not a sliver.
    pub fn tetrahedron(random: &mut Random) -> Self {
        loop {
            let corners: [DVec3; 4] = std::array::from_fn(|_| 0.5 * random.direction());
            let [a, b, c, d] = corners;
            let volume = (b - a).cross(c - a).dot(d - a).abs() / 6.0;
            let mean = (a + b + c + d) / 4.0;
            let solid = Self::hull(&corners.map(|v| v - mean));
            if volume > 0.01 && solid.faces.iter().all(|f| f.distance > 0.03) {
                return solid;
            }
        }
    }

    /// A hull with 20 triangular faces, its vertices on a sphere of diameter 1.
    pub fn hull_of_twenty(random: &mut Random) -> Self {
        loop {
            let points: [DVec3; 12] = std::array::from_fn(|_| 0.5 * random.direction());
            let solid = Self::hull(&points);
            if solid.faces.len() == 20 && solid.faces.iter().all(|f| f.distance > 0.05) {
                return solid;
            }
        }
    }

    /// A cube, a tetrahedron or a hull of 20 faces.
    pub fn any(random: &mut Random) -> Self {
        match random.below(3) {
            0 => Self::cube(),
            1 => Self::tetrahedron(random),
            _ => Self::hull_of_twenty(random),
        }
    }

    /// The block enlarged about its origin.
    pub fn scaled(&self, scale: f64) -> Self {
        Self::hull(&self.vertices.iter().map(|v| *v * scale).collect::<Vec<_>>())
    }

    /// The block in the world.
    pub fn at(&self, centre: DVec3, rotation: DQuat) -> Placed {
        let turn = DMat3::from_quat(rotation);
        let faces = self.faces.iter().map(|f| HalfSpace {
            normal: turn * f.normal,
            ..*f
        });
        let distances = self.faces.iter().map(|f| f.distance);
        Placed {
            centre,
            deformation: turn,
            faces: faces.collect(),
            vertices: self.vertices.iter().map(|v| turn * *v).collect(),
            radius: self.radius(),
            smallest_distance: distances.fold(f64::INFINITY, f64::min),
        }
    }

    /// Distance of the farthest vertex from the origin.
    pub fn radius(&self) -> f64 {
        self.vertices.iter().map(|v| v.length()).fold(0.0, f64::max)
    }
}

/// Corners of each face.
fn loops(of: &ConvexPolyhedron) -> impl Iterator<Item = Vec<DVec3>> {
    let ring = of.vertices_adj_to_face();
    of.faces().iter().map(move |face| {
        let first = face.first_vertex_or_edge as usize;
        let ring = &ring[first..first + face.num_vertices_or_edges as usize];
        ring.iter().map(|v| of.points()[*v as usize]).collect()
    })
}

/// A sphere in the world.
pub fn ball(radius: f64, centre: DVec3) -> Placed {
    Placed {
        centre,
        deformation: DMat3::IDENTITY,
        radius,
        smallest_distance: radius,
        ..Placed::default()
    }
}

/// A pair of blocks with their poses.
pub struct Couple {
    /// The blocks in their own frames.
    pub solids: [Solid; 2],
    /// Their centres.
    pub centres: [DVec3; 2],
    /// Their rotations into the world.
    pub rotations: [DQuat; 2],
    /// Size of the smaller block, L.
    pub length: f64,
}

impl Couple {
    /// Two blocks of diameters 1 and 1 to `ratio`, moved together along a random line until parry's gap is `gap`, in units
    /// of the smaller one (negative: an overlap). The line is not the shortest path, which would end with vertex on vertex
    /// rather than on a face or edge across edge.
    pub fn random(random: &mut Random, ratio: f64, gap: f64) -> Self {
        loop {
            let mut solids = [Solid::any(random), Solid::any(random)];
            if ratio > 1.0 {
                let which = random.below(2) as usize;
                solids[which] = solids[which].scaled(random.magnitude(1.0, ratio));
            }
            let radii = [solids[0].radius(), solids[1].radius()];
            let way = random.direction();
            let aside = random.vector() * 0.4 * (radii[0] + radii[1]);
            let couple = Self {
                centres: [DVec3::ZERO, way * 3.0 * (radii[0] + radii[1]) + aside],
                rotations: [random.rotation(), random.rotation()],
                solids,
                length: 2.0 * radii[0].min(radii[1]),
            };
            if let Some(couple) = couple.closed(way, gap) {
                return couple;
            }
        }
    }

    /// Moves the second block along −`way` by Newton's method on the gap, which is convex in the distance moved and so is
    /// never overshot; the last part along the normal. `None` if the block passes by.
    fn closed(mut self, way: DVec3, gap: f64) -> Option<Self> {
        for _ in 0..30 {
            let there = self.oracle()?;
            let rate = there.normal1.dot(way);
            if rate < 0.05 {
                return None;
            }
            // Near enough that no other feature touches first, far enough that parry finds a gap.
            if there.dist < 0.002 * self.length {
                self.centres[1] -= there.normal1 * (there.dist - gap * self.length);
                return Some(self);
            }
            self.centres[1] -= way * (there.dist - 0.001 * self.length) / rate;
        }
        None
    }

    /// parry's contact at any distance; `None` if its EPA fails.
    pub fn oracle(&self) -> Option<query::Contact> {
        let pose = |k: usize| Pose::from_parts(self.centres[k], self.rotations[k]);
        let [a, b] = &self.solids;
        query::contact(&pose(0), &a.oracle, &pose(1), &b.oracle, 1e6).expect("convex shapes")
    }

    /// Both blocks in the world.
    pub fn placed(&self) -> [Placed; 2] {
        std::array::from_fn(|k| self.solids[k].at(self.centres[k], self.rotations[k]))
    }
}
