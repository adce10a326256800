//! The blocks of a scene in its lattice.

use super::{Company, Felt, Gap, Inside, Rock, Wet, faces::asked, gaps::gaps, inlets::AtInlet};
use crate::{
    Result,
    bodies::{Blocks, Motion},
    coupling::film::film,
    immersed::{Immersed, Submerged, Work},
    lattice::Lattice,
    scene::Scene,
    simulation::BlockSetup,
    units::Units,
};

/// How often fluid and blocks met since the start or the last restart.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Exchanges {
    /// Times that the host waited for loads: at the ends of steps after which blocks moved, or were asked for.
    pub readings: u64,
    /// What was computed of the blocks' cells.
    pub cells: Work,
}

/// Blocks in a fluid on a lattice.
#[derive(Debug)]
pub struct Coupled {
    pub(super) rock: Rock,
    pub(super) wet: Wet,
    /// Blocks in the fluid, the first ones; the others are walls and solids, which the lattice has already.
    in_fluid: usize,
    /// Those narrower than a cell at the start.
    gaps: Vec<Gap>,
    /// Blocks in the fluid about whose faces a probe asks.
    pub(super) asked: Vec<bool>,
    /// Blocks that lie where fluid enters at the start.
    pub(super) began: Vec<AtInlet>,
}

impl Coupled {
    /// The blocks of a scene, as `setup` has them, in its lattice.
    ///
    /// # Errors
    /// What the blocks or the device lack.
    pub async fn new(
        device: &wgpu::Device,
        queue: &wgpu::Queue,
        lattice: &Lattice,
        (scene, units): (&Scene, &Units),
        setup: BlockSetup,
    ) -> Result<Self> {
        let mut setup = setup;
        setup.setup.film = film(scene, units, &setup.setup.blocks);
        let in_fluid = setup.in_fluid;
        let held = (scene.coupling.hold / units.time_step).round();
        let company = Company {
            time_step: units.time_step,
            // Times of steps are rounded.
            hold: (held - 0.5) * units.time_step,
            inside: Some(Inside {
                density: scene.fluid.density,
                layer: units.cell,
            }),
        };
        let mut rock = Rock::new(device, queue, scene, setup, company).await?;
        let gaps = gaps(
            &rock.setup.setup,
            &rock.blocks,
            in_fluid,
            units.cell,
            &mut rock.finder,
        )
        .await?;
        let all = &rock.setup.setup.blocks;
        let blocks = &all[..in_fluid];
        let probes = blocks.iter().map(|block| asked(scene, &block.name));
        let probes: Vec<[bool; 2]> = probes.collect();
        let submerged = blocks.iter().zip(&probes);
        let submerged = submerged.map(|(block, [followed, faces])| Submerged {
            shape: block.shape.clone(),
            loaded: block.motion != Motion::Fixed || *followed,
            faces: *faces,
        });
        let submerged = submerged.collect();
        let period = rock.blocks.period();
        let mut coupled = Self {
            wet: Wet::new(device, lattice, (scene, units), submerged, period)?,
            rock,
            in_fluid,
            gaps,
            asked: probes.into_iter().map(|[_, faces]| faces).collect(),
            began: Vec::new(),
        };
        coupled.began = coupled.will_be_at_inlets(scene, units);
        Ok(coupled)
    }

    /// The rock, and its side of the fluid.
    pub(crate) fn sides(&mut self) -> (&mut Rock, &mut Wet) {
        (&mut self.rock, &mut self.wet)
    }

    /// Whether a block can move at all.
    pub fn moves(&self) -> bool {
        self.rock.moves()
    }

    /// What the fluid around each block does to it, of the last reading: what moves it beside its weight and its contacts.
    pub fn around(&self) -> &[Felt] {
        self.rock.around()
    }

    /// What each block feels of the fluid, of the last reading, the inertia of the fluid inside its cells included.
    pub fn felt(&self) -> &[Felt] {
        self.rock.felt()
    }

    /// The blocks as they are.
    pub fn blocks(&self) -> &Blocks {
        self.rock.blocks()
    }

    /// The blocks as they were made.
    pub fn setup(&self) -> &BlockSetup {
        self.rock.setup()
    }

    /// Number of blocks that are in the fluid, the first ones; the others are its solids and walls.
    pub fn in_fluid(&self) -> usize {
        self.in_fluid
    }

    /// The pairs of blocks, one of them in the fluid, that were less than a cell apart at the start.
    pub fn gaps(&self) -> &[Gap] {
        &self.gaps
    }

    /// Their cells.
    pub fn immersed(&self) -> &Immersed {
        &self.wet.immersed
    }

    /// How often fluid and blocks met.
    pub fn exchanges(&self) -> Exchanges {
        Exchanges {
            readings: self.rock.meetings(),
            cells: self.wet.immersed.work(),
        }
    }
}
