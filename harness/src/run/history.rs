//! Sums over the fluid in time: `history.csv` and `history.png`.

use super::{
    engine::Engine,
    probes::table,
    recorder::{Notes, Recorder},
    schedule::Schedule,
};
use crate::picture::{Chart, Track};
use anyhow::Result;
use riprap::{
    output::{Csv, Table},
    scene::{self, Quantity},
    simulation::Totals,
};
use std::path::{Path, PathBuf};

/// Points of a curve where the scene does not say how many: enough for a picture.
const POINTS: f64 = 200.0;

pub struct History {
    schedule: Schedule,
    quantities: Vec<Quantity>,
    path: PathBuf,
    table: Csv,
}

impl History {
    /// Begins the table of the history of this number, or goes on with it after a restart.
    pub fn new(engine: &Engine, folder: &Path, last: u64, number: usize) -> Result<Self> {
        let simulation = &engine.simulation;
        let history = &simulation.scene().output.histories[number];
        let path = folder.join(format!("{}.csv", name(number)));
        let columns: Vec<&str> = history.quantities.iter().map(|q| about(*q).0).collect();
        // Of the scene's run, not of `--steps`: a run in parts has one table.
        let usual = simulation.scene().run.duration(simulation.units()) / POINTS;
        let every = history.every.or(Some(usual));
        Ok(Self {
            schedule: Schedule::new(every, simulation.units(), last),
            quantities: history.quantities.clone(),
            table: table(engine, &path, &columns)?,
            path,
        })
    }
}

/// Name of the files of a history: `history`, `history_2`, ….
pub fn name(number: usize) -> String {
    match number {
        0 => "history".into(),
        _ => format!("history_{}", number + 1),
    }
}

/// Whether a probe of this name would overwrite a history.
pub fn claims(histories: &[scene::History], probe: &str) -> bool {
    (0..histories.len()).any(|number| name(number) == probe)
}

/// Name and unit of a quantity.
pub fn about(quantity: Quantity) -> (&'static str, &'static str) {
    match quantity {
        Quantity::KineticEnergy => ("kinetic energy", "J"),
        Quantity::Enstrophy => ("enstrophy", "m³/s²"),
        Quantity::Mass => ("mass", "kg"),
        Quantity::MomentumX => ("momentum along x", "kg m/s"),
        Quantity::MomentumY => ("momentum along y", "kg m/s"),
        Quantity::MomentumZ => ("momentum along z", "kg m/s"),
        Quantity::MaxSpeed => ("largest speed", "m/s"),
        Quantity::BlockKineticEnergy => ("kinetic energy of blocks", "J"),
        Quantity::BlockPotentialEnergy => ("potential energy of blocks", "J"),
        Quantity::ContactEnergy => ("elastic energy of contacts", "J"),
        Quantity::FrictionWork => ("work of friction", "J"),
        Quantity::DampingWork => ("work of damping", "J"),
        Quantity::OutsideWork => ("work of drives and loads", "J"),
        Quantity::EnergyError => ("error of the energy", ""),
        Quantity::Contacts => ("contacts", ""),
        Quantity::AwakeBlocks => ("awake blocks", ""),
        Quantity::BlockMaxSpeed => ("largest speed of a block", "m/s"),
    }
}

fn value(quantity: Quantity, totals: &Totals) -> f64 {
    match quantity {
        Quantity::KineticEnergy => totals.kinetic_energy,
        Quantity::Enstrophy => totals.enstrophy,
        Quantity::Mass => totals.mass,
        Quantity::MomentumX => totals.momentum[0],
        Quantity::MomentumY => totals.momentum[1],
        Quantity::MomentumZ => totals.momentum[2],
        Quantity::MaxSpeed => totals.max_speed,
    }
}

impl Recorder for History {
    fn schedule(&self) -> &Schedule {
        &self.schedule
    }

    fn record(&mut self, engine: &mut Engine, notes: &mut Notes) -> Result<()> {
        let totals = engine.totals()?;
        notes.max_speed = notes.max_speed.max(totals.max_speed);
        let values: Vec<f64> = self
            .quantities
            .iter()
            .map(|quantity| value(*quantity, &totals))
            .collect();
        let (step, time) = (engine.simulation.step(), engine.simulation.time());
        self.table.append(step, time, &values)?;
        notes.file(self.path.clone());
        Ok(())
    }

    fn finish(&mut self, engine: &Engine, notes: &mut Notes) -> Result<()> {
        let table = Table::read(&self.path)?;
        if table.column("time").is_none_or(|times| times.len() < 2) {
            return Ok(());
        }
        let columns: Vec<_> = self.quantities.iter().map(|q| about(*q)).collect();
        let names: Vec<[&str; 1]> = columns.iter().map(|(column, ..)| [*column]).collect();
        let tracks: Vec<Track<'_>> = columns
            .iter()
            .zip(&names)
            .map(|((_, quantity, unit), columns)| Track {
                quantity,
                unit,
                columns,
            })
            .collect();
        let path = self.path.with_extension("png");
        let title = &engine.scene().title;
        let drawn = Chart::history(title, &table, &tracks).and_then(|chart| chart.draw(&path));
        notes.picture(path, drawn);
        Ok(())
    }
}
