//! A result, in the table and in the file.

use super::{
    roofline::{self, Ceilings, Parts},
    variant::Variant,
};
use kit::{
    clock::{self, Spent},
    gpu,
};
use riprap::{
    lattice::{Storage, bytes_a_cell},
    wgpu,
};
use serde::Serialize;
use std::fmt;

/// Where it was measured.
#[derive(Clone, Debug, Serialize)]
pub struct Machine {
    /// Adapter.
    pub adapter: String,
    /// API it is reached through.
    pub backend: String,
    /// Driver and its version.
    pub driver: String,
    /// Whether the adapter computes on the CPU.
    pub software: bool,
    /// Cores of the CPU.
    pub cores: usize,
    /// Version of riprap.
    pub version: &'static str,
    /// Commit of the working directory, where there is one.
    pub commit: Option<String>,
    /// When, UTC.
    pub date: String,
}

impl Machine {
    /// This machine with an adapter, now.
    pub fn of(info: &wgpu::AdapterInfo) -> Self {
        Self {
            adapter: info.name.clone(),
            backend: format!("{:?}", info.backend),
            driver: format!("{} {}", info.driver, info.driver_info)
                .trim()
                .into(),
            software: gpu::is_software(info),
            ..Self::host()
        }
    }

    /// A name for files: adapter, backend and cores, such as `llvmpipe_vulkan_2_cores`.
    pub fn slug(&self) -> String {
        let name = self.adapter.split('(').next().unwrap_or_default();
        let text = format!("{name} {} {} cores", self.backend, self.cores).to_lowercase();
        let words = text.split(|c: char| !c.is_ascii_alphanumeric());
        let words: Vec<_> = words.filter(|word| !word.is_empty()).collect();
        words.join("_")
    }

    /// This machine without an adapter, now.
    pub fn host() -> Self {
        let git = std::process::Command::new("git")
            .args(["rev-parse", "--short=12", "HEAD"])
            .output();
        let commit = git.ok().filter(|out| out.status.success());
        let now = std::time::SystemTime::now().duration_since(std::time::UNIX_EPOCH);
        Self {
            adapter: "no adapter".into(),
            backend: "none".into(),
            driver: String::new(),
            software: true,
            cores: clock::cores(),
            version: env!("CARGO_PKG_VERSION"),
            commit: commit.map(|out| String::from_utf8_lossy(&out.stdout).trim().into()),
            date: utc(now.map_or(0, |d| d.as_secs())),
        }
    }
}

impl fmt::Display for Machine {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let basis = if self.software {
            "MLUPS by CPU time"
        } else {
            "MLUPS by GPU time"
        };
        write!(
            f,
            "{} ({}, {}), {} cores, riprap {} {}; {basis}",
            self.adapter,
            self.backend,
            self.driver,
            self.cores,
            self.version,
            self.commit.as_deref().unwrap_or_default()
        )
    }
}

/// ISO 8601 of seconds since 1970. Days are counted in years that begin in March, so that leap days
/// come last.
fn utc(seconds: u64) -> String {
    let days = seconds / 86_400 + 719_468;
    let (era, day) = (days / 146_097, days % 146_097);
    let year = (day - day / 1_460 + day / 36_524 - day / 146_096) / 365;
    let day = day - (365 * year + year / 4 - year / 100);
    let month = (5 * day + 2) / 153;
    let day = day - (153 * month + 2) / 5 + 1;
    let year = 400 * era + year + u64::from(month >= 10);
    let month = if month < 10 { month + 3 } else { month - 9 };
    let (hour, minute, second) = (seconds / 3_600 % 24, seconds / 60 % 60, seconds % 60);
    format!("{year}-{month:02}-{day:02}T{hour:02}:{minute:02}:{second:02}Z")
}

/// What one variant does on one grid.
#[derive(Clone, Debug, Serialize)]
pub struct Row {
    /// Name of the variant.
    pub variant: &'static str,
    /// Cells an axis.
    pub grid: u32,
    /// Storage of the populations.
    pub storage: &'static str,
    /// Cells an invocation.
    pub lanes: u32,
    /// Storage bindings of the populations.
    pub bindings: u32,
    /// Elements of a brick an axis.
    pub brick: [u32; 3],
    /// Milliseconds a step by the clock on the wall.
    pub ms_wall: f64,
    /// Milliseconds a step between GPU timestamps.
    pub ms_device: Option<f64>,
    /// Milliseconds of CPU time a step, all threads together.
    pub ms_cpu: f64,
    /// Million cells a second: cells × steps × cores / CPU seconds on a software adapter, by GPU
    /// time, or wall time without timestamps, elsewhere.
    pub mlups: f64,
    /// Million cells a second by the clock on the wall.
    pub mlups_wall: f64,
    /// Bytes that a step moves for a cell away from walls.
    pub bytes_a_cell: u64,
    /// Bytes that a step moves in all.
    pub bytes_a_step: u64,
    /// Counted bytes a second, on the time that `mlups` has.
    pub bandwidth: f64,
    /// Bytes that the fastest copy reads and writes a second, in the same rounds.
    pub copy_bandwidth: f64,
    /// `bandwidth` over `copy_bandwidth`.
    pub share_of_copy: f64,
    /// Time of streaming without collision in the same layout, over the time of this.
    pub ratio_to_stream_only: f64,
    /// Floating-point operations of a step over its cells, counted from the code of its kernels.
    pub flops_a_cell: f64,
    /// Such operations a second.
    pub flops: f64,
    /// Those of a kernel that does nothing else, in the same rounds.
    pub arithmetic_ceiling: f64,
    /// Where the time goes, as parts of it.
    pub parts: Parts,
    /// Where and when.
    #[serde(flatten)]
    pub machine: Machine,
}

