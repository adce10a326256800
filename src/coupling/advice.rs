//! Warnings about the resolution and stability of blocks in a fluid, and about water that particles resolve poorly.

use super::{
    Coupled, Gap,
    gaps::{gaps, narrowest},
};
use crate::{
    Result,
    geometry::{Form, min_max},
    rock::{Block, Blocks, Motion, broadphase::HostBroadphase, formula_values},
    scene::{
        Advice, ProbePlace, Scene, Warning,
        build::{BlockSetup, particle_lattice, scene_step, water_bodies},
    },
    sph::{ConvexPart, Scheme, Setup, Side, SpeedEstimate, water_volume},
};
use glam::DVec3;

/// Fewest cells across a resolved block: in a cube of this width, 42 % of the cells contain no surface.
const MIN_CELLS_ACROSS: f64 = 8.0;
/// Tolerance of [`MIN_CELLS_ACROSS`], cells: a width that is printed as 8.0 passes.
const WIDTH_TOLERANCE: f64 = 0.05;

/// The block with the smallest value among those below a limit.
struct Ranked {
    count: usize,
    name: String,
    value: f64,
}

impl Ranked {
    /// `None` if no value is below `limit`.
    fn below(limit: f64, all: impl Iterator<Item = (String, f64)>) -> Option<Self> {
        let low: Vec<_> = all.filter(|(_, value)| *value < limit).collect();
        let count = low.len();
        let least = low.into_iter().min_by(|a, b| a.1.total_cmp(&b.1))?;
        Some(Self {
            count,
            name: least.0,
            value: least.1,
        })
    }
}

impl Coupled<'_> {
    /// Warnings about unresolved blocks and gaps, blocks lighter than the fluid, and blocks in inflow cells.
    pub fn advise(&self, scene: &Scene) -> Advice {
        let mut advice = Advice::new();
        let mut warn = |place: &str, message: String| {
            advice.push(Warning {
                place: place.into(),
                message,
            });
        };
        let cell = scene.domain.cell;
        let setup = &self.setup().setup;
        let blocks = setup.blocks[..self.in_fluid()].iter();
        let domain = self.domain_size();
        let widths = blocks
            .clone()
            .map(|block| (block.name.clone(), width(block, domain) / cell));
        if let Some(thin) = Ranked::below(MIN_CELLS_ACROSS - WIDTH_TOLERANCE, widths) {
            warn(
                "domain.cell",
                format!(
                    "{} blocks are fewer than {MIN_CELLS_ACROSS} cells across, {} only {:.1}: the loads on them \
                     are inaccurate; use cell ≤ {:.3e} m",
                    thin.count,
                    thin.name,
                    thin.value,
                    cell * thin.value / MIN_CELLS_ACROSS
                ),
            );
        }
        self.warn_of_gaps(cell, &mut warn);
        let fluid = scene.fluid.density;
        let free = blocks.filter(|block| block.motion == Motion::Free);
        let ratios = free.map(|block| {
            let density = setup.materials[block.material].density;
            (block.name.clone(), density / fluid)
        });
        // Measured with a cube of eight cells between its own images, which trap sound: density ratios of 0.3, 0.6 and 1
        // are stable with 1, 2 and 4 steps between exchanges; 0.5 with 2 and 0.8 with 4 are not.
        let safe = 1.0 - 0.5 / f64::from(scene.coupling.interval);
        if let Some(light) = Ranked::below(1.0, ratios) {
            warn(
                "materials",
                format!(
                    "{} blocks are lighter than the fluid, {} has {:.2} of its density: they float, and \
                     their added mass exceeds their mass, so that they accelerate more slowly than they should, and below \
                     {safe} of its density, with coupling.interval = {}, may oscillate; use a density above \
                     {fluid} kg/m³, or at least above {}",
                    light.count,
                    light.name,
                    light.value,
                    scene.coupling.interval,
                    safe * fluid
                ),
            );
        }
        self.warn_of_inlets(&mut advice);
        advice
    }

    /// Width of the narrowest block in the fluid, m: the smallest distance between two parallel planes that enclose it,
    /// one of them along a face. The length of a block that spans the domain is none. `None` without blocks.
    pub fn narrowest(&self) -> Option<f64> {
        let blocks = self.setup().setup.blocks[..self.in_fluid()].iter();
        let widths = blocks.map(|block| width(block, self.domain_size()));
        widths.filter(|w| w.is_finite()).min_by(f64::total_cmp)
    }

    /// Edges of the domain, m.
    fn domain_size(&self) -> DVec3 {
        let (cells, _) = self.solid_cells().domain();
        self.solid_cells().frame().units.cell * DVec3::from_array(cells.map(f64::from))
    }

    /// The narrowest open gap between a block in the fluid and another block, a wall, or a periodic image; `None` if all are
    /// wider than `within` (m).
    pub fn narrowest_gap(&self, within: f64) -> Option<Gap> {
        let cell = self.solid_cells().frame().units.cell;
        narrowest(
            &self.setup().setup,
            self.blocks(),
            (self.in_fluid(), cell, within),
        )
    }

    fn warn_of_gaps(&self, cell: f64, warn: &mut impl FnMut(&str, String)) {
        let (closed, open): (Vec<&Gap>, Vec<&Gap>) =
            self.gaps().iter().partition(|gap| gap.is_closed(cell));
        let narrowest = open.iter().min_by(|a, b| a.width.total_cmp(&b.width));
        if let Some(gap) = narrowest {
            let [a, b] = gap.blocks.map(|block| self.blocks().name(block));
            warn(
                "domain.cell",
                format!(
                    "gaps between blocks narrower than a cell: {}, the narrowest {:.2e} m ({:.2} cells) \
                     between {a} and {b}: the grid does not resolve the flow and the pressure in them; use \
                     cell ≤ {:.1e} m, or close them. Pairs that touch, with no water between them: {}",
                    open.len(),
                    gap.width,
                    gap.width / cell,
                    gap.width,
                    closed.len()
                ),
            );
        }
    }
}

