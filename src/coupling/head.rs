//! The pressure of the water around a block, continued into its closed joints.

use super::passed_on::Field;
use crate::bodies::outer;
use glam::{DMat3, DVec3};

/// What is known of the water at one place on the rims of joints.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Sample {
    /// m.
    pub place: DVec3,
    /// Length of rim that it stands for, m.
    pub length: f64,
    /// Pa; 0 where it is dry.
    pub pressure: f64,
}

/// A linear field of pressure, by least squares over the rims of joints, those that are dry included where water at rest
/// would come up to them. Where rims do not tell, across a joint that is open on one side only, it is that of water at
/// rest; and nothing in it is above the head of all of its rims or below.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Head {
    /// The middle of the rims, m.
    pub place: DVec3,
    /// Pa there.
    pub pressure: f64,
    /// Pa/m, beside that of water at rest.
    pub slope: DVec3,
    /// ρ g, Pa/m.
    pub weight: DVec3,
    /// Least and highest of it, in Pa at `place` if from there on it was at rest.
    pub range: [f64; 2],
}

impl Head {
    /// At `x` (m), Pa; water does not pull.
    pub fn at(&self, x: DVec3) -> f64 {
        let way = x - self.place;
        let [least, most] = self.range;
        let head = (self.pressure + self.slope.dot(way)).max(least).min(most);
        (head + self.weight.dot(way)).max(0.0)
    }

    /// The field of samples, of which those nearer than `reach` (m) to each other teach nothing about slopes; none
    /// without water.
    pub fn fit(samples: &[Sample], reach: f64, weight: DVec3) -> Option<Self> {
        let wet = samples.iter().filter(|sample| sample.pressure > 0.0);
        let (level, all) = wet.fold((0.0, 0.0), |(level, all), sample| {
            let head = sample.pressure - weight.dot(sample.place);
            (level + sample.length * head, all + sample.length)
        });
        if all <= 0.0 {
            return None;
        }
        let counts = |sample: &&Sample| {
            sample.pressure > 0.0 || level / all + weight.dot(sample.place) > 0.0
        };
        let used = || samples.iter().filter(counts);
        let length: f64 = used().map(|sample| sample.length).sum();
        let place = used().map(|sample| sample.length * sample.place);
        let place = place.sum::<DVec3>() / length;
        let head = |sample: &Sample| sample.pressure - weight.dot(sample.place - place);
        let pressure = used().map(|sample| sample.length * head(sample));
        let pressure = pressure.sum::<f64>() / length;
        let mut spread = DMat3::from_diagonal(DVec3::splat(reach.powi(2) / 12.0));
        let (mut with_place, mut range) = (DVec3::ZERO, [f64::INFINITY, f64::NEG_INFINITY]);
        for sample in used() {
            let (share, way) = (sample.length / length, sample.place - place);
            spread += share * outer(way, way);
            with_place += share * (head(sample) - pressure) * way;
            range = [range[0].min(head(sample)), range[1].max(head(sample))];
        }
        Some(Self {
            place,
            pressure,
            slope: spread.inverse() * with_place,
            weight,
            range,
        })
    }
}

impl Field for Head {
    fn moved(self, way: DVec3) -> Self {
        Self {
            place: self.place + way,
            ..self
        }
    }

    fn mean(heads: &[Self]) -> Self {
        let Self { place, weight, .. } = heads[0];
        let share = 1.0 / heads.len() as f64;
        let mut mean = Self {
            place,
            weight,
            range: [f64::INFINITY, f64::NEG_INFINITY],
            ..Self::default()
        };
        for head in heads {
            let way = place - head.place;
            mean.pressure += share * (head.pressure + (head.slope + weight).dot(way));
            mean.slope += share * head.slope;
            let [least, most] = head.range.map(|end| end + weight.dot(way));
            mean.range = [mean.range[0].min(least), mean.range[1].max(most)];
        }
        mean
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn samples(places: &[DVec3], pressure: impl Fn(DVec3) -> f64) -> Vec<Sample> {
        let sample = |&place: &DVec3| Sample {
            place,
            length: 1.0,
            pressure: pressure(place).max(0.0),
        };
        places.iter().map(sample).collect()
    }

    #[test]
    fn still_water_is_found_exactly_whatever_is_wet() {
        let weight = DVec3::new(1.0, 0.0, -10.0);
        let still = |x: DVec3| 100.0 + weight.dot(x);
        // On one side only, two, and some above the water.
        for places in [
            vec![
                DVec3::X,
                DVec3::new(1.0, 0.0, 3.0),
                DVec3::new(1.0, 2.0, -1.0),
            ],
            vec![DVec3::new(2.0, 1.0, 5.0), DVec3::ZERO],
            vec![
                DVec3::ZERO,
                DVec3::new(3.0, 1.0, 12.0),
                DVec3::new(-9.0, 1.0, 20.0),
            ],
        ] {
            let head = Head::fit(&samples(&places, still), 4.0, weight).unwrap();
            for x in [DVec3::new(-3.0, 1.0, -2.0), DVec3::Z * 4.0] {
                assert!((head.at(x) - still(x)).abs() < 1e-9, "{}", head.at(x));
            }
            assert_eq!(head.at(DVec3::Z * 1e3), 0.0);
        }
        assert_eq!(
            Head::fit(&samples(&[DVec3::Z * 99.0], still), 4.0, weight),
            None
        );
    }

    #[test]
    fn the_mean_of_still_water_is_the_same_water() {
        let still = |x: DVec3| 100.0 - 10.0 * x.z;
        let weight = DVec3::Z * -10.0;
        let at = |x: f64, z: f64| {
            let places = [DVec3::new(x, 0.0, z), DVec3::new(x + 1.0, 2.0, z + 3.0)];
            Head::fit(&samples(&places, still), 4.0, weight).unwrap()
        };
        let aside = at(-7.0, 1.0).moved(DVec3::X * 7.0);
        let mean = Head::mean(&[at(0.0, 0.0), at(5.0, -4.0), aside]);
        for x in [DVec3::new(-3.0, 1.0, -2.0), DVec3::Z * 4.0] {
            assert!((mean.at(x) - still(x)).abs() < 1e-9, "{}", mean.at(x));
        }
        assert_eq!(mean.at(DVec3::Z * 1e3), 0.0);
    }

    /// A dam, 60 across: between two levels, and to a dry toe; no farther than to the levels.
    #[test]
    fn between_two_levels_it_falls_linearly() {
        let places = [-30.0, 30.0].map(|x| DVec3::X * x);
        for (up, down) in [(65.0, 35.0), (65.0, 0.0)] {
            let level = |x: DVec3| if x.x < 0.0 { up } else { down };
            let head = Head::fit(&samples(&places, level), 4.0, DVec3::NEG_Z).unwrap();
            let between = 0.5 * (up + down);
            for (x, expected) in [(-30.0, up), (0.0, between), (30.0, down), (-90.0, up)] {
                let found = head.at(DVec3::X * x);
                assert!((found - expected).abs() < 0.1, "{found} at {x}");
            }
        }
    }
}
