//! The setup of a simulation of blocks.

use super::Period;
use crate::{
    formula::Formula,
    geometry::Shape,
    rock::law::{Elastic, Film, Joint},
};
use glam::{DMat3, DQuat, DVec3};
use std::sync::Arc;

/// Initial blocks and the parameters of their simulation, SI.
#[derive(Clone, Debug)]
pub struct Setup {
    /// The blocks.
    pub blocks: Vec<Block>,
    /// The materials, to which [`Block::material`] refers.
    pub materials: Vec<Material>,
    /// Joints between two materials that differ from [`Joint::between`].
    pub pairs: Vec<PairMaterial>,
    /// Gravity, m/s².
    pub gravity: DVec3,
    /// Mass damping α, 1/s.
    pub damping: f64,
    /// Time step, s. By default [`USUAL_SHARE`](crate::rock::law::USUAL_SHARE) of the stability bound,
    /// shortened when contacts stiffen.
    pub time_step: Option<f64>,
    /// Distance below which pairs are candidates, m. By default a tenth of the mean radius of the parts
    /// that can move.
    pub skin: Option<f64>,
    /// When blocks at rest fall asleep; `None`: never.
    pub sleep: Option<Sleep>,
    /// Largest overlap at the start, as a share of the smaller centroid-to-face distance of the two blocks.
    pub start_overlap: f64,
    /// Largest overlap later on, as a share of the same distance; above a tenth the blocks no longer count as
    /// hard. Fast blocks of low stiffness may need more.
    pub largest_overlap: f64,
    /// Smallest area of the springs of a contact, as a share of (2d)², d being the same distance.
    ///
    /// The contact area of a corner or an edge starts at zero: a cube corner that penetrates by u exerts a force of
    /// 1.46 k_n u³. A rock cube of 1 m with 100 MPa/m penetrates by 5.6 cm if it stands on its corner, and by
    /// a quarter of a millimetre on its face; a real corner is crushed until it carries the load. With a
    /// value of 1/4, the share of each of the four corners of a square face, a corner is as stiff as
    /// that part of the face from the first touch. Contacts of a larger area do not change; cohesion
    /// and tensile strength use the true area.
    pub corner_area: f64,
    /// The fluid in thin gaps between rigid blocks whose flow the fluid solver does not resolve, if any.
    pub film: Option<Film>,
    /// The periodic box, if any: blocks then also touch the images of others.
    pub period: Option<Period>,
    /// Guides (frictionless rails) of free rigid blocks.
    pub guides: Vec<Guide>,
}

impl Default for Setup {
    /// No blocks; gravity of 9.81 m/s² along −z, no mass damping, no sleep, overlaps of at most 1 % at the start
    /// and 10 % later, no smallest area for corners, no fluid in the gaps.
    fn default() -> Self {
        Self {
            blocks: Vec::new(),
            materials: Vec::new(),
            pairs: Vec::new(),
            gravity: DVec3::new(0.0, 0.0, -9.81),
            damping: 0.0,
            time_step: None,
            skin: None,
            sleep: None,
            start_overlap: 0.01,
            largest_overlap: 0.1,
            corner_area: 0.0,
            film: None,
            period: None,
            guides: Vec::new(),
        }
    }
}

/// A frictionless rail on which a free rigid block slides without rotation. The rail takes up the forces across it and
/// does no work.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Guide {
    /// Index in [`Setup::blocks`].
    pub block: usize,
    /// Direction of sliding, of any length but 0.
    pub axis: DVec3,
}

/// One block at the start.
#[derive(Clone, Debug)]
pub struct Block {
    /// Name, for messages and output.
    pub name: String,
    /// Shape, about its centroid.
    pub shape: Arc<Shape>,
    /// Index in [`Setup::materials`].
    pub material: usize,
    /// Centroid, m.
    pub centre: DVec3,
    /// Rotation from the block's frame to the world's.
    pub rotation: DQuat,
    /// Velocity of the centroid, m/s; ignored for a driven block.
    pub velocity: DVec3,
    /// Spin about the world's axes, rad/s; ignored for a driven block.
    pub spin: DVec3,
    /// How the block moves.
    pub motion: Motion,
    /// Deformation, if any; only for a free block of one convex part whose material is
    /// [`Elastic`]. The block then never sleeps.
    pub deformable: Option<Deformable>,
    /// Forces on points of a free block, which then never sleeps.
    pub point_loads: Vec<PointLoad>,
    /// Acceleration of a free block in addition to gravity, m/s², formulas of t. The block then
    /// never sleeps.
    pub acceleration: Option<[Formula; 3]>,
}