/// Fraction of the domain from which a block spans it.
const SPANS: f64 = 0.99;

/// Smallest distance between two parallel planes that enclose a block, one of them along a face, m; not along an axis along which
/// the block spans the domain.
fn width(block: &Block, domain: DVec3) -> f64 {
    let shape = &block.shape;
    let faces = shape.parts().iter().flat_map(|part| match &part.form {
        Form::Sphere { .. } => vec![DVec3::X, DVec3::Y, DVec3::Z],
        Form::Convex(shape) => shape.faces().iter().map(|face| face.normal).collect(),
    });
    let widths = faces.filter_map(|n| {
        let [low, high] = shape.extent(n);
        let world = block.rotation * n;
        let axis = (0..3).find(|&axis| world[axis].abs() > 1.0 - 1e-9);
        let spans = axis.is_some_and(|axis| high - low >= SPANS * domain[axis]);
        (!spans).then_some(high - low)
    });
    widths.fold(f64::INFINITY, f64::min)
}

/// Least number of particles over the depth that resolves waves and pressure: at 25 a standing wave loses a few percent of
/// its height per period.
const MIN_DEPTH_PARTICLES: f64 = 10.0;

/// Tolerated relative difference between the mass of the particles and that of the bodies of water.
const MASS_TOLERANCE: f64 = 0.01;

/// Ratio of the long-wave speed to the largest expected speed above which still water is 4 % denser at its bottom.
const MAX_WAVE_SPEED_RATIO: f64 = 2.0;

/// Tolerated ratio of the fall speed of a block to the largest expected speed. The fall speed is an upper bound, which
/// friction and water reduce.
const FALL_SPEED_RATIO: f64 = 1.5;

/// Difference of the size of a tank from a whole number of spacings from which its water starts too far from the wall, or too near.
const WALL_TOLERANCE: f64 = 0.05;

