//! Headline numbers of a run: means over its last part, from the tables that it wrote.

use super::super::history;
use anyhow::Result;
use riprap::{
    output::Table,
    scene::{History, Quantity, Scene},
};
use serde::Serialize;
use std::path::PathBuf;

/// Fraction of the simulated time, at its end, over which means are taken: transients of the start have decayed, and
/// enough rows remain.
const LAST: f64 = 0.25;

/// A number or a vector, and its difference from the run at half the resolution.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Headline {
    /// Table, without its file extension.
    pub table: String,
    /// Name of the quantity.
    pub quantity: String,
    /// Its unit; empty for a pure number.
    pub unit: &'static str,
    /// Mean over the last quarter; three components of a vector.
    pub value: Vec<f64>,
    /// The same at half the resolution.
    pub coarse: Vec<f64>,
    /// Length of the difference.
    pub difference: f64,
    /// The difference relative to the value, unless that is zero.
    pub relative: Option<f64>,
}

impl Headline {
    fn new(
        (table, quantity, unit): (&str, &str, &'static str),
        value: Vec<f64>,
        coarse: Vec<f64>,
    ) -> Self {
        let length = |all: &[f64]| all.iter().map(|x| x * x).sum::<f64>().sqrt();
        let apart: Vec<f64> = value.iter().zip(&coarse).map(|(a, b)| a - b).collect();
        let (difference, size) = (length(&apart), length(&value));
        Self {
            table: table.into(),
            quantity: quantity.into(),
            unit,
            relative: (size > 0.0).then(|| difference / size),
            difference,
            value,
            coarse,
        }
    }

    /// Whether it is zero at both resolutions, so that there is nothing to report.
    pub fn is_zero(&self) -> bool {
        self.value.iter().chain(&self.coarse).all(|x| *x == 0.0)
    }
}

/// The tables that a scene writes, and the quantities of those that are histories.
pub fn tables(scene: &Scene) -> Vec<(String, &[Quantity])> {
    let histories = scene.output.histories.iter().enumerate();
    let histories =
        histories.map(|(n, requested)| (History::file_name(n), requested.quantities.as_slice()));
    let probes = scene.probes.iter();
    let probes = probes.map(|probe| (probe.name.clone(), [].as_slice()));
    histories.chain(probes).collect()
}

/// The headline numbers of a table in two runs, the finer one first; none for a table with several rows per time.
pub fn of(
    (name, quantities): &(String, &[Quantity]),
    folders: [&PathBuf; 2],
) -> Result<Vec<Headline>> {
    let mut read = Vec::new();
    for folder in folders {
        read.push(Table::read(folder.join(format!("{name}.csv")))?);
    }
    // Quantity and unit, and the values at both resolutions.
    type Found = ((String, &'static str), Vec<f64>, Vec<f64>);
    let mut found: Vec<Found> = Vec::new();
    for (column, values) in &read[0].columns {
        let requested = quantities.iter().find(|known| known.name() == column);
        let known = requested.map(|requested| (column.clone(), history::unit(*requested)));
        let Some(quantity) = known.or_else(|| headline(column)) else {
            continue;
        };
        let fine = last_mean(&read[0], values);
        let coarse = read[1].column(column).and_then(|v| last_mean(&read[1], v));
        let (Some(fine), Some(coarse)) = (fine, coarse) else {
            continue;
        };
        // Components of a vector are consecutive columns.
        match found.last_mut() {
            Some((last, a, b)) if *last == quantity => {
                a.push(fine);
                b.push(coarse);
            }
            _ => found.push((quantity, vec![fine], vec![coarse])),
        }
    }
    let made = found.into_iter();
    Ok(made
        .map(|((quantity, unit), fine, coarse)| {
            Headline::new((name, &quantity, unit), fine, coarse)
        })
        .collect())
}

/// Quantity and unit of a probe's column; components of a vector share the quantity. `None` for a column without a
/// headline number.
fn headline(column: &str) -> Option<(String, &'static str)> {
    let extreme = ["_min", "_max"].iter().any(|end| column.ends_with(end));
    if extreme || ["step", "time", "s"].contains(&column) {
        return None;
    }
    let of_box = column.strip_suffix("_mean").unwrap_or(column);
    let axes = ["_x", "_y", "_z"];
    let stem = axes.iter().find_map(|axis| of_box.strip_suffix(axis));
    let name = stem.unwrap_or(of_box);
    Some((name.into(), unit(name)))
}

/// Mean of a column over the last part of the time; `None` if times repeat or no value is finite.
fn last_mean(table: &Table, values: &[f64]) -> Option<f64> {
    let times = table.column("time")?;
    if times.windows(2).any(|pair| pair[1] <= pair[0]) {
        return None;
    }
    let begin = (1.0 - LAST) * times.last()?;
    let last = times.iter().zip(values);
    let some: Vec<f64> = last
        .filter(|(time, value)| **time >= begin && value.is_finite())
        .map(|(_, value)| *value)
        .collect();
    (!some.is_empty()).then(|| some.iter().sum::<f64>() / some.len() as f64)
}

/// The unit of a measured quantity.
pub fn unit(quantity: &str) -> &'static str {
    match quantity {
        "velocity" | "mean_velocity" => "m/s",
        "pressure" | "mean_pressure" | "pressure_rms" | "joint_pressure" | "von_mises" => "Pa",
        "impulse" => "Pa s",
        "turbulent_kinetic_energy" => "m²/s²",
        name if name.starts_with("reynolds_stress") => "m²/s²",
        name if name.starts_with("stress") => "Pa",
        "density" => "kg/m³",
        "eddy_viscosity" => "m²/s",
        "q_criterion" => "1/s²",
        "vorticity" => "1/s",
        "position" | "level" | "x" | "y" | "z" => "m",
        name if name.ends_with("_of_max") => "m",
        "rotation" => "°",
        "spin" => "rad/s",
        "force" | "fluid_force" | "film_force" | "buoyancy" | "support" | "uplift_of_faces" => "N",
        "torque" | "fluid_torque" => "N m",
        "strain_energy" => "J",
        "area" => "m²",
        "volume" => "m³",
        _ => "",
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn table(rows: &[[f64; 2]]) -> Table {
        let column = |n: usize| rows.iter().map(|row| row[n]).collect();
        Table {
            columns: vec![("time".into(), column(0)), ("level".into(), column(1))],
        }
    }

    fn mean(rows: &[[f64; 2]]) -> Option<f64> {
        let table = table(rows);
        last_mean(&table, &table.columns[1].1)
    }

    #[test]
    fn means_are_of_the_last_quarter_and_of_numbers() {
        let rows = [[0.0, 9.0], [1.0, 9.0], [2.0, 9.0], [3.0, 1.0], [4.0, 2.0]];
        assert_eq!(mean(&rows), Some(1.5));
        assert_eq!(mean(&[[0.0, 9.0], [4.0, f64::NAN]]), None);
    }

    #[test]
    fn a_profile_has_no_headline() {
        assert_eq!(mean(&[[0.0, 1.0], [0.0, 2.0]]), None);
    }

    #[test]
    fn components_of_a_vector_are_one_quantity() {
        let some = |name: &str, unit| Some((String::from(name), unit));
        assert_eq!(headline("velocity_x"), some("velocity", "m/s"));
        assert_eq!(headline("velocity_z_mean"), some("velocity", "m/s"));
        assert_eq!(headline("safety_sliding"), some("safety_sliding", ""));
        assert_eq!(headline("pressure_max"), None);
        assert_eq!(headline("time"), None);
    }

    #[test]
    fn differences_of_vectors_are_lengths() {
        let force = |value, coarse| Headline::new(("a", "force", "N"), value, coarse);
        let found = force(vec![3.0, 4.0, 0.0], vec![3.0, 3.5, 0.0]);
        assert_eq!((found.difference, found.relative), (0.5, Some(0.1)));
        let none = force(vec![0.0; 3], vec![0.0; 3]);
        assert!(none.is_zero() && none.relative.is_none());
    }
}
