//! Warnings about keys that are valid, but probably not as intended.

use super::{
    Advice, Block, BlockShape, Boundary, Face, Material, Motion, ProbePlace, Scene, Shape, Solid,
    Warning,
};
use crate::formula::Formula;
use glam::DVec3;
use std::f64::consts::PI;

/// Tolerance for the rounding of numbers in scenes: of the sine of an angle between directions, and relative of times and
/// stiffnesses.
const ROUNDED: f64 = 1e-3;
/// Fraction of the gravity of the blocks from which the acceleration of the fluid is gravity, too; a smaller one drives a flow.
const GRAVITY: f64 = 0.5;
/// Angle of friction, degrees, below which the number is probably a tangent: as a tangent it is that of 56°. No contact of dry
/// rocks is so slippery.
const TANGENT: f64 = 1.5;
/// Steps above which a run is probably not meant to be that long.
const STEPS: f64 = 1e8;
/// Ratio of the densities of a block and the fluid above which one of them is probably not in kg/m³: that of iron to water is 8.
const DENSITIES: f64 = 100.0;
/// Largest overlap of a block at rest, as a fraction of its smallest distance from centroid to face or of its radius: as much
/// as blocks may overlap at the start.
const SINKS: f64 = 0.01;

impl Scene {
    /// Warns of keys that contradict each other or are probably in the wrong unit, for a run in steps of `time_step` (s).
    pub fn suspicious_keys(&self, time_step: f64) -> Advice {
        let mut advice = Advice::new();
        let mut warn = |place: String, message: String| advice.push(Warning { place, message });
        if let Some((fluid, rock)) = self.gravities() {
            warn(
                "rock.gravity".into(),
                format!(
                    "the fluid weighs along {fluid:?} m/s² (fluid.acceleration) and the blocks fall along {rock:?} m/s² with \
                     buoyancy against both; give one direction to both, or, where the acceleration drives a flow alone, \
                     ignore this warning"
                ),
            );
        }
        let half_space = |solid: &Solid| matches!(solid.shape, Shape::HalfSpace { .. });
        if !self.has_fluid() && self.domain.is_given() && !self.solids.iter().any(half_space) {
            warn(
                "domain".into(),
                "without [fluid] it only bounds half-spaces in [[solids]], of which there are none: blocks leave it, and nothing \
                 repeats; remove it, or add fixed blocks as walls"
                    .into(),
            );
        }
        let (hold, length) = (self.coupling.hold, self.run.length(time_step));
        if self.has_blocks() && hold > 0.0 && hold >= length {
            warn(
                "coupling.hold".into(),
                format!(
                    "blocks are held for {hold} s and the run ends at {length:.6} s: none of them will move; take less, or run \
                     longer"
                ),
            );
        }
        let steps = length / time_step;
        if steps > STEPS {
            warn(
                "run".into(),
                format!(
                    "takes {steps:.1e} steps of {time_step:.1e} s, which the stiffest contact or the fluid bounds: run for a \
                     shorter time, or look for a normal_stiffness, viscosity or cell in another unit"
                ),
            );
        }
        // With a duration such a time is refused.
        let from = self.statistics.as_ref().map(|statistics| statistics.from);
        if let Some(from) = from.filter(|from| *from >= length) {
            warn(
                "statistics.from".into(),
                format!(
                    "is {from} s, and the run ends at {length:.6} s: nothing will be sampled; begin earlier, or run longer"
                ),
            );
        }
        let exchange = f64::from(self.coupling.interval) * time_step;
        if self.has_blocks() && self.has_fluid() && self.coupling.interval > 1 && exchange >= length
        {
            warn(
                "coupling.interval".into(),
                format!(
                    "blocks meet the fluid every {exchange:.3e} s and the run ends at {length:.6} s: none of them will react to \
                     it; take less, or run longer"
                ),
            );
        }
        if let Some((face, speed, pressure, number)) = self.impulsive_start(time_step) {
            let axis = face.axis().index();
            let through = self.domain.size[axis] / speed;
            warn(
                "coupling.hold".into(),
                format!(
                    "is 0, and the water crosses {} at {speed} m/s from t = 0: this sends a pressure wave of ρcU = {pressure:.2e} Pa, more \
                     than the submerged weight of blocks[{number}] over its area; hold the blocks until the flow has developed (hold = {through:.2e} is \
                     one passage), or let the velocity grow from 0, as with min(1, t/{through:.2e})",
                    face.name()
                ),
            );
        }
        for (number, block) in self.blocks.iter().enumerate() {
            let still = |of: &[Formula; 3]| of.iter().all(|part| part.constant() == Some(0.0));
            if block.motion == Motion::Driven && still(&block.velocity) && still(&block.spin) {
                warn(
                    format!("blocks[{number}].motion"),
                    "it is driven, with neither `velocity` nor `spin`: it stands still; give one, or motion = \"fixed\""
                        .into(),
                );
            }
        }
        for one in self.materials.iter().filter(|_| self.has_fluid()) {
            let ratio = one.density / self.fluid.density;
            if !(1.0 / DENSITIES..=DENSITIES).contains(&ratio) {
                warn(
                    format!("materials.{}.density", one.name),
                    format!(
                        "{} and fluid.density = {} are kg/m³, and differ by a factor of {:.0}: write 2700 for rock and 1000 for \
                         water, not 2.7 and 1",
                        one.density,
                        self.fluid.density,
                        ratio.max(1.0 / ratio)
                    ),
                );
            }
        }
        let [x, y, z] = self.rock.gravity;
        if self.has_blocks() && z > x.abs().max(y.abs()) {
            warn(
                "rock.gravity".into(),
                format!(
                    "blocks fall upwards, along +z: write gravity = [{}, {}, {}], unless z is the depth",
                    x, y, -z
                ),
            );
        }
        for (number, block) in self.blocks.iter().enumerate() {
            if let Some((depth, stiffness)) = self.sinks(block) {
                let first = self.materials.first().map(|one| one.name.as_str());
                let material = block.material.as_deref().or(first).unwrap_or_default();
                warn(
                    format!("materials.{material}.normal_stiffness"),
                    format!(
                        "blocks[{number}] sinks into a plane of its material by {:.1} % of {} under its own weight: its \
                         contacts are too soft; use normal_stiffness ≥ {stiffness:.2e} Pa/m",
                        100.0 * depth,
                        match block.shape {
                            BlockShape::Sphere { .. } => "its radius",
                            _ => "half its least edge",
                        }
                    ),
                );
            }
        }
        for one in &self.materials {
            if one.tensile_strength > 0.0 && one.cohesion == 0.0 {
                warn(
                    format!("materials.{}.tensile_strength", one.name),
                    "under tension its bonds have no strength in shear, which is the cohesion: a bonded block slides off; give cohesion \
                     too"
                        .into(),
                );
            }
        }
        for (number, solid) in self.solids.iter().enumerate() {
            if self.is_lost_between_cells(solid) {
                warn(
                    format!("solids[{number}]"),
                    "fills no cell of the fluid, because it holds the centre of none: only blocks meet it; use surface = \"exact\", or a \
                     smaller domain.cell"
                        .into(),
                );
            }
        }
        // Formulas in time, which shake a tank, are not judged.
        let gravity = self.fluid.acceleration.each_ref().map(Formula::constant);
        if let ([Some(x), Some(y), Some(z)], true) = (gravity, self.has_particles()) {
            let is_level = z < 0.0 && -z >= x.hypot(y);
            let gauges = self
                .probes
                .iter()
                .filter(|probe| matches!(probe.place, ProbePlace::Gauge { .. }));
            for probe in gauges.filter(|_| !is_level) {
                warn(
                    format!("probes.{}", probe.name),
                    format!(
                        "it measures the level along z, and the water weighs along {:?} m/s²; use a line along this direction",
                        [x, y, z]
                    ),
                );
            }
        }
        for probe in &self.probes {
            let short = |every: &f64| *every < time_step * (1.0 - ROUNDED);
            if let Some(every) = probe.every.filter(short) {
                warn(
                    format!("probes.{}.every", probe.name),
                    format!(
                        "{every} s is shorter than the step of {time_step:.4e} s: it measures in each step; use every ≥ \
                         {time_step:.4e}"
                    ),
                );
            }
            let long = |every: &f64| *every > length * (1.0 + ROUNDED);
            if let Some(every) = probe.every.filter(long) {
                warn(
                    format!("probes.{}.every", probe.name),
                    format!(
                        "{every} s is longer than the run of {length:.6} s: it measures at the start and the end only"
                    ),
                );
            }
        }
        let materials = self.materials.iter();
        let materials =
            materials.map(|one| (format!("materials.{}", one.name), Some(one.friction)));
        let pairs = self.material_pairs.iter().enumerate();
        let pairs = pairs.map(|(n, pair)| (format!("material_pairs[{n}]"), pair.friction));
        for (place, friction) in materials.chain(pairs) {
            let tangent = |degrees: &f64| *degrees > 0.0 && *degrees < TANGENT;
            if let Some(degrees) = friction.filter(tangent) {
                warn(
                    format!("{place}.friction"),
                    format!(
                        "{degrees} is an angle in degrees; if it is tan φ, write friction = {:.1}",
                        degrees.atan().to_degrees()
                    ),
                );
            }
        }
        advice
    }

