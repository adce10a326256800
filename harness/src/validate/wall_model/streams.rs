//! Streams through a duct, between plates and along rods: scenes with solids and blocks.

use super::{BULK, CHANNELS, SAMPLES, mean_and_stress};
use crate::validate::{
    CaseContext, Outcome, Record,
    tank::{self, Tank, block, numbers},
};
use riprap::scene::{
    BlockShape, Boundary, EddyViscosity, Motion, Scene, Shape, Solid, SolidSurface, WallModel,
};

/// Limit on the relative error of the mean velocity over the friction velocity, with the model.
const LIMIT: f64 = 0.08;

/// Half of the distance between plates, their thickness, and the periodic box of one plate, cells.
const PLATES_H: f64 = 12.0;
const PLATE: f64 = 8.0;
const PLATES: [u32; 3] = [48, 32, 24];

/// Edge of a square rod, and the periodic box of one rod, cells.
const ROD: f64 = 24.0;
const RODS: [u32; 3] = [48, 48, 24];

/// Half of the width of a square duct, and its cells.
const DUCT_H: f64 = 12.0;
const DUCT: [u32; 3] = [48, 24, 24];

/// A stream in a periodic box that a force per mass drives.
#[derive(Clone, Copy, Debug)]
struct Stream {
    cells: [u32; 3],
    /// Axis of the stream.
    axis: usize,
    /// Cross-section of the water over its perimeter, cells.
    h: f64,
    /// Mean velocity over the friction velocity (published).
    expected: f64,
    /// Kinematic viscosity, lattice units.
    nu: f64,
    model: bool,
}

impl Stream {
    /// `length`: cells whose Reynolds number by the friction velocity is `reynolds`.
    fn new(axis: usize, cells: [u32; 3], h: f64, [length, reynolds, expected]: [f64; 3]) -> Self {
        Self {
            cells,
            axis,
            h,
            expected,
            nu: BULK / expected * length / reynolds,
            model: true,
        }
    }

    fn friction_velocity(&self) -> f64 {
        BULK / self.expected
    }

    /// Force per mass.
    fn force(&self) -> f64 {
        self.friction_velocity().powi(2) / self.h
    }

    /// The log law at a distance from a wall, as the text of a formula.
    fn log_law(&self, distance: &str) -> String {
        let friction = self.friction_velocity();
        let wall_units = 0.384 * friction / self.nu;
        format!("{friction}*(log(1 + {distance}*{wall_units})/0.384 + 2)")
    }

    fn scene(&self, velocity: [String; 3]) -> anyhow::Result<Scene> {
        let mut scene = tank::scene(self.cells, 0.5 + 3.0 * self.nu)?;
        scene.numerics.eddy_viscosity = EddyViscosity::Wale;
        if self.model {
            scene.numerics.wall_model = WallModel::WernerWengle;
        }
        let mut acceleration = [0.0; 3];
        acceleration[self.axis] = self.force();
        scene.fluid.acceleration = numbers(acceleration);
        for (component, text) in scene.initial.velocity.iter_mut().zip(velocity) {
            *component = text.parse()?;
        }
        Ok(scene)
    }

    /// Means over `time` steps, `settle` such times after the start: U_b⁺ and the friction over the published one.
    /// `bulk`: mean velocity of the water by the momentum of all cells.
    fn judge(
        &self,
        context: &CaseContext,
        scene: &Scene,
        (settle, time): (u64, f64),
        bulk: impl Fn(f64) -> f64,
        [name, place]: [&str; 2],
    ) -> anyhow::Result<[Record; 2]> {
        let mut tank = Tank::fill(context, scene)?;
        tank.advance(settle * time as u64)?;
        let each = (time as u64 / SAMPLES) | 1;
        let mut samples = Vec::new();
        for _ in 0..=SAMPLES {
            tank.advance(each)?;
            samples.push(bulk(tank.totals()?.momentum[self.axis]));
        }
        let [mean, stress] = mean_and_stress(&samples, each, self.h, self.force());
        let trial = tank.trial(name);
        let place = match self.model {
            true => place.to_owned(),
            false => format!("{place}, no model"),
        };
        let found = mean / stress.max(0.0).sqrt();
        let limit = self.model.then_some(LIMIT);
        let part = stress / (mean / self.expected).powi(2);
        Ok([
            trial.relative(format!("U_b⁺, {place}"), found, self.expected, limit),
            trial.report(format!("friction / published, {place}"), part),
        ])
    }
}

