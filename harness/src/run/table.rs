//! Tables of measurements over time, `NAME.csv`, and their curves, `NAME.png`.

use super::{
    recorder::{Recorder, RunLog, Schedule},
    scene_run::SceneRun,
    statistics::TableStatistics,
};
use crate::picture::{Chart, Track};
use anyhow::{Result, anyhow};
use riprap::output::{Csv, Table};
use std::path::{Path, PathBuf};

/// A table and its curves.
pub struct TimeTable {
    /// Name of its files.
    pub name: String,
    /// s between rows.
    pub every: Option<f64>,
    /// Columns other than step and time.
    pub columns: Vec<String>,
    /// Number of leading columns with the place of a row; `None` for a table without statistics.
    pub coordinates: Option<usize>,
    /// Curves drawn at the end, if there are any.
    pub tracks: Vec<Track>,
    /// Title above the curves.
    pub title: String,
}

/// Rows for the present state of a run.
type Rows = Box<dyn FnMut(&mut SceneRun, &mut RunLog) -> Result<Vec<Vec<f64>>>>;

impl TimeTable {
    /// Creates the table in `folder`, or continues it after a restart; `rows` are due until the step `last`.
    pub fn recorder(
        self,
        run: &SceneRun,
        folder: &Path,
        last: u64,
        rows: impl FnMut(&mut SceneRun, &mut RunLog) -> Result<Vec<Vec<f64>>> + 'static,
    ) -> riprap::Result<Box<dyn Recorder>> {
        let path = folder.join(format!("{}.csv", self.name));
        let table = match run.step() {
            0 => Csv::create(&path, &self.columns)?,
            step => Csv::resume(&path, &self.columns, step)?,
        };
        let requested = run.scene().statistics.as_ref();
        let requested = requested
            .filter(|_| self.every.is_some())
            .zip(self.coordinates);
        let mut statistics = requested.map(|(requested, coordinates)| {
            let title = format!("{}: {}", run.scene().title, self.name);
            TableStatistics::new(&path, &title, requested.from, &self.columns, coordinates)
        });
        if let Some(statistics) = &mut statistics {
            statistics.replay()?;
        }
        Ok(Box::new(TableRecorder {
            schedule: Schedule::new(self.every, run.time_step(), last),
            table,
            statistics,
            about: self,
            path,
            rows: Box::new(rows),
        }))
    }
}

struct TableRecorder {
    about: TimeTable,
    schedule: Schedule,
    path: PathBuf,
    table: Csv,
    statistics: Option<TableStatistics>,
    rows: Rows,
}

impl Recorder for TableRecorder {
    fn schedule(&self) -> &Schedule {
        &self.schedule
    }

    fn record(&mut self, run: &mut SceneRun, log: &mut RunLog) -> Result<()> {
        let rows = (self.rows)(run, log)?;
        for row in &rows {
            self.table.append(run.step(), run.time(), row)?;
        }
        if let Some(statistics) = &mut self.statistics {
            statistics.push(run.time(), &rows);
        }
        log.file(self.path.clone());
        Ok(())
    }

    fn statistics(&self) -> Option<&TableStatistics> {
        self.statistics.as_ref()
    }

    /// Writes the statistics and draws the tracks; draws nothing if the table has fewer than two times, or no finite number.
    fn finish(&mut self, run: &SceneRun, log: &mut RunLog) -> Result<()> {
        if let Some(statistics) = &self.statistics {
            statistics.write(log, run.step(), run.time())?;
        }
        let TimeTable {
            name,
            tracks,
            title,
            ..
        } = &self.about;
        if tracks.is_empty() {
            return Ok(());
        }
        let table = Table::read(&self.path)?;
        let is_empty = |name: &String| {
            let values = table.column(name).unwrap_or_default();
            !values.iter().any(|value| value.is_finite())
        };
        let mut columns = tracks.iter().flat_map(|track| &track.columns);
        if columns.all(is_empty) || table.column("time").is_none_or(|times| times.len() < 2) {
            return Ok(());
        }
        let picture = self.path.with_extension("png");
        let mut views = run.scene().views.iter().filter(|view| view.animation);
        let drawn = match views.any(|view| view.name == *name) {
            true => Err(anyhow!(
                "this file belongs to the view of the same name; give one of them another name"
            )),
            false => Chart::history(title, &table, tracks).and_then(|chart| chart.draw(&picture)),
        };
        log.picture(picture, drawn);
        Ok(())
    }
}
