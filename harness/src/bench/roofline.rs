//! Where the time of a step goes: to the bytes that it must move, to their places, to arithmetic, to the rest
//! (Williams, Waterman & Patterson 2009, Commun. ACM 52:65).

use super::work::Work;
use riprap::lattice::Lattice;
use serde::Serialize;
use std::fmt;

/// Floating-point operations of a step, counted from its kernels; those of cells outside of the domain too, which few
/// bricks have.
pub fn flops_a_step(lattice: &Lattice) -> u64 {
    let kernels = lattice.kernels(false);
    kernels
        .map(|(kernel, groups)| {
            let work = Work::of(kernel.linked(), kernel.entry());
            work.flops * u64::from(kernel.invocations()) * u64::from(groups)
        })
        .sum()
}

/// Parts of the time of a step; a device that does two of them at once has parts that add up to more than it all.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Parts {
    /// What the fastest copy takes for the same bytes.
    pub copy: f64,
    /// What streaming alone takes beyond that: words that lie apart, and finding them.
    pub places: f64,
    /// What the operations take at the arithmetic ceiling.
    pub arithmetic: f64,
    /// What nothing of that explains: conversions, selections and integers, registers that do not suffice, launches.
    pub rest: f64,
}

/// What a step is made of, and what the machine can do; seconds, bytes and operations of a step.
#[derive(Clone, Copy, Debug)]
pub struct Ceilings {
    /// Bytes of a step.
    pub bytes: f64,
    /// Bytes a second.
    pub copy_bandwidth: f64,
    /// Seconds of a step that only streams the populations.
    pub stream_only: f64,
    /// Seconds that the fastest copy takes for the bytes of that.
    pub stream_copy: f64,
    /// Operations of a step.
    pub flops: f64,
    /// Operations a second.
    pub arithmetic: f64,
}

impl Parts {
    /// Of a step of `seconds`.
    pub fn of(seconds: f64, ceilings: Ceilings) -> Self {
        let share = |part: f64| part / seconds;
        let copy = share(ceilings.bytes / ceilings.copy_bandwidth);
        let places = share((ceilings.stream_only - ceilings.stream_copy).max(0.0));
        let arithmetic = share(ceilings.flops / ceilings.arithmetic);
        Self {
            copy,
            places,
            arithmetic,
            rest: (1.0 - copy - places - arithmetic).max(0.0),
        }
    }

    /// What takes the greatest part.
    pub fn limit(&self) -> &'static str {
        let all = [
            (self.copy, "bandwidth"),
            (self.places, "places of words"),
            (self.arithmetic, "arithmetic"),
            (self.rest, "other instructions"),
        ];
        let most = all.into_iter().max_by(|a, b| a.0.total_cmp(&b.0));
        most.map_or("", |(_, name)| name)
    }
}

/// Heads of the columns.
pub const HEAD: &str = "variant                        store  lanes |  B/cell flop/cell | copy places arithmetic rest | limited by";

impl fmt::Display for Parts {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let [copy, places, arithmetic, rest] =
            [self.copy, self.places, self.arithmetic, self.rest].map(|part| 100.0 * part);
        write!(
            f,
            "{copy:>3.0}% {places:>5.0}% {arithmetic:>9.0}% {rest:>3.0}% | {}",
            self.limit()
        )
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use kit::arithmetic::{FLOPS, program};

    #[test]
    fn the_ceiling_has_the_operations_that_are_counted() {
        let linked = program().link().unwrap();
        let work = Work::of(&linked, "multiply_add");
        // A turn of the loop, and seven sums of four components at the end.
        assert_eq!((work.flops, work.loops), (FLOPS + 28, 1));
    }

    const CEILINGS: Ceilings = Ceilings {
        bytes: 2e9,
        copy_bandwidth: 1e10,
        stream_only: 0.5,
        stream_copy: 0.1,
        flops: 1e9,
        arithmetic: 1e10,
    };

    #[test]
    fn parts_are_of_the_whole_step() {
        let parts = Parts::of(1.0, CEILINGS);
        let found = [parts.copy, parts.places, parts.arithmetic, parts.rest];
        for (found, expected) in found.into_iter().zip([0.2, 0.4, 0.1, 0.3]) {
            assert!((found - expected).abs() < 1e-12, "{parts:?}");
        }
        assert_eq!(parts.limit(), "places of words");
    }

    #[test]
    fn a_device_that_does_all_at_once_has_no_rest() {
        let parts = Parts::of(0.21, CEILINGS);
        assert_eq!(parts.rest, 0.0);
        let fast = Ceilings {
            stream_only: 0.2,
            ..CEILINGS
        };
        assert_eq!(Parts::of(0.21, fast).limit(), "bandwidth");
    }
}
