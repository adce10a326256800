//! Number of boxes from which the device finds pairs faster than the host.

use super::{Core, Plan, Row, kernels};
use crate::bench::Bench;
use riprap::{Result, gpu::Processor, rock::broadphase::AutoBroadphase};
use serde::Serialize;

/// The number of boxes from which a search on the device is the faster one.
#[derive(Clone, Debug, Serialize)]
pub struct Crossover {
    /// Kind of record: `crossover`.
    pub part: &'static str,
    /// Sizes of the boxes.
    pub variant: String,
    /// The number; `None` if the host is faster up to the largest number tried.
    pub boxes: Option<usize>,
    /// Largest number of boxes tried.
    pub up_to: usize,
    /// Default of the library on such an adapter; `None` if it never searches on the device.
    pub default: Option<usize>,
}

/// Measures both searches over the numbers of boxes, and their crossover.
pub fn crossover(bench: &Bench<'_>) -> Result<(Vec<Row>, Vec<Crossover>)> {
    let plan = Plan {
        piles: Vec::new(),
        items: vec![100, 316, 1000, 3162, 10_000, 31_623, 100_000],
        rounds: 5,
    };
    println!(
        "\nbroadphase: the fastest of {} samples\n{}",
        plan.rounds,
        super::HEAD
    );
    let mut rows = Vec::new();
    kernels::broadphase(&plan, &Core::new()?, Some(bench), &mut rows)?;
    let processor = Processor::of(&bench.device.adapter_info());
    let default = AutoBroadphase::crossover_on(processor);
    let cross = |ratio: u32| {
        let of = |by: &str| {
            let variant = format!("{by}, sizes 1:{ratio}");
            let own = rows.iter().filter(move |row| row.variant == variant);
            own.map(|row| (row.count, row.ms)).collect::<Vec<_>>()
        };
        Crossover {
            part: "crossover",
            variant: format!("sizes 1:{ratio}"),
            boxes: crossing(&of("host"), &of("device")),
            up_to: plan.items.iter().copied().max().unwrap_or_default(),
            default: (default < usize::MAX).then_some(default),
        }
    };
    let all: Vec<_> = [1, 100].map(cross).into();
    for found in &all {
        let at = match found.boxes {
            Some(boxes) => format!("the device is faster from {boxes} boxes on"),
            None => format!("the host is faster up to {} boxes", found.up_to),
        };
        println!("{}: {at}", found.variant);
    }
    if let Some(boxes) = all.iter().filter_map(|found| found.boxes).max() {
        println!("a scene takes it as `rock.broadphase_crossover = {boxes}`");
    }
    Ok((rows, all))
}

/// The count from which the second cost is below the first, by log–log interpolation of the cost ratio.
fn crossing(first: &[(usize, f64)], second: &[(usize, f64)]) -> Option<usize> {
    let both = first.iter().zip(second);
    // Logarithm of the second cost over the first.
    let excess: Vec<_> = both.map(|(a, b)| (a.0 as f64, (b.1 / a.1).ln())).collect();
    let from = excess.iter().rposition(|(_, excess)| *excess >= 0.0);
    let Some(last) = from else {
        return first.first().map(|(count, _)| *count);
    };
    let [(low, above), (high, below)] = *excess.get(last..last + 2)?.first_chunk()?;
    let share = above / (above - below);
    Some((low * (high / low).powf(share)).round() as usize)
}

#[cfg(test)]
mod tests {
    use super::crossing;

    #[test]
    fn costs_cross_where_their_lines_do() {
        let host = [100, 1000, 10_000].map(|n| (n, n as f64));
        let device = |overhead: f64| [100, 1000, 10_000].map(|n| (n, overhead + 0.01 * n as f64));
        // More expensive by 300/100 at 100, cheaper by 1000/309 at 1000: 100·10^(ln 3/(ln 3 + ln 3.236)).
        assert_eq!(crossing(&host, &device(299.0)), Some(304));
        assert_eq!(crossing(&host, &device(1.0)), Some(100));
        assert_eq!(crossing(&host, &device(1e6)), None);
        assert_eq!(crossing(&[], &[]), None);
    }
}
