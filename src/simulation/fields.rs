//! Fields of a fluid and its totals, in SI.

use super::{Simulation, lattice_fluid::LatticeFluid};
use crate::{
    Error, Result,
    coupling::{Coupled, Rock},
    lattice::Derived,
    output::{Array, Cloud, ImageData},
    scene::Field,
    sph::Water,
};

/// Sums over the fluid, SI.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Totals {
    /// ∫ ρ dV, kg.
    pub mass: f64,
    /// ∫ ρu dV, kg m/s.
    pub momentum: [f64; 3],
    /// ∫ ½ρu² dV, J.
    pub kinetic_energy: f64,
    /// ∫ ½ω² dV, m³/s².
    pub enstrophy: f64,
    /// Largest speed, m/s.
    pub max_speed: f64,
    /// Mean velocity along the axis of the prescribed bulk velocity, m/s; 0 if none is prescribed.
    pub bulk_velocity: f64,
    /// Body force per mass that maintains the bulk velocity, m/s².
    pub driving_acceleration: f64,
}

impl Simulation {
    /// The given fields on all cells.
    ///
    /// # Errors
    /// If the scene has no fluid on a lattice, the device is lost or cannot hold a field.
    pub async fn image(&mut self, fields: &[Field]) -> Result<ImageData> {
        Ok(ImageData {
            origin: self.scene.domain.origin,
            spacing: self.scene.domain.cell,
            cells: self.scene.cells().map(|n| n as usize),
            arrays: self.arrays(fields, None).await?,
        })
    }

    /// The given fields on the given cells only; cells are indices into an array over the domain, x
    /// fastest. Only the values of these cells are read back.
    ///
    /// # Errors
    /// If the scene has no fluid on a lattice, a cell is outside the domain, the device is lost or cannot hold a field.
    pub async fn read(&mut self, fields: &[Field], cells: &[u32]) -> Result<Vec<Array>> {
        let count = self.lattice_fluid()?.lattice.grid().cell_count();
        if let Some(outside) = cells.iter().find(|cell| **cell as usize >= count) {
            return Err(Error::scene(
                "cells",
                format!("cell {outside} was requested; the domain has cells 0 to {count} − 1"),
            ));
        }
        self.arrays(fields, Some(cells)).await
    }

    async fn arrays(&mut self, fields: &[Field], cells: Option<&[u32]>) -> Result<Vec<Array>> {
        let (fluid, rock) = self.lattice_and_rock()?;
        fluid.arrays(rock, fields, cells).await
    }

    /// The sums over the fluid.
    ///
    /// # Errors
    /// If the scene has no fluid on a lattice, or the device is lost.
    pub async fn totals(&mut self) -> Result<Totals> {
        let (fluid, _) = self.lattice_and_rock()?;
        let sums = fluid
            .observer
            .sums(&fluid.device, &fluid.queue, &mut fluid.lattice)
            .await?;
        let units = &fluid.units;
        let volume = units.cell.powi(3);
        let mass = units.density * volume;
        let speed = units.velocity_from_lattice(1.0);
        let rate = units.rate_from_lattice(1.0);
        let control = fluid.flow_control.as_ref();
        Ok(Totals {
            bulk_velocity: control.map_or(0.0, |control| speed * control.bulk_velocity(&sums)),
            driving_acceleration: control.map_or(0.0, |control| {
                control.acceleration() / units.acceleration_to_lattice(1.0)
            }),
            mass: mass * (sums.cells + sums.excess),
            momentum: sums.momentum.map(|j| mass * speed * j),
            kinetic_energy: mass * speed * speed * sums.kinetic_energy,
            enstrophy: volume * rate * rate * sums.enstrophy,
            max_speed: speed * sums.max_speed,
        })
    }
}

