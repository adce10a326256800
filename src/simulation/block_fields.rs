//! Fields of blocks, contacts and faces for ParaView.

use crate::{
    coupling::{Coupled, FluidLoad},
    geometry::{Form, Pose, corners},
    output::{Array, Cloud, Polyhedra, Surface},
    psm::FaceLoad,
    rock::{Block, Blocks, ContactPoint, Motion},
};
use glam::{DMat3, DVec3};
use std::f64::consts::{PI, TAU};

/// Number of facets of a sphere around its axis; half as many from pole to pole.
const AROUND: u32 = 24;

/// The parts of the blocks `shown`, which are the first of all `blocks`, at their current positions, with fields of
/// their blocks: number, velocity (m/s) and speed (m/s), spin (rad/s), net contact force (N), whether the block is
/// fixed or asleep, and the number of its material.
///
/// If any block deforms, also the Cauchy stress along the axes of the world (Pa; xx, yy, zz, xy, yz, xz,
/// tension positive), von Mises stress (Pa) and strain energy (J); NaN for rigid blocks.
///
/// In a fluid, with one [`FluidLoad`] for each of the first blocks, also the force of the flow and the buoyancy (N);
/// NaN for fixed blocks without a probe, and for solids.
pub fn block_polyhedra(shown: &[Block], blocks: &Blocks, loads: &[FluidLoad]) -> Polyhedra {
    let mut made = Polyhedra::default();
    let mut owners = Vec::new();
    let poses = blocks.poses();
    for (number, (block, pose)) in shown.iter().zip(&poses).enumerate() {
        for part in block.shape.parts() {
            let first = made.points.len() as u32;
            let (points, faces) = surface(&part.form);
            let placed = points.into_iter().map(|x| pose.point(part.offset + x));
            made.points.extend(placed.map(|x| x.to_array()));
            let numbered = faces
                .into_iter()
                .map(|face| face.into_iter().map(|corner| first + corner).collect());
            made.cells.push(numbered.collect());
            owners.push(number);
        }
    }
    let spins: Vec<DVec3> = blocks.spins().collect();
    let forces: Vec<DVec3> = blocks.contact_forces().collect();
    let asleep: Vec<bool> = blocks.asleep().collect();
    let scalar = |name: &str, value: &dyn Fn(usize) -> f64| {
        Array::scalars(name, owners.iter().map(|&owner| value(owner)))
    };
    let vector = |name: &str, value: &dyn Fn(usize) -> DVec3| {
        Array::vectors(name, owners.iter().map(|&owner| value(owner)))
    };
    let flag = |set: bool| f64::from(u8::from(set));
    made.arrays = vec![
        scalar("id", &|owner| owner as f64),
        vector("velocity", &|owner| poses[owner].velocity),
        scalar("speed", &|owner| poses[owner].velocity.length()),
        vector("spin", &|owner| spins[owner]),
        vector("contact_force", &|owner| forces[owner]),
        scalar("fixed", &|owner| flag(shown[owner].motion == Motion::Fixed)),
        scalar("asleep", &|owner| flag(asleep[owner])),
        scalar("material", &|owner| shown[owner].material as f64),
    ];
    if blocks.any_deforms() {
        let stress = |owner: &usize| {
            let stress = blocks.stress(*owner).map(voigt);
            stress.unwrap_or([f64::NAN; 6])
        };
        made.arrays.extend([
            Array {
                components: 6,
                ..Array::scalars("stress", owners.iter().flat_map(stress))
            },
            scalar("von_mises", &|owner| {
                blocks.von_mises(owner).unwrap_or(f64::NAN)
            }),
            scalar("strain_energy", &|owner| {
                blocks.strain_energy(owner).unwrap_or(f64::NAN)
            }),
        ]);
    }
    if !loads.is_empty() {
        let known = |owner: usize| {
            let known = |load: &&FluidLoad| {
                shown[owner].motion != Motion::Fixed || load.flow.entrained > 0.0
            };
            loads.get(owner).filter(known)
        };
        let force = |owner, of: fn(&FluidLoad) -> DVec3| known(owner).map_or(DVec3::NAN, of);
        made.arrays.extend([
            vector("fluid_force", &|owner| force(owner, |load| load.flow.force)),
            vector("buoyancy", &|owner| {
                force(owner, |load| load.buoyancy.force)
            }),
        ]);
    }
    made
}

