//! The recorders that a scene requests.

use super::super::{
    collection, gauges,
    recorder::{Recorders, RunLog, Schedule},
    rock::block_probe,
    slices,
    table::TimeTable,
    views::Views,
    walls,
};
use super::{LOOKS, SceneRun};
use riprap::{
    Error, Result,
    scene::{Probe, ProbePlace},
    simulation::{Kind, probe::Gauge},
};
use std::path::Path;

impl SceneRun {
    /// The recorders of the scene until the step `last`, except histories and checkpoints.
    pub fn recorders(&self, folder: &Path, last: u64) -> Result<Recorders> {
        let scene = self.scene();
        let kind = self.simulation.kind();
        let mut recorders = Recorders::new();
        recorders.extend(walls::recorder(self, folder, last)?);
        for probe in &scene.probes {
            recorders.extend(self.probe(folder, last, probe)?);
        }
        recorders.extend(collection::recorders(self, folder, last)?);
        if kind == Kind::Lattice {
            let every = self.time_step() * last as f64 / LOOKS;
            let schedule = Schedule::new(Some(every), self.time_step(), last);
            let look = |run: &mut Self, log: &mut RunLog| {
                log.max_speed = log.max_speed.max(run.totals()?.max_speed);
                Ok(())
            };
            recorders.push(Box::new((schedule, look)));
            let slices = scene.output.slices.iter();
            recorders.extend(slices.map(|slice| slices::recorder(self, folder, last, slice)));
        }
        for view in &scene.views {
            let adapter = self.drawing_adapter.clone();
            recorders.push(Box::new(Views::new(self, folder, last, view, adapter)));
        }
        Ok(recorders)
    }

    /// The recorders of the tables of a probe.
    fn probe(&self, folder: &Path, last: u64, probe: &Probe) -> Result<Recorders> {
        let simulation = &self.simulation;
        match (&probe.place, simulation.kind()) {
            (
                ProbePlace::Block {
                    block,
                    faces,
                    safety,
                },
                kind,
            ) => {
                let tables = [*faces && kind == Kind::Lattice, *safety];
                block_probe::recorders(self, folder, last, (probe, block), tables)
            }
            (_, Kind::Particles) => Ok(vec![gauges::recorder(self, folder, last, probe)?]),
            (_, Kind::Rock | Kind::Lattice) => {
                let gauge = self.gauge(probe)?;
                let table = TimeTable {
                    name: probe.name.clone(),
                    every: probe.every,
                    columns: gauge.columns().to_vec(),
                    coordinates: Some(gauge.coordinates()),
                    tracks: Vec::new(),
                    title: String::new(),
                };
                let recorder = table.recorder(self, folder, last, move |run, _| {
                    let arrays = run.read(gauge.fields(), gauge.cells())?;
                    Ok(gauge.rows(&arrays)?)
                });
                Ok(vec![recorder?])
            }
        }
    }

    /// Checks that each probe of a lattice has a place in it.
    pub(super) fn check_probes(&self) -> Result<()> {
        if self.simulation.kind() == Kind::Particles {
            return Ok(());
        }
        let of_fluid = |probe: &&Probe| !matches!(probe.place, ProbePlace::Block { .. });
        let mut probes = self.scene().probes.iter().filter(of_fluid);
        probes.try_for_each(|probe| self.gauge(probe).map(drop))
    }

    /// The cells of the lattice that a probe measures.
    ///
    /// # Errors
    /// If there is no lattice, or the probe has no place in it.
    fn gauge(&self, probe: &Probe) -> Result<Gauge> {
        if self.simulation.kind() != Kind::Lattice {
            let message = "measures a fluid, and there is none";
            return Err(Error::scene(format!("probes.{}", probe.name), message));
        }
        Gauge::new(self.scene(), self.simulation.solid(), probe)
    }
}
