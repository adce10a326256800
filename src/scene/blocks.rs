//! Single blocks and rows of blocks.

use std::fmt;

use schemars::{JsonSchema, Schema, SchemaGenerator};
use serde::Deserialize;
use serde::de::value::{MapAccessDeserializer, SeqAccessDeserializer};
use serde::de::{Deserializer, MapAccess, SeqAccess, Visitor};
use toml::de::DeTable;

use super::deformable::{FixedPoint, PointLoad};
use super::rules::{direction, finite, finite_constants, names, refuse};
use super::{BlockShape, Scene, block_shape};
use crate::error::Result;
use crate::formula::Formula;

/// A block, or rows of equal blocks.
#[derive(Clone, Debug, PartialEq, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Block {
    /// Name for messages, probes and files; copies get `_1`, `_2`, … after it. Default `block_` and
    /// the number of this table, from 1.
    #[serde(default)]
    pub name: Option<String>,
    /// The shape, in the block's own frame.
    #[serde(rename = "kind")]
    #[schemars(flatten)]
    pub shape: BlockShape,
    /// Position of the origin of the block's own frame, m. Default (0, 0, 0).
    #[serde(default)]
    pub position: [f64; 3],
    /// Rotation of the block about the origin of its own frame. Default none.
    #[serde(default)]
    pub rotation: Rotation,
    /// How the block moves. Default `free`.
    #[serde(default)]
    pub motion: Motion,
    /// Velocity of the centroid, m/s: for a free block at the time 0, three numbers; for a driven block
    /// three numbers or formulas of t. Default at rest.
    #[serde(default)]
    pub velocity: [Formula; 3],
    /// Angular velocity about the axes of the world, rad/s, given like the velocity. Default none.
    #[serde(default)]
    pub spin: [Formula; 3],
    /// Name of its material. Default the first one.
    #[serde(default)]
    pub material: Option<String>,
    /// Whether it deforms: as a whole, with one strain and one stress (discontinuous deformation analysis).
    /// Only free blocks of one convex polyhedron, of a material with `youngs_modulus`; they never sleep, and
    /// their elasticity limits the step. Default false: it is rigid.
    #[serde(default)]
    pub deformable: bool,
    /// Stress of deformable blocks at zero strain, such as the in-situ stress of
    /// the rock: xx, yy, zz, xy, yz, xz along the axes of the world, Pa; tension is positive. Default 0.
    #[serde(default)]
    pub initial_stress: [f64; 6],
    /// Points of a deformable block that are held in place. Default none.
    #[serde(default)]
    pub fixed_points: Vec<FixedPoint>,
    /// Forces on points of a free block, deformable or rigid; it never sleeps. Default none.
    #[serde(default)]
    pub point_loads: Vec<PointLoad>,
    /// Acceleration of a free block besides gravity, m/s²: three numbers or formulas of t; it never sleeps.
    /// Default none.
    #[serde(default)]
    pub acceleration: Option<[Formula; 3]>,
    /// Axis of a frictionless rail on which a free rigid block slides, of any length. Forces move the block along the axis only,
    /// and it does not rotate. Copies have the same axis. Default none.
    #[serde(default)]
    pub guide: Option<[f64; 3]>,
    /// Rows of copies; each row copies all blocks that the rows before it made: one row for a stack, two for a wall, with
    /// rotations for an arch. One table or a list of tables. Default only the block itself.
    #[serde(default, deserialize_with = "rows")]
    #[schemars(schema_with = "rows_schema")]
    pub repeat: Vec<Repeat>,
}

/// A part of a compound: any shape but a compound.
#[derive(Clone, Debug, PartialEq, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Part {
    /// The shape, in the part's own frame.
    #[serde(rename = "kind")]
    #[schemars(flatten)]
    pub shape: BlockShape,
    /// Position of the origin of the part's own frame in the frame of the block, m. Default (0, 0, 0).
    #[serde(default)]
    pub position: [f64; 3],
    /// Rotation of the part about that origin. Default none.
    #[serde(default)]
    pub rotation: Rotation,
}

/// A rotation.
#[derive(Clone, Copy, Debug, PartialEq, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Rotation {
    /// Axis, of any length; the rotation is counter-clockwise if the axis points at the viewer.
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

impl Rotation {
    /// Checks the numbers of the rotation at `key`.
    pub(super) fn check(&self, key: &str) -> Result<()> {
        direction(format!("{key}.axis"), &self.axis)?;
        finite(format!("{key}.angle"), &[self.angle])
    }
}

/// How a block moves.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Motion {
    /// Forces move it.
    #[default]
    Free,
    /// It does not move.
    Fixed,
    /// It moves with the given `velocity` and `spin`, whatever the forces on it.
    Driven,
}

/// A row of copies.
#[derive(Clone, Copy, Debug, PartialEq, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Repeat {
    /// Number of blocks in the row, the first one included, at least 1.
    pub count: u32,
    /// Displacement from one block to the next, m. Default (0, 0, 0).
    #[serde(default)]
    pub step: [f64; 3],
    /// Rotation of each block relative to the previous one, applied before the displacement. Default none.
    #[serde(default)]
    pub turn: Rotation,
    /// A point on the axis of that rotation, m. Default (0, 0, 0).
    #[serde(default)]
    pub about: [f64; 3],
}

