//! Blocks with uniform deformation (Mikola & Sitar 2014, §2), against exact solutions of affine bodies.

use super::{DENSITY, G, Rock, cuboid, floor, joint, setup};
use crate::validate::{CaseContext, Outcome, Trial};
use glam::{DMat3, DQuat, DVec3};
use riprap::{
    geometry::skew,
    rock::{
        Block, Deformable, FixedPoint, Setup,
        integrate::{Affine, Wrench},
        law::{Elastic, Joint},
    },
};
use std::{f64::consts::TAU, time::Instant};

/// Rock as soft as tuff.
const ROCK: Elastic = Elastic {
    youngs_modulus: 1e9,
    poissons_ratio: 0.25,
};

/// Blocks of one material with the given elasticity.
fn elastic(blocks: Vec<Block>, joint: Joint, elastic: Elastic) -> Setup {
    let mut setup = setup(blocks, joint);
    setup.materials[0].elastic = Some(elastic);
    setup
}

/// A single box with these edges (m).
fn alone(edges: DVec3) -> Affine {
    let volume = edges.x * edges.y * edges.z;
    let squares = edges * edges;
    let inertia = DVec3::splat(squares.element_sum()) - squares;
    let inertia = DMat3::from_diagonal(inertia * (volume / 12.0));
    Affine::new(volume, inertia, DENSITY, ROCK, DMat3::ZERO)
}

/// One central-difference step of `dt` (s) of a free body.
fn step(body: &Affine, f: &mut DMat3, rate: &mut DMat3, dt: f64) {
    let free = Wrench {
        force: DVec3::ZERO,
        moment: DMat3::ZERO,
    };
    *rate += body.accelerations(*f, &free).1 * (0.5 * dt);
    *f += *rate * dt;
    *rate += body.accelerations(*f, &free).1 * (0.5 * dt);
}

/// Frobenius norm.
fn norm(a: DMat3) -> f64 {
    let squares = a.to_cols_array().map(|x| x * x);
    squares.iter().sum::<f64>().sqrt()
}

/// Largest strain within `steps` steps of `share` of the critical step, from an initial strain of 1e-9 in every mode.
fn largest(edges: DVec3, share: f64, steps: u64) -> (f64, Trial) {
    let begin = Instant::now();
    let body = alone(edges);
    // All entries differ, so that every mode is excited.
    let start = [1.0, 0.3, -0.7, 0.2, -0.9, 0.5, -0.4, 0.6, 0.8];
    let mut f = DMat3::IDENTITY + DMat3::from_cols_array(&start) * 1e-9;
    let (mut rate, mut most) = (DMat3::ZERO, 0.0f64);
    for _ in 0..steps {
        step(&body, &mut f, &mut rate, share * body.critical_step());
        most = most.max(norm(body.strain(f)));
    }
    let [x, y, z] = edges.to_array();
    let what = format!("{x}x{y}x{z} m, {share} Δt_c");
    (most, Trial::since(begin, what, 1, steps))
}

/// Δt_c = 2/ω_max of the nine-by-nine elastic problem of a block and of a cube; the central difference must be stable just below
/// it and unstable just above.
pub fn critical_step(_: &CaseContext) -> Outcome {
    let trial = Trial {
        setup: "E = 1 GPa, ν = 0.25, ρ = 2500 kg/m³".into(),
        cells: 1,
        ..Trial::default()
    };
    let (block, cube) = (DVec3::new(1.0, 2.0, 3.0), DVec3::ONE);
    let [lambda, mu] = ROCK.lame();
    let volumetric = (3.0 * (3.0 * lambda + 2.0 * mu) / DENSITY).sqrt().recip();
    let mut records = vec![
        // Three digits of the reference are known.
        trial.absolute(
            "Δt_c of 1x2x3 m, s",
            alone(block).critical_step(),
            8.13e-4,
            5e-7,
        ),
        // Two derivations of the same number.
        trial.relative(
            "Δt_c of 1 m, s",
            alone(cube).critical_step(),
            volumetric,
            1e-12,
        ),
    ];
    for edges in [block, cube] {
        let (early, _) = largest(edges, 0.98, 50_000);
        let (late, trial) = largest(edges, 0.98, 100_000);
        records.push(trial.absolute("strain over 1e5 steps / over 5e4", late / early, 1.0, 0.01));
        let (blown, trial) = largest(edges, 1.02, 40);
        // It grows by the factor 1.49 per step.
        records.push(trial.at_least("strain over 40 steps / at 0.98", blown / early, 1e4));
    }
    Ok(records)
}

