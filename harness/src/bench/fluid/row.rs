//! A result of the fluid part, in the table and in the file, and the split of the time of a step: bytes moved, their scattered
//! places, arithmetic, rest (Williams, Waterman & Patterson 2009, Commun. ACM 52:65).

use super::variant::Variant;
use crate::bench::work::Work;
use kit::clock::Turn;
use riprap::lattice::{Lattice, Storage, bytes_per_cell, bytes_per_step};
use serde::Serialize;
use std::fmt;

/// Result of one variant on one grid.
#[derive(Clone, Debug, Serialize)]
pub struct Row {
    /// Name of the variant.
    pub variant: &'static str,
    /// Cells per axis.
    pub grid: u32,
    /// Storage of the populations.
    pub storage: &'static str,
    /// Cells per invocation.
    pub lanes: u32,
    /// Storage bindings of the populations.
    pub bindings: u32,
    /// Elements of a brick per axis.
    pub brick: [u32; 3],
    /// Wall time per step, ms.
    pub ms_wall: f64,
    /// Time per step between GPU timestamps, ms.
    pub ms_device: Option<f64>,
    /// CPU time per step of all threads together, ms.
    pub ms_cpu: f64,
    /// Million cells per second: cells × steps × cores / CPU seconds on a software adapter; elsewhere by GPU time, or by wall
    /// time without timestamps.
    pub mlups: f64,
    /// Million cells per second of wall time.
    pub mlups_wall: f64,
    /// Bytes that a step moves per cell away from walls.
    #[serde(rename = "bytes_a_cell")]
    pub bytes_per_cell: u64,
    /// Total bytes that a step moves.
    #[serde(rename = "bytes_a_step")]
    pub bytes_per_step: u64,
    /// Counted bytes per second, on the time base of `mlups`.
    pub bandwidth: f64,
    /// Bytes that the fastest copy reads and writes per second, in the same rounds.
    pub copy_bandwidth: f64,
    /// `bandwidth` over `copy_bandwidth`.
    pub share_of_copy: f64,
    /// Time of streaming without collision in the same layout, over the time of this variant.
    pub ratio_to_stream_only: f64,
    /// Floating-point operations of a step over its cells, counted from the code of its kernels.
    pub flops_a_cell: f64,
    /// Floating-point operations per second.
    pub flops: f64,
    /// The same of a kernel that does nothing else, in the same rounds.
    pub arithmetic_ceiling: f64,
    /// Split of the time, as fractions of it.
    pub parts: Parts,
}

/// Limits of the machine, from the same rounds as the steps compared with them.
#[derive(Clone, Copy, Debug)]
pub struct Ceilings {
    /// Bytes that the fastest copy reads and writes per second.
    pub copy_bandwidth: f64,
    /// Seconds of a step that only streams, in the same layout.
    pub stream_only: f64,
    /// Bytes moved by that step.
    pub stream_bytes: u64,
    /// Floating-point operations per second of a kernel that does nothing else.
    pub arithmetic: f64,
}

/// Bytes and operations of a step.
#[derive(Clone, Copy, Debug)]
pub struct StepWork {
    /// Bytes.
    pub bytes: u64,
    /// Floating-point operations, counted from its kernels, including those of cells outside the domain, which few bricks have.
    pub flops: u64,
}

impl StepWork {
    /// Counts a step of a lattice.
    pub fn of(lattice: &Lattice) -> Self {
        let kernels = lattice.kernels(false).map(|(kernel, groups)| {
            let work = Work::of(kernel.linked(), kernel.entry());
            work.flops * u64::from(kernel.invocations()) * u64::from(groups)
        });
        Self {
            bytes: bytes_per_step(lattice.setup(), lattice.grid(), lattice.geometry()),
            flops: kernels.sum(),
        }
    }
}

impl Row {
    /// A row from the time, the bytes and the operations of a step.
    pub fn new(
        variant: &Variant,
        grid: u32,
        step: &Turn,
        work: StepWork,
        ceilings: Ceilings,
    ) -> Self {
        let cells = f64::from(grid).powi(3);
        let bandwidth = work.bytes as f64 / step.basis;
        Self {
            variant: variant.name,
            grid,
            storage: storage(variant.setup.storage),
            lanes: variant.setup.lanes,
            bindings: variant.memory.bindings.populations,
            brick: variant.setup.brick,
            ms_wall: 1e3 * step.spent.wall,
            ms_device: step.device.map(|s| 1e3 * s),
            ms_cpu: 1e3 * step.spent.cpu,
            mlups: cells / step.basis / 1e6,
            mlups_wall: cells / step.spent.wall / 1e6,
            bytes_per_cell: bytes_per_cell(&variant.setup),
            bytes_per_step: work.bytes,
            bandwidth,
            copy_bandwidth: ceilings.copy_bandwidth,
            share_of_copy: bandwidth / ceilings.copy_bandwidth,
            ratio_to_stream_only: ceilings.stream_only / step.basis,
            flops_a_cell: work.flops as f64 / cells,
            flops: work.flops as f64 / step.basis,
            arithmetic_ceiling: ceilings.arithmetic,
            parts: Parts::of(step.basis, work, ceilings),
        }
    }
}

