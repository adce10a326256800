//! Wall model: a law of the wall gives the friction of walls whose near-wall layer the grid does not resolve.

use super::{
    CaseContext, Outcome, Record, Trial, fields,
    tank::{self, Tank, block, numbers},
};
use riprap::{
    lattice::{Face, Force, WallModel},
    scene::{self, BlockShape, Boundary, EddyViscosity, Motion, Scene, Shape, Solid, SolidSurface},
};

/// Initial mean velocity.
const BULK: f64 = 0.04;
const WALL: Face = Face::Wall([0.0; 3]);
/// Number of states averaged.
const SAMPLES: u64 = 100;
/// Limit on the relative error of the mean velocity over the friction velocity.
const LIMIT: f64 = 0.05;
/// Re_τ and the mean velocity over the friction velocity (Lee & Moser 2015).
const CHANNELS: [(f64, f64); 2] = [(1000.0, 19.99), (5200.0, 24.1)];

/// The same limit between plates that are blocks.
const PLATES_LIMIT: f64 = 0.08;
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

/// A channel 4 depths long and 2 depths wide, between walls or between a wall and a face without friction.
#[derive(Clone, Copy, Debug)]
struct Channel {
    /// Cells of the depth: from a wall to the middle or to the other face.
    depth: u32,
    /// Whether the other face is a wall too.
    closed: bool,
    reynolds: f64,
    /// Equivalent sand roughness, cells.
    roughness: f64,
    /// Mean velocity over the friction velocity.
    expected: f64,
    model: Option<WallModel>,
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

/// Averages of a channel.
struct Means {
    /// Mean velocity over the friction velocity, from the momentum that the fluid loses.
    bulk: f64,
    /// Mean of the stresses that the walls report, over the momentum that the fluid loses.
    reported: f64,
    /// Mean velocity of the cells next to the walls, over the friction velocity.
    first: f64,
    /// Least increase of the mean velocity, over the friction velocity, from one layer to the next.
    least_increase: f64,
}

/// Mean velocity and profile of channels with the model; in the long form on other grids too, and without the model.
pub fn channel(context: &CaseContext) -> Outcome {
    let mut records = Vec::new();
    for (reynolds, expected) in CHANNELS {
        let usual = Channel {
            depth: 12,
            closed: true,
            reynolds,
            roughness: 0.0,
            expected,
            model: Some(WallModel::WernerWengle),
        };
        let others = [
            Channel { depth: 8, ..usual },
            Channel { depth: 16, ..usual },
            Channel {
                model: Some(WallModel::Reichardt),
                ..usual
            },
            Channel {
                model: None,
                ..usual
            },
        ];
        let others = others.into_iter().filter(|_| context.full);
        for channel in std::iter::once(usual).chain(others) {
            records.extend(channel.judge(context)?);
        }
    }
    Ok(records)
}

/// Water over a rough bed: U_b/u_τ = 2.5 ln(h/k_s) + 6.0 (Keulegan 1938), the mean of the log law of a rough wall over the depth.
pub fn rough_channel(context: &CaseContext) -> Outcome {
    let mut records = Vec::new();
    for roughness in [0.1, 1.0] {
        let depth: u32 = 12;
        let channel = Channel {
            depth,
            closed: false,
            reynolds: 2e4,
            roughness,
            expected: 2.5 * (f64::from(depth) / roughness).ln() + 6.0,
            model: Some(WallModel::WernerWengle),
        };
        records.extend(channel.judge(context)?);
    }
    Ok(records)
}

/// Mean velocity in a square duct at Re_τ 2400 by its half width, with the model and without: friction is that of a round pipe of the
/// same ratio of cross-section to perimeter (Prandtl 1935; Pirozzoli et al. 2018).
pub fn duct(context: &CaseContext) -> Outcome {
    const REYNOLDS: f64 = 2400.0;
    // 1/√f = 2 log₁₀(Re √f) − 0.8, where Re √f = √8 · 2 Re_τ and U_b⁺ = √(8/f).
    let per_root = 2.0 * (8f64.sqrt() * 2.0 * REYNOLDS).log10() - 0.8;
    let expected = 8f64.sqrt() * per_root;
    let mut records = Vec::new();
    for model in [true, false] {
        let friction = BULK / expected;
        // Cross-section over perimeter.
        let h = 0.5 * DUCT_H;
        let force = friction * friction / h;
        let scene = duct_scene(friction, friction * DUCT_H / REYNOLDS, force, model)?;
        let mut tank = Tank::fill(context, &scene)?;
        let time = DUCT_H / friction;
        tank.advance(2 * time as u64)?;
        let each = (time as u64 / SAMPLES) | 1;
        let cells: f64 = DUCT.map(f64::from).iter().product();
        let mut bulk = Vec::new();
        for _ in 0..=SAMPLES {
            tank.advance(each)?;
            bulk.push(tank.totals()?.momentum[0] / cells);
        }
        let means = mean_and_stress(&bulk, each, h, force);
        let trial = tank.trial("square duct");
        let place = if model { "duct" } else { "duct, no model" };
        records.extend(judge_friction(&trial, place, model, means, expected));
    }
    Ok(records)
}

/// The flow begins with the log law of the nearest wall and vortices along the duct, which break up.
fn duct_scene(friction: f64, nu: f64, force: f64, model: bool) -> anyhow::Result<Scene> {
    let mut scene = tank::scene(DUCT, 0.5 + 3.0 * nu)?;
    tank::close(&mut scene);
    let faces = &mut scene.boundaries;
    (faces.x_min, faces.x_max) = (Boundary::Periodic, Boundary::Periodic);
    scene.numerics.eddy_viscosity = EddyViscosity::Wale;
    if model {
        scene.numerics.wall_model = scene::WallModel::WernerWengle;
    }
    scene.fluid.acceleration = numbers([force, 0.0, 0.0]);
    let wall_units = 0.384 * friction / nu;
    let [x, y, z] = ["x", "y", "z"].map(|axis| format!("(pi*{axis}/{DUCT_H})"));
    let (width, h) = (2.0 * DUCT_H, DUCT_H);
    let from_wall = format!("min(min(y, {width} - y), min(z, {width} - z))");
    let velocity = [
        format!(
            "{friction}*(log(1 + {from_wall}*{wall_units})/0.384 + 2) + 0.003*cos{y}*sin{z}*sin{x}"
        ),
        format!("0.003*sin(pi*y/{width})*cos({z} + pi*x/{width})"),
        format!("0.003*sin(pi*z/{width})*cos({y} + pi*x/{h})"),
    ];
    for (component, text) in scene.initial.velocity.iter_mut().zip(velocity) {
        *component = text.parse()?;
    }
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
        let friction = BULK / expected;
        let force = friction * friction / PLATES_H;
        let mut tank = Tank::fill(context, &self.scene(friction, reynolds)?)?;
        let time = 4.0 * PLATES_H / friction;
        tank.advance(time as u64)?;
        let each = (time as u64 / SAMPLES) | 1;
        let mut bulk = Vec::new();
        for _ in 0..=SAMPLES {
            tank.advance(each)?;
            let [length, height, width] = PLATES.map(f64::from);
            let open = length * (height - PLATE) * width;
            // The momentum includes that of the solid.
            let solid = length * PLATE * width * self.velocity;
            bulk.push((tank.totals()?.momentum[0] - solid) / open - self.velocity);
        }
        let means = mean_and_stress(&bulk, each, PLATES_H, force);
        let trial = tank.trial("plates that are blocks");
        let mut place = format!("surfaces {} off the grid", self.offset);
        if self.velocity != 0.0 {
            place += ", plates that move";
        }
        if !self.model {
            place += ", no model";
        }
        Ok(judge_friction(&trial, &place, self.model, means, expected))
    }