    /// The velocity face of the lattice that sends the largest pressure wave at t = 0, its normal speed (m/s), that pressure ρcΔU (Pa),
    /// and the free block, a box or sphere, for which it is larger than the submerged weight over the area.
    fn impulsive_start(&self, time_step: f64) -> Option<(Face, f64, f64, usize)> {
        if !self.has_fluid() || self.has_particles() || self.coupling.hold > 0.0 {
            return None;
        }
        let middle = self.centre(self.cells().map(|n| n / 2));
        let speed = |(face, boundary): (Face, &Boundary)| match boundary {
            Boundary::Velocity { velocity, .. } => {
                let normal = &velocity[face.axis().index()];
                let at_start = &self.initial.velocity[face.axis().index()];
                let [speed, own] = [normal, at_start].map(|of| of.eval_at(middle, 0.0));
                Some((face, speed.abs(), (speed - own).abs()))
            }
            _ => None,
        };
        let inlets = self.boundaries.iter().filter_map(speed);
        let (face, speed, change) = inlets.max_by(|a, b| a.2.total_cmp(&b.2))?;
        let sound = self.domain.cell / time_step / 3.0_f64.sqrt();
        let pressure = self.fluid.density * sound * change;
        let gravity = DVec3::from_array(self.rock.gravity).length();
        let is_light = |block: &Block| {
            let height = match &block.shape {
                BlockShape::Sphere { radius } => 4.0 / 3.0 * radius,
                BlockShape::Box { size: [a, b, c] } => a.min(*b).min(*c),
                _ => return false,
            };
            let density = self.material_of(block).map_or(0.0, |one| one.density);
            let weight = (density - self.fluid.density).max(0.0) * gravity * height;
            block.motion == Motion::Free && pressure > weight
        };
        let number = self.blocks.iter().position(is_light)?;
        (speed > 0.0).then_some((face, speed, pressure, number))
    }