/// Warnings about the water of `scene` with the particle setup `setup`: `positions` (m) are the initial positions of the
/// particles, `state` the initial state of `blocks`.
///
/// # Errors
/// [`crate::Error::Scene`] if a body of water has an invalid shape; errors of the search for gaps.
pub async fn particle_advice(
    scene: &Scene,
    blocks: &BlockSetup,
    state: &Blocks,
    setup: &Setup,
    positions: &[DVec3],
) -> Result<Advice> {
    let mut advice = Advice::new();
    let mut warn = |place: String, message: String| advice.push(Warning { place, message });
    let spacing = setup.spacing;
    if let Some(up) = (-setup.gravity).try_normalize() {
        let [low, high] = min_max(positions.iter().map(|x| up.dot(*x)));
        // At the start the water is compressed by its weight.
        let particles = ((high - low) / spacing).round() + 1.0;
        if particles < MIN_DEPTH_PARTICLES {
            warn(
                "particles.spacing".into(),
                format!(
                    "the water is {particles:.0} particles deep, and waves need {MIN_DEPTH_PARTICLES} at least; use a spacing of \
                     {:.2e} m",
                    spacing * particles / MIN_DEPTH_PARTICLES
                ),
            );
        }
    }
    check_mass(scene, blocks, setup, positions.len(), &mut warn)?;
    check_walls(setup, positions, &mut warn);
    check_support(scene, blocks, setup, &mut warn);
    check_speeds(scene, blocks, setup, positions, &mut warn);
    check_probes(scene, blocks, setup, positions, &mut warn);
    let free = || {
        let all = blocks.setup.blocks.iter();
        all.filter(|block| block.motion == Motion::Free)
    };
    let gravity = DVec3::from(scene.rock.gravity);
    if free().next().is_some() && gravity.distance(setup.gravity) > 1e-6 * gravity.length() {
        warn(
            "fluid.acceleration".into(),
            format!(
                "is {} m/s² for the water, and rock.gravity is {gravity} m/s² for the blocks; buoyancy is wrong unless \
                 they are equal",
                setup.gravity
            ),
        );
    }
    let support = f64::from(setup.layers()) * spacing;
    let thin = |block: &Block, form: &Form| match form {
        Form::Sphere { radius } => 2.0 * radius < support,
        Form::Convex(part) => part.faces().iter().any(|face| {
            // The ends of a prism in a planar scene do not touch water.
            let is_end = setup.plane && (block.rotation * face.normal).y.abs() > 0.5;
            2.0 * face.distance < support && !is_end
        }),
    };
    let thin = free().filter(|block| {
        let mut parts = block.shape.parts().iter();
        parts.all(|part| thin(block, &part.form))
    });
    let names: Vec<&str> = thin.map(|block| block.name.as_str()).collect();
    if let Some(first) = names.first() {
        warn(
            "particles.spacing".into(),
            format!(
                "{} blocks, `{first}` the first, are thinner than the {support:.2e} m of the kernel support, so water interacts \
                 across them; use a smaller spacing",
                names.len()
            ),
        );
    }
    let mut broadphase = HostBroadphase;
    let width = 2.0 * spacing;
    let mut narrow = gaps(
        &blocks.setup,
        state,
        blocks.in_fluid,
        width,
        &mut broadphase,
    )
    .await?;
    narrow.retain(|gap| !gap.is_closed(spacing));
    let least = |a: &&Gap, b: &&Gap| a.width.total_cmp(&b.width);
    if let Some(narrowest) = narrow.iter().min_by(least) {
        let [first, second] = narrowest
            .blocks
            .map(|block| blocks.setup.blocks[block].name.as_str());
        warn(
            "particles.spacing".into(),
            format!(
                "gaps between blocks narrower than two spacings: {}, the narrowest of {:.2e} m between `{first}` and \
                 `{second}`: they hold one layer of particles at most, and none below half a spacing; close them, or use \
                 a smaller spacing",
                narrow.len(),
                narrowest.width
            ),
        );
    }
    Ok(advice)
}

