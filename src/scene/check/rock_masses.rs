//! Rock masses have a volume, and joints that can cut it.

use super::blocks::{half_spaces, points};
use super::rules::{direction, finite, names, not_negative, ordered, positive, refuse};
use crate::error::Result;
use crate::scene::{Distribution, JointSet, Persistence, Scene, Volume};

impl Scene {
    pub(super) fn check_rock_masses(&self) -> Result<()> {
        let named = self.rock_masses.iter().enumerate();
        names(
            "rock_masses",
            named.filter_map(|(i, mass)| Some((i, mass.name.as_deref()?))),
        )?;
        for (index, mass) in self.rock_masses.iter().enumerate() {
            let key = format!("rock_masses[{index}]");
            self.material(&format!("{key}.material"), mass.material.as_deref())?;
            if mass.deformable {
                self.check_elastic(&key, mass.material.as_deref())?;
                finite(format!("{key}.initial_stress"), &mass.initial_stress)?;
            } else if mass.initial_stress != [0.0; 6] {
                return refuse(
                    format!("{key}.initial_stress"),
                    "belongs to deformable blocks; add deformable = true, or remove it",
                );
            }
            match &mass.volume {
                Volume::Box { min, max } => ordered(&key, *min, *max)?,
                Volume::Vertices { vertices } => points(&format!("{key}.vertices"), vertices)?,
                Volume::HalfSpaces { faces } => half_spaces(&format!("{key}.faces"), faces)?,
                Volume::Mesh {
                    scale, translate, ..
                } => {
                    positive(format!("{key}.scale"), *scale, "m")?;
                    finite(format!("{key}.translate"), translate)?;
                }
            }
            for (number, set) in mass.joints.iter().enumerate() {
                joints(&format!("{key}.joints[{number}]"), set)?;
            }
            if let Some(up) = &mass.up {
                direction(format!("{key}.up"), up)?;
            } else if self.rock.gravity == [0.0; 3] {
                return refuse(
                    format!("{key}.up"),
                    "without gravity nothing says which way is up; give up, such as [0, 0, 1]",
                );
            }
            direction(format!("{key}.north"), &mass.north)?;
            let smallest = mass.smallest_volume;
            not_negative(format!("{key}.smallest_volume"), smallest, "m³")?;
            let thinnest = mass.smallest_thickness;
            not_negative(format!("{key}.smallest_thickness"), thinnest, "")?;
            not_negative(format!("{key}.aperture"), mass.aperture, "m")?;
            let regions = [("fixed", &mass.fixed), ("removed", &mass.removed)];
            for (name, regions) in regions {
                for (number, region) in regions.iter().enumerate() {
                    self.check_region(&format!("{key}.{name}[{number}]"), region)?;
                }
            }
        }
        Ok(())
    }
}

fn joints(key: &str, set: &JointSet) -> Result<()> {
    if !(0.0..=90.0).contains(&set.dip) {
        return refuse(
            format!("{key}.dip"),
            format!(
                "is {} degrees; joints dip from 0 (flat) to 90 (upright)",
                set.dip
            ),
        );
    }
    finite(format!("{key}.dip_direction"), &[set.dip_direction])?;
    positive(format!("{key}.spacing"), set.spacing, "m")?;
    finite(format!("{key}.origin"), &set.origin)?;
    if let Some(scatter) = set.scatter {
        let most = match set.distribution {
            Distribution::Uniform => 1.0f64.next_down(),
            Distribution::Normal => 1.0,
            Distribution::Lognormal => 10.0,
            Distribution::None | Distribution::Exponential => {
                return refuse(
                    format!("{key}.scatter"),
                    "has no meaning for this distribution; remove it, or give distribution = \
                     \"uniform\", \"normal\" or \"lognormal\"",
                );
            }
        };
        if !(0.0..=most).contains(&scatter) {
            return refuse(
                format!("{key}.scatter"),
                format!("is {scatter}; it lies from 0 to {most:.0}, below 1 where uniform"),
            );
        }
    }
    if let Some(Persistence { fraction, length }) = set.persistence {
        positive(format!("{key}.persistence.length"), length, "m")?;
        if !(0.0..=1.0).contains(&fraction) {
            return refuse(
                format!("{key}.persistence.fraction"),
                format!("is {fraction}; it lies from 0 to 1 (joints open everywhere)"),
            );
        }
    }
    Ok(())
}