/// Mean velocity in a square duct at Re_τ 2400 by its half width, with the model and without: friction is that of a round pipe of the
/// same ratio of cross-section to perimeter (Prandtl 1935; Pirozzoli et al. 2018).
pub fn duct(context: &CaseContext) -> Outcome {
    const REYNOLDS: f64 = 2400.0;
    // 1/√f = 2 log₁₀(Re √f) − 0.8, where Re √f = √8 · 2 Re_τ and U_b⁺ = √(8/f).
    let per_root = 2.0 * (8f64.sqrt() * 2.0 * REYNOLDS).log10() - 0.8;
    let of = [DUCT_H, REYNOLDS, 8f64.sqrt() * per_root];
    let mut records = Vec::new();
    for model in [true, false] {
        let stream = Stream {
            model,
            ..Stream::new(0, DUCT, 0.5 * DUCT_H, of)
        };
        let time = DUCT_H / stream.friction_velocity();
        let cells: f64 = DUCT.map(f64::from).iter().product();
        let bulk = |momentum| momentum / cells;
        let scene = duct_scene(&stream)?;
        let names = ["square duct", "duct"];
        records.extend(stream.judge(context, &scene, (2, time), bulk, names)?);
    }
    Ok(records)
}

/// The flow begins with the log law of the nearest wall and vortices along the duct, which break up.
fn duct_scene(stream: &Stream) -> anyhow::Result<Scene> {
    let [x, y, z] = ["x", "y", "z"].map(|axis| format!("(pi*{axis}/{DUCT_H})"));
    let (width, h) = (2.0 * DUCT_H, DUCT_H);
    let from_wall = format!("min(min(y, {width} - y), min(z, {width} - z))");
    let law = stream.log_law(&from_wall);
    let mut scene = stream.scene([
        format!("{law} + 0.003*cos{y}*sin{z}*sin{x}"),
        format!("0.003*sin(pi*y/{width})*cos({z} + pi*x/{width})"),
        format!("0.003*sin(pi*z/{width})*cos({y} + pi*x/{h})"),
    ])?;
    tank::close(&mut scene);
    let faces = &mut scene.boundaries;
    (faces.x_min, faces.x_max) = (Boundary::Periodic, Boundary::Periodic);
    Ok(scene)
}

/// A channel at Re_τ 5200 between plates that are blocks.
#[derive(Clone, Copy, Debug)]
struct Plates {
    /// Height of their surfaces above a face between cells, cells.
    offset: f64,
    /// Their velocity along the stream, cells per step.
    velocity: f64,
    model: bool,
}

/// Friction of plates that are blocks, with surfaces on cell faces and off them, at rest and moving, and without the model.
pub fn blocks(context: &CaseContext) -> Outcome {
    let rest = Plates {
        offset: 0.0,
        velocity: 0.0,
        model: true,
    };
    let all = [
        rest,
        Plates {
            offset: 0.3,
            ..rest
        },
        Plates {
            offset: 0.5,
            ..rest
        },
        Plates {
            velocity: -0.02,
            ..rest
        },
        Plates {
            model: false,
            ..rest
        },
    ];
    let mut records = Vec::new();
    for plates in all {
        records.extend(plates.judge(context)?);
    }
    Ok(records)
}

impl Plates {
    fn judge(&self, context: &CaseContext) -> anyhow::Result<[Record; 2]> {
        let (reynolds, expected) = CHANNELS[1];
        let stream = Stream {
            model: self.model,
            ..Stream::new(0, PLATES, PLATES_H, [PLATES_H, reynolds, expected])
        };
        let [length, height, width] = PLATES.map(f64::from);
        let open = length * (height - PLATE) * width;
        // The momentum includes that of the solid.
        let solid = length * PLATE * width * self.velocity;
        let bulk = |momentum| (momentum - solid) / open - self.velocity;
        let mut place = format!("surfaces {} off the grid", self.offset);
        if self.velocity != 0.0 {
            place += ", plates that move";
        }
        let time = 4.0 * PLATES_H / stream.friction_velocity();
        let names = ["plates that are blocks", &place];
        stream.judge(context, &self.scene(&stream)?, (1, time), bulk, names)
    }

    /// A plate in a periodic box, its middle at the height `offset`. The flow begins with the log law and rolls across the
    /// stream, which break up.
    fn scene(&self, stream: &Stream) -> anyhow::Result<Scene> {
        let h = PLATES_H;
        let size = PLATES.map(f64::from);
        let floor = 0.5 * PLATE + self.offset;
        let law = stream.log_law(&format!("max(0, {h} - abs(y - {}))", floor + h));
        let phase = format!("(pi*z/{h} + sin(2*pi*x/{}))", size[0]);
        let height = format!("(pi*(y - {floor})/{})", 2.0 * h);
        let mut scene = stream.scene([
            format!("{law} + ({})", self.velocity),
            format!("0.003*cos{phase}*sin{height}"),
            format!("0.003*sin{phase}*cos{height}"),
        ])?;
        let shape = BlockShape::Box {
            size: [size[0], PLATE, size[2]],
        };
        let middle = [0.5 * size[0], self.offset, 0.5 * size[2]];
        let motion = match self.velocity {
            0.0 => Motion::Fixed,
            _ => Motion::Driven,
        };
        let mut plate = block(shape, middle, motion);
        plate.velocity = numbers([self.velocity, 0.0, 0.0]);
        scene.blocks.push(plate);
        Ok(scene)
    }
}

