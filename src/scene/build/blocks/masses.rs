//! Rock masses, cut into blocks.

use super::{
    DiscardedPieces,
    rows::symmetric,
    shapes::{closed_mesh, half_spaces},
    solids::holds,
};
use crate::{
    Error, Result,
    geometry::{Compass, HalfSpace, JointSet, Persistence, Polyhedron, RockMass, Scatter},
    rock::{Block, Deformable, Motion},
    scene::{self, Advice, Distribution, Scene, Volume, Warning},
};
use glam::DVec3;

/// The blocks of the rock mass `index`, and the pieces that are too small for a block; `advice` takes warnings.
pub(super) fn blocks(
    scene: &Scene,
    index: usize,
    mass: &scene::RockMass,
    advice: &mut Advice,
) -> Result<(Vec<Block>, DiscardedPieces)> {
    let key = format!("rock_masses[{index}]");
    let name = match &mass.name {
        Some(name) => name.clone(),
        None => format!("rock_mass_{}", index + 1),
    };
    let material = scene.material(&format!("{key}.material"), mass.material.as_deref())?;
    let rock = RockMass {
        joints: (0..)
            .zip(&mass.joints)
            .map(|(n, set)| joints(mass, n, set))
            .collect(),
        compass: Compass {
            up: DVec3::from(mass.up.unwrap_or_else(|| scene.up())),
            north: DVec3::from(mass.north),
        },
        smallest_volume: mass.smallest_volume,
        smallest_thickness: mass.smallest_thickness,
        ..RockMass::new(vec![volume(scene, &key, &mass.volume, advice)?])
    };
    let fragments = rock
        .cut()
        .map_err(|error| error.at_key(|what| format!("{key}.{what}")))?;
    let mut left_out = DiscardedPieces {
        mass: name.clone(),
        pieces: fragments.slivers.len(),
        narrow: 0,
        share: fragments.slivers.iter().map(|s| s.volume).sum::<f64>() / fragments.volume,
    };
    let removed = holds(scene, &mass.removed)?;
    let fixed = holds(scene, &mass.fixed)?;
    let pieces = fragments.blocks.len();
    let kept = fragments.blocks.into_iter();
    let kept: Vec<_> = kept.filter(|fragment| !removed(fragment.centre)).collect();
    let removed = pieces - kept.len();
    let mut blocks = Vec::new();
    for (number, fragment) in kept.into_iter().enumerate() {
        let motion = if fixed(fragment.centre) {
            Motion::Fixed
        } else {
            Motion::Free
        };
        let volume = fragment.shape.volume();
        let Some((shape, offset)) = opened(fragment.shape, mass.aperture) else {
            left_out.pieces += 1;
            left_out.narrow += 1;
            left_out.share += volume / fragments.volume;
            continue;
        };
        let deforms = mass.deformable && motion == Motion::Free;
        blocks.push(Block {
            material,
            deformable: deforms.then(|| Deformable {
                initial_stress: symmetric(&mass.initial_stress),
                ..Deformable::default()
            }),
            motion,
            ..Block::new(
                format!("{name}_{}", number + 1),
                crate::geometry::Shape::from(shape),
                fragment.centre + offset,
            )
        });
    }
    if blocks.is_empty() {
        let small = left_out.pieces - left_out.narrow;
        let message = format!(
            "no block is left of {name}: {removed} of its pieces are in `removed`, {small} are smaller or thinner than \
             smallest_volume and smallest_thickness allow, {} are narrower than an aperture of {} m; change these keys",
            left_out.narrow, mass.aperture
        );
        return Err(Error::scene(key, message));
    }
    let mut warn = |part: &str, message: &str| {
        advice.push(Warning {
            place: format!("{key}.{part}"),
            message: message.into(),
        });
    };
    if !mass.fixed.is_empty() && blocks.iter().all(|block| block.motion == Motion::Free) {
        warn(
            "fixed",
            "holds the centroid of no block: all blocks are free; move its regions, or remove it",
        );
    }
    if !mass.removed.is_empty() && removed == 0 {
        warn(
            "removed",
            "holds the centroid of no block: all blocks are there; move its regions, or remove it",
        );
    }
    if pieces + left_out.pieces == 1 && !mass.joints.is_empty() {
        warn(
            "joints",
            "none of them cuts the mass, which is one block; check their origins and spacings",
        );
    }
    Ok((blocks, left_out))
}

