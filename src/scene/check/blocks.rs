//! Blocks are written so that they can be made: numbers, names, and what may move them.

use super::rules::{direction, finite, finite_constants, names, positive, refuse};
use crate::error::Result;
use crate::formula::Formula;
use crate::scene::{Block, BlockShape, Motion, PlaneFace, Rotation, Scene};

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
            shape(&key, &block.shape)?;
            finite(format!("{key}.position"), &block.position)?;
            turn(&format!("{key}.rotation"), &block.rotation)?;
            motion(&key, block)?;
            self.check_deformable(&key, block)?;
            repeats(&key, block)?;
        }
        Ok(())
    }
}

pub(super) fn shape(key: &str, shape: &BlockShape) -> Result<()> {
    match shape {
        BlockShape::Box { size } => {
            for (axis, edge) in size.iter().enumerate() {
                positive(format!("{key}.size[{axis}]"), *edge, "m")?;
            }
            Ok(())
        }
        BlockShape::Vertices { vertices } => points(&format!("{key}.vertices"), vertices),
        BlockShape::HalfSpaces { faces } => half_spaces(&format!("{key}.faces"), faces),
        BlockShape::Tetrahedron { edge }
        | BlockShape::Octahedron { edge }
        | BlockShape::Dodecahedron { edge }
        | BlockShape::Icosahedron { edge } => positive(format!("{key}.edge"), *edge, "m"),
        BlockShape::Sphere { radius } => positive(format!("{key}.radius"), *radius, "m"),
        BlockShape::Mesh { scale, .. } => positive(format!("{key}.scale"), *scale, "m"),
        BlockShape::Compound { parts } => {
            if parts.is_empty() {
                return refuse(format!("{key}.parts"), "has no parts; list at least one");
            }
            for (number, part) in parts.iter().enumerate() {
                let key = format!("{key}.parts[{number}]");
                self::shape(&key, &part.shape)?;
                finite(format!("{key}.position"), &part.position)?;
                turn(&format!("{key}.rotation"), &part.rotation)?;
            }
            Ok(())
        }
    }
}

pub(super) fn points(key: &str, points: &[[f64; 3]]) -> Result<()> {
    for (number, point) in points.iter().enumerate() {
        finite(format!("{key}[{number}]"), point)?;
    }
    if points.len() < 4 {
        return refuse(
            key,
            format!("{} points have no volume; give at least 4", points.len()),
        );
    }
    Ok(())
}

pub(super) fn half_spaces(key: &str, faces: &[PlaneFace]) -> Result<()> {
    for (number, face) in faces.iter().enumerate() {
        direction(format!("{key}[{number}].normal"), &face.normal)?;
        finite(format!("{key}[{number}].distance"), &[face.distance])?;
    }
    if faces.len() < 4 {
        return refuse(
            key,
            format!("{} half-spaces bound nothing; give at least 4", faces.len()),
        );
    }
    Ok(())
}

pub(super) fn turn(key: &str, rotation: &Rotation) -> Result<()> {
    direction(format!("{key}.axis"), &rotation.axis)?;
    finite(format!("{key}.angle"), &[rotation.angle])
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
        turn(&format!("{key}.turn"), &row.turn)?;
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
