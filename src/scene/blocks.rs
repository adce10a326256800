//! Blocks that stand alone or in rows.

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

/// A block, or a row of equal ones.
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
    /// Where the origin of the block's own frame is, m. Default (0, 0, 0).
    #[serde(default)]
    pub position: [f64; 3],
    /// How the block is turned about the origin of its own frame. Default not at all.
    #[serde(default)]
    pub rotation: Rotation,
    /// What may move it. Default `free`.
    #[serde(default)]
    pub motion: Motion,
    /// Velocity of the centroid, m/s: of a free block at the time 0, three numbers; of a driven one
    /// three numbers or formulas of t. Default at rest.
    #[serde(default)]
    pub velocity: [Formula; 3],
    /// Spin about the axes of the world, rad/s: as the velocity. Default none.
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
    /// Stress that deformable blocks bear at the start without strain, as what the rock around them has
    /// pressed into them: xx, yy, zz, xy, yz, xz along the axes of the world, Pa; tension is positive. Default 0.
    #[serde(default)]
    pub initial_stress: [f64; 6],
    /// Points of a deformable block that stay where they are. Default none.
    #[serde(default)]
    pub fixed_points: Vec<FixedPoint>,
    /// Forces on points of a free block, deformable or rigid; it never sleeps. Default none.
    #[serde(default)]
    pub point_loads: Vec<PointLoad>,
    /// Acceleration of a free block besides gravity, m/s²: three numbers or formulas of t; it never sleeps.
    /// Default none.
    #[serde(default)]
    pub acceleration: Option<[Formula; 3]>,
    /// Axis of a rail without friction on which a free rigid block slides, of any length: along it forces move the block, across
    /// it nothing does, and it does not turn. Copies have the same. Default none.
    #[serde(default)]
    pub guide: Option<[f64; 3]>,
    /// Rows of copies, each of all that those before it made: one for a stack, two for a wall, with
    /// turns for an arch. One table or a list of them. Default only the block itself.
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
    /// Where the origin of the part's own frame is in the block's, m. Default (0, 0, 0).
    #[serde(default)]
    pub position: [f64; 3],
    /// How the part is turned about that origin. Default not at all.
    #[serde(default)]
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

impl Rotation {
    /// The numbers of the turn at `key`.
    pub(super) fn check(&self, key: &str) -> Result<()> {
        direction(format!("{key}.axis"), &self.axis)?;
        finite(format!("{key}.angle"), &[self.angle])
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

/// A list of rows, or its only one. Read by hand, since serde's untagged enums lose the place of an error.
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

/// A part has the keys that say where it is, and no parts.
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

/// Most blocks of a table: far beyond what runs in a day, so a slip of the pen.
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
