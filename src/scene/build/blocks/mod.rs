//! Conversion of a scene to its blocks.

mod masses;
mod materials;
mod rows;
mod shapes;
mod solids;

pub(crate) use shapes::{rotation, shape};

use crate::{
    Error, Result,
    formula::Formula,
    geometry::Form,
    rock::{Block, FixedPoint, Guide, Motion, Period, Setup, Sleep},
    scene::{Advice, Boundary, Face, NOT_IN_PLANE, ProbePlace, Scene},
};
use glam::{DVec2, DVec3, Vec3Swizzles};
use std::collections::HashSet;

/// The blocks of a scene, ready to be run.
#[derive(Clone, Debug)]
pub struct BlockSetup {
    /// The blocks.
    pub setup: Setup,
    /// The rock masses from which pieces are left out.
    pub left_out: Vec<DiscardedPieces>,
    /// Warnings about keys of rock masses that have no effect.
    pub advice: Advice,
    /// Number of blocks that a fluid flows around; they come first. After them come the solids and walls, which the
    /// cells of a lattice represent already.
    pub in_fluid: usize,
}

/// Pieces of a rock mass that are smaller or thinner than the scene allows for blocks.
#[derive(Clone, Debug, PartialEq)]
pub struct DiscardedPieces {
    /// Name of the rock mass.
    pub mass: String,
    /// Number of pieces.
    pub pieces: usize,
    /// How many of them are narrower than the aperture of the joints.
    pub narrow: usize,
    /// Their volume, as a fraction of that of the mass.
    pub share: f64,
}

/// The blocks of a scene: those of `blocks` in their order, then those of `rock_masses`, then the
/// `solids`, which are fixed, and with a fluid the faces of the domain through which nothing flows.
///
/// # Errors
/// [`Error::Scene`] naming the table and key from which no block can be made; [`Error::File`] for a
/// mesh.
pub fn block_setup(scene: &Scene) -> Result<BlockSetup> {
    let rock = &scene.rock;
    let mut setup = Setup {
        materials: materials::materials(scene),
        pairs: materials::pairs(scene)?,
        gravity: DVec3::from(rock.gravity),
        damping: rock.mass_damping,
        time_step: rock.time_step,
        skin: rock.skin,
        largest_overlap: rock.largest_overlap,
        corner_area: rock.corner_area,
        sleep: rock.sleep.map(|sleep| Sleep {
            speed: sleep.speed,
            after: sleep.time,
            ..Sleep::default()
        }),
        ..Setup::default()
    };
    setup.period = period(scene);
    let (mut left_out, mut advice) = (Vec::new(), Advice::new());
    for (index, block) in scene.blocks.iter().enumerate() {
        let first = setup.blocks.len();
        setup.blocks.extend(rows::blocks(scene, index, block)?);
        let all = first..setup.blocks.len();
        let axis = block.guide.map(DVec3::from);
        setup.guides.extend(
            axis.into_iter()
                .flat_map(|axis| all.clone().map(move |block| Guide { block, axis })),
        );
    }
    for (index, mass) in scene.rock_masses.iter().enumerate() {
        let (blocks, lost) = masses::blocks(scene, index, mass, &mut advice)?;
        setup.blocks.extend(blocks);
        if lost.pieces > 0 {
            left_out.push(lost);
        }
    }
    let in_fluid = setup.blocks.len();
    for (index, solid) in scene.solids.iter().enumerate() {
        setup.blocks.push(solids::block(scene, index, solid)?);
    }
    if scene.has_fluid() {
        setup.blocks.extend(solids::walls(scene)?);
    }
    check_names(scene, &setup)?;
    check_faces(scene, &setup.blocks, in_fluid)?;
    check_safety(scene, &setup)?;
    check_domain(scene, &setup)?;
    if scene.is_plane() {
        check_plane(&setup)?;
        keep_plane(&mut setup);
    }
    Ok(BlockSetup {
        setup,
        left_out,
        advice,
        in_fluid,
    })
}

/// The periodic box, infinite along the axes whose faces are not periodic. In a plane flow nothing varies along y, and blocks
/// fill the width.
fn period(scene: &Scene) -> Option<Period> {
    let faces = [Face::XMin, Face::YMin, Face::ZMin];
    let size = std::array::from_fn(|axis| {
        let repeats = *scene.boundaries.face(faces[axis]) == Boundary::Periodic;
        match repeats && !(scene.is_plane() && axis == 1) {
            true => scene.domain.size[axis],
            false => f64::INFINITY,
        }
    });
    let size = DVec3::from_array(size);
    (scene.has_fluid() && size.min_element().is_finite()).then(|| Period {
        origin: DVec3::from(scene.domain.origin),
        size,
    })
}

