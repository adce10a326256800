//! Blocks at the limit of friction or balance: on an incline, under a couple, and a wedge on two planes.

use super::{DENSITY, G, Rock, cuboid, floor, joint, setup, slope};
use crate::validate::{CaseContext, Outcome, Trial};
use glam::DVec3;
use riprap::{
    formula::Formula,
    geometry::{HalfSpace, Polyhedron},
    rock::{Block, PairMaterial, PointLoad, Setup},
};
use std::sync::Arc;

const ALPHA: f64 = 30.0;
const STIFFNESS: f64 = 1e8;
const HEIGHT: f64 = 0.4;

/// The block on the incline, with the penetration of its equilibrium.
fn on_incline(phi: f64) -> anyhow::Result<Setup> {
    let turn = slope(ALPHA);
    let pressed = DENSITY * HEIGHT * G * ALPHA.to_radians().cos() / STIFFNESS;
    let plate = cuboid(12.0, 3.0, 1.0)?;
    let plate = Block::new("plate", plate, turn * DVec3::new(4.0, 0.0, -0.5));
    let at = turn * DVec3::Z * (0.5 * HEIGHT - pressed);
    let block = Block::new("block", cuboid(1.0, 1.0, HEIGHT)?, at);
    let list = vec![plate.fixed().rotated(turn), block.rotated(turn)];
    Ok(setup(list, joint(STIFFNESS, phi)))
}

/// A block on an incline of 30°, s = ½gt²(sin α − cos α tan φ): it slides at φ = 20°, slips at 29.9°, holds at 30.1°.
pub fn slides(_: &CaseContext) -> Outcome {
    let mut records = Vec::new();
    for (phi, limit) in [(20.0f64, Some(1e-3)), (29.9, Some(1e-2)), (30.1, None)] {
        let what = format!("α = {ALPHA}°, φ = {phi}°, k = {STIFFNESS:.0e} Pa/m");
        // Friction holds the block until the contact carries its weight; only then is its friction angle set.
        let mut rock = Rock::from_rest(on_incline(60.0)?, 100.0, 0.4, on_incline(phi)?, what)?;
        let start = rock.blocks.poses()[1].centre;
        rock.run(1.0)?;
        let way = (rock.blocks.poses()[1].centre - start).dot(slope(ALPHA) * DVec3::X);
        let [alpha, angle] = [ALPHA, phi].map(f64::to_radians);
        let exact = 0.5 * G * (alpha.sin() - alpha.cos() * angle.tan());
        let trial = rock.trial();
        records.push(match limit {
            Some(limit) => trial.relative("way after 1 s, m", way, exact, limit),
            None => trial.at_most("way after 1 s, m", way.abs(), 1e-6),
        });
    }
    Ok(records)
}

/// At 0.3° from the threshold a strip of 20 mm carries the column of 49 kN: it must not yield by more than a tenth of that angle,
/// θ = 2W/(k s²).
const COLUMN_STIFFNESS: f64 = 4e11;

/// A column topples if tan α > b/h: one of 1 m × 1 m × 2 m, 0.3° below and above.
pub fn toppling(_: &CaseContext) -> Outcome {
    let threshold = 0.5f64.atan().to_degrees();
    let mut records = Vec::new();
    for off in [-0.3, 0.3] {
        let alpha = threshold + off;
        let turn = slope(alpha);
        let plate = Block::new("plate", cuboid(5.0, 5.0, 1.0)?, turn * DVec3::Z * -0.5);
        let column = Block::new("column", cuboid(1.0, 1.0, 2.0)?, turn * DVec3::Z);
        let list = vec![plate.fixed().rotated(turn), column.rotated(turn)];
        let setup = setup(list, joint(COLUMN_STIFFNESS, 50.0));
        let what = format!("1 x 1 x 2 m at {alpha:.3}°, k = {COLUMN_STIFFNESS:.0e} Pa/m");
        let mut rock = Rock::from_rest(setup.clone(), 20.0, 0.3, setup, what)?;
        rock.run(1.0)?;
        let tilt = rock.blocks.rotation(1).angle_between(turn);
        let trial = rock.trial();
        // It falls by ½ · 0.034 rad/s² · t² and more; if it stands, it stands at 1 mrad.
        records.push(if off < 0.0 {
            trial.at_most("tilt after 1 s, stands, rad", tilt, 3e-3)
        } else {
            trial.at_least("tilt after 1 s, topples, rad", tilt, 1e-2)
        });
    }
    Ok(records)
}

