//! A wedge on two planes (Goodman & Shi 1985): it slides along their line of intersection if its factor
//! of safety, (N₁ tan φ₁ + N₂ tan φ₂)/(W sin ψ), is below one.

use super::{
    Outcome, Stand, Trial,
    rock::{DENSITY, G, Rock, joint, setup},
};
use glam::DVec3;
use riprap::{
    geometry::{HalfSpace, Polyhedron},
    rock::{Block, Material, PairMaterial, Setup},
};
use std::sync::Arc;

const STIFFNESS: f64 = 1e9;

/// Two planes (dip, dip direction, friction angle, degrees) and the factor of safety.
const WEDGES: [([[f64; 3]; 2], f64); 2] = [
    ([[50.0, 120.0, 30.0], [50.0, 240.0, 30.0]], 1.2949),
    ([[45.0, 105.0, 20.0], [70.0, 235.0, 30.0]], 1.10662),
];

struct Wedge {
    planes: [[f64; 3]; 2],
    normals: [DVec3; 2],
    /// Down the line of intersection.
    line: DVec3,
    /// Normal forces over the weight.
    forces: [f64; 2],
}

impl Wedge {
    fn new(planes: [[f64; 3]; 2]) -> Self {
        // Upward normals; x east, y north.
        let normals = planes.map(|[dip, direction, _]| {
            let (dip, direction) = (dip.to_radians(), direction.to_radians());
            let out = dip.sin();
            DVec3::new(out * direction.sin(), out * direction.cos(), dip.cos())
        });
        let mut line = normals[0].cross(normals[1]).normalize();
        line *= -line.z.signum();
        // Across the line, N₁n₁ + N₂n₂ carries the weight.
        let up = DVec3::Z - line * line.z;
        let forces = solve(normals, normals.map(|n| up.dot(n)));
        Self {
            planes,
            normals,
            line,
            forces,
        }
    }

    fn tan_phi(&self) -> [f64; 2] {
        self.planes.map(|plane| plane[2].to_radians().tan())
    }

    fn safety(&self) -> f64 {
        let [t1, t2] = self.tan_phi();
        (self.forces[0] * t1 + self.forces[1] * t2) / -self.line.z
    }

    /// A prism along the line on two slabs, pressed in as it will be.
    fn setup(&self, tan_phi: [f64; 2]) -> anyhow::Result<Setup> {
        let face = |normal: DVec3, distance: f64| HalfSpace { normal, distance };
        let [n1, n2] = self.normals;
        let (prism, at) = Polyhedron::from_half_spaces(&[
            face(-n1, 0.0),
            face(-n2, 0.0),
            face((n1 + n2).normalize(), 1.0),
            face(self.line, 1.0),
            face(-self.line, 1.0),
        ])?;
        let weight = DENSITY * G * prism.volume();
        let pressed =
            [0, 1].map(|k| weight * self.forces[k] / (STIFFNESS * area(&prism, self.normals[k])));
        // The way d with n₁·d = −u₁, n₂·d = −u₂.
        let [a, b] = solve(self.normals, pressed);
        let sink = -(n1 * a + n2 * b);
        let mut list = Vec::new();
        for (k, n) in self.normals.into_iter().enumerate() {
            let across = self.line.cross(n);
            let sides = [self.line, -self.line, across, -across].map(|side| face(side, 6.0));
            let all: Vec<_> = sides
                .into_iter()
                .chain([face(n, 0.0), face(-n, 1.0)])
                .collect();
            let (slab, at) = Polyhedron::from_half_spaces(&all)?;
            let mut slab = Block::new(format!("slab {k}"), Arc::new(slab.into()), at).fixed();
            slab.material = k + 1;
            list.push(slab);
        }
        list.push(Block::new("wedge", Arc::new(prism.into()), at + sink));
        let joints = tan_phi.map(|t| joint(STIFFNESS, t.atan().to_degrees()));
        let mut setup = setup(list, joints[0]);
        setup.materials = vec![
            Material {
                density: DENSITY,
                joint: joints[0],
                elastic: None,
            };
            3
        ];
        let pair = |k: usize| PairMaterial {
            materials: [0, k + 1],
            joint: joints[k],
        };
        setup.pairs = vec![pair(0), pair(1)];
        Ok(setup)
    }
}

/// a, b of (a n₁ + b n₂)·n_k = c_k.
fn solve([n1, n2]: [DVec3; 2], [c1, c2]: [f64; 2]) -> [f64; 2] {
    let cos = n1.dot(n2);
    let det = 1.0 - cos * cos;
    [(c1 - cos * c2) / det, (c2 - cos * c1) / det]
}

/// Area of the face that looks against `normal`, m².
fn area(shape: &Polyhedron, normal: DVec3) -> f64 {
    let faces = shape.faces().iter().zip(shape.loops());
    let on_plane = faces.filter(|(face, _)| face.normal.dot(normal) < -1.0 + 1e-9);
    let polygon = on_plane.map(|(_, corners)| {
        let corner = |i: usize| shape.vertices()[corners[i] as usize];
        let part = |i: usize| (corner(i) - corner(0)).cross(corner(i + 1) - corner(0));
        0.5 * (1..corners.len() - 1).map(part).sum::<DVec3>().length()
    });
    polygon.sum()
}

/// Both wedges, tan φ scaled to factors of safety of 0.99 and 1.01.
pub fn run(_: &Stand) -> Outcome {
    let mut records = Vec::new();
    for (planes, expected) in WEDGES {
        let wedge = Wedge::new(planes);
        let safety = wedge.safety();
        for scaled in [0.99, 1.01] {
            let what = format!("FS scaled from {safety:.5} to {scaled}");
            let tan_phi = wedge.tan_phi().map(|t| t * scaled / safety);
            let [held, freed] = [wedge.setup([2.0; 2])?, wedge.setup(tan_phi)?];
            let mut rock = Rock::from_rest(held, 300.0, 0.1, freed, what)?;
            let start = rock.blocks.poses()[2].centre;
            rock.run(1.0)?;
            let way = (rock.blocks.poses()[2].centre - start).dot(wedge.line);
            let trial = rock.trial();
            records.push(if scaled < 1.0 {
                // ½ g sin ψ (1 − FS) t².
                let exact = 0.5 * G * -wedge.line.z * (1.0 - scaled);
                trial.relative("way after 1 s, slips, m", way, exact, 0.02)
            } else {
                trial.at_most("way after 1 s, holds, m", way.abs(), 1e-5)
            });
        }
        // What the literature prints, to its last digit; nothing runs.
        let trial = Trial {
            setup: format!("planes {:?}", wedge.planes),
            ..Trial::default()
        };
        records.push(trial.absolute("factor of safety by statics", safety, expected, 1e-4));
        let plunge = (-wedge.line.z).asin().to_degrees();
        records.push(trial.report("plunge of the line, degrees", plunge, None));
    }
    Ok(records)
}