/// What a step is compared with, from the same rounds.
#[derive(Clone, Copy, Debug)]
pub struct Beside {
    /// Bytes that the fastest copy reads and writes a second.
    pub copy_bandwidth: f64,
    /// Seconds of a step that only streams, in the same layout.
    pub stream_only: f64,
    /// Bytes that it moves.
    pub stream_bytes: u64,
    /// Floating-point operations a second, where nothing else is done.
    pub arithmetic: f64,
}

/// What a step moves and computes.
#[derive(Clone, Copy, Debug)]
pub struct Moved {
    /// Bytes.
    pub bytes: u64,
    /// Floating-point operations.
    pub flops: u64,
}

impl Row {
    /// A row from the time of a step and what it moves and computes.
    pub fn new(
        machine: &Machine,
        variant: &Variant,
        grid: u32,
        step: &Spent,
        Moved { bytes, flops }: Moved,
        beside: Beside,
    ) -> Self {
        let cells = f64::from(grid).powi(3);
        let bandwidth = bytes as f64 / step.basis;
        Self {
            variant: variant.name,
            grid,
            storage: match variant.setup.storage {
                Storage::F32 => "f32",
                Storage::F16 => "f16",
            },
            lanes: variant.setup.lanes,
            bindings: variant.memory.bindings,
            brick: variant.setup.brick,
            ms_wall: 1e3 * step.wall,
            ms_device: step.device.map(|s| 1e3 * s),
            ms_cpu: 1e3 * step.cpu,
            mlups: cells / step.basis / 1e6,
            mlups_wall: cells / step.wall / 1e6,
            bytes_a_cell: bytes_a_cell(&variant.setup),
            bytes_a_step: bytes,
            bandwidth,
            copy_bandwidth: beside.copy_bandwidth,
            share_of_copy: bandwidth / beside.copy_bandwidth,
            ratio_to_stream_only: beside.stream_only / step.basis,
            flops_a_cell: flops as f64 / cells,
            flops: flops as f64 / step.basis,
            arithmetic_ceiling: beside.arithmetic,
            parts: Parts::of(
                step.basis,
                Ceilings {
                    bytes: bytes as f64,
                    copy_bandwidth: beside.copy_bandwidth,
                    stream_only: beside.stream_only,
                    stream_copy: beside.stream_bytes as f64 / beside.copy_bandwidth,
                    flops: flops as f64,
                    arithmetic: beside.arithmetic,
                },
            ),
            machine: machine.clone(),
        }
    }
}

/// Heads of the columns of a row.
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
            self.bytes_a_cell,
            self.bandwidth / 1e9,
            100.0 * self.share_of_copy,
            100.0 * self.ratio_to_stream_only
        )
    }
}

/// Prints where the time of the steps on a grid goes.
pub fn explain(grid: u32, rows: &[Row]) {
    let mut some = rows.iter().filter(|row| row.grid == grid).peekable();
    let Some(first) = some.peek() else { return };
    println!(
        "\nwhere the time goes, of {:.1} GB/s copied and {:.1} Gflop/s computed at most\n{}",
        first.copy_bandwidth / 1e9,
        first.arithmetic_ceiling / 1e9,
        roofline::HEAD
    );
    for row in some {
        println!(
            "{:<30} {:>5} {:>6} | {:>7} {:>9.0} | {}",
            row.variant, row.storage, row.lanes, row.bytes_a_cell, row.flops_a_cell, row.parts
        );
    }
}

#[cfg(test)]
mod tests {
    #[test]
    fn dates_count_leap_days() {
        assert_eq!(super::utc(0), "1970-01-01T00:00:00Z");
        assert_eq!(super::utc(951_782_400), "2000-02-29T00:00:00Z");
        assert_eq!(super::utc(1_735_689_599), "2024-12-31T23:59:59Z");
    }
}
