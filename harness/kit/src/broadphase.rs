//! Boxes for broadphase tests: scattered, crowded, of equal and of many sizes.

use riprap::rock::broadphase::Aabb;

/// Knuth's MMIX generator, which gives the same scenes on every machine.
pub struct Random(pub u64);

impl Random {
    /// 32 bits.
    pub fn bits(&mut self) -> u32 {
        self.0 = self
            .0
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 32) as u32
    }

    /// In [0, 1).
    pub fn unit(&mut self) -> f64 {
        f64::from(self.bits()) / 4_294_967_296.0
    }

    /// In [low, high).
    pub fn between(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * self.unit()
    }
}

/// A box given by its lower corner and edges.
pub fn item(min: [f64; 3], edges: [f64; 3], group: u32) -> Aabb {
    Aabb {
        min,
        max: [0, 1, 2].map(|a| min[a] + edges[a]),
        group,
    }
}

/// `count` boxes with sizes from 1 to `ratio` cm, uniform on a logarithmic scale, in a domain of half their volume; on
/// average one of eight is fixed.
pub fn scattered(count: u32, ratio: f64, seed: u64) -> Vec<Aabb> {
    let mut random = Random(seed);
    let sizes: Vec<f64> = (0..count)
        .map(|_| 0.01 * ratio.powf(random.unit()))
        .collect();
    let volume: f64 = sizes.iter().map(|s| s.powi(3)).sum();
    let side = (0.5 * volume).cbrt();
    let boxes = (0..).zip(sizes).map(|(group, size)| {
        let min = [(); 3].map(|()| random.between(-0.5, 0.5) * side - 0.5 * size);
        let edges = [(); 3].map(|()| size * random.between(0.5, 1.0));
        let fixed = random.bits().is_multiple_of(8);
        item(min, edges, if fixed { u32::MAX } else { group })
    });
    boxes.collect()
}

/// All overlapping pairs by comparing every box with every other.
pub fn brute_force(items: &[Aabb]) -> Vec<[u32; 2]> {
    let mut pairs = Vec::new();
    for j in 0..items.len() {
        for i in 0..j {
            let (a, b) = (&items[i], &items[j]);
            let apart = (0..3).any(|k| a.max[k] < b.min[k] || b.max[k] < a.min[k]);
            if !apart && a.group != b.group {
                pairs.push([i as u32, j as u32]);
            }
        }
    }
    pairs.sort_unstable();
    pairs
}
