//! The inertia of the fluid: inside a block, and the added mass around it.

use super::{FluidLoad, fluid_load::add_loads};
use crate::geometry::{Load, Pose, skew};
use crate::psm::spin;
use crate::rock::integrate::Principal;
use glam::{DMat3, DVec3};

/// Upper bounds of the added mass and the added inertia of a block, as ratios to the mass and the inertia of the fluid
/// that it displaces.
///
/// For a box with the block's inertia and the edges a ≤ b ≤ c, ⅔ √(bc)/a bounds the added mass of potential flow, whose
/// coefficient is 1/2 for a sphere, 2/3 for a cube, and 0.48 √(bc)/a for a thin disc (Lamb 1932, art. 102); ½ √(bc)/a
/// bounds the added inertia. A viscous layer that moves with the block extends the box on each side, to G times its
/// volume. It adds G − 1 to the mass coefficient and scales the potential-flow term by G; the inertia coefficient grows by
/// 1.5 (G^(5/3) − 1). A bound above the actual value slows the response to sound, which then drives a light block between
/// walls: for a cube of eight cells the bounds are 2.3 and 3.6; with half the density of the fluid, 5 and 10 were unstable.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct AddedMass {
    /// Added mass over displaced mass.
    pub mass: f64,
    /// Added inertia over displaced inertia.
    pub inertia: f64,
}

impl AddedMass {
    /// Bounds for a block of volume `volume` (m³) and inertia tensor `inertia` for a density of one (m⁵). `layer` (m) is
    /// the thickness of the viscous layer: at least a cell, or the diffusion length between two exchanges.
    pub fn bound(volume: f64, inertia: DMat3, layer: f64) -> Self {
        let moments = Principal::of(inertia).moments;
        // For a box, I_x = V (b² + c²)/12.
        let squares = (0.5 * moments.element_sum() - moments) * (12.0 / volume);
        let mut edges = squares.to_array().map(|square| square.max(0.0).sqrt());
        edges.sort_by(f64::total_cmp);
        let [a, b, c] = edges;
        let [p, q, r] = edges.map(|edge| edge + 2.0 * layer);
        let growth = p * q * r / (a * b * c);
        let slenderness = (q * r).sqrt() / p;
        Self {
            mass: growth - 1.0 + 2.0 / 3.0 * slenderness * growth,
            inertia: 1.5 * (growth.powf(5.0 / 3.0) - 1.0) + 0.5 * slenderness,
        }
    }
}

/// Mass properties of a block.
#[derive(Clone, Copy, Debug)]
pub struct MassProperties {
    /// Mass, kg.
    pub mass: f64,
    /// Volume, m³.
    pub volume: f64,
    /// Inertia tensor for a density of one, world axes, m⁵.
    pub inertia: DMat3,
    /// Gravity, m/s².
    pub gravity: DVec3,
    /// Bounds of the added mass.
    pub added: AddedMass,
}

/// Compensates the inertia of the fluid inside a block, and stabilises the added mass of the fluid around it.
///
/// The fluid inside a block moves with the block, and its inertia is part of the load on the cells. The mass of the block
/// is that of the rock alone, so the inertia m_f dv/dt since the last exchange is returned to the block, with m_f = ρ Σε.
/// ρ ΣB would be too small: the fluid in surface cells follows too, with a delay, and at low viscosity B is small there.
/// Inertia returned before the fluid has followed accelerates the block; a light one diverges. Therefore m_f is at most
/// ρ ΣB + m/2, and for rotation, to which surface cells contribute most, (ρ ΣB + m)/2.
///
/// The loads respond to the motion in the previous step. The added mass m_a of a block lighter than it then excites a
/// growing oscillation. The block is advanced as if it had the additional virtual mass m_v, and receives m_v times its
/// previous acceleration (Schwarz, Kempe & Fröhlich 2015, J. Comput. Phys. 281:591):
/// (m + m_v) a = F + m_f dv/dt + m g + m_v a_before. That is stable for m_a < m + 2 m_v, which determines m_v, and
/// has no effect on a steady acceleration. Contact forces are not part of a; they act on the rock alone.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[cfg_attr(feature = "checkpoint", derive(serde::Serialize, serde::Deserialize))]
pub struct InteriorInertia {
    /// Velocity and spin at the last exchange, m/s and rad/s; `None` before the first one.
    velocity: Option<[DVec3; 2]>,
    /// Result of the last exchange: acceleration due to fluid and gravity, m/s², and torque over the density of the
    /// rock, m⁵/s². For a block with prescribed motion: its linear and angular acceleration, m/s² and rad/s².
    response: [DVec3; 2],
}

impl InteriorInertia {
    /// The load under which the rock alone moves as it does together with the fluid inside it. `cell_load` is the mean
    /// over the last `dt` (s), `density` (kg/m³) is that of the fluid.
    pub fn load(
        &mut self,
        cell_load: &FluidLoad,
        pose: &Pose,
        properties: &MassProperties,
        density: f64,
        dt: f64,
    ) -> Load {
        let load = add_loads(cell_load.flow, cell_load.buoyancy);
        let is_initialised = self.is_initialised();
        let [linear, angular] = self.accelerations(pose, dt);

        // Densities: masses over the volume of the block.
        let rock = properties.mass / properties.volume;
        let displaced = density * (load.entrained + load.missing) / properties.volume;
        let entrained = density * load.entrained / properties.volume;
        let interior = displaced.min(entrained + 0.5 * rock);
        let interior_rotation = displaced.min(0.5 * (entrained + rock));
        let [virtual_mass, virtual_inertia] = [properties.added.mass, properties.added.inertia]
            .map(|bound| 0.5 * (bound * displaced - rock).max(0.0));
        let force = load.force / properties.volume + interior * linear + rock * properties.gravity;
        // At the start: the acceleration due to weight and buoyancy.
        let [acceleration_before, torque_before] = if is_initialised {
            self.response
        } else {
            [
                cell_load.buoyancy.force / properties.mass + properties.gravity,
                cell_load.buoyancy.torque() / rock,
            ]
        };
        let acceleration = (force + virtual_mass * acceleration_before) / (rock + virtual_mass);
        let torque = load.torque() + interior_rotation * (properties.inertia * angular);
        let response = (torque + virtual_inertia * torque_before) / (rock + virtual_inertia);
        self.response = [acceleration, response];
        Load {
            force: properties.mass * (acceleration - properties.gravity),
            // A torque is the skew part of a moment.
            moment: load.moment + 0.5 * skew(rock * response - load.torque()),
            ..load
        }
    }

