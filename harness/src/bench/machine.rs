//! Machine and time of a measurement.

use kit::{clock, gpu};
use riprap::wgpu;
use serde::Serialize;
use std::fmt;

/// Machine, version and time of a measurement.
#[derive(Clone, Debug, Serialize)]
pub struct Machine {
    /// Adapter.
    pub adapter: String,
    /// API through which it is accessed.
    pub backend: String,
    /// Driver and its version.
    pub driver: String,
    /// Whether the adapter computes on the CPU.
    pub software: bool,
    /// Cores of the CPU.
    pub cores: usize,
    /// Version of riprap.
    pub version: &'static str,
    /// Commit of the working directory, if any.
    pub commit: Option<String>,
    /// Date and time, UTC.
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

impl Machine {
    /// Results of this machine, as a JSON array.
    pub fn json<T: Serialize>(
        &self,
        rows: impl IntoIterator<Item = T>,
    ) -> serde_json::Result<String> {
        #[derive(Serialize)]
        struct Kept<'a, T> {
            #[serde(flatten)]
            row: T,
            #[serde(flatten)]
            machine: &'a Machine,
        }
        let kept = |row| Kept { row, machine: self };
        let kept: Vec<_> = rows.into_iter().map(kept).collect();
        Ok(serde_json::to_string_pretty(&kept)? + "\n")
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
