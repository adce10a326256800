//! A rock mass at rest under its weight: the scene for timing contacts and steps.

use glam::DVec3;
use riprap::{
    Result,
    geometry::{Form, HalfSpace, JointSet, RockMass, Scatter, Shape},
    rock::{
        Block, Blocks, Material, Setup,
        broadphase::{Broadphase, HostBroadphase},
        contact::Placed,
        law::Joint,
    },
};

use std::sync::Arc;

/// Layers of blocks of about 1 m: piles grow sideways, so that the weight settles in the same number of steps in all of
/// them, and the fraction of blocks at the walls has little effect on the cost.
const LAYERS: f64 = 6.0;
/// Width of the bedrock around the free blocks, m.
const BEDROCK: f64 = 1.0;
/// Mass damping, 1/s. A column of height H oscillates at πc/2H = 160 rad/s, c = √(k_n h/ρ) = 614 m/s,
/// and the pile, which is sheared as well, at half of that: twice its frequency is critical damping.
const DAMPING: f64 = 150.0;

/// Largest speed of a block at rest, m/s: at steps of some 1e-5 s it moves by 1e-7 of its size in one.
const REST: f64 = 3e-3;
/// Steps after which a pile is used even if it still moves.
const MOST_STEPS: u64 = 4000;

/// A pile of blocks.
pub struct Pile {
    /// The blocks, with pairs and contacts.
    pub blocks: Blocks,
    /// Blocks that can move.
    pub free: usize,
    /// Steps that it took to come to rest.
    pub steps: u64,
    setup: Setup,
}

impl Pile {
    /// About `count` free blocks as cut, not yet settled.
    pub fn fresh(count: usize) -> Result<Self> {
        let setup = jointed(count)?;
        let blocks = Blocks::new(setup.clone())?;
        Ok(Self {
            free: (0..blocks.len()).filter(|&i| blocks.moves(i)).count(),
            steps: 0,
            blocks,
            setup,
        })
    }

    /// About `count` free blocks at rest.
    pub fn settled(count: usize) -> Result<Self> {
        let mut pile = Self::fresh(count)?;
        while pile.blocks.steps() < MOST_STEPS {
            for _ in 0..20 {
                pile.step()?;
            }
            if pile.blocks.largest_speed() < REST {
                break;
            }
        }
        pile.steps = pile.blocks.steps();
        Ok(pile)
    }

    /// Takes one step, after an update of the pairs if necessary.
    pub fn step(&mut self) -> Result<()> {
        self.find_pairs()?;
        self.blocks.step()
    }

    /// Updates the pairs if necessary; returns whether it was.
    pub fn find_pairs(&mut self) -> Result<bool> {
        let wanted = self.blocks.needs_pairs();
        if wanted {
            let pairs = pollster::block_on(HostBroadphase.pairs(&self.blocks.aabbs()))?;
            self.blocks.set_pairs(pairs)?;
        }
        Ok(wanted)
    }

    /// The same blocks at their present poses, without velocities, pairs and contacts.
    pub fn apart(&self) -> Result<Blocks> {
        let mut setup = self.setup.clone();
        let poses = self.blocks.poses();
        for (i, (block, pose)) in setup.blocks.iter_mut().zip(poses).enumerate() {
            (block.centre, block.rotation) = (pose.centre, self.blocks.rotation(i));
        }
        Blocks::new(setup)
    }

    /// All blocks at their present poses, as input of the contact search.
    pub fn placed(&self) -> Vec<Placed> {
        let both = self.setup.blocks.iter().zip(self.blocks.poses());
        let placed = both.flat_map(|(block, pose)| {
            block.shape.parts().iter().map(move |part| {
                let mut placed = Placed::default();
                match &part.form {
                    Form::Convex(shape) => placed.update(shape, part.offset, &pose),
                    Form::Sphere { radius } => placed.update_sphere(*radius, part.offset, &pose),
                }
                placed
            })
        });
        placed.collect()
    }

    /// The joint properties of every pair of blocks.
    pub fn joint(&self) -> &Joint {
        &self.setup.materials[0].joint
    }
}

/// Three oblique joint sets of 1 m with scattered spacing.
pub fn joint_sets() -> Vec<JointSet> {
    let set = |dip, dip_direction, seed| JointSet {
        dip,
        dip_direction,
        spacing: 1.0,
        scatter: Scatter::Uniform { range: 0.2 },
        origin: DVec3::splat(0.123),
        seed,
        persistence: None,
    };
    vec![set(8.0, 20.0, 1), set(80.0, 100.0, 2), set(85.0, 195.0, 3)]
}

/// Rock cut by three joint sets of 1 m. The blocks at the sides and below are fixed bedrock, those that the top of the
/// box cuts are removed, the others are free.
fn jointed(count: usize) -> Result<Setup> {
    // A box one spacing wider holds that many whole blocks.
    let half = 0.5 * ((count as f64 / LAYERS).sqrt() + 1.0);
    let (low, high) = (
        DVec3::new(-half, -half, 0.0),
        DVec3::new(half, half, LAYERS + 1.0),
    );
    let axes = [DVec3::X, DVec3::Y, DVec3::Z];
    let sides = axes.into_iter().flat_map(|axis| {
        [
            HalfSpace::through(low - BEDROCK, -axis),
            HalfSpace::through(high + BEDROCK, axis),
        ]
    });
    let mass = RockMass {
        joints: joint_sets(),
        ..RockMass::new(vec![sides.collect()])
    };
    let mut blocks = Vec::new();
    for (n, fragment) in mass.cut()?.blocks.into_iter().enumerate() {
        let corners = fragment.shape.vertices().iter();
        let corners: Vec<_> = corners.map(|v| fragment.centre + *v).collect();
        if corners.iter().any(|corner| corner.z > high.z) {
            continue;
        }
        let shape: Arc<Shape> = Arc::new(fragment.shape.into());
        let block = Block::new(format!("{n}"), shape, fragment.centre);
        let free = corners
            .iter()
            .all(|c| c.cmpge(low).all() && c.cmple(high).all());
        blocks.push(if free { block } else { block.fixed() });
    }
    Ok(Setup {
        blocks,
        materials: vec![Material {
            joint: Joint {
                friction_angle: 35f64.to_radians(),
                ..Joint::default()
            },
            ..Material::default()
        }],
        damping: DAMPING,
        ..Setup::default()
    })
}
