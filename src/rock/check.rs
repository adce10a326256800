//! Validation of a [`Setup`].

use super::{
    Block, Deformable, Guide, Motion, Setup, Sleep,
    body::formula_values,
    narrowphase::{Joints, label},
};
use crate::{Error, Result, geometry::Form, rock::law::Joint};
use glam::DVec3;

/// # Errors
/// [`Error::Argument`] at `place` if the number is not finite and greater than 0.
pub(super) fn positive(place: &str, value: f64, unit: &str) -> Result<()> {
    if value > 0.0 && value.is_finite() {
        return Ok(());
    }
    let message = format!("{value} must be greater than 0 {unit}");
    Err(Error::argument(place, message))
}

/// # Errors
/// [`Error::Argument`] naming the first invalid value.
pub(super) fn check(setup: &Setup) -> Result<()> {
    if !setup.gravity.is_finite() {
        let message = format!("{} must be finite", setup.gravity);
        return Err(Error::argument("gravity", message));
    }
    if !(setup.damping >= 0.0 && setup.damping.is_finite()) {
        let message = format!("{} must be 0 1/s or more", setup.damping);
        return Err(Error::argument("damping", message));
    }
    if let Some(step) = setup.time_step {
        positive("time_step", step, "s")?;
    }
    if let Some(skin) = setup.skin {
        positive("skin", skin, "m")?;
    }
    positive("start_overlap", setup.start_overlap, "")?;
    positive("largest_overlap", setup.largest_overlap, "")?;
    if !(0.0..=1.0).contains(&setup.corner_area) {
        let message = format!("{} must be between 0 and 1", setup.corner_area);
        return Err(Error::argument("corner_area", message));
    }
    if let Some(period) = &setup.period {
        period.check()?;
    }
    if let Some(film) = &setup.film {
        film.check()?;
    }
    if let Some(Sleep {
        speed,
        after,
        change,
    }) = setup.sleep
    {
        positive("sleep.speed", speed, "m/s")?;
        positive("sleep.after", after, "s")?;
        positive("sleep.change", change, "")?;
    }
    for (i, material) in setup.materials.iter().enumerate() {
        let place = format!("materials[{i}]");
        positive(&format!("{place}.density"), material.density, "kg/m³")?;
        material.joint.check(&place)?;
        if let Some(elastic) = &material.elastic {
            elastic.check(&place)?;
        }
    }
    for (i, pair) in setup.pairs.iter().enumerate() {
        let place = format!("pairs[{i}]");
        if let Some(bad) = pair.materials.iter().find(|&&m| m >= setup.materials.len()) {
            let message = format!("there is no material {bad}, only {}", setup.materials.len());
            return Err(Error::argument(place, message));
        }
        pair.joint.check(&place)?;
    }
    for (i, block) in setup.blocks.iter().enumerate() {
        check_block(setup, i)?;
        let place = label(i, &block.name);
        check_deformable(setup, block, &place)?;
        check_applied_forces(block, &place)?;
    }
    setup
        .guides
        .iter()
        .try_for_each(|guide| check_guide(setup, guide))
}

/// Checks that a guided block is free and rigid, and starts along its guide.
fn check_guide(setup: &Setup, guide: &Guide) -> Result<()> {
    let Some(block) = setup.blocks.get(guide.block) else {
        let (number, known) = (guide.block, setup.blocks.len());
        let message = format!("there is no block {number}, only {known}");
        return Err(Error::argument("guides", message));
    };
    let refuse = |message: &str| {
        let place = format!("{}: guide", label(guide.block, &block.name));
        Err(Error::argument(place, message))
    };
    let axis = guide.axis.try_normalize();
    let Some(axis) = axis.filter(|_| guide.axis.is_finite()) else {
        return refuse("must be an axis of finite length, not 0, such as [0, 0, 1]");
    };
    if block.motion != Motion::Free || block.deformable.is_some() {
        return refuse(
            "only a free rigid block slides along one; remove motion or deformable, or the guide",
        );
    }
    if setup.film.is_some() {
        return refuse(
            "films of fluid between blocks (coupling.lubrication) push guided ones aside; turn them off, or remove the guide",
        );
    }
    let across = block.velocity - axis.dot(block.velocity) * axis;
    if across.length() > 1e-9 * block.velocity.length() || block.spin != DVec3::ZERO {
        return refuse("its velocity must be along its guide, and its spin 0");
    }
    Ok(())
}