/// The block with each face set back by half the aperture, and its centroid from that of the original block; `None`
/// if too little is left for a block.
fn opened(shape: Polyhedron, aperture: f64) -> Option<(Polyhedron, DVec3)> {
    if aperture == 0.0 {
        return Some((shape, DVec3::ZERO));
    }
    let faces: Vec<_> = shape
        .faces()
        .iter()
        .map(|face| HalfSpace {
            distance: face.distance - 0.5 * aperture,
            ..*face
        })
        .collect();
    Polyhedron::from_half_spaces(&faces).ok()
}

/// The joint set `number` of a mass.
fn joints(mass: &scene::RockMass, number: u64, set: &scene::JointSet) -> JointSet {
    let width = set.spacing * set.scatter.unwrap_or(scene::JointSet::USUAL_SCATTER);
    JointSet {
        dip: set.dip,
        dip_direction: set.dip_direction,
        spacing: set.spacing,
        scatter: match set.distribution {
            Distribution::None => Scatter::None,
            Distribution::Uniform => Scatter::Uniform { range: width },
            Distribution::Normal => Scatter::Normal { deviation: width },
            Distribution::Lognormal => Scatter::Lognormal { deviation: width },
            Distribution::Exponential => Scatter::Exponential,
        },
        origin: DVec3::from(set.origin),
        // Sets of one mass draw different numbers, and so do masses with neighbouring seeds.
        seed: mass
            .seed
            .wrapping_mul(0x9e37_79b9_7f4a_7c15)
            .wrapping_add(number),
        persistence: set.persistence.map(|persistence| Persistence {
            fraction: persistence.fraction,
            length: persistence.length,
        }),
    }
}

/// Excess of the volume of a hull over that of its mesh from which the mesh counts as not convex.
const NOT_CONVEX: f64 = 1e-3;

/// The faces of a volume, in the coordinates of the scene; `advice` takes warnings.
fn volume(
    scene: &Scene,
    key: &str,
    volume: &Volume,
    advice: &mut Advice,
) -> Result<Vec<HalfSpace>> {
    let seen = |hull: &Polyhedron, centroid: DVec3| {
        let faces = hull.faces().iter();
        faces.map(|face| face.seen_from(-centroid)).collect()
    };
    match volume {
        Volume::Box { min, max } => {
            let face = |axis: usize, sign: f64, at: f64| {
                let mut normal = DVec3::ZERO;
                normal[axis] = sign;
                HalfSpace {
                    normal,
                    distance: sign * at,
                }
            };
            let both = |axis| [face(axis, -1.0, min[axis]), face(axis, 1.0, max[axis])];
            Ok((0..3).flat_map(both).collect())
        }
        Volume::Vertices { vertices } => {
            let points: Vec<DVec3> = vertices.iter().copied().map(DVec3::from).collect();
            let (hull, centroid) = Polyhedron::from_vertices(&points)
                .map_err(|error| error.at_key(|what| format!("{key}.{what}")))?;
            Ok(seen(&hull, centroid))
        }
        Volume::HalfSpaces { faces } => Ok(half_spaces(faces)),
        Volume::Mesh {
            file,
            scale,
            translate,
        } => {
            let path = scene.dir().join(file);
            let mesh = closed_mesh(&path, *scale, DVec3::from(*translate))?;
            let (hull, centroid) = Polyhedron::from_vertices(&mesh.vertices)?;
            let more = hull.volume() / mesh.volume().abs() - 1.0;
            if more > NOT_CONVEX {
                advice.push(Warning {
                    place: format!("{key}.file"),
                    message: format!(
                        "the mesh is not convex, and the mass is its hull, which has {:.1} % more volume; give its convex parts \
                         as meshes of several masses",
                        100.0 * more
                    ),
                });
            }
            Ok(seen(&hull, centroid))
        }
    }
}