/// Checks that nothing moves a block out of the plane of a plane flow or turns it about another axis than y.
fn check_plane(setup: &Setup) -> Result<()> {
    let refuse = |block: &Block, what: &str| {
        Err(Error::scene(
            format!("block {}", block.name),
            format!(
                "{what}, and in a plane scene (particles.plane) blocks move along x and z and turn about y; correct it, or \
                 remove plane"
            ),
        ))
    };
    if setup.gravity.y != 0.0 {
        return Err(Error::scene("rock.gravity", NOT_IN_PLANE));
    }
    let is_zero = |formula: &Formula| formula.constant() == Some(0.0);
    for block in &setup.blocks {
        let stress = block
            .deformable
            .as_ref()
            .map(|own| own.initial_stress.y_axis);
        if stress.is_some_and(|stress| stress.xz() != DVec2::ZERO) {
            return refuse(block, "its initial stress has components xy or yz");
        }
        let (velocity, spin) = match &block.motion {
            Motion::Driven { velocity, spin } => (
                is_zero(&velocity[1]),
                is_zero(&spin[0]) && is_zero(&spin[2]),
            ),
            _ => (block.velocity.y == 0.0, block.spin.xz() == DVec2::ZERO),
        };
        if !velocity {
            return refuse(block, "its velocity has a component along y");
        }
        if !spin {
            return refuse(block, "its spin has components along x or z");
        }
        if let Some([_, y, _]) = &block.acceleration
            && !is_zero(y)
        {
            return refuse(block, "its acceleration has a component along y");
        }
        for load in &block.point_loads {
            let lever = (block.rotation * load.point).y;
            if !is_zero(&load.force[1]) || lever.abs() > 1e-6 * block.shape.radius() {
                return refuse(
                    block,
                    "a point load acts along y, or in front of its centroid or behind it",
                );
            }
        }
    }
    for guide in &setup.guides {
        if guide.axis.y != 0.0 {
            return refuse(
                &setup.blocks[guide.block],
                "its guide has a component along y",
            );
        }
    }
    Ok(())
}

/// Plane strain: nothing moves along y in the deformable blocks of a plane scene.
fn keep_plane(setup: &mut Setup) {
    for block in &mut setup.blocks {
        let radius = block.shape.radius();
        if let Some(deformable) = &mut block.deformable {
            let points = [DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::Z].map(|point| FixedPoint {
                point: radius * point,
                axes: [false, true, false],
            });
            deformable.fixed_points.extend(points);
        }
    }
}

/// Similarity (Jaro–Winkler) from which one name counts as a misspelling of the other.
const ALIKE: f64 = 0.75;

/// Checks that names are distinct, and that the blocks that probes name exist.
fn check_names(scene: &Scene, setup: &Setup) -> Result<()> {
    let mut names = HashSet::with_capacity(setup.blocks.len());
    for block in &setup.blocks {
        if !names.insert(block.name.as_str()) {
            return Err(Error::scene(
                "blocks",
                format!(
                    "two blocks are called `{}`; give their tables other names",
                    block.name
                ),
            ));
        }
    }
    for (index, probe) in scene.probes.iter().enumerate() {
        if let ProbePlace::Block { block, .. } = &probe.place
            && !names.contains(block.as_str())
        {
            let alike = |name: &&str| strsim::jaro_winkler(name, block);
            let all = setup.blocks.iter().map(|block| block.name.as_str());
            let best = all.max_by(|a, b| alike(a).total_cmp(&alike(b)));
            let remedy = match best.filter(|best| alike(best) >= ALIKE) {
                Some(best) => format!("did you mean `{best}`?"),
                None => {
                    let some = setup.blocks.iter().take(20);
                    let names: Vec<_> = some.map(|block| format!("`{}`", block.name)).collect();
                    format!("there are {}", names.join(", "))
                }
            };
            return Err(Error::scene(
                format!("probes[{index}].block"),
                format!("there is no block `{block}`; {remedy}"),
            ));
        }
    }
    Ok(())
}

/// Checks that blocks start in the domain, if there is one; fixed blocks need only reach into it.
fn check_domain(scene: &Scene, setup: &Setup) -> Result<()> {
    let domain = &scene.domain;
    if !domain.is_given() {
        return Ok(());
    }
    let (low, high) = (DVec3::from(domain.origin), DVec3::from(domain.end()));
    for block in &setup.blocks {
        let fixed = block.motion == Motion::Fixed;
        let margin = DVec3::splat(if fixed { block.shape.radius() } else { 0.0 });
        let out = block.centre.cmplt(low - margin) | block.centre.cmpgt(high + margin);
        if out.any() {
            return Err(Error::scene(
                format!("block {}", block.name),
                format!(
                    "its centroid {} lies outside the domain, which reaches from {low} to {high} m; \
                     move it, or enlarge the domain",
                    block.centre
                ),
            ));
        }
    }
    Ok(())
}

/// Checks that probes with `faces` are of blocks with plane faces in the fluid, the first `in_fluid` of `blocks`.
fn check_faces(scene: &Scene, blocks: &[Block], in_fluid: usize) -> Result<()> {
    for (index, probe) in scene.probes.iter().enumerate() {
        if let ProbePlace::Block {
            block, faces: true, ..
        } = &probe.place
            && let Some(found) = blocks.iter().position(|other| other.name == *block)
        {
            let mut parts = blocks[found].shape.parts().iter();
            let message = if found >= in_fluid {
                "is a solid, whose cells the fluid does not enter; use a probe of the kind `face`, or make it a block with \
                 motion = \"fixed\""
            } else if parts.all(|part| matches!(part.form, Form::Sphere { .. })) {
                "is a sphere, which has no plane faces; remove `faces`"
            } else {
                continue;
            };
            return Err(Error::scene(
                format!("probes[{index}].faces"),
                format!("`{block}` {message}"),
            ));
        }
    }
    Ok(())
}

/// Checks that probes with `safety` are of blocks without a guide.
fn check_safety(scene: &Scene, setup: &Setup) -> Result<()> {
    let guided = |name: &str| {
        let mut guides = setup.guides.iter();
        guides.any(|guide| setup.blocks[guide.block].name == name)
    };
    for (index, probe) in scene.probes.iter().enumerate() {
        if let ProbePlace::Block {
            block,
            safety: true,
            ..
        } = &probe.place
            && guided(block)
        {
            return Err(Error::scene(
                format!("probes[{index}].safety"),
                format!(
                    "`{block}` slides along a guide, which holds it in addition to its contacts, and factors of safety consider \
                     only contacts; remove `safety`, or the guide of the block"
                ),
            ));
        }
    }
    Ok(())
}