/// Warns if the mass of the particles differs from that of the bodies of water.
fn check_mass(
    scene: &Scene,
    blocks: &BlockSetup,
    setup: &Setup,
    particles: usize,
    warn: &mut impl FnMut(String, String),
) -> Result<()> {
    let volume = water_volume(
        &particle_lattice(scene)?,
        &water_bodies(scene)?,
        &blocks.setup.blocks,
    );
    let expected = setup.density * volume;
    let mass = setup.particle_mass() * particles as f64;
    if (mass / expected - 1.0).abs() > MASS_TOLERANCE {
        warn(
            "particles.spacing".into(),
            format!(
                "the particles are {mass:.4} kg of water, and its bodies hold {expected:.4} kg outside the blocks; place the \
                 sides of water and blocks at whole numbers of spacings from the lower corner of the domain, or use \
                 a smaller spacing"
            ),
        );
    }
    Ok(())
}

/// Warns if the last particles before a wall are not half a spacing from it.
fn check_walls(setup: &Setup, positions: &[DVec3], warn: &mut impl FnMut(String, String)) {
    for axis in (0..3).filter(|&axis| !(setup.plane && axis == 1)) {
        if setup.faces[axis][0] == Side::Periodic {
            continue;
        }
        let (size, spacing) = (setup.size[axis], setup.spacing);
        let end = setup.origin[axis] + size;
        let last = min_max(positions.iter().map(|x| x[axis]))[1];
        let count = size / spacing;
        let apart = (count - count.round()).abs();
        if apart > WALL_TOLERANCE
            && end - last < 1.5 * spacing
            && setup.faces[axis][1] != Side::Open
        {
            warn(
                format!("domain.size[{axis}]"),
                format!(
                    "{size} m are {count:.2} particles: the water starts {:.2} of a spacing from the upper wall instead of half of \
                     one, and sloshes; use {:.4} or {:.4} m, or a spacing that divides the size",
                    (end - last) / spacing,
                    count.floor() * spacing,
                    count.ceil() * spacing
                ),
            );
        }
    }
}

/// Warns if nothing supports the water against gravity.
fn check_support(
    scene: &Scene,
    blocks: &BlockSetup,
    setup: &Setup,
    warn: &mut impl FnMut(String, String),
) {
    let falls = |axis: usize| setup.faces[axis][0] == Side::Periodic || setup.gravity[axis] == 0.0;
    // Walls follow the blocks and solids in the list.
    let supports = blocks
        .setup
        .blocks
        .iter()
        .take(blocks.in_fluid + scene.solids.len());
    let mut supports = supports.filter(|block| block.motion != Motion::Free);
    if setup.gravity != DVec3::ZERO && (0..3).all(falls) && supports.next().is_none() {
        warn(
            "boundaries".into(),
            format!(
                "gravity, {} m/s², acts along periodic axes, and no block opposes it: the water falls for ever; give the \
                 lower face kind = \"wall\", or add a bed below the water",
                formula_values(&scene.fluid.acceleration, 0.0)
            ),
        );
    }
}

/// Warns if the water or a block is too fast, or the water too deep, for the speed of sound.
fn check_speeds(
    scene: &Scene,
    blocks: &BlockSetup,
    setup: &Setup,
    positions: &[DVec3],
    warn: &mut impl FnMut(String, String),
) {
    let expected = setup.largest_speed();
    let length = scene.run.length(scene_step(scene, setup.acoustic_step()));
    let speeds = SpeedEstimate::new(positions, setup.spacing, setup.gravity).over(length);
    let wave_speed = speeds.of_water() / std::f64::consts::SQRT_2;
    if setup.scheme == Scheme::Delta && wave_speed > MAX_WAVE_SPEED_RATIO * expected {
        let compression = (wave_speed / setup.sound_speed).powi(2);
        warn(
            "particles.largest_speed".into(),
            format!(
                "is {expected:.3} m/s for the speed of sound, and the water is so deep that at rest it would be {:.0} % \
                 denser at its bottom; give {:.3} m/s",
                100.0 * compression,
                speeds.of_water()
            ),
        );
    }
    let fastest = |free: bool| {
        let all = blocks.setup.blocks.iter();
        let all = all.filter(|block| (block.motion == Motion::Free) == free);
        let all = all.map(|block| (speeds.of_block(block), block.name.as_str()));
        all.max_by(|a, b| a.0.total_cmp(&b.0))
    };
    for (free, ratio, verb) in [
        (false, 1.0, "is driven at"),
        (true, FALL_SPEED_RATIO, "may fall at"),
    ] {
        let too_fast = fastest(free).filter(|(speed, _)| *speed > 1.001 * ratio * expected);
        if let Some((speed, name)) = too_fast {
            warn(
                "particles.largest_speed".into(),
                format!(
                    "is {expected:.3} m/s for the speed of sound, and block `{name}` {verb} up to {speed:.3} m/s, Mach \
                     {:.2}: its impact compresses the water; give {speed:.3} m/s",
                    speed / setup.sound_speed
                ),
            );
        }
    }
}