/// Angular velocity of the spinning block, rad/s.
const OMEGA: f64 = 20.0;

/// A block that spins at a constant rate: its centrifugal strain is known exactly, and it must not grow. With F = R U and U
/// constant, U Σ = ω² U S/V in the plane of rotation, so that Σ = ω² S/V there. Checks strain, angular momentum and energy over a
/// hundred revolutions; over a thousand with `--full`.
pub fn spin(context: &CaseContext) -> Outcome {
    let begin = Instant::now();
    let body = alone(DVec3::new(1.0, 2.0, 3.0));
    let stress = DVec3::new(0.0, 4.0, 9.0) * (DENSITY / 12.0 * OMEGA * OMEGA);
    let (young, ratio) = (ROCK.youngs_modulus, ROCK.poissons_ratio);
    let exact = (stress * (1.0 + ratio) - DVec3::splat(ratio * stress.element_sum())) / young;
    let stretch = (exact * 2.0 + DVec3::ONE).to_array().map(f64::sqrt);
    let mut f = DMat3::from_diagonal(DVec3::from_array(stretch));
    let mut rate = skew(DVec3::X * OMEGA) * f;
    let start = body.angular_momentum(f, rate);
    let energy = |f, rate| body.kinetic(rate) + body.strain_energy(f);
    let before = energy(f, rate);
    let revolutions = if context.full { 1000.0 } else { 100.0 };
    let dt = 0.1 * body.critical_step();
    let steps = (revolutions * TAU / OMEGA / dt) as u64;
    let (mut strain, mut momentum, mut gain) = (0.0f64, 0.0f64, 0.0f64);
    for _ in 0..steps {
        step(&body, &mut f, &mut rate, dt);
        let off = body.strain(f) - DMat3::from_diagonal(exact);
        strain = strain.max(norm(off) / exact.max_element());
        let now = body.angular_momentum(f, rate);
        momentum = momentum.max((now - start).length() / start.length());
        gain = gain.max((energy(f, rate) / before - 1.0).abs());
    }
    let what = format!(
        "1x2x3 m, {OMEGA} rad/s, {revolutions} revolutions, strain {:.1e}",
        exact.z
    );
    let trial = Trial::since(begin, what, 1, steps);
    let second_order = (OMEGA * dt).powi(2);
    Ok(vec![
        trial.at_most("largest error of the strain / strain", strain, second_order),
        trial.at_most("largest error of the momentum / momentum", momentum, 1e-12),
        trial.at_most("largest error of the energy / energy", gain, 1e-10),
        trial.at_most(
            "growth of the volume",
            f.determinant() - DVec3::from_array(stretch).element_product(),
            1e-9,
        ),
    ])
}

/// Periods of the vibrating cube.
const PERIODS: usize = 50;

/// A cube that vibrates in its volume: ω² = 12(3λ + 2μ)/(ρa²); the central difference shortens the period by (ωΔt)²/24. Measures
/// the period at three time steps, and its order.
pub fn vibration(_: &CaseContext) -> Outcome {
    let a = 2.0;
    let [lambda, mu] = ROCK.lame();
    let omega = (12.0 * (3.0 * lambda + 2.0 * mu) / (DENSITY * a * a)).sqrt();
    let mut records = Vec::new();
    for product in [0.2, 0.1, 0.05] {
        let begin = Instant::now();
        let body = alone(DVec3::splat(a));
        let dt = product / omega;
        // Small enough that the law is linear to the digits that are checked.
        let (mut f, mut rate) = (DMat3::IDENTITY * (1.0 + 1e-8), DMat3::ZERO);
        let mut crossings = Vec::new();
        let mut before = body.strain(f).x_axis.x;
        let mut steps = 0;
        while crossings.len() <= PERIODS {
            step(&body, &mut f, &mut rate, dt);
            steps += 1;
            let now = body.strain(f).x_axis.x;
            if before > 0.0 && now <= 0.0 {
                crossings.push((steps as f64 - now / (now - before)) * dt);
            }
            before = now;
        }
        let period = (crossings[PERIODS] - crossings[0]) / PERIODS as f64;
        let what = format!("cube of {a} m, ωΔt = {product}, {PERIODS} periods");
        let trial = Trial::since(begin, what, 1, steps);
        // sin(½ω'Δt) = ½ωΔt of the central difference.
        let exact = 2.0 * (0.5 * product).asin() / product;
        records.push(trial.relative("period / 2π/ω", period * omega / TAU, 1.0, None));
        records.push(trial.relative(
            "the same by the step's own ω",
            period * omega / TAU * exact,
            1.0,
            1e-5,
        ));
    }
    Ok(records)
}