impl LatticeFluid {
    async fn arrays(
        &mut self,
        rock: Option<&Rock>,
        fields: &[Field],
        cells: Option<&[u32]>,
    ) -> Result<Vec<Array>> {
        let units = self.units;
        let mut state = None;
        let mut arrays = Vec::with_capacity(fields.len());
        for &field in fields {
            if state.is_none()
                && matches!(field, Field::Velocity | Field::Pressure | Field::Density)
            {
                let (device, queue) = (&self.device, &self.queue);
                let read = self
                    .observer
                    .state_on(device, queue, &mut self.lattice, cells);
                state = Some(read.await?);
            }
            let excess = state.iter().flat_map(|state| &state.excess);
            let rate = units.rate_from_lattice(1.0) as f32;
            let values = match field {
                Field::Velocity => state.as_ref().map_or_else(Vec::new, |state| {
                    let speed = units.velocity_from_lattice(1.0) as f32;
                    let scaled = |values: &Vec<f32>| values.iter().map(|u| u * speed).collect();
                    side_by_side(&state.velocity.each_ref().map(scaled))
                }),
                Field::Pressure => {
                    // p is linear in ρ − 1; going through ρ in f32 would lose three digits.
                    let of_one = units.pressure_from_lattice(2.0);
                    excess.map(|e| (f64::from(*e) * of_one) as f32).collect()
                }
                Field::Density => excess
                    .map(|e| units.density_from_lattice(1.0 + f64::from(*e)) as f32)
                    .collect(),
                Field::EddyViscosity => {
                    let scale = units.viscosity_from_lattice(1.0) as f32;
                    self.derived(Derived::EddyViscosity, scale, cells).await?
                }
                Field::QCriterion => {
                    self.derived(Derived::QCriterion, rate * rate, cells)
                        .await?
                }
                Field::Vorticity => {
                    let mut parts = [const { Vec::new() }; 3];
                    for (axis, part) in (0..).zip(&mut parts) {
                        *part = self.derived(Derived::Vorticity(axis), rate, cells).await?;
                    }
                    side_by_side(&parts)
                }
                Field::Solid => self.solid_values(self.coupled(rock), cells),
                Field::MeanVelocity
                | Field::MeanPressure
                | Field::PressureRms
                | Field::ReynoldsStress
                | Field::TurbulentKineticEnergy => {
                    side_by_side(&self.statistic(field, cells).await?)
                }
            };
            arrays.push(Array {
                name: field.name().into(),
                components: field.components(),
                values,
            });
        }
        Ok(arrays)
    }

    async fn derived(
        &mut self,
        quantity: Derived,
        scale: f32,
        cells: Option<&[u32]>,
    ) -> Result<Vec<f32>> {
        let (device, queue) = (&self.device, &self.queue);
        let mut values = self
            .observer
            .derived_on(device, queue, &mut self.lattice, quantity, cells)
            .await?;
        values.iter_mut().for_each(|value| *value *= scale);
        Ok(values)
    }

    /// Solid fraction: 1 in solid cells and in cells whose centres are in a block; in cells that the surface of a static
    /// solid cuts, the fraction that the solid fills.
    fn solid_values(&self, coupled: Option<Coupled<'_>>, cells: Option<&[u32]>) -> Vec<f32> {
        let (solid, surface) = (self.solid(), &self.lattice.setup().surface);
        let blocks = coupled.map_or_else(Vec::new, |coupled| coupled.cells_near_blocks(0.0));
        let value = |cell: usize| {
            let in_block = || blocks.binary_search_by_key(&cell, |found| found.cell.index as usize);
            let is_solid = solid.get(cell).is_some_and(|solid| *solid) || in_block().is_ok();
            let cut = || surface.binary_search_by_key(&cell, |found| found.cell as usize);
            match is_solid {
                true => 1.0,
                false => cut().map_or(0.0, |place| surface[place].fraction),
            }
        };
        match cells {
            Some(cells) => cells.iter().map(|cell| value(*cell as usize)).collect(),
            None => (0..self.lattice.grid().cell_count()).map(value).collect(),
        }
    }
}

/// Interleaves the components: all components of a cell are adjacent.
fn side_by_side(components: &[Vec<f32>]) -> Vec<f32> {
    let cells = 0..components.first().map_or(0, Vec::len);
    cells
        .flat_map(|cell| components.iter().map(move |values| values[cell]))
        .collect()
}

/// The particles of `water` as points with their ids and `fields`: velocity (m/s), pressure (Pa) and density (kg/m³).
/// Particles carry no other field.
pub fn point_cloud(water: &Water, fields: &[Field]) -> Cloud {
    let scalar = |values: &[f64]| values.iter().map(|v| *v as f32).collect();
    let array = |field: &Field| {
        let values: Vec<f32> = match field {
            Field::Velocity => water.velocities.iter().flat_map(|v| v.to_array()).collect(),
            Field::Pressure => scalar(&water.pressures),
            Field::Density => scalar(&water.densities),
            _ => return None,
        };
        Some(Array {
            name: field.name().into(),
            components: field.components(),
            values,
        })
    };
    let mut arrays: Vec<Array> = fields.iter().filter_map(array).collect();
    arrays.push(Array::scalars(
        "id",
        water.ids.iter().copied().map(f64::from),
    ));
    Cloud {
        points: water.positions.iter().map(|x| x.to_array()).collect(),
        arrays,
    }
}
