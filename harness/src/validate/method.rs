//! How a case is computed, where it leaves that open.

use riprap::{
    lattice::{self, Setup},
    scene::{self, Scene},
};
use std::fmt;

/// A setting: what it changes of the defaults of a lattice, or of a scene.
#[derive(Clone, Copy)]
pub struct Method {
    /// What it is called.
    pub name: &'static str,
    flow: fn(&mut Setup),
    scene: fn(&mut Scene),
}

impl Method {
    /// As the library has it by default.
    pub const DEFAULT: Self = Self::of("default", |_| {}, |_| {});
    /// One relaxation time.
    pub const BGK: Self = Self::of(
        "bgk",
        |flow| {
            flow.collision = lattice::Collision::Bgk;
            flow.wall_lambda = None;
        },
        |scene| scene.numerics.collision = scene::Collision::Bgk,
    );
    /// The operator of Suga et al. (2015).
    pub const SUGA: Self = Self::of(
        "suga",
        |flow| {
            flow.collision = lattice::Collision::Suga;
            flow.wall_lambda = None;
        },
        |scene| scene.numerics.collision = scene::Collision::Suga,
    );
    /// Λ = 3/16 everywhere (Ginzburg & d'Humières 2003).
    pub const MAGIC: Self = Self::of(
        "Λ = 3/16",
        |flow| flow.lambda = Some(3.0 / 16.0),
        |scene| scene.numerics.lambda = Some(3.0 / 16.0),
    );
    /// Equilibrium to second order.
    pub const ORDER_2: Self = Self::of(
        "order 2",
        |flow| flow.equilibrium = lattice::Equilibrium::SecondOrder,
        |scene| scene.numerics.equilibrium = scene::Equilibrium::SecondOrder,
    );
    /// Two bytes a population.
    pub const HALF: Self = Self::of(
        "16-bit",
        |flow| {
            flow.storage = lattice::Storage::F16;
            // Two values share a word.
            flow.lanes = flow.lanes.max(2);
        },
        |scene| scene.numerics.storage = scene::Storage::F16,
    );
    /// The solid operator of Noble & Torczynski (1998).
    pub const NOBLE: Self = Self::of(
        "noble",
        |_| {},
        |scene| scene.numerics.solid_operator = scene::SolidOperator::Noble,
    );
    /// Their second one.
    pub const SUPERPOSITION: Self = Self::of(
        "superposition",
        |_| {},
        |scene| scene.numerics.solid_operator = scene::SolidOperator::Superposition,
    );
    /// The weight of Noble & Torczynski (1998).
    pub const STANDARD_WEIGHT: Self = Self::of(
        "standard weight",
        |_| {},
        |scene| scene.numerics.solid_weight = Some(scene::SolidWeight::Standard),
    );
    /// Fluid and blocks meet every second step.
    pub const EVERY_2: Self = Self::of("interval 2", |_| {}, |scene| scene.coupling.interval = 2);
    /// Every eighth step.
    pub const EVERY_8: Self = Self::of("interval 8", |_| {}, |scene| scene.coupling.interval = 8);

    const fn of(name: &'static str, flow: fn(&mut Setup), scene: fn(&mut Scene)) -> Self {
        Self { name, flow, scene }
    }

    /// Changes a lattice that has the defaults.
    pub fn arrange(&self, flow: &mut Setup) {
        (self.flow)(flow);
    }

    /// Changes a scene that has the defaults.
    pub fn choose(&self, scene: &mut Scene) {
        (self.scene)(scene);
    }
}

impl fmt::Debug for Method {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name)
    }
}
