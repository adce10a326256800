//! Conversion of a scene in SI to a fluid in lattice units, and these units.

use crate::{
    Error, Result,
    lattice::{
        Collision, Equilibrium, Face, Force, MAX_ROUGHNESS, Setup, SolidOperator, SolidWeight,
        Storage, SurfaceCell, SyntheticTurbulence, WallModel,
    },
    psm::{oblique_shift, sphere_growth},
    scene::{self, BodyForce, Boundary, Numerics, Scene, SolidFractions, solid_fractions::Growth},
    units::{SOUND_SPEED_SQUARED, Units},
};

impl Units {
    /// The units of `scene`: its `time_step`, or Δt = Ma Δx/(√3 U) from its Mach number and
    /// velocity scale.
    ///
    /// # Errors
    /// If the scene gives neither a time step nor any velocity from which one follows.
    pub fn of(scene: &Scene) -> Result<Self> {
        if scene.has_particles() {
            return Err(Error::scene(
                "particles",
                "a fluid of particles has no lattice; run it as one of particles",
            ));
        }
        let cell = scene.domain.cell;
        let time_step = match scene.numerics.time_step {
            Some(time_step) => time_step,
            None => {
                let mach = scene.numerics.mach.unwrap_or(Numerics::DEFAULT_MACH);
                mach * cell * SOUND_SPEED_SQUARED.sqrt() / scene.velocity_scale()?
            }
        };
        Ok(Self {
            cell,
            time_step,
            density: scene.fluid.density,
        })
    }
}

/// The lattice fluid of a scene. With `cpu`, the features of an adapter, the kernels are made for a CPU, where several cells
/// per invocation and wide words are faster; without it they are made for GPUs.
///
/// # Errors
/// If a formula is not finite somewhere, or a mesh cannot be read.
pub fn lattice_setup(scene: &Scene, units: &Units, cpu: Option<wgpu::Features>) -> Result<Setup> {
    let software = cpu.is_some();
    let cells = scene.cells();
    let numerics = &scene.numerics;
    let storage = match numerics.storage {
        scene::Storage::F32 => Storage::F32,
        scene::Storage::F16 => Storage::F16,
    };
    let mut setup = Setup::periodic(cells, units.viscosity_to_lattice(scene.fluid.viscosity));
    setup.storage = storage;
    setup.collision = match numerics.collision {
        scene::Collision::Hermite => Collision::Hermite,
        scene::Collision::Suga => Collision::Suga,
        scene::Collision::Bgk => Collision::Bgk,
    };
    setup.equilibrium = match numerics.equilibrium {
        scene::Equilibrium::Product => Equilibrium::Product,
        scene::Equilibrium::SecondOrder => Equilibrium::SecondOrder,
    };
    // The published operator keeps its published rates next to walls too.
    setup.wall_lambda = (setup.collision == Collision::Hermite).then_some(numerics.wall_lambda);
    setup.lambda = numerics.lambda;
    setup.odd_rate_floor = numerics.odd_rate_floor;
    if scene.has_blocks() {
        setup.solid_operator = Some(match numerics.solid_operator {
            scene::SolidOperator::Holdych => SolidOperator::Holdych,
            scene::SolidOperator::Noble => SolidOperator::Noble,
            scene::SolidOperator::Superposition => SolidOperator::Superposition,
        });
        setup.solid_weight = numerics.solid_weight.map(|weight| match weight {
            scene::SolidWeight::Exact => SolidWeight::Exact,
            scene::SolidWeight::Standard => SolidWeight::Standard,
        });
    }
    // The published operator keeps its rates next to blocks too.
    setup.solid_lambda = (setup.collision == Collision::Hermite).then_some(numerics.solid_lambda);
    if let Some(aperture) = scene.coupling.joint_aperture {
        setup.joint_aperture = Some(aperture_to_lattice(aperture, &setup, units)?);
    }
    setup.wale =
        (numerics.eddy_viscosity == scene::EddyViscosity::Wale).then_some(numerics.wale_constant);
    setup.wale_interval = numerics.wale_interval;
    setup.wall_model = match numerics.wall_model {
        scene::WallModel::None => None,
        scene::WallModel::WernerWengle => Some(WallModel::WernerWengle),
        scene::WallModel::Reichardt => Some(WallModel::Reichardt),
    };
    setup.sloping_faces = numerics.has_sloping_faces();
    let force = |a: f64| units.acceleration_to_lattice(a);
    setup.force = match scene.force_field()? {
        // Flow control changes it during the run.
        BodyForce::None if scene.fluid.kept_velocity().is_some() => Force::Constant([0.0; 3]),
        BodyForce::None => Force::None,
        BodyForce::Uniform(a) => Force::Constant(a.map(force)),
        BodyForce::Field([x, y, z]) => {
            let each = x.iter().zip(&y).zip(&z);
            let lattice = |a: &f32| force(f64::from(*a)) as f32;
            Force::Field(each.map(|((x, y), z)| [x, y, z].map(lattice)).collect())
        }
    };
    for (number, (face, boundary)) in (0..).zip(scene.boundaries.iter()) {
        let side = usize::from(face.is_max());
        if let Boundary::Velocity {
            turbulence: Some(turbulence),
            ..
        } = boundary
        {
            setup.turbulence[face.axis().index()][side] = Some(SyntheticTurbulence {
                intensity: turbulence.intensity,
                length: turbulence.length / units.cell,
                // Each face has eddies of its own.
                seed: turbulence.seed.wrapping_mul(6).wrapping_add(number),
            });
        }
        setup.faces[face.axis().index()][side] = match boundary {
            Boundary::Periodic => Face::Periodic,
            Boundary::Wall {
                velocity,
                roughness,
            } => {
                let key = || format!("boundaries.{}", face.name());
                setup.wall_roughness[face.axis().index()][side] =
                    roughness_to_lattice(*roughness, units, key)?;
                Face::Wall(velocity.map(|v| units.velocity_to_lattice(v)))
            }
            Boundary::FreeSlip => Face::FreeSlip,
            Boundary::Velocity { .. } => Face::Velocity(face_velocity(scene, units, face, 0.0)?),
            Boundary::Pressure { reflecting, .. } => {
                let density = face_density(scene, units, face, 0.0)?;
                if *reflecting {
                    Face::Pressure { density }
                } else {
                    Face::Outflow { density }
                }
            }
            Boundary::Open => {
                return Err(Error::scene(
                    format!("boundaries.{}", face.name()),
                    "only particles leave through an open face; use kind = \"pressure\"",
                ));
            }
        };
    }
    let (_, gradient) = scene.hydrostatic();
    let density =
        |pascal_a_metre: f64| units.pressure_to_lattice(pascal_a_metre * units.cell) - 1.0;
    setup.open_face_gradient = gradient.map(density);
    match cpu {
        Some(features) => setup.use_cpu_layout(features),
        None => setup.use_gpu_layout(),
    }
    if !scene.solids.is_empty() {
        // The weight for blocks, or the default weight of the operator.
        let weight = setup.solid_weight.unwrap_or(match setup.solid_operator {
            None | Some(SolidOperator::Holdych) => SolidWeight::Exact,
            Some(_) => SolidWeight::Standard,
        });
        let growth = Growth {
            sphere: sphere_growth(weight, setup.tau()),
            oblique: oblique_shift(weight),
        };
        let SolidFractions { mask, partial } = scene.effective_solid_fractions(growth)?;
        scene.check_openings(&mask)?;
        let cells = partial.into_iter();
        setup.surface = cells
            .map(|(cell, fraction)| SurfaceCell { cell, fraction })
            .collect();
        if mask.solid_count() > 0 {
            setup.solid = mask.as_slice().iter().map(|&s| s != 0).collect();
            for (index, solid) in scene.solids.iter().enumerate() {
                roughness_to_lattice(solid.roughness, units, || format!("solids[{index}]"))?;
            }
            let roughness = scene.solid_roughness()?.into_iter();
            setup.solid_roughness = roughness.map(|k| (k / units.cell) as f32).collect();
        }
    }
    let fewest = if storage == Storage::F32 { 1 } else { 2 };
    let preferred = match numerics.lanes {
        Some(requested) => [requested; 2],
        None => [if software { 4 } else { fewest }, fewest],
    };
    if !preferred.iter().any(|&lanes| setup.spread_lanes(lanes)) {
        if numerics.lanes.is_none() {
            let [_, ny, nz] = setup.cells;
            return Err(Error::scene(
                "numerics.storage",
                format!(
                    "packs pairs of cells along y or z into words, and the domain is periodic along both with {ny} and {nz} cells; use an \
                     even number along one of them, or storage = \"f32\""
                ),
            ));
        }
        // An impossible number is refused later, with the reason.
        setup.lanes = preferred[1];
    }
    Ok(setup)
}

