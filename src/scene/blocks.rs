//! Blocks that stand alone or in rows.

use std::path::PathBuf;

use schemars::JsonSchema;
use serde::Deserialize;

use super::block_shape::{BlockShape, Keys, Kind, PlaneFace};
use super::deformable::{FixedPoint, PointLoad};
use super::one_or_many::OneOrMany;
use super::tagged::through;
use crate::formula::Formula;

/// A block, or a row of equal ones.
#[derive(Clone, Debug, PartialEq, JsonSchema)]
#[schemars(deny_unknown_fields)]
pub struct Block {
    /// Name for messages, probes and files; copies get `_1`, `_2`, … after it. Default `block_` and
    /// the number of this table, from 1.
    #[schemars(default)]
    pub name: Option<String>,
    /// The shape, in the block's own frame.
    #[schemars(flatten)]
    pub shape: BlockShape,
    /// Where the origin of the block's own frame is, m. Default (0, 0, 0).
    #[schemars(default)]
    pub position: [f64; 3],
    /// How the block is turned about the origin of its own frame. Default not at all.
    #[schemars(default)]
    pub rotation: Rotation,
    /// What may move it. Default `free`.
    #[schemars(default)]
    pub motion: Motion,
    /// Velocity of the centroid, m/s: of a free block at the time 0, three numbers; of a driven one
    /// three numbers or formulas of t. Default at rest.
    #[schemars(default)]
    pub velocity: [Formula; 3],
    /// Spin about the axes of the world, rad/s: as the velocity. Default none.
    #[schemars(default)]
    pub spin: [Formula; 3],
    /// Name of its material. Default the first one.
    #[schemars(default)]
    pub material: Option<String>,
    /// Whether it deforms: as a whole, with one strain and one stress (discontinuous deformation analysis).
    /// Only free blocks of one convex polyhedron, of a material with `youngs_modulus`; they never sleep, and
    /// their elasticity limits the step. Default false: it is rigid.
    #[schemars(default)]
    pub deformable: bool,
    /// Stress that deformable blocks bear at the start without strain, as what the rock around them has
    /// pressed into them: xx, yy, zz, xy, yz, xz along the axes of the world, Pa; tension is positive. Default 0.
    #[schemars(default)]
    pub initial_stress: [f64; 6],
    /// Points of a deformable block that stay where they are. Default none.
    #[schemars(default)]
    pub fixed_points: Vec<FixedPoint>,
    /// Forces on points of a free block, deformable or rigid; it never sleeps. Default none.
    #[schemars(default)]
    pub point_loads: Vec<PointLoad>,
    /// Acceleration of a free block besides gravity, m/s²: three numbers or formulas of t; it never sleeps.
    /// Default none.
    #[schemars(default)]
    pub acceleration: Option<[Formula; 3]>,
    /// Axis of a rail without friction on which a free rigid block slides, of any length: along it forces move the block, across
    /// it nothing does, and it does not turn. Copies have the same. Default none.
    #[schemars(default)]
    pub guide: Option<[f64; 3]>,
    /// Rows of copies, each of all that those before it made: one for a stack, two for a wall, with
    /// turns for an arch. One table or a list of them. Default only the block itself.
    #[schemars(default, with = "OneOrMany<Repeat>")]
    pub repeat: Vec<Repeat>,
}

/// A part of a compound: any shape but a compound.
#[derive(Clone, Debug, PartialEq, JsonSchema)]
#[schemars(deny_unknown_fields)]
pub struct Part {
    /// The shape, in the part's own frame.
    #[schemars(flatten)]
    pub shape: BlockShape,
    /// Where the origin of the part's own frame is in the block's, m. Default (0, 0, 0).
    #[schemars(default)]
    pub position: [f64; 3],
    /// How the part is turned about that origin. Default not at all.
    #[schemars(default)]
    pub rotation: Rotation,
}

/// A turn.
#[derive(Clone, Copy, Debug, PartialEq, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Rotation {
    /// Axis, of any length; the turn is counter-clockwise when it points at the viewer.
    pub axis: [f64; 3],
    /// Angle, degrees.
    pub angle: f64,
}

impl Default for Rotation {
    fn default() -> Self {
        Self {
            axis: [0.0, 0.0, 1.0],
            angle: 0.0,
        }
    }
}

