//! Numbers that sum up all blocks.

use super::{super::recorder::RunLog, Rock};
use riprap::{rock::EnergyLedger, scene::Quantity};

/// The present values of `quantities`, those of blocks from `rock`, the others from `of_fluid`.
pub fn values(
    rock: Option<Rock<'_>>,
    quantities: &[Quantity],
    log: &mut RunLog,
    of_fluid: impl Fn(Quantity) -> f64,
) -> Vec<f64> {
    let Some(rock) = rock else {
        return quantities.iter().map(|q| of_fluid(*q)).collect();
    };
    log.block_speed = log.block_speed.max(rock.max_speed());
    let ledger = rock.blocks.ledger();
    let value = |quantity: &Quantity| match quantity.is_of_blocks() {
        true => value(&rock, *quantity, &ledger),
        false => of_fluid(*quantity),
    };
    quantities.iter().map(value).collect()
}

/// A quantity of blocks; NaN for one of the fluid.
fn value(rock: &Rock<'_>, quantity: Quantity, ledger: &EnergyLedger) -> f64 {
    match quantity {
        Quantity::BlockKineticEnergy => ledger.kinetic,
        Quantity::BlockPotentialEnergy => ledger.potential - rock.start.potential,
        Quantity::StrainEnergy => ledger.strain,
        Quantity::ContactEnergy => ledger.elastic,
        Quantity::FrictionWork => ledger.friction,
        Quantity::DampingWork => ledger.dashpot + ledger.mass_damping + ledger.film,
        Quantity::ContactLoss => ledger.lost,
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
    /// turned over. The balance counts what ended contacts held, [`EnergyLedger::lost`].
    pub fn energy_error(&self, now: &EnergyLedger) -> f64 {
        self.part_of_turnover(now, now.balance() - self.start.balance())
    }

    /// What contacts held when they ended, as a part of what has been turned over: the error of the contact law, positive
    /// where it takes energy out.
    pub fn contact_loss(&self, now: &EnergyLedger) -> f64 {
        self.part_of_turnover(now, now.lost - self.start.lost)
    }

    /// `energy` as a part of what has been turned over: the kinetic energy now and at the start, the change of the
    /// potential one, the strain, all that was taken, and what was put in.
    fn part_of_turnover(&self, now: &EnergyLedger, energy: f64) -> f64 {
        let turned = now.kinetic
            + self.start.kinetic
            + (now.potential - self.start.potential).abs()
            + (now.strain - self.start.strain).abs()
            + now.elastic.abs()
            + now.friction
            + now.dashpot
            + now.mass_damping
            + now.film
            + now.lost.abs()
            + now.driven.abs()
            + now.loads.abs();
        if turned > 0.0 { energy / turned } else { 0.0 }
    }
}