/// Warns about probes that water cannot reach.
fn check_probes(
    scene: &Scene,
    blocks: &BlockSetup,
    setup: &Setup,
    positions: &[DVec3],
    warn: &mut impl FnMut(String, String),
) {
    let fixed = blocks.setup.blocks.iter();
    let fixed = fixed.filter(|block| block.motion == Motion::Fixed);
    let fixed: Vec<(&str, ConvexPart<'_>)> = fixed
        .flat_map(|block| {
            ConvexPart::of_block(block)
                .into_iter()
                .map(|part| (block.name.as_str(), part))
        })
        .collect();
    let inside = |x: DVec3| {
        let found = fixed.iter().find(|(_, part)| part.depth(x) > 0.0);
        found.map(|(name, _)| *name)
    };
    let [low, high] = min_max(positions.iter().map(|x| x.z));
    for (index, probe) in scene.probes.iter().enumerate() {
        let block = match &probe.place {
            ProbePlace::Point { at } => inside(DVec3::from(*at)),
            // Half a spacing in front of its wall.
            ProbePlace::Sensor { at, normal, .. } => {
                let outward = DVec3::AXES[normal.axis().index()] * f64::from(normal.sign());
                inside(DVec3::from(*at) + 0.5 * setup.spacing * outward)
            }
            // The whole column up to the top of the water.
            ProbePlace::Gauge { at: [x, y] } => {
                let count = ((high - low) / setup.spacing).ceil() as u32;
                let column = (0..=count).map(|n| {
                    let z = low + f64::from(n) * setup.spacing;
                    inside(DVec3::new(*x, *y, z.min(high)))
                });
                let column: Option<Vec<&str>> = column.collect();
                column.and_then(|names| names.first().copied())
            }
            _ => None,
        };
        if let Some(block) = block {
            warn(
                format!("probes[{index}].at"),
                format!(
                    "`{}` is inside block `{block}`, which water cannot reach; move the probe",
                    probe.name
                ),
            );
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::{Polyhedron, Shape};

    #[test]
    fn width_of_a_plate_a_sphere_and_a_tetrahedron() {
        let width_in =
            |shape: &Shape, domain| width(&Block::new("block", shape.clone(), DVec3::ZERO), domain);
        let width = |shape: &Shape| width_in(shape, DVec3::splat(4.0));
        let plate: Shape = Polyhedron::cuboid(DVec3::new(3.0, 0.2, 1.0))
            .unwrap()
            .into();
        assert!((width(&plate) - 0.2).abs() < 1e-12);
        assert!((width_in(&plate, DVec3::new(4.0, 0.2, 4.0)) - 1.0).abs() < 1e-12);
        assert!((width(&Shape::sphere(0.7).unwrap()) - 1.4).abs() < 1e-12);
        // Between a face and the corner opposite to it: edge · √(2/3).
        let tetrahedron: Shape = Polyhedron::tetrahedron(1.0).unwrap().into();
        assert!((width(&tetrahedron) - (2.0f64 / 3.0).sqrt()).abs() < 1e-12);
    }

    #[test]
    fn the_smallest_value_and_the_count_below_a_limit() {
        let all = [("a", 3.0), ("b", 1.0), ("c", 9.0), ("d", 2.0)];
        let all = all.iter().map(|(name, value)| ((*name).into(), *value));
        let found = Ranked::below(5.0, all.clone()).unwrap();
        assert_eq!((found.count, found.name.as_str()), (3, "b"));
        assert!(Ranked::below(1.0, all).is_none());
    }
}