/// A slab and a plank on a floor, 3 % below and above the limit of a couple about the vertical and of a force across one end:
/// limit analysis with uniform pressure.
pub fn twist(_: &CaseContext) -> Outcome {
    let mut records = Vec::new();
    for (length, breadth) in [(1.0, 1.0), (2.0, 0.2)] {
        let weight = DENSITY * length * breadth * HEIGHT * G;
        let friction = weight * ALPHA.to_radians().tan();
        let [_, couple] = resistance(length, breadth, 0.0);
        let loads: [(&str, f64, &[f64]); 2] = [
            ("couple", couple / length, &[1.0, -1.0]),
            ("force at one end", push_at_end(length, breadth), &[1.0]),
        ];
        for (name, limit, ends) in loads {
            for share in [0.97, 1.03] {
                let force = share * limit * friction;
                let load = |end: &f64| {
                    // It grows for half a second, so that the block does not slide before it rests.
                    let force = ["0", &format!("{} * min(1, 2*t)", end * force), "0"];
                    let [x, y, z] = force.map(str::parse::<Formula>);
                    let point = DVec3::new(0.5 * end * length, 0.0, -0.5 * HEIGHT);
                    let force = [x?, y?, z?];
                    anyhow::Ok(PointLoad { point, force })
                };
                let shape = cuboid(length, breadth, HEIGHT)?;
                let mut block = Block::new("block", shape, DVec3::Z * 0.5 * HEIGHT);
                block.point_loads = ends.iter().map(load).collect::<Result<_, _>>()?;
                let setup = setup(vec![floor(5.0)?, block], joint(1e9, ALPHA));
                let what = format!("{length} x {breadth} m, {name}, {share} of the limit");
                let mut rock = Rock::new(setup, what)?;
                rock.run(1.5)?;
                let angle = rock.blocks.rotation(1).to_axis_angle().1;
                let trial = rock.trial();
                records.push(if share < 1.0 {
                    trial.at_most("angle after 1.5 s, holds, rad", angle, 1e-3)
                } else {
                    trial.at_least("angle after 1.5 s, turns, rad", angle, 1e-2)
                });
            }
        }
    }
    Ok(records)
}

/// Friction of a rectangular face (m) under uniform pressure over its limit when it slides, and its moment about the middle over
/// that limit, m: the face turns about a point on its axis `distance` (m) from the middle. By the midpoint rule.
fn resistance(length: f64, breadth: f64, distance: f64) -> [f64; 2] {
    let middles = || (0..200).map(|i| (f64::from(i) + 0.5) / 200.0 - 0.5);
    let mut sums = [0.0; 2];
    for (x, y) in middles().flat_map(|x| middles().map(move |y| (x * length, y * breadth))) {
        let arm = x + distance;
        sums[0] += arm / arm.hypot(y);
        sums[1] += (x * arm + y * y) / arm.hypot(y);
    }
    sums.map(|sum| sum / 4e4)
}

/// The largest force across the end of a face (m) that friction holds, over the limit of sliding.
fn push_at_end(length: f64, breadth: f64) -> f64 {
    let [mut low, mut high] = [0.0, length];
    for _ in 0..60 {
        let middle = 0.5 * (low + high);
        let [force, moment] = resistance(length, breadth, middle);
        *(if moment > 0.5 * length * force {
            &mut low
        } else {
            &mut high
        }) = middle;
    }
    resistance(length, breadth, low)[0]
}

/// Pa/m. The springs release energy when friction drops to its value: the error of the distance falls as 1/√k.
const WEDGE_STIFFNESS: f64 = 1e10;

/// Two planes (dip, dip direction, friction angle, degrees) and the factor of safety.
const WEDGES: [([[f64; 3]; 2], f64); 2] = [
    ([[50.0, 120.0, 30.0], [50.0, 240.0, 30.0]], 1.2949),
    ([[45.0, 105.0, 20.0], [70.0, 235.0, 30.0]], 1.10662),
];

/// A wedge on two planes (Goodman & Shi 1985): it slides along their line of intersection if its factor
/// of safety, (N₁ tan φ₁ + N₂ tan φ₂)/(W sin ψ), is below one.
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

    /// A prism along the line on two slabs, with the penetration of its equilibrium.
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
        let pressed = [0, 1]
            .map(|k| weight * self.forces[k] / (WEDGE_STIFFNESS * area(&prism, self.normals[k])));
        // The displacement d with n₁·d = −u₁, n₂·d = −u₂.
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
        let joints = tan_phi.map(|t| joint(WEDGE_STIFFNESS, t.atan().to_degrees()));
        let mut setup = setup(list, joints[0]);
        setup.materials = vec![setup.materials[0]; 3];
        let pair = |k: usize| PairMaterial {
            materials: [0, k + 1],
            joint: joints[k],
        };
        setup.pairs = vec![pair(0), pair(1)];
        Ok(setup)
    }
}

/// Solves (a n₁ + b n₂)·n_k = c_k for a, b.
fn solve([n1, n2]: [DVec3; 2], [c1, c2]: [f64; 2]) -> [f64; 2] {
    let cos = n1.dot(n2);
    let det = 1.0 - cos * cos;
    [(c1 - cos * c2) / det, (c2 - cos * c1) / det]
}

/// Area of the face whose normal is opposite to `normal`, m².
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
pub fn wedge(_: &CaseContext) -> Outcome {
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
        // The value in the literature, to its last digit; nothing is run.
        let trial = Trial {
            setup: format!("planes {:?}", wedge.planes),
            ..Trial::default()
        };
        records.push(trial.absolute("factor of safety by statics", safety, expected, 1e-4));
        let plunge = (-wedge.line.z).asin().to_degrees();
        records.push(trial.report("plunge of the line, degrees", plunge));
    }
    Ok(records)
}
