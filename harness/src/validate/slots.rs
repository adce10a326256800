//! Every combination of slots is valid WGSL, and a setup binds only what it uses.

use super::{CaseContext, Outcome, Trial, fields::changed, record::describe};
use anyhow::Context;
use riprap::{
    gpu::kernel,
    lattice::{
        BrickKind, Collision, Equilibrium, Force, Setup, SolidOperator, SolidWeight, Storage,
        WallModel, collide_stream,
    },
};
use std::time::Instant;

/// Runs the case.
pub fn run(_: &CaseContext) -> Outcome {
    let begin = Instant::now();
    let mut linked = 0;
    let mut wrong: Vec<String> = Vec::new();
    for setup in setups() {
        for kind in [
            BrickKind::All,
            BrickKind::Plain,
            BrickKind::Flagged,
            BrickKind::Psm,
        ] {
            // One binding, as on most devices, and four, as large grids need.
            for bindings in [1, 4] {
                let program = collide_stream(&setup, bindings, kind);
                let shader = program
                    .link()
                    .with_context(|| format!("{} {kind:?}", describe(&setup)))?;
                let found = kernel::bindings(&shader, "collide_stream")?;
                let mut found: Vec<_> = found.into_iter().map(|b| b.name).collect();
                found.sort();
                if found != expected(&setup, bindings, kind) {
                    wrong.push(format!("{found:?}"));
                }
                linked += 1;
            }
        }
    }
    let what = match wrong.first() {
        Some(first) => format!("first: {first}"),
        None => "collide_stream, all slots".into(),
    };
    let trial = Trial::since(begin, what, 0, 0);
    Ok(vec![
        trial.report("combinations that naga validates", f64::from(linked)),
        trial.at_most("combinations with other bindings", wrong.len() as f64, 0.0),
    ])
}

fn setups() -> Vec<Setup> {
    let mut all = vec![Setup::periodic([16; 3], 0.01)];
    let mut vary = |choices: &[&dyn Fn(&mut Setup)]| {
        let each = |setup| choices.iter().map(move |choice| changed(setup, choice));
        all = all.iter().flat_map(each).collect();
    };
    vary(&[
        &|s| s.collision = Collision::Bgk,
        &|s| s.collision = Collision::Hermite,
        &|s| s.collision = Collision::Suga,
    ]);
    vary(&[&|s| s.equilibrium = Equilibrium::Product, &|s| {
        s.equilibrium = Equilibrium::SecondOrder
    }]);
    vary(&[&|s| s.wale = None, &|s| s.wale = Some(0.5), &|s| {
        s.wale = Some(0.5);
        s.wall_model = Some(WallModel::WernerWengle);
    }]);
    vary(&[
        &|s| s.force = Force::None,
        &|s| s.force = Force::Constant([1e-5, 0.0, 0.0]),
        &|s| s.force = Force::Field(Vec::new()),
    ]);
    vary(&[
        &|s| (s.storage, s.lanes) = (Storage::F32, 1),
        &|s| (s.storage, s.lanes) = (Storage::F32, 4),
        &|s| (s.storage, s.lanes) = (Storage::F16, 2),
        &|s| (s.storage, s.lanes) = (Storage::F16, 4),
    ]);
    vary(&[
        &|s| s.solid_operator = Some(SolidOperator::Holdych),
        &|s| {
            s.solid_operator = Some(SolidOperator::Holdych);
            s.solid_weight = Some(SolidWeight::Standard);
        },
        &|s| s.solid_operator = Some(SolidOperator::Noble),
        &|s| s.solid_operator = Some(SolidOperator::Superposition),
    ]);
    vary(&[&|s| s.max_speed = 0.0, &|s| s.max_speed = 0.3]);
    all
}

/// The names that the kernel of a setup binds, sorted.
fn expected(setup: &Setup, bindings: u32, kind: BrickKind) -> Vec<String> {
    let mut names: Vec<_> = (0..bindings).map(|b| format!("populations_{b}")).collect();
    let wale = setup.wale.is_some();
    let flagged = matches!(kind, BrickKind::Flagged | BrickKind::Psm);
    let friction_on_blocks =
        kind == BrickKind::Psm && setup.wall_model.is_some() && setup.storage == Storage::F32;
    let optional = [
        (wale, "velocity_before_0"),
        (wale && setup.wale_interval == 1, "velocity_after_0"),
        (setup.keeps_eddy_viscosity(), "eddy_viscosity"),
        (setup.wall_model.is_some(), "near_wall_viscosity"),
        (matches!(setup.force, Force::Constant(_)), "uniform_force"),
        (matches!(setup.force, Force::Field(_)), "force_field_0"),
        (setup.max_speed > 0.0, "guard_state"),
        (kind != BrickKind::All, "bricks"),
        (flagged, "flags"),
        (kind == BrickKind::Psm, "psm_planes_0"),
        (friction_on_blocks, "face_codes"),
    ];
    let used = optional.into_iter().filter(|(used, _)| *used);
    names.extend(used.map(|(_, name)| name.to_owned()));
    names.sort();
    names
}