/// Length of the bar, m.
const LENGTH: f64 = 10.0;

/// A bar that hangs by a point of its upper face: V P = mg ⊗ X, which gives the mean stress ρgL/2 and the elongation ρgL²/2E of
/// the exact solution. Checks stress, elongation, thinning by Poisson's ratio, support force and energies at rest.
pub fn bar(_: &CaseContext) -> Outcome {
    let top = DVec3::Z * (0.5 * LENGTH);
    let mut bar = Block::new("bar", cuboid(1.0, 0.8, LENGTH)?, DVec3::ZERO);
    bar.deformable = Some(Deformable {
        fixed_points: vec![FixedPoint {
            point: top,
            axes: [true; 3],
        }],
        ..Deformable::default()
    });
    let mut setup = elastic(vec![bar], joint(1e9, 30.0), ROCK);
    // Critical damping for the axial mode of a bar held at one end, ω = ½√(12E/ρ)/L.
    setup.damping = (12.0 * ROCK.youngs_modulus / DENSITY).sqrt() / LENGTH;
    let mut rock = Rock::new(setup, format!("{LENGTH} m, E = 1 GPa"))?;
    rock.run(0.3)?;
    let pose = rock.blocks.poses()[0];
    let support = rock.blocks.support(0).map_or(f64::NAN, |force| force.z);
    let mean = 0.5 * DENSITY * G * LENGTH;
    let longer = (pose.point(top) - pose.point(-top)).length() - LENGTH;
    let thinner = (pose.deformation * DVec3::Y).length() - 1.0;
    let von_mises = rock.blocks.von_mises(0).unwrap_or(f64::NAN);
    let strain = rock.blocks.ledger().strain;
    let error = rock.energy_error() / rock.blocks.ledger().dissipated();
    let trial = rock.trial();
    // At strains of 1.2e-4, stresses by area and by length differ by as much.
    Ok(vec![
        trial.relative("mean stress, Pa", rock.vertical_stress(0), mean, 5e-4),
        trial.relative(
            "elongation, m",
            longer,
            mean * LENGTH / ROCK.youngs_modulus,
            5e-4,
        ),
        trial.relative("von Mises stress, Pa", von_mises, mean, 5e-4),
        trial.relative(
            "thinning",
            thinner,
            -ROCK.poissons_ratio * mean / ROCK.youngs_modulus,
            1e-3,
        ),
        trial.relative(
            "strain energy, J",
            strain,
            0.5 * mean * mean / ROCK.youngs_modulus * 0.8 * LENGTH,
            1e-3,
        ),
        trial.relative("support, N", support, rock.blocks.mass(0) * G, 1e-6),
        trial.at_most(
            "way of the fixed point, m",
            (pose.point(top) - top).length(),
            1e-12,
        ),
        trial.at_most("error of the energy / energy taken", error, 0.01),
    ])
}

/// Cubes on a rigid floor, the second of them rigid: each bears half its own weight and the cubes above it.
pub fn stack(_: &CaseContext) -> Outcome {
    let mut list = vec![floor(9.0)?];
    for n in 0..4 {
        let at = DVec3::Z * (0.5 + f64::from(n));
        let block = Block::new(format!("{n}"), cuboid(1.0, 1.0, 1.0)?, at);
        list.push(if n == 1 { block } else { block.deformable() });
    }
    let mut setup = elastic(list, joint(1e9, 30.0), ROCK);
    // Near critical for the vibration of the whole stack.
    setup.damping = 300.0;
    let mut rock = Rock::new(setup, "four cubes, the second one rigid, E = 1 GPa")?;
    rock.run(0.4)?;
    let trial = rock.trial();
    let weight = rock.blocks.mass(1) * G;
    let mut records = Vec::new();
    for (block, above) in [(1, 3.0), (3, 1.0), (4, 0.0)] {
        let stress = rock.vertical_stress(block);
        let name = format!("stress of block {block}, Pa");
        // A strain of 1e-4 changes area and height by as much.
        records.push(trial.relative(name, stress, -(above + 0.5) * weight, 1e-3));
    }
    let rigid = rock.blocks.stress(2).is_none();
    records.push(trial.at_least(
        "the rigid one has no stress",
        f64::from(u8::from(rigid)),
        1.0,
    ));
    let error = rock.energy_error() / rock.blocks.ledger().dissipated();
    records.push(trial.at_most("error of the energy / energy taken", error, 0.01));
    Ok(records)
}