/// A stream along square rods, at Re_τ 5200 by the ratio of the cross-section of the water to its perimeter.
#[derive(Clone, Copy, Debug)]
struct Rods {
    /// Their angle to the grid, degrees.
    angle: f64,
    /// Whether they are solids with an exact surface instead of blocks.
    at_rest: bool,
    model: bool,
}

/// Friction of rods whose faces lie along the grid and at an angle to it, and without the model.
pub fn rods(context: &CaseContext) -> Outcome {
    Rods::judge_angles(context, &[0.0, Rods::SLOPE, 45.0], false)
}

/// The same for solids with exact surfaces, as terrain has them.
pub fn surfaces(context: &CaseContext) -> Outcome {
    Rods::judge_angles(context, &[Rods::SLOPE, 45.0], true)
}

impl Rods {
    /// Angle of a slope of 1:2, degrees.
    const SLOPE: f64 = 26.565_051_177_077_99;

    /// Rods at these angles, and at a slope of 1:2 without the model.
    fn judge_angles(context: &CaseContext, angles: &[f64], at_rest: bool) -> Outcome {
        let with_model = angles.iter().map(|&angle| (angle, true));
        let mut records = Vec::new();
        for (angle, model) in with_model.chain([(Self::SLOPE, false)]) {
            let rods = Self {
                angle,
                at_rest,
                model,
            };
            records.extend(rods.judge(context)?);
        }
        Ok(records)
    }

    /// Cross-section of the water, and its ratio to the perimeter.
    fn section() -> [f64; 2] {
        let area = f64::from(RODS[0] * RODS[1]) - ROD * ROD;
        [area, area / (4.0 * ROD)]
    }

    fn judge(&self, context: &CaseContext) -> anyhow::Result<[Record; 2]> {
        let (reynolds, expected) = CHANNELS[1];
        let [area, h] = Self::section();
        let stream = Stream {
            model: self.model,
            ..Stream::new(2, RODS, h, [h, reynolds, expected])
        };
        let (name, surfaces) = match self.at_rest {
            true => ("square rods that are solids", "exact surfaces "),
            false => ("square rods that are blocks", ""),
        };
        let place = format!("{surfaces}at {:.1}° to the grid", self.angle);
        let bulk = |momentum| momentum / (area * f64::from(RODS[2]));
        let time = h / stream.friction_velocity();
        let scene = self.scene(&stream)?;
        stream.judge(context, &scene, (2, time), bulk, [name, &place])
    }

    /// The flow begins with the log law around a round rod of the same perimeter, and vortices that break up.
    fn scene(&self, stream: &Stream) -> anyhow::Result<Scene> {
        let middle = RODS.map(|cells| 0.5 * f64::from(cells));
        let from_middle = format!("sqrt((x - {})^2 + (y - {})^2)", middle[0], middle[1]);
        let round = 2.0 * ROD / std::f64::consts::PI;
        let law = stream.log_law(&format!("max(0, {from_middle} - {round})"));
        let [x, y, z] = ["x", "y", "z"].map(|axis| format!("(2*pi*{axis}/{ROD})"));
        let mut scene = stream.scene([
            format!("0.003*sin{y}*cos{z}"),
            format!("0.003*sin{z}*cos{x}"),
            format!("{law} + 0.003*sin{x}*cos{y}"),
        ])?;
        if self.at_rest {
            scene.solids = self.solids(middle);
            return Ok(scene);
        }
        let shape = BlockShape::Box {
            size: [ROD, ROD, f64::from(RODS[2])],
        };
        let mut rod = block(shape, middle, Motion::Fixed);
        rod.rotation.angle = self.angle;
        scene.blocks.push(rod);
        Ok(scene)
    }

    /// The rod as what is behind one of its faces, without what is in front of the three others.
    fn solids(&self, middle: [f64; 3]) -> Vec<Solid> {
        let face = |n: u32| {
            let (sin, cos) = (self.angle + 90.0 * f64::from(n)).to_radians().sin_cos();
            let out = if n > 0 { -1.0 } else { 1.0 };
            let [x, y, z] = middle;
            let mut solid = Solid::new(Shape::HalfSpace {
                point: [x + 0.5 * ROD * cos, y + 0.5 * ROD * sin, z],
                normal: [out * cos, out * sin, 0.0],
            });
            solid.void = n > 0;
            solid.surface = Some(SolidSurface::Exact);
            solid
        };
        (0..4).map(face).collect()
    }
}