/// A list of rows, or a single row. Read by hand, because serde's untagged enums lose the location of an error.
fn rows<'de, D: Deserializer<'de>>(from: D) -> Result<Vec<Repeat>, D::Error> {
    struct Rows;
    impl<'de> Visitor<'de> for Rows {
        type Value = Vec<Repeat>;

        fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
            f.write_str("a table or a list of tables")
        }

        fn visit_map<A: MapAccess<'de>>(self, map: A) -> Result<Vec<Repeat>, A::Error> {
            Ok(vec![Repeat::deserialize(MapAccessDeserializer::new(map))?])
        }

        fn visit_seq<A: SeqAccess<'de>>(self, list: A) -> Result<Vec<Repeat>, A::Error> {
            Vec::deserialize(SeqAccessDeserializer::new(list))
        }
    }
    from.deserialize_any(Rows)
}

fn rows_schema(generator: &mut SchemaGenerator) -> Schema {
    let one = generator.subschema_for::<Repeat>();
    schemars::json_schema!({
        "anyOf": [one.clone(), { "type": "array", "items": one }]
    })
}

/// Checks that a part has only the keys of its shape and placement, and is not a compound.
pub(super) fn check_part(part: &DeTable<'_>, kind: &str) -> Result<(), String> {
    const OF_BLOCKS: [&str; 12] = [
        "name",
        "motion",
        "velocity",
        "spin",
        "material",
        "deformable",
        "initial_stress",
        "fixed_points",
        "point_loads",
        "acceleration",
        "guide",
        "repeat",
    ];
    match OF_BLOCKS.iter().find(|key| part.contains_key(**key)) {
        Some(key) => Err(format!(
            "`{key}` belongs to the whole block, not to a part of it; give it to the block"
        )),
        None if kind == "compound" => {
            Err("a part cannot be a compound; list its parts among the others".into())
        }
        None => Ok(()),
    }
}

/// Largest number of blocks of a table: far more than can be run in a day, so more is a typing error.
const MOST: f64 = 1e7;

impl Scene {
    pub(super) fn check_blocks(&self) -> Result<()> {
        let named = self.blocks.iter().enumerate();
        names(
            "blocks",
            named.filter_map(|(i, block)| Some((i, block.name.as_deref()?))),
        )?;
        for (index, block) in self.blocks.iter().enumerate() {
            let key = format!("blocks[{index}]");
            self.material(&format!("{key}.material"), block.material.as_deref())?;
            block_shape::check(&key, &block.shape)?;
            finite(format!("{key}.position"), &block.position)?;
            block.rotation.check(&format!("{key}.rotation"))?;
            motion(&key, block)?;
            self.check_deformable(&key, block)?;
            repeats(&key, block)?;
        }
        Ok(())
    }
}

fn motion(key: &str, block: &Block) -> Result<()> {
    let still = |formulas: &[Formula; 3]| formulas.iter().all(|f| f.constant() == Some(0.0));
    for (name, formulas) in [("velocity", &block.velocity), ("spin", &block.spin)] {
        let key = format!("{key}.{name}");
        finite_constants(&key, formulas)?;
        match block.motion {
            Motion::Fixed if !still(formulas) => {
                return refuse(
                    key,
                    "a fixed block does not move; remove it, or use motion = \"driven\"",
                );
            }
            Motion::Free if formulas.iter().any(|f| !f.is_constant()) => {
                return refuse(
                    key,
                    "a free block starts with three numbers; for formulas of t use motion = \
                     \"driven\"",
                );
            }
            _ => {}
        }
        let at_start = |formula: &&Formula| formula.eval(0.0, 0.0, 0.0, 0.0);
        if let Some(formula) = formulas.iter().find(|f| !at_start(f).is_finite()) {
            return refuse(
                key,
                format!(
                    "`{formula}` is {} at t = 0; give a formula that is finite at all times",
                    at_start(&formula)
                ),
            );
        }
        if let Some(formula) = formulas.iter().find(|f| f.uses_place()) {
            return refuse(
                key,
                format!("`{formula}` uses x, y or z; the motion of a block is a formula of t"),
            );
        }
    }
    Ok(())
}

fn repeats(key: &str, block: &Block) -> Result<()> {
    let mut all = 1.0;
    for (number, row) in block.repeat.iter().enumerate() {
        let key = format!("{key}.repeat[{number}]");
        if row.count == 0 {
            return refuse(
                format!("{key}.count"),
                "a row has at least the block itself; give at least 1",
            );
        }
        finite(format!("{key}.step"), &row.step)?;
        finite(format!("{key}.about"), &row.about)?;
        row.turn.check(&format!("{key}.turn"))?;
        all *= f64::from(row.count);
        if all > MOST {
            return refuse(
                format!("{key}.count"),
                format!("these are {all:.3e} blocks; at most {MOST:.0e} are made of a table"),
            );
        }
        if row.count > 1 && row.step == [0.0; 3] && row.turn.angle == 0.0 {
            return refuse(
                key,
                "all copies would be in one place; give a step or a turn",
            );
        }
    }
    Ok(())
}