    /// A plate in a periodic box, its middle at the height `offset`. The flow begins with the log law and rolls across the
    /// stream, which break up.
    fn scene(&self, friction: f64, reynolds: f64) -> anyhow::Result<Scene> {
        let h = PLATES_H;
        let size = PLATES.map(f64::from);
        let nu = friction * h / reynolds;
        let mut scene = tank::scene(PLATES, 0.5 + 3.0 * nu)?;
        scene.numerics.eddy_viscosity = EddyViscosity::Wale;
        if self.model {
            scene.numerics.wall_model = scene::WallModel::WernerWengle;
        }
        scene.fluid.acceleration = numbers([friction * friction / h, 0.0, 0.0]);
        let floor = 0.5 * PLATE + self.offset;
        let from_plate = format!("max(0, {h} - abs(y - {}))", floor + h);
        let phase = format!("(pi*z/{h} + sin(2*pi*x/{}))", size[0]);
        let height = format!("(pi*(y - {floor})/{})", 2.0 * h);
        let wall_units = 0.384 * friction / nu;
        let velocity = [
            format!(
                "{friction}*(log(1 + {from_plate}*{wall_units})/0.384 + 2) + ({})",
                self.velocity
            ),
            format!("0.003*cos{phase}*sin{height}"),
            format!("0.003*sin{phase}*cos{height}"),
        ];
        for (component, text) in scene.initial.velocity.iter_mut().zip(velocity) {
            *component = text.parse()?;
        }
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

/// Mean velocity of samples `each` steps apart, and the mean stress over the density: the fluid loses to the walls what the force
/// per mass adds and it does not keep. `h`: cross-section over its perimeter.
fn mean_and_stress(bulk: &[f64], each: u64, h: f64, force: f64) -> [f64; 2] {
    let change = (bulk[bulk.len() - 1] - bulk[0]) / (SAMPLES * each) as f64;
    let mean = bulk.iter().sum::<f64>() / bulk.len() as f64;
    [mean, h * (force - change)]
}

/// U_b⁺ and the friction of blocks, by the mean velocity of the water and its stress over the density.
fn judge_friction(
    trial: &Trial,
    place: &str,
    model: bool,
    [mean, stress]: [f64; 2],
    expected: f64,
) -> [Record; 2] {
    let found = mean / stress.max(0.0).sqrt();
    let limit = model.then_some(PLATES_LIMIT);
    let part = stress / (mean / expected).powi(2);
    [
        trial.relative(format!("U_b⁺, {place}"), found, expected, limit),
        trial.report(format!("friction / published, {place}"), part),
    ]
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
        let friction = BULK / expected;
        let force = friction * friction / h;
        let mut tank = Tank::fill(context, &self.scene(friction, reynolds)?)?;
        let time = h / friction;
        tank.advance(2 * time as u64)?;
        let each = (time as u64 / SAMPLES) | 1;
        let mut bulk = Vec::new();
        for _ in 0..=SAMPLES {
            tank.advance(each)?;
            bulk.push(tank.totals()?.momentum[2] / (area * f64::from(RODS[2])));
        }
        let means = mean_and_stress(&bulk, each, h, force);
        let trial = tank.trial(if self.at_rest {
            "square rods that are solids"
        } else {
            "square rods that are blocks"
        });
        let mut place = format!("at {:.1}° to the grid", self.angle);
        if self.at_rest {
            place = format!("exact surfaces {place}");
        }
        if !self.model {
            place += ", no model";
        }
        Ok(judge_friction(&trial, &place, self.model, means, expected))
    }

    /// The flow begins with the log law around a round rod of the same perimeter, and vortices that break up.
    fn scene(&self, friction: f64, reynolds: f64) -> anyhow::Result<Scene> {
        let [_, h] = Self::section();
        let middle = RODS.map(|cells| 0.5 * f64::from(cells));
        let nu = friction * h / reynolds;
        let mut scene = tank::scene(RODS, 0.5 + 3.0 * nu)?;
        scene.numerics.eddy_viscosity = EddyViscosity::Wale;
        if self.model {
            scene.numerics.wall_model = scene::WallModel::WernerWengle;
        }
        scene.fluid.acceleration = numbers([0.0, 0.0, friction * friction / h]);
        let from_middle = format!("sqrt((x - {})^2 + (y - {})^2)", middle[0], middle[1]);
        let from_rod = format!(
            "max(0, {from_middle} - {})",
            2.0 * ROD / std::f64::consts::PI
        );
        let wall_units = 0.384 * friction / nu;
        let [x, y, z] = ["x", "y", "z"].map(|axis| format!("(2*pi*{axis}/{ROD})"));
        let velocity = [
            format!("0.003*sin{y}*cos{z}"),
            format!("0.003*sin{z}*cos{x}"),
            format!(
                "{friction}*(log(1 + {from_rod}*{wall_units})/0.384 + 2) + 0.003*sin{x}*cos{y}"
            ),
        ];
        for (component, text) in scene.initial.velocity.iter_mut().zip(velocity) {
            *component = text.parse()?;
        }
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

impl Channel {
    /// Layers of cells across the channel.
    fn layers(&self) -> u32 {
        self.depth * if self.closed { 2 } else { 1 }
    }

    fn judge(&self, context: &CaseContext) -> anyhow::Result<Vec<Record>> {
        let h = f64::from(self.depth);
        let friction = BULK / self.expected;
        let cells = [4 * self.depth, self.layers(), 2 * self.depth];
        let mut setup = context.setup(cells, friction * h / self.reynolds);
        let other = if self.closed { WALL } else { Face::FreeSlip };
        setup.faces[1] = [WALL, other];
        setup.force = Force::Constant([friction * friction / h, 0.0, 0.0]);
        setup.wale = Some(0.5);
        setup.wall_model = self.model;
        setup.wall_roughness[1] = [self.roughness; 2];
        let mut start = fields::turbulent_channel(cells, h, friction, self.reynolds);
        // A rough wall shifts the profile.
        let u = &mut start.velocity[0];
        let mean = u.iter().map(|u| f64::from(*u)).sum::<f64>() / u.len() as f64;
        u.iter_mut().for_each(|u| *u += (BULK - mean) as f32);
        let mut flow = context.flow(setup, &start, true)?;
        // Times h/u_τ until the flow no longer depends on its start, and over which means are taken.
        let (settle, average) = if context.full {
            (8.0, 16.0)
        } else {
            (4.0, 4.0)
        };
        flow.advance((settle * h / friction) as u64)?;
        // Odd, so that populations that alternate at walls contribute both of their states.
        let each = ((average * h / friction) as u64 / SAMPLES) | 1;
        let means = self.average(&mut flow, friction * friction / h, each)?;
        let trial = flow.trial();
        let mut name = match self.roughness {
            0.0 => format!("Re_τ {:.0}, {} cells", self.reynolds, self.layers()),
            rough => format!("h/k_s {:.0}", h / rough),
        };
        name += match self.model {
            Some(WallModel::WernerWengle) => "",
            Some(WallModel::Reichardt) => ", Reichardt",
            None => ", no model",
        };
        let limit = self.model.map(|_| LIMIT);
        let bulk = trial.relative(format!("{name}: U_b⁺"), means.bulk, self.expected, limit);
        let first = format!("{name}: U⁺ of the first cell");
        let increase = format!("{name}: least increase of U⁺ from cell to cell");
        Ok(match self.model {
            None => vec![
                bulk,
                trial.report(first, means.first),
                trial.report(increase, means.least_increase),
            ],
            Some(_) => vec![
                bulk,
                trial.at_least(first, means.first, 0.0),
                trial.at_least(increase, means.least_increase, 0.0),
                trial.relative(
                    format!("{name}: stress that the walls report over that lost"),
                    means.reported,
                    1.0,
                    1e-2,
                ),
            ],
        })
    }

    /// Means over states `each` steps apart, in a flow driven by a force per volume.
    fn average(&self, flow: &mut super::Flow<'_>, force: f64, each: u64) -> anyhow::Result<Means> {
        let (h, layers) = (f64::from(self.depth), self.layers() as usize);
        let length = 4 * self.depth as usize;
        let mut rows = 0;
        let mut profile = vec![0.0; layers];
        let mut bulk = Vec::new();
        let mut reported = 0.0;
        for _ in 0..=SAMPLES {
            flow.advance(each)?;
            let state = flow.state()?;
            let u = &state.velocity[0];
            rows = u.len() / length / layers;
            let mut mean = 0.0;
            for (row, values) in u.chunks(length).enumerate() {
                let sum: f64 = values.iter().map(|u| f64::from(*u)).sum();
                profile[row % layers] += sum;
                mean += sum / u.len() as f64;
            }
            bulk.push(mean);
            if self.model.is_some() {
                let walls = flow.wall_stresses()?;
                let sum: f64 = walls.iter().map(|wall| f64::from(wall.stress[0])).sum();
                reported += sum / walls.len() as f64 / (SAMPLES + 1) as f64;
            }
        }
        let [bulk, stress] = mean_and_stress(&bulk, each, h, force);
        let cells = (SAMPLES + 1) as f64 * (length * rows) as f64;
        let mean = |y: usize| {
            let both = match self.closed {
                true => (profile[y] + profile[layers - 1 - y]) / 2.0,
                false => profile[y],
            };
            both / cells / stress.sqrt()
        };
        let increases = (1..self.depth as usize).map(|y| mean(y) - mean(y - 1));
        Ok(Means {
            bulk: bulk / stress.sqrt(),
            reported: reported / stress,
            first: mean(0),
            least_increase: increases.fold(f64::INFINITY, f64::min),
        })
    }
}