    /// Whether an exchange has taken place.
    pub fn is_initialised(&self) -> bool {
        self.velocity.is_some()
    }

    /// Linear and angular acceleration over the last `dt` (s), m/s² and rad/s².
    fn accelerations(&mut self, pose: &Pose, dt: f64) -> [DVec3; 2] {
        let now = [pose.velocity, spin(pose)];
        let before = self.velocity.replace(now);
        before.map_or([DVec3::ZERO; 2], |[velocity, spin]| {
            [(now[0] - velocity) / dt, (now[1] - spin) / dt]
        })
    }

    /// Updates the accelerations of a block with prescribed motion.
    pub fn prescribe_motion(&mut self, pose: &Pose, dt: f64) {
        self.response = self.accelerations(pose, dt);
    }

    /// The load of the exterior fluid on a block with prescribed motion: its cell load without the inertia of the fluid
    /// inside it. `inertia` (m⁵) is the tensor of the shape.
    pub fn external_load(
        &self,
        cell_load: &FluidLoad,
        inertia: DMat3,
        volume: f64,
        density: f64,
    ) -> Load {
        let flow = cell_load.flow;
        let displaced = density * (flow.entrained + flow.missing);
        let [linear, angular] = self.response;
        let torque = displaced / volume * (inertia * angular);
        Load {
            force: flow.force + displaced * linear,
            moment: flow.moment + 0.5 * skew(torque),
            ..flow
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::DQuat;

    /// A block of 2 m³ in water, with the ratio of its density to that of water.
    fn block(ratio: f64) -> (MassProperties, Load) {
        let properties = MassProperties {
            mass: 2000.0 * ratio,
            volume: 2.0,
            inertia: DMat3::from_diagonal(DVec3::new(1.0, 2.0, 3.0)),
            gravity: DVec3::Z * -10.0,
            added: AddedMass {
                mass: 5.0,
                inertia: 10.0,
            },
        };
        let load = Load {
            entrained: 1.5,
            missing: 0.5,
            ..Load::default()
        };
        (properties, load)
    }

    fn flow(flow: Load) -> FluidLoad {
        let buoyancy = Load::default();
        FluidLoad { flow, buoyancy }
    }

    fn pose(velocity: DVec3, spin: DVec3) -> Pose {
        Pose::rigid(DVec3::ZERO, DQuat::IDENTITY, velocity, spin)
    }

    #[test]
    fn a_steady_load_is_unchanged() {
        let (properties, mut load) = block(0.5);
        load.force = DVec3::new(3.0, 0.0, 20_000.0);
        load.moment = skew(DVec3::new(1.0, -2.0, 5.0)) * 0.5;
        let mut interior = InteriorInertia::default();
        let mut found = Load::default();
        for _ in 0..500 {
            found = interior.load(
                &flow(load),
                &pose(DVec3::X, DVec3::Y),
                &properties,
                1000.0,
                0.1,
            );
        }
        assert!(
            (found.force - load.force).length() < 1e-9,
            "{}",
            found.force
        );
        assert!((found.torque() - load.torque()).length() < 1e-9);
    }

    #[test]
    fn the_interior_inertia_is_compensated() {
        let (properties, mut load) = block(2.5);
        let (dt, rate, angular_rate) = (0.1, DVec3::new(2.0, 0.0, -1.0), DVec3::new(0.0, 0.5, 2.0));
        load.force = -1000.0 * 2.0 * rate;
        load.moment = 0.5 * skew(-1000.0 * (properties.inertia * angular_rate));
        let mut interior = InteriorInertia::default();
        let mut found = Load::default();
        for n in 0..200 {
            let t = dt * f64::from(n);
            found = interior.load(
                &flow(load),
                &pose(t * rate, t * angular_rate),
                &properties,
                1000.0,
                dt,
            );
        }
        assert!(found.force.length() < 1e-9, "{}", found.force);
        assert!(found.torque().length() < 1e-9, "{}", found.torque());
    }

    /// m v' = F − m_a v' with the added mass one step late: without virtual mass it grows by m_a/m per step.
    #[test]
    fn light_blocks_do_not_oscillate() {
        let (properties, mut load) = block(0.5);
        let (dt, added, force) = (0.1, 2500.0, DVec3::X * 1000.0);
        let mut interior = InteriorInertia::default();
        let (mut velocity, mut before) = (DVec3::ZERO, DVec3::ZERO);
        for _ in 0..200 {
            let rate = (velocity - before) / dt;
            load.force = force - (added + 2000.0) * rate - properties.mass * properties.gravity;
            let found = interior.load(
                &flow(load),
                &pose(velocity, DVec3::ZERO),
                &properties,
                1000.0,
                dt,
            );
            before = velocity;
            velocity += (found.force / properties.mass + properties.gravity) * dt;
        }
        let rate = (velocity - before) / dt;
        assert!(
            (rate - force / (properties.mass + added)).length() < 1e-9,
            "{rate}"
        );
    }
}