/// Aperture of closed joints, m → cells; refused if joints with this cell and viscosity cannot have it.
fn aperture_to_lattice(aperture: f64, setup: &Setup, units: &Units) -> Result<f64> {
    let range = setup.joint_aperture_range().map(|cells| cells * units.cell);
    // Tolerates the rounding of the range in the message.
    if (range[0] * (1.0 - 1e-4)..=range[1] * (1.0 + 1e-4)).contains(&aperture) {
        let [least, largest] = range;
        return Ok(aperture.clamp(least, largest) / units.cell);
    }
    let [least, largest] = range;
    Err(Error::scene(
        "coupling.joint_aperture",
        format!(
            "is {aperture} m; closed joints conduct as slots of {least:.4e} to {largest:.4e} m with this cell, time step and viscosity: leave \
             the key out for the widest, or give blocks an opening of a cell or more"
        ),
    ))
}

/// Roughness of a wall, m → cells; refused if the law of a rough wall does not hold.
fn roughness_to_lattice(roughness: f64, units: &Units, key: impl Fn() -> String) -> Result<f64> {
    let cells = roughness / units.cell;
    if cells <= MAX_ROUGHNESS {
        return Ok(cells);
    }
    Err(Error::scene(
        format!("{}.roughness", key()),
        format!(
            "is {roughness} m; the log law of rough walls holds up to {MAX_ROUGHNESS} cells, {:.3e} m here: larger roughness is \
             a shape that the grid resolves",
            MAX_ROUGHNESS * units.cell
        ),
    ))
}

/// Density prescribed on a face at the time `t` (s), lattice units; 1 if the face prescribes none.
///
/// # Errors
/// If a formula is not finite at this time.
pub fn face_density(scene: &Scene, units: &Units, face: scene::Face, t: f64) -> Result<f64> {
    let pressure = scene.face_pressure(face, t)?;
    Ok(units.pressure_to_lattice(pressure.unwrap_or(0.0)))
}

/// Velocity of a face at the time `t` (s), lattice units.
///
/// # Errors
/// If a formula is not finite somewhere.
pub fn face_velocity(
    scene: &Scene,
    units: &Units,
    face: scene::Face,
    t: f64,
) -> Result<Vec<[f32; 3]>> {
    let velocity = scene.face_velocity(face, t)?;
    let lattice = |v: f64| units.velocity_to_lattice(v) as f32;
    Ok(velocity.into_iter().map(|u| u.map(lattice)).collect())
}