/// Name of a storage in the files.
pub fn storage(storage: Storage) -> &'static str {
    match storage {
        Storage::F32 => "f32",
        Storage::F16 => "f16",
    }
}

/// Column heads of a row.
pub const HEAD: &str = "variant                        store  lanes bindings |  ms wall   ms GPU   ms CPU | \
    MLUPS  B/cell   GB/s  of copy  of streaming";

impl fmt::Display for Row {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let device = self.ms_device.map_or("-".into(), |ms| format!("{ms:.3}"));
        write!(
            f,
            "{:<30} {:>5} {:>6} {:>8} | {:>8.3} {device:>8} {:>8.3} | {:>6.1} {:>7} {:>6.1} {:>7.0}% {:>12.0}%",
            self.variant,
            self.storage,
            self.lanes,
            self.bindings,
            self.ms_wall,
            self.ms_cpu,
            self.mlups,
            self.bytes_per_cell,
            self.bandwidth / 1e9,
            100.0 * self.share_of_copy,
            100.0 * self.ratio_to_stream_only
        )
    }
}

/// Fractions of the time of a step; on a device that overlaps them they add up to more than one.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Parts {
    /// Time of the fastest copy for the same bytes.
    pub copy: f64,
    /// Additional time of streaming alone: scattered words, and their addresses.
    pub places: f64,
    /// Time of the operations at the arithmetic ceiling.
    pub arithmetic: f64,
    /// The rest: conversions, selections and integers, register pressure, launches.
    pub rest: f64,
}

impl Parts {
    /// Splits the time of a step of `seconds`.
    pub fn of(seconds: f64, work: StepWork, ceilings: Ceilings) -> Self {
        let copied = |bytes: u64| bytes as f64 / ceilings.copy_bandwidth;
        let places = (ceilings.stream_only - copied(ceilings.stream_bytes)).max(0.0);
        let arithmetic = work.flops as f64 / ceilings.arithmetic;
        let [copy, places, arithmetic] =
            [copied(work.bytes), places, arithmetic].map(|part| part / seconds);
        Self {
            copy,
            places,
            arithmetic,
            rest: (1.0 - copy - places - arithmetic).max(0.0),
        }
    }

    /// Name of the largest part.
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

/// Prints the split of the time of the steps on a grid.
pub fn explain(grid: u32, rows: &[Row]) {
    let mut some = rows.iter().filter(|row| row.grid == grid).peekable();
    let Some(first) = some.peek() else { return };
    println!(
        "\nwhere the time goes, of {:.1} GB/s copied and {:.1} Gflop/s computed at most\n\
         variant                        store  lanes |  B/cell flop/cell | copy places arithmetic rest | limited by",
        first.copy_bandwidth / 1e9,
        first.arithmetic_ceiling / 1e9
    );
    for row in some {
        let Parts {
            copy,
            places,
            arithmetic,
            rest,
        } = row.parts;
        println!(
            "{:<30} {:>5} {:>6} | {:>7} {:>9.0} | {:>3.0}% {:>5.0}% {:>9.0}% {:>3.0}% | {}",
            row.variant,
            row.storage,
            row.lanes,
            row.bytes_per_cell,
            row.flops_a_cell,
            100.0 * copy,
            100.0 * places,
            100.0 * arithmetic,
            100.0 * rest,
            row.parts.limit()
        );
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use kit::subject::{FLOPS, program};

    #[test]
    fn the_ceiling_has_the_operations_that_are_counted() {
        let linked = program().link().unwrap();
        let work = Work::of(&linked, "multiply_add");
        // An iteration of the loop, and seven sums of four components at the end.
        assert_eq!((work.flops, work.loops), (FLOPS + 28, 1));
    }

    const WORK: StepWork = StepWork {
        bytes: 2_000_000_000,
        flops: 1_000_000_000,
    };
    const CEILINGS: Ceilings = Ceilings {
        copy_bandwidth: 1e10,
        stream_only: 0.5,
        stream_bytes: 1_000_000_000,
        arithmetic: 1e10,
    };

    #[test]
    fn parts_are_of_the_whole_step() {
        let parts = Parts::of(1.0, WORK, CEILINGS);
        let found = [parts.copy, parts.places, parts.arithmetic, parts.rest];
        for (found, expected) in found.into_iter().zip([0.2, 0.4, 0.1, 0.3]) {
            assert!((found - expected).abs() < 1e-12, "{parts:?}");
        }
        assert_eq!(parts.limit(), "places of words");
    }

    #[test]
    fn a_device_that_does_all_at_once_has_no_rest() {
        assert_eq!(Parts::of(0.21, WORK, CEILINGS).rest, 0.0);
        let fast = Ceilings {
            stream_only: 0.2,
            ..CEILINGS
        };
        assert_eq!(Parts::of(0.21, WORK, fast).limit(), "bandwidth");
    }
}
