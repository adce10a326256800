//! The friction on walls and blocks with a wall model over time: `walls.csv`, one row per time.

use super::{recorder::Recorder, scene_run::SceneRun, summary::Summary, table::TimeTable};
use crate::picture::Track;
use riprap::simulation::{WallFriction, WallFrictions, WallPlace};
use serde::Serialize;
use std::{fmt, path::Path};

/// The wall model in the summary.
#[derive(Clone, Copy, Debug, Default, Serialize)]
pub struct WallModelSummary {
    /// Fraction of the area of walls and solids at rest with the model.
    pub area_share: f64,
    /// Fraction of the area of the faces of blocks with the model; 0 without blocks.
    pub block_area_share: f64,
    /// Mean y⁺ of the first cell at these faces at the end.
    pub y_plus_mean: f64,
    /// Largest y⁺ of these cells.
    pub y_plus_max: f64,
    /// Mean magnitude of the stress, Pa, where the law gives all of it, or on all these faces if it does so nowhere.
    pub stress_mean: f64,
}

impl WallModelSummary {
    /// The summary of the frictions at the end; `None` without a model.
    pub fn of(frictions: &WallFrictions) -> Option<Self> {
        let walls = &frictions.walls;
        if walls.is_empty() {
            return None;
        }
        let whole: Vec<_> = walls.iter().filter(|wall| wall.share == 1.0).collect();
        // On a smooth laminar flow the law acts nowhere, and the walls are no-slip.
        let modelled = match whole.is_empty() {
            true => walls.iter().collect(),
            false => whole,
        };
        let size = |wall: &WallFriction| wall.stress.iter().map(|s| s * s).sum::<f64>().sqrt();
        Some(Self {
            area_share: frictions.area_share,
            block_area_share: frictions.block_area_share,
            y_plus_mean: mean(walls.iter().map(|wall| wall.y_plus)),
            y_plus_max: walls.iter().map(|wall| wall.y_plus).fold(0.0, f64::max),
            stress_mean: mean(modelled.into_iter().map(size)),
        })
    }
}

impl fmt::Display for WallModelSummary {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let percent = |share: f64, of| {
            (share > 0.0).then(|| format!("{:.1} % of the area of {of}", 100.0 * share))
        };
        let on = [
            percent(self.area_share, "walls"),
            percent(self.block_area_share, "blocks"),
        ];
        let on: Vec<String> = on.into_iter().flatten().collect();
        // A share that is printed as 100 % leaves no others.
        let is_whole = |share: f64| share == 0.0 || share >= 0.9995;
        let others = match is_whole(self.area_share) && is_whole(self.block_area_share) {
            true => "",
            false => {
                "; the others have no slip (corners, convex edges, gaps under five cells, faces that lie across cells, open and \
                 moving faces)"
            }
        };
        write!(
            f,
            "  wall model on {}: y⁺ half a cell from them {:.1} on average, \
             {:.1} at most, stress {:.3e} Pa{others}",
            on.join(" and "),
            self.y_plus_mean,
            self.y_plus_max,
            self.stress_mean
        )
    }
}

/// Mean of `values`; 0 if there are none.
fn mean(values: impl Iterator<Item = f64>) -> f64 {
    let (mut sum, mut count) = (0.0, 0.0);
    for value in values {
        sum += value;
        count += 1.0;
    }
    if count > 0.0 { sum / count } else { 0.0 }
}

/// A row of the table: the [`columns`] for each place that has the model.
fn row(frictions: &WallFrictions, places: &[WallPlace]) -> Vec<f64> {
    let of = |place: &WallPlace| {
        let own = || {
            frictions
                .walls
                .iter()
                .filter(move |wall| wall.place == *place)
        };
        let area: f64 = own().map(|wall| wall.area).sum();
        let mean = |value: &dyn Fn(&WallFriction) -> f64| match area > 0.0 {
            true => own().map(|wall| wall.area * value(wall)).sum::<f64>() / area,
            false => 0.0,
        };
        let [x, y, z] = [0, 1, 2].map(|axis| mean(&|wall| wall.stress[axis]));
        let u = mean(&|wall| wall.friction_velocity);
        let y_plus = mean(&|wall| wall.y_plus);
        let largest = own().map(|wall| wall.y_plus).fold(0.0, f64::max);
        [area, x, y, z, u, y_plus, largest]
    };
    places.iter().flat_map(of).collect()
}

fn columns(places: &[WallPlace]) -> Vec<String> {
    let names = [
        "area",
        "stress_x",
        "stress_y",
        "stress_z",
        "friction_velocity",
        "y_plus",
        "y_plus_max",
    ];
    let of = |place: &WallPlace| {
        let place = place.name();
        names.map(|name| format!("{place}_{name}"))
    };
    places.iter().flat_map(of).collect()
}

/// The recorder of the table; `None` without a model.
pub fn recorder(
    run: &SceneRun,
    folder: &Path,
    last: u64,
) -> riprap::Result<Option<Box<dyn Recorder>>> {
    let places = run.simulation.wall_places();
    if places.is_empty() {
        return Ok(None);
    }
    let columns = columns(&places);
    let names = columns.iter().map(String::as_str);
    let stresses: Vec<_> = names.filter(|name| name.contains("_stress_")).collect();
    let table = TimeTable {
        name: "walls".into(),
        every: run.scene().output.every,
        tracks: vec![Track::new("mean stress", "Pa", &stresses)],
        title: format!("{}: friction of walls", run.scene().title),
        columns: columns.clone(),
        coordinates: Some(0),
    };
    let rows = move |run: &mut SceneRun, _: &mut _| Ok(vec![row(&run.wall_friction()?, &places)]);
    Ok(Some(table.recorder(run, folder, last, rows)?))
}

impl SceneRun {
    /// Adds the wall model to the summary.
    pub(super) fn report_wall_model(&mut self, summary: &mut Summary) {
        match self.wall_friction() {
            Ok(found) => summary.wall_model = WallModelSummary::of(&found),
            Err(error) => {
                let message = format!("the friction of walls is not known: {error}");
                summary.warnings.push(message);
            }
        }
    }
}
