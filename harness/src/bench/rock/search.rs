//! Finding pairs, on the host and on a device.

use super::{
    Bench, Plan,
    core::{Core, Cost, time_on_all},
    row::{Basis, Done, Row, push},
};
use crate::{bench::report::Machine, gpu};
use riprap::{
    Result,
    rock::broadphase::{Aabb, Broadphase, DeviceBroadphase, HostBroadphase},
};
use std::time::Duration;

/// A hanging driver is given up after this.
const PATIENCE: Duration = Duration::from_secs(300);

/// Largest size over the smallest one.
pub const RATIOS: [u32; 2] = [1, 100];

/// Both finders on boxes of one size and of sizes 1:100, over the numbers of boxes.
///
/// # Errors
/// If the device fails.
pub fn measure(
    plan: &Plan,
    core: &Core,
    device: Option<&Bench<'_>>,
    machine: &Machine,
    rows: &mut Vec<Row>,
) -> Result<()> {
    let mut finder = device
        .map(|gpu| DeviceBroadphase::new(gpu.device, gpu.queue))
        .transpose()?;
    for ratio in RATIOS {
        for &count in &plan.items {
            let items = scattered(count, f64::from(ratio));
            let (mut on_host, mut on_device) = (Cost::NONE, Cost::NONE);
            // The first turn compiles and allocates.
            let mut pairs = pollster::block_on(HostBroadphase.pairs(&items))?.len();
            for _ in 0..=plan.rounds {
                let search = || pollster::block_on(HostBroadphase.pairs(&items));
                on_host = on_host.lower(core.time(search)?.1);
                if let (Some(gpu), Some(finder)) = (device, &mut finder) {
                    let search =
                        || gpu::drive(gpu.device, PATIENCE, "a search", finder.pairs(&items))?;
                    let (found, took) = time_on_all(search)?;
                    pairs = pairs.max(found.len());
                    on_device = on_device.lower(took);
                }
            }
            let mut put = |by: &str, cost, basis| {
                let done = Done {
                    kernel: "broadphase",
                    variant: format!("{by}, sizes 1:{ratio}"),
                    count,
                    pairs,
                    contacts: 0,
                };
                push(rows, Row::new(machine, done, cost, basis));
            };
            put("host", on_host, Basis::Cpu);
            if device.is_some() {
                let basis = match machine.software {
                    true => Basis::Cpu,
                    false => Basis::Wall,
                };
                put("device", on_device, basis);
            }
        }
    }
    Ok(())
}

/// Boxes of sizes from 1 to `ratio` cm, evenly on a logarithmic scale, in a cube of half their volume;
/// each eighth is fixed.
fn scattered(count: usize, ratio: f64) -> Vec<Aabb> {
    let mut random = Random(count as u64);
    let sizes: Vec<f64> = (0..count)
        .map(|_| 0.01 * ratio.powf(random.unit()))
        .collect();
    let volume: f64 = sizes.iter().map(|s| s.powi(3)).sum();
    let side = (0.5 * volume).cbrt();
    let boxes = (0..).zip(sizes).map(|(n, size)| {
        let min = [(); 3].map(|()| random.unit() * side - 0.5 * size);
        let max = min.map(|low| low + size * (0.5 + 0.5 * random.unit()));
        let fixed = random.unit() < 0.125;
        let group = if fixed { u32::MAX } else { n };
        Aabb { min, max, group }
    });
    boxes.collect()
}

/// Knuth's MMIX generator: the same boxes everywhere.
struct Random(u64);

impl Random {
    /// In [0, 1).
    fn unit(&mut self) -> f64 {
        let next = self.0.wrapping_mul(6_364_136_223_846_793_005);
        self.0 = next.wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 32) as f64 / 4_294_967_296.0
    }
}