fn check_block(setup: &Setup, index: usize) -> Result<()> {
    let block = &setup.blocks[index];
    let refuse = |message: String| Err(Error::argument(label(index, &block.name), message));
    let Some(material) = setup.materials.get(block.material) else {
        let (number, known) = (block.material, setup.materials.len());
        return refuse(format!("there is no material {number}, only {known}"));
    };
    let mass = material.density * block.shape.volume();
    if !(mass > 0.0 && mass.is_finite()) {
        return refuse(format!("its mass is {mass} kg; it must be greater than 0"));
    }
    let numbers = [
        ("centre", block.centre.is_finite()),
        ("rotation", block.rotation.is_finite()),
        ("velocity", block.velocity.is_finite()),
        ("spin", block.spin.is_finite()),
    ];
    if let Some((name, _)) = numbers.iter().find(|(_, finite)| !finite) {
        return refuse(format!("its {name} is not finite"));
    }
    if (block.rotation.length() - 1.0).abs() > 1e-6 {
        let length = block.rotation.length();
        return refuse(format!(
            "its rotation is a quaternion of length {length}, not 1"
        ));
    }
    if let Motion::Driven { velocity, spin } = &block.motion {
        for (name, formulas) in [("velocity", velocity), ("spin", spin)] {
            let value = |k: usize| formulas[k].eval_at([0.0; 3], 0.0);
            if let Some(k) = (0..3).find(|&k| !value(k).is_finite()) {
                let text = formulas[k].text();
                return refuse(format!("its {name} `{text}` is not finite at t = 0"));
            }
        }
    }
    Ok(())
}

/// The joint of each pair of materials.
pub(super) fn joints(setup: &Setup) -> Joints {
    let materials = setup.materials.len();
    let mut table = Vec::with_capacity(materials * materials);
    for a in &setup.materials {
        let row = setup.materials.iter();
        table.extend(row.map(|b| Joint::between(&a.joint, &b.joint)));
    }
    for pair in &setup.pairs {
        let [a, b] = pair.materials;
        table[a * materials + b] = pair.joint;
        table[b * materials + a] = pair.joint;
    }
    Joints {
        materials: materials as u32,
        table,
    }
}

/// Speed of a fixed point that is attributed to rounding, as a share of the speeds of which it is the sum.
const SPEED_ROUNDING: f64 = 1e-12;

/// # Errors
/// [`Error::Argument`] at `place` if the block cannot deform.
fn check_deformable(setup: &Setup, block: &Block, place: &str) -> Result<()> {
    let Some(Deformable {
        initial_stress,
        fixed_points,
    }) = &block.deformable
    else {
        return Ok(());
    };
    let refuse = |message: String| Err(Error::argument(place, message));
    if block.motion != Motion::Free {
        return refuse(
            "a deformable block is moved by forces; make it free and hold it by fixed points, or make it rigid"
                .into(),
        );
    }
    match block.shape.parts() {
        [part] if matches!(part.form, Form::Convex(_)) => {}
        [_] => {
            return refuse(
                "a sphere cannot deform, since its contacts need it round; give a polyhedron, or make it rigid"
                    .into(),
            );
        }
        parts => {
            return refuse(format!(
                "a compound of {} parts cannot deform; give a convex block, or make it rigid",
                parts.len()
            ));
        }
    }
    if setup.materials[block.material].elastic.is_none() {
        return refuse(format!(
            "it is deformable, and its material {} has no elasticity; give it Young's modulus and \
             Poisson's ratio",
            block.material
        ));
    }
    if !initial_stress.is_finite() || *initial_stress != initial_stress.transpose() {
        return refuse(format!(
            "its initial stress {initial_stress} Pa must be finite and symmetric"
        ));
    }
    for (number, fixed) in fixed_points.iter().enumerate() {
        let place = format!("{place}: fixed point {number}");
        if !fixed.point.is_finite() {
            return Err(Error::argument(place, "its place is not finite"));
        }
        if fixed.axes == [false; 3] {
            let message = "it is held along no axis; name one at least, or leave it out";
            return Err(Error::argument(place, message));
        }
        let turning = block.spin.cross(block.rotation * fixed.point);
        let velocity = block.velocity + turning;
        let scale = block.velocity.length() + turning.length();
        let moves = |k: usize| fixed.axes[k] && velocity[k].abs() > SPEED_ROUNDING * scale;
        if (0..3).any(moves) {
            let message = format!(
                "it starts with {velocity} m/s where it is held; let the block start at rest, or about \
                 that point"
            );
            return Err(Error::argument(place, message));
        }
    }
    Ok(())
}

/// # Errors
/// [`Error::Argument`] at `place` if a force acts on a block that is not free, or is not finite at the start.
fn check_applied_forces(block: &Block, place: &str) -> Result<()> {
    let acts = !block.point_loads.is_empty() || block.acceleration.is_some();
    if acts && block.motion != Motion::Free {
        let message = "point loads and an acceleration act on free blocks alone, and it is fixed or driven; \
                       make it free, or remove them";
        return Err(Error::argument(place, message));
    }
    for (number, load) in block.point_loads.iter().enumerate() {
        if !load.point.is_finite() || !formula_values(&load.force, 0.0).is_finite() {
            let message = "its place or its force at t = 0 is not finite";
            return Err(Error::argument(
                format!("{place}: point load {number}"),
                message,
            ));
        }
    }
    match &block.acceleration {
        Some(formulas) if !formula_values(formulas, 0.0).is_finite() => Err(Error::argument(
            place,
            "its acceleration at t = 0 is not finite",
        )),
        _ => Ok(()),
    }
}
