//! Numbers that sum up all blocks.

use super::{super::recorder::Notes, Rock};
use riprap::{bodies::Ledger, scene::Quantity};

/// The present values of `quantities`, those of blocks from `rock`, the others from `of_fluid`.
pub fn values(
    rock: Option<Rock<'_>>,
    quantities: &[Quantity],
    notes: &mut Notes,
    of_fluid: impl Fn(Quantity) -> f64,
) -> Vec<f64> {
    let Some(rock) = rock else {
        return quantities.iter().map(|q| of_fluid(*q)).collect();
    };
    notes.block_speed = notes.block_speed.max(rock.max_speed());
    let ledger = rock.blocks.ledger();
    let value = |quantity: &Quantity| match quantity.is_of_blocks() {
        true => value(&rock, *quantity, &ledger),
        false => of_fluid(*quantity),
    };
    quantities.iter().map(value).collect()
}

/// A quantity of blocks; NaN for one of the fluid.
fn value(rock: &Rock<'_>, quantity: Quantity, ledger: &Ledger) -> f64 {
    match quantity {
        Quantity::BlockKineticEnergy => ledger.kinetic,
        Quantity::BlockPotentialEnergy => ledger.potential - rock.start.potential,
        Quantity::StrainEnergy => ledger.strain,
        Quantity::ContactEnergy => ledger.elastic,
        Quantity::FrictionWork => ledger.friction,
        Quantity::DampingWork => ledger.dashpot + ledger.mass_damping + ledger.film + ledger.lost,
        Quantity::OutsideWork => ledger.driven + ledger.loads,
        Quantity::EnergyError => rock.energy_error(ledger),
        Quantity::Contacts => rock.blocks.contacts().count() as f64,
        Quantity::AwakeBlocks => rock.awake() as f64,
        Quantity::BlockMaxSpeed => rock.max_speed(),
        Quantity::MaxVonMises => {
            let stresses = (0..rock.shown).filter_map(|block| rock.blocks.von_mises(block));
            stresses.fold(0.0, f64::max)
        }
        _ => f64::NAN,
    }
}

impl Rock<'_> {
    /// What the balance of energies has lost or gained since the start, as a part of what has been
    /// turned over: of the kinetic energy now, the fall of the potential one, the strain, and all that
    /// was taken.
    pub fn energy_error(&self, now: &Ledger) -> f64 {
        let change = now.balance() - self.start.balance();
        let turned = now.kinetic
            + self.start.kinetic
            + (now.potential - self.start.potential).abs()
            + (now.strain - self.start.strain).abs()
            + now.elastic.abs()
            + now.friction
            + now.dashpot
            + now.mass_damping
            + now.film
            + now.driven.abs()
            + now.loads.abs();
        if turned > 0.0 { change / turned } else { 0.0 }
    }
}