/// Affine deformation of a block: the point X, from the centroid in the block's own frame, is at c + F X.
#[derive(Clone, Debug, PartialEq)]
pub struct Deformable {
    /// Stress at zero strain, symmetric, along the axes of the world, Pa; tension
    /// is positive.
    pub initial_stress: DMat3,
    /// Points that are held in their initial positions.
    pub fixed_points: Vec<FixedPoint>,
}

impl Default for Deformable {
    /// No stress and no fixed points. Not derived, because the default of a matrix is the identity.
    fn default() -> Self {
        Self {
            initial_stress: DMat3::ZERO,
            fixed_points: Vec::new(),
        }
    }
}

/// A point of a block that is held in its position.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FixedPoint {
    /// The point, from the centroid in the block's own frame, m.
    pub point: DVec3,
    /// World axes along which it is held.
    pub axes: [bool; 3],
}

/// A force on a point of a block.
#[derive(Clone, Debug, PartialEq)]
pub struct PointLoad {
    /// The point, from the centroid in the block's own frame, m.
    pub point: DVec3,
    /// The force along the axes of the world, N, formulas of t.
    pub force: [Formula; 3],
}

impl Block {
    /// A free block of the first material, at rest, without rotation.
    pub fn new(name: impl Into<String>, shape: impl Into<Arc<Shape>>, centre: DVec3) -> Self {
        Self {
            name: name.into(),
            shape: shape.into(),
            material: 0,
            centre,
            rotation: DQuat::IDENTITY,
            velocity: DVec3::ZERO,
            spin: DVec3::ZERO,
            motion: Motion::Free,
            deformable: None,
            point_loads: Vec::new(),
            acceleration: None,
        }
    }

    /// The same block, fixed.
    pub fn fixed(self) -> Self {
        Self {
            motion: Motion::Fixed,
            ..self
        }
    }

    /// The same block, deformable, without stress at the start.
    pub fn deformable(self) -> Self {
        Self {
            deformable: Some(Deformable::default()),
            ..self
        }
    }

    /// The same block, rotated by `rotation`.
    pub fn rotated(self, rotation: DQuat) -> Self {
        Self { rotation, ..self }
    }
}

/// How a block moves.
#[derive(Clone, Debug, Default, PartialEq)]
#[expect(
    clippy::large_enum_variant,
    reason = "one a block, whose shape and contacts are larger by far"
)]
pub enum Motion {
    /// By forces.
    #[default]
    Free,
    /// Not at all.
    Fixed,
    /// By formulas of t, regardless of the forces.
    Driven {
        /// Velocity of the centroid, m/s.
        velocity: [Formula; 3],
        /// Spin about the world's axes, rad/s.
        spin: [Formula; 3],
    },
}

/// The material of a block.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Material {
    /// Density, kg/m³.
    pub density: f64,
    /// The joint between two faces of this material.
    pub joint: Joint,
    /// Elasticity; required for deformable blocks.
    pub elastic: Option<Elastic>,
}

impl Default for Material {
    /// Rigid rock of 2650 kg/m³ with dry joints.
    fn default() -> Self {
        Self {
            density: 2650.0,
            joint: Joint::default(),
            elastic: None,
        }
    }
}

/// The joint between two materials.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PairMaterial {
    /// Indices in [`Setup::materials`], in either order.
    pub materials: [usize; 2],
    /// Their joint.
    pub joint: Joint,
}

/// When a block falls asleep: it then does not move, and the contacts among sleeping blocks keep
/// their forces without being computed.
///
/// A sleeping block would have moved by less than `speed` × the time for which it would still have moved. It wakes as
/// soon as the force of a moving neighbour on it, or its load, changes by more than `change` of its weight. Positions
/// therefore differ from those without sleep by about `speed` × (time asleep).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sleep {
    /// Speed of its fastest point below which a block rests, m/s.
    pub speed: f64,
    /// Time for which it must have been that slow, s.
    pub after: f64,
    /// Change of force that wakes it, as a share of its weight (without gravity: of its largest
    /// contact force).
    pub change: f64,
}

impl Default for Sleep {
    /// Slower than 1 µm/s for 0.1 s; wakes at a millionth of the weight.
    fn default() -> Self {
        Self {
            speed: 1e-6,
            after: 0.1,
            change: 1e-6,
        }
    }
}
