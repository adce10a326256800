//! Points sorted into bins, to find those near a place.

use std::collections::HashMap;

/// Points of `D` coordinates.
pub struct Taken<const D: usize> {
    bin: f64,
    points: HashMap<[i64; D], Vec<[f64; D]>>,
}

impl<const D: usize> Taken<D> {
    /// For distances up to `bin` (m).
    pub fn new(bin: f64) -> Self {
        Self {
            bin,
            points: HashMap::new(),
        }
    }

    fn place(&self, point: [f64; D]) -> [i64; D] {
        point.map(|coordinate| (coordinate / self.bin).floor() as i64)
    }

    pub fn add(&mut self, point: [f64; D]) {
        self.points
            .entry(self.place(point))
            .or_default()
            .push(point);
    }

    /// Whether a point is nearer than `distance` to `point`.
    pub fn near(&self, point: [f64; D], distance: f64) -> bool {
        let place = self.place(point);
        // The bin and its 3^D − 1 neighbours, counted in base 3.
        (0..3_i64.pow(D as u32)).any(|number| {
            let mut digits = number;
            let neighbour = place.map(|along| {
                let step = digits % 3 - 1;
                digits /= 3;
                along + step
            });
            let points = self.points.get(&neighbour).into_iter().flatten();
            points
                .into_iter()
                .any(|other| square(*other, point) < distance * distance)
        })
    }
}

fn square<const D: usize>(a: [f64; D], b: [f64; D]) -> f64 {
    a.iter().zip(b).map(|(a, b)| (a - b).powi(2)).sum()
}
