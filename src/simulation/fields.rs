//! What a simulation shows, in SI.

use super::Simulation;
use crate::{
    Result,
    lattice::Derived,
    output::{Array, Image},
    scene::Field,
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
}

impl Simulation {
    /// The given fields on all cells.
    ///
    /// # Errors
    /// If the device is lost or does not hold a field.
    pub async fn image(&mut self, fields: &[Field]) -> Result<Image> {
        let (device, queue) = (&self.device.clone(), &self.queue.clone());
        let units = self.units;
        let mut arrays = Vec::new();
        let any = |wanted: &[Field]| fields.iter().any(|field| wanted.contains(field));
        if any(&[Field::Velocity, Field::Pressure, Field::Density]) {
            let state = self
                .observer
                .state(device, queue, &mut self.lattice)
                .await?;
            let rho = |excess: &f32| 1.0 + f64::from(*excess);
            let scalar = |name: &str, of: &dyn Fn(f64) -> f64| Array {
                name: name.into(),
                components: 1,
                values: state.excess.iter().map(|e| of(rho(e)) as f32).collect(),
            };
            for field in fields {
                match field {
                    Field::Velocity => {
                        let scale = units.velocity_from_lattice(1.0) as f32;
                        arrays.push(vector("velocity", &state.velocity, scale));
                    }
                    Field::Pressure => arrays.push(Array {
                        name: "pressure".into(),
                        components: 1,
                        // p is linear in ρ − 1; going through ρ in f32 would lose three digits.
                        values: state
                            .excess
                            .iter()
                            .map(|&e| {
                                let of_one = units.pressure_from_lattice(2.0);
                                (f64::from(e) * of_one) as f32
                            })
                            .collect(),
                    }),
                    Field::Density => {
                        arrays.push(scalar("density", &|rho| units.density_from_lattice(rho)));
                    }
                    _ => {}
                }
            }
        }
        let rate = units.rate_from_lattice(1.0) as f32;
        for field in fields {
            match field {
                Field::EddyViscosity => {
                    let scale = units.viscosity_from_lattice(1.0) as f32;
                    arrays.push(
                        self.derived("eddy_viscosity", Derived::EddyViscosity, scale)
                            .await?,
                    );
                }
                Field::QCriterion => {
                    arrays.push(
                        self.derived("q_criterion", Derived::QCriterion, rate * rate)
                            .await?,
                    );
                }
                Field::Vorticity => {
                    let mut parts = [Vec::new(), Vec::new(), Vec::new()];
                    for (axis, part) in (0..).zip(&mut parts) {
                        *part = self
                            .derived("", Derived::Vorticity(axis), 1.0)
                            .await?
                            .values;
                    }
                    arrays.push(vector("vorticity", &parts, rate));
                }
                _ => {}
            }
        }
        let solid = &self.lattice.setup().solid;
        if fields.contains(&Field::Solid) {
            let values = match solid.is_empty() {
                true => vec![0.0; self.lattice.grid().cell_count()],
                false => solid.iter().map(|&s| f32::from(u8::from(s))).collect(),
            };
            arrays.push(Array {
                name: "solid".into(),
                components: 1,
                values,
            });
        }
        Ok(Image {
            origin: self.scene.domain.origin,
            spacing: self.scene.domain.cell,
            cells: self.scene.cells().map(|n| n as usize),
            arrays,
        })
    }

    async fn derived(&mut self, name: &str, quantity: Derived, scale: f32) -> Result<Array> {
        let (device, queue) = (&self.device.clone(), &self.queue.clone());
        let mut values = self
            .observer
            .derived(device, queue, &mut self.lattice, quantity)
            .await?;
        values.iter_mut().for_each(|value| *value *= scale);
        Ok(Array {
            name: name.into(),
            components: 1,
            values,
        })
    }

    /// The sums over the fluid.
    ///
    /// # Errors
    /// If the device is lost.
    pub async fn totals(&mut self) -> Result<Totals> {
        let sums = self
            .observer
            .sums(&self.device, &self.queue, &mut self.lattice)
            .await?;
        let units = &self.units;
        let volume = units.cell.powi(3);
        let mass = units.density * volume;
        let speed = units.velocity_from_lattice(1.0);
        let rate = units.rate_from_lattice(1.0);
        Ok(Totals {
            mass: mass * (sums.cells + sums.excess),
            momentum: sums.momentum.map(|j| mass * speed * j),
            kinetic_energy: mass * speed * speed * sums.kinetic_energy,
            enstrophy: volume * rate * rate * sums.enstrophy,
            max_speed: speed * sums.max_speed,
        })
    }
}

fn vector(name: &str, components: &[Vec<f32>; 3], scale: f32) -> Array {
    let [x, y, z] = components;
    let each = x.iter().zip(y).zip(z);
    Array {
        name: name.into(),
        components: 3,
        values: each
            .flat_map(|((x, y), z)| [x * scale, y * scale, z * scale])
            .collect(),
    }
}