/// The entries xx, yy, zz, xy, yz, xz of a symmetric matrix, in the order of VTK.
pub fn voigt(m: DMat3) -> [f64; 6] {
    [
        m.x_axis.x, m.y_axis.y, m.z_axis.z, m.y_axis.x, m.z_axis.y, m.z_axis.x,
    ]
}

/// The contacts of blocks: the points where forces act, with the force on the second block (N) and its
/// magnitude (N), the normal from the first to the second, the overlap (m), the area (m²), and the
/// numbers of both blocks.
pub fn contact_cloud(blocks: &Blocks) -> Cloud {
    let contacts: Vec<ContactPoint> = blocks.contacts().collect();
    let vector = |name: &str, value: fn(&ContactPoint) -> DVec3| {
        Array::vectors(name, contacts.iter().map(value))
    };
    let scalar = |name: &str, value: fn(&ContactPoint) -> f64| {
        Array::scalars(name, contacts.iter().map(value))
    };
    Cloud {
        points: contacts.iter().map(|c| c.point.to_array()).collect(),
        arrays: vec![
            vector("force", |c| c.force),
            scalar("force_magnitude", |c| c.force.length()),
            vector("normal", |c| c.normal),
            scalar("overlap", |c| c.overlap),
            scalar("area", |c| c.area),
            scalar("first", |c| c.blocks[0] as f64),
            scalar("second", |c| c.blocks[1] as f64),
        ],
    }
}

/// Corners relative to the centroid, m, and faces of a form.
fn surface(form: &Form) -> (Vec<DVec3>, Vec<Vec<u32>>) {
    match form {
        Form::Convex(shape) => (shape.vertices().to_vec(), shape.loops().to_vec()),
        Form::Sphere { radius } => globe(*radius),
    }
}

/// A sphere with facets between meridians and parallels.
fn globe(radius: f64) -> (Vec<DVec3>, Vec<Vec<u32>>) {
    let rings = AROUND / 2;
    let mut points = vec![DVec3::Z * radius];
    for ring in 1..rings {
        let polar = PI * f64::from(ring) / f64::from(rings);
        points.extend((0..AROUND).map(|k| {
            let azimuth = TAU * f64::from(k) / f64::from(AROUND);
            let (sine, cosine) = polar.sin_cos();
            DVec3::new(sine * azimuth.cos(), sine * azimuth.sin(), cosine) * radius
        }));
    }
    let south = points.len() as u32;
    points.push(-DVec3::Z * radius);
    let on = |ring: u32, k: u32| 1 + (ring - 1) * AROUND + k % AROUND;
    let mut faces = Vec::new();
    for k in 0..AROUND {
        faces.push(vec![0, on(1, k), on(1, k + 1)]);
        for ring in 1..rings - 1 {
            faces.push(vec![
                on(ring, k),
                on(ring + 1, k),
                on(ring + 1, k + 1),
                on(ring, k + 1),
            ]);
        }
        faces.push(vec![south, on(rings - 1, k + 1), on(rings - 1, k)]);
    }
    (points, faces)
}

/// The faces of the blocks for which a probe requests face loads, with the number of their block, pressure and shear
/// stress (Pa), and the wetted fraction of their area; NaN for faces without adjacent fluid.
pub fn face_surface(coupled: &Coupled<'_>) -> Surface {
    let mut made = Surface::default();
    let mut shown: Vec<(usize, &FaceLoad)> = Vec::new();
    let poses = coupled.blocks().poses();
    let blocks = &coupled.setup().setup.blocks;
    for (number, (block, pose)) in blocks.iter().zip(&poses).enumerate() {
        for load in coupled.face_loads(number) {
            made.polygons.push(polygon(block, load, pose));
            shown.push((number, load));
        }
    }
    let scalar = |name: &str, value: &dyn Fn(&(usize, &FaceLoad)) -> f64| {
        Array::scalars(name, shown.iter().map(value))
    };
    made.arrays = vec![
        scalar("block", &|(block, _)| *block as f64),
        scalar("pressure", &|(_, load)| load.pressure()),
        scalar("wetted", &|(_, load)| load.wetted / load.face.area),
        Array::vectors("shear", shown.iter().map(|(_, load)| load.shear())),
    ];
    made
}

fn polygon(block: &Block, load: &FaceLoad, pose: &Pose) -> Vec<[f64; 3]> {
    let part = &block.shape.parts()[load.face.part];
    let Form::Convex(shape) = &part.form else {
        return Vec::new();
    };
    let corners = corners(shape, load.face.face, part.offset, pose);
    corners.iter().map(|x| x.to_array()).collect()
}