/// What may move a block.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Motion {
    /// Forces do.
    #[default]
    Free,
    /// Nothing does.
    Fixed,
    /// It moves as `velocity` and `spin` say, whatever stands in its way.
    Driven,
}

/// A row of copies.
#[derive(Clone, Copy, Debug, PartialEq, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Repeat {
    /// Number of blocks in the row, the first one included, at least 1.
    pub count: u32,
    /// From a block to the next one, m. Default (0, 0, 0).
    #[serde(default)]
    pub step: [f64; 3],
    /// How each block is turned against the one before, before the step. Default not at all.
    #[serde(default)]
    pub turn: Rotation,
    /// A point of the axis of that turn, m. Default (0, 0, 0).
    #[serde(default)]
    pub about: [f64; 3],
}

/// All keys of a block and of a part: a part is a block without those that concern its motion.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Flat {
    kind: Kind,
    name: Option<String>,
    size: Option<[f64; 3]>,
    vertices: Option<Vec<[f64; 3]>>,
    faces: Option<Vec<PlaneFace>>,
    edge: Option<f64>,
    radius: Option<f64>,
    file: Option<PathBuf>,
    scale: Option<f64>,
    hull: Option<bool>,
    parts: Option<Vec<Part>>,
    #[serde(default)]
    position: [f64; 3],
    #[serde(default)]
    rotation: Rotation,
    motion: Option<Motion>,
    velocity: Option<[Formula; 3]>,
    spin: Option<[Formula; 3]>,
    material: Option<String>,
    deformable: Option<bool>,
    initial_stress: Option<[f64; 6]>,
    fixed_points: Option<Vec<FixedPoint>>,
    point_loads: Option<Vec<PointLoad>>,
    acceleration: Option<[Formula; 3]>,
    guide: Option<[f64; 3]>,
    repeat: Option<OneOrMany<Repeat>>,
}

impl Flat {
    fn shape(&mut self) -> Result<BlockShape, String> {
        let keys = Keys {
            size: self.size.take(),
            vertices: self.vertices.take(),
            faces: self.faces.take(),
            edge: self.edge.take(),
            radius: self.radius.take(),
            file: self.file.take(),
            scale: self.scale.take(),
            hull: self.hull.take(),
            parts: self.parts.take(),
        };
        keys.typed(self.kind)
    }

    fn typed(mut self) -> Result<Block, String> {
        Ok(Block {
            shape: self.shape()?,
            name: self.name,
            position: self.position,
            rotation: self.rotation,
            motion: self.motion.unwrap_or_default(),
            velocity: self.velocity.unwrap_or_default(),
            spin: self.spin.unwrap_or_default(),
            material: self.material,
            deformable: self.deformable.unwrap_or_default(),
            initial_stress: self.initial_stress.unwrap_or_default(),
            fixed_points: self.fixed_points.unwrap_or_default(),
            point_loads: self.point_loads.unwrap_or_default(),
            acceleration: self.acceleration,
            guide: self.guide,
            repeat: self.repeat.map_or_else(Vec::new, |rows| rows.0),
        })
    }
}

through!(Flat => Block);

/// The keys of a part.
#[derive(Deserialize)]
#[serde(transparent)]
struct FlatPart(Flat);

impl FlatPart {
    fn typed(mut self) -> Result<Part, String> {
        let flat = &self.0;
        let whole = [
            ("name", flat.name.is_some()),
            ("motion", flat.motion.is_some()),
            ("velocity", flat.velocity.is_some()),
            ("spin", flat.spin.is_some()),
            ("material", flat.material.is_some()),
            ("deformable", flat.deformable.is_some()),
            ("initial_stress", flat.initial_stress.is_some()),
            ("fixed_points", flat.fixed_points.is_some()),
            ("point_loads", flat.point_loads.is_some()),
            ("acceleration", flat.acceleration.is_some()),
            ("guide", flat.guide.is_some()),
            ("repeat", flat.repeat.is_some()),
        ];
        if let Some((key, _)) = whole.iter().find(|(_, given)| *given) {
            return Err(format!(
                "`{key}` belongs to the whole block, not to a part of it; give it to the block"
            ));
        }
        let shape = self.0.shape()?;
        if matches!(shape, BlockShape::Compound { .. }) {
            return Err("a part cannot be a compound; list its parts among the others".into());
        }
        Ok(Part {
            shape,
            position: self.0.position,
            rotation: self.0.rotation,
        })
    }
}

through!(FlatPart => Part);