    /// The material of a block, by default the first one.
    fn material_of(&self, block: &Block) -> Option<&Material> {
        match &block.material {
            Some(name) => self.materials.iter().find(|one| one.name == *name),
            None => self.materials.first(),
        }
    }

    /// Whether a box in the domain of a lattice contains the centre of no cell, and fills none in part.
    fn is_lost_between_cells(&self, solid: &Solid) -> bool {
        let Shape::Box { min, max } = &solid.shape else {
            return false;
        };
        if !self.has_fluid() || self.has_particles() || solid.is_exact() || solid.void {
            return false;
        }
        let cells = self.cells();
        let [low, high] = [self.centre([0; 3]), self.centre(cells.map(|n| n - 1))];
        let half = 0.5 * self.domain.cell;
        let each = |a: usize| [min[a].max(low[a] - half), max[a].min(high[a] + half)];
        let is_inside = |[from, to]: [f64; 2]| to - from > ROUNDED * self.domain.cell;
        let misses = |a: usize| {
            let [from, to] = each(a).map(|at| (at - low[a]) / self.domain.cell);
            (from - ROUNDED).ceil() > (to + ROUNDED).floor()
        };
        (0..3).all(|a| is_inside(each(a))) && (0..3).any(misses)
    }

    /// Overlap of a free box or sphere at rest with a plane of its own material, as a fraction of half its smallest edge or of
    /// its radius, and the stiffness that reduces this overlap to [`SINKS`], Pa/m; `None` if the overlap is not larger than
    /// that.
    ///
    /// The contact force is k_n A(u) u at the depth u (Hart, Cundall & Lemos 1988). A is the largest face of a box, and for a
    /// sphere the circle that the plane cuts out, π u (2R − u), but not less than `rock.corner_area` (2R)². In a fluid the
    /// weight is the submerged weight.
    fn sinks(&self, block: &Block) -> Option<(f64, f64)> {
        let material = self.material_of(block)?;
        if block.motion != Motion::Free {
            return None;
        }
        let (volume, size) = match &block.shape {
            BlockShape::Sphere { radius } => (4.0 / 3.0 * PI * radius.powi(3), *radius),
            BlockShape::Box { size: [a, b, c] } => (a * b * c, 0.5 * a.min(*b).min(*c)),
            _ => return None,
        };
        let area = |depth: f64| match &block.shape {
            BlockShape::Sphere { radius } => {
                let circle = PI * depth * (2.0 * radius - depth);
                circle.max(self.rock.corner_area * (2.0 * radius).powi(2))
            }
            _ => 0.5 * volume / size,
        };
        let fluid = if self.has_fluid() {
            self.fluid.density
        } else {
            0.0
        };
        let gravity = DVec3::from_array(self.rock.gravity).length();
        let weight = (material.density - fluid).max(0.0) * volume * gravity;
        let limit = SINKS * size;
        let needed = weight / (area(limit) * limit);
        if needed <= material.normal_stiffness * (1.0 + ROUNDED) {
            return None;
        }
        // k A(u) u grows with u: bisection up to `size`, beyond which the block falls through.
        let presses = |depth: f64| material.normal_stiffness * area(depth) * depth;
        let (mut low, mut high) = (limit, size);
        for _ in 0..40 {
            let middle = 0.5 * (low + high);
            match presses(middle) < weight {
                true => low = middle,
                false => high = middle,
            }
        }
        Some((high / size, needed))
    }

    /// Accelerations of a lattice fluid and of blocks, m/s², if their directions differ; for particles every difference is reported
    /// where the blocks are known.
    fn gravities(&self) -> Option<([f64; 3], [f64; 3])> {
        let rock = self.rock.gravity;
        let constant = self.fluid.acceleration.each_ref().map(|a| a.constant());
        let [Some(x), Some(y), Some(z)] = constant else {
            return None;
        };
        let coupled = self.has_blocks() && self.has_fluid() && !self.has_particles();
        let [a, g] = [[x, y, z], rock].map(DVec3::from_array);
        let weighs = a.length() >= GRAVITY * g.length() && g != DVec3::ZERO;
        let apart = a.angle_between(g).sin() > ROUNDED || a.dot(g) < 0.0;
        (coupled && weighs && apart).then_some(([x, y, z], rock))
    }
}