/// Two bars that collide end to end without damping.
pub fn collision(_: &CaseContext) -> Outcome {
    let bar = |name: &str, x: f64, v: f64| -> anyhow::Result<Block> {
        let block = Block::new(name, cuboid(2.0, 0.5, 0.5)?, DVec3::X * x).deformable();
        Ok(Block {
            velocity: DVec3::X * v,
            ..block
        })
    };
    let joint = Joint {
        damping: 0.0,
        ..joint(1e11, 30.0)
    };
    let rock = Elastic {
        youngs_modulus: 1e10,
        ..ROCK
    };
    let list = vec![bar("left", -1.01, 1.0)?, bar("right", 1.01, 0.0)?];
    let mut setup = elastic(list, joint, rock);
    setup.gravity = DVec3::ZERO;
    let mut rock = Rock::new(setup, "two bars of 2 m at 1 m/s, E = 10 GPa")?;
    rock.run(0.04)?;
    let (start, end) = (rock.start, rock.blocks.ledger());
    let momentum: DVec3 = rock.blocks.poses().iter().map(|pose| pose.velocity).sum();
    let error = rock.energy_error() / start.kinetic;
    let trial = rock.trial();
    Ok(vec![
        trial.at_most(
            "error of the momentum / momentum",
            (momentum - DVec3::X).length(),
            1e-12,
        ),
        trial.at_most("error of the energy / energy", error, 0.01),
        trial.report("share that rings on as strain", end.strain / start.kinetic),
        trial.report(
            "velocity of the second, m/s",
            rock.blocks.poses()[1].velocity.x,
        ),
    ])
}

/// Centroid and rotation 0.2 s after the throw; the block is rigid if `young` is `None`.
fn thrown(young: Option<f64>) -> anyhow::Result<(DVec3, DQuat, Trial)> {
    let turn = DQuat::from_scaled_axis(DVec3::new(0.3, 0.2, 0.1));
    let mut block = Block::new("thrown", cuboid(1.0, 0.8, 0.6)?, DVec3::Z * 0.55).rotated(turn);
    (block.velocity, block.spin) = (DVec3::new(1.0, 0.3, -1.0), DVec3::new(0.5, -1.0, 2.0));
    if young.is_some() {
        block = block.deformable();
    }
    let rock = Elastic {
        youngs_modulus: young.unwrap_or(ROCK.youngs_modulus),
        ..ROCK
    };
    let mut setup = elastic(vec![floor(9.0)?, block], joint(1e8, 30.0), rock);
    (setup.corner_area, setup.largest_overlap) = (0.25, 0.3);
    // The step that the stiffest block needs, so that all runs share it.
    setup.time_step = Some(4e-6);
    let what = young.map_or("rigid".into(), |young| format!("E = {young:.0e} Pa"));
    let mut rock = Rock::new(setup, what)?;
    rock.run(0.2)?;
    let centre = rock.blocks.poses()[1].centre;
    Ok((centre, rock.blocks.rotation(1), rock.trial()))
}

/// A block thrown onto a floor approaches the motion of a rigid one as it gets stiffer: the difference at three moduli falls
/// with 1/E.
pub fn rigid_limit(_: &CaseContext) -> Outcome {
    let (centre, rotation, _) = thrown(None)?;
    let mut records = Vec::new();
    let mut before = None;
    for young in [1e9, 1e10, 1e11] {
        let (at, turned, trial) = thrown(Some(young))?;
        let off = (at - centre).length() + turned.angle_between(rotation);
        records.push(trial.report("way and angle from the rigid one, m + rad", off));
        if let Some(before) = before {
            // A tenth by theory; contacts that begin a step earlier or later add to it.
            records.push(trial.at_most("that / at a tenth of the modulus", off / before, 0.2));
        }
        before = Some(off);
    }
    Ok(records)
}
