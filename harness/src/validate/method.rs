//! Numerical methods for cases that leave the choice open.

use riprap::{
    lattice::{self, Setup},
    scene::{self, Scene},
};
use std::fmt;

/// A named change to the defaults of a lattice or of a scene.
#[derive(Clone, Copy)]
pub struct Method {
    /// Name of the method.
    pub name: &'static str,
    flow: fn(&mut Setup),
    scene: fn(&mut Scene),
}

impl Method {
    /// The defaults of the library.
    pub const DEFAULT: Self = Self::of("default", |_| {}, |_| {});
    /// The BGK operator, with one relaxation time.
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
    /// Two bytes per population.
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
    /// The second solid operator of Noble & Torczynski (1998).
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
    /// Fluid and blocks are coupled every second step.
    pub const EVERY_2: Self = Self::of("interval 2", |_| {}, |scene| scene.coupling.interval = 2);
    /// Fluid and blocks are coupled every eighth step.
    pub const EVERY_8: Self = Self::of("interval 8", |_| {}, |scene| scene.coupling.interval = 8);

    const fn of(name: &'static str, flow: fn(&mut Setup), scene: fn(&mut Scene)) -> Self {
        Self { name, flow, scene }
    }

    /// Applies the method to a lattice that has the defaults.
    pub fn arrange(&self, flow: &mut Setup) {
        (self.flow)(flow);
    }

    /// Applies the method to a scene that has the defaults.
    pub fn choose(&self, scene: &mut Scene) {
        (self.scene)(scene);
    }
}

impl fmt::Debug for Method {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name)
    }
}
