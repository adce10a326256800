//! The rock part: cutting, contacts, the search for pairs, the step of all blocks.

mod crossover;
mod kernels;
mod pile;

pub use crossover::{Crossover, crossover};
pub use kit::clock::exponent;

use super::{
    Bench,
    target::{Target, show},
};
use cpu_time::ThreadTime;
use kit::clock::Spent;
use pile::Split;
use riprap::{Error, Result};
use serde::Serialize;
use std::{fmt, time::Instant};

/// Extent of the measurement.
#[derive(Clone, Debug)]
pub struct Plan {
    /// Approximate numbers of free blocks in piles.
    pub piles: Vec<usize>,
    /// Numbers of boxes for the broadphase.
    pub items: Vec<usize>,
    /// Samples, of which the fastest counts.
    pub rounds: usize,
}

impl Plan {
    /// Up to a thousand blocks if `quick`, ten thousand by default, or a hundred thousand if `full`, which take long to come to
    /// rest.
    pub fn new(quick: bool, full: bool) -> Self {
        let (blocks, boxes, rounds) = match (quick, full) {
            (_, true) => (5, 5, 9),
            (true, _) => (3, 4, 5),
            (false, false) => (4, 5, 9),
        };
        let powers = |largest| (2..=largest).map(|k| 10usize.pow(k)).collect();
        Self {
            piles: powers(blocks),
            items: powers(boxes),
            rounds,
        }
    }
}

/// Time of one kernel for one number of blocks or boxes.
#[derive(Clone, Debug, Serialize)]
pub struct Row {
    /// `cut`, `broadphase`, `contact` or `step`.
    pub kernel: &'static str,
    /// What the kernel works on, and where it runs.
    pub variant: String,
    /// Boxes of the broadphase, blocks that a cut makes, free blocks otherwise.
    pub count: usize,
    /// Pairs that a call finds or resolves.
    pub pairs: usize,
    /// Contacts per call.
    pub contacts: usize,
    /// CPU time per call, the least of several, ms.
    pub ms_cpu: f64,
    /// Wall time per call, the least of several, ms.
    pub ms_wall: f64,
    /// The cost, one of these two: wall time on a GPU and on all cores, else CPU time.
    pub ms: f64,
    /// Contacts over the cost of all pairs.
    pub contacts_a_second: f64,
    /// Pairs over the cost.
    pub pairs_a_second: f64,
    /// Share of the pairs that needed a linear program.
    pub share_of_programs: Option<f64>,
    /// p of cost ∝ countᵖ over this count and the previous ones of the same variant.
    pub exponent: Option<f64>,
    /// Speed of the fastest free block, m/s.
    pub largest_speed: Option<f64>,
    /// Cost over that of the variant that this one is compared with.
    pub ratio: Option<f64>,
    /// Split of the time of a step.
    pub split: Option<Split>,
}

/// Time that counts as the cost.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Basis {
    /// CPU time.
    Cpu,
    /// Wall time.
    Wall,
}

impl Row {
    /// A row for a call on `count` boxes or blocks.
    pub fn new(
        kernel: &'static str,
        variant: impl Into<String>,
        count: usize,
        spent: Spent,
        basis: Basis,
    ) -> Self {
        let seconds = match basis {
            Basis::Cpu => spent.cpu,
            Basis::Wall => spent.wall,
        };
        Self {
            kernel,
            variant: variant.into(),
            count,
            pairs: 0,
            contacts: 0,
            ms_cpu: 1e3 * spent.cpu,
            ms_wall: 1e3 * spent.wall,
            ms: 1e3 * seconds,
            contacts_a_second: 0.0,
            pairs_a_second: 0.0,
            share_of_programs: None,
            exponent: None,
            largest_speed: None,
            ratio: None,
            split: None,
        }
    }

    /// Adds the rates and the exponent to the row, prints it and appends it to `rows`.
    pub fn push(mut self, rows: &mut Vec<Self>) {
        let alike = |other: &&Self| other.kernel == self.kernel && other.variant == self.variant;
        let all = rows.iter().filter(alike).chain([&self]);
        let points: Vec<_> = all.map(|row| (row.count as f64, row.ms)).collect();
        self.exponent = exponent(&points);
        self.contacts_a_second = 1e3 * self.contacts as f64 / self.ms;
        self.pairs_a_second = 1e3 * self.pairs as f64 / self.ms;
        println!("{self}");
        rows.push(self);
    }
}

/// Column heads of a row.
pub const HEAD: &str = "kernel      variant                               count     pairs  contacts |     ms CPU    ms wall | contacts/s    pairs/s    LP     p  ratio";

impl fmt::Display for Row {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let or_dash = |text: Option<String>| text.unwrap_or_else(|| "-".into());
        write!(
            f,
            "{:<11} {:<34} {:>8} {:>9} {:>9} | {:>10.4} {:>10.4} | {:>10.0} {:>10.0} {:>5} {:>5} {:>6}",
            self.kernel,
            self.variant,
            self.count,
            self.pairs,
            self.contacts,
            self.ms_cpu,
            self.ms_wall,
            self.contacts_a_second,
            self.pairs_a_second,
            or_dash(self.share_of_programs.map(|s| format!("{:.1}%", 100.0 * s))),
            or_dash(self.exponent.map(|p| format!("{p:.2}"))),
            or_dash(self.ratio.map(|r| format!("{r:.2}"))),
        )?;
        match &self.split {
            Some(split) => write!(f, "\n            {split}"),
            None => Ok(()),
        }
    }
}

/// A dedicated thread, on which parallel loops run serially.
struct Core(rayon::ThreadPool);

impl Core {
    fn new() -> Result<Self> {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(1).build();
        pool.map(Self)
            .map_err(|e| Error::argument("threads", e.to_string()))
    }

    /// Time of `work` on that thread.
    fn time(&self, work: impl FnOnce() -> Result<()> + Send) -> Result<Spent> {
        self.0.install(|| {
            let (wall, cpu) = (Instant::now(), ThreadTime::now());
            work()?;
            Ok(Spent {
                wall: wall.elapsed().as_secs_f64(),
                cpu: cpu.elapsed().as_secs_f64(),
            })
        })
    }
}

/// Time per call in the fastest of some `rounds`, each with the given number of `calls`.
fn fastest(rounds: usize, calls: usize, mut call: impl FnMut() -> Result<Spent>) -> Result<Spent> {
    let mut least = Spent::MOST;
    for _ in 0..rounds {
        let mut spent = Spent::default();
        for _ in 0..calls {
            spent += call()?;
        }
        least = least.lower(spent.scaled(1.0 / calls as f64));
    }
    Ok(least)
}

/// Measures the whole plan and prints a table as it goes; without a device, only on the host.
pub fn measure(plan: &Plan, device: Option<&Bench<'_>>) -> Result<(Vec<Row>, Vec<Target>)> {
    println!("\nrock: the fastest of {} samples\n{}", plan.rounds, HEAD);
    let core = Core::new()?;
    let mut rows = Vec::new();
    kernels::cut(plan, &mut rows)?;
    kernels::broadphase(plan, &core, device, &mut rows)?;
    kernels::few_blocks(plan, &core, &mut rows)?;
    pile::measure(plan, &core, &mut rows)?;
    let targets = show("rock", targets(&rows));
    Ok((rows, targets))
}

/// The targets for which there are rows.
fn targets(rows: &[Row]) -> [Option<Target>; 10] {
    let of = |kernel, variant| {
        let all = rows.iter().filter(move |row| row.kernel == kernel);
        all.filter(move |row| row.variant == variant)
    };
    let contacts = of("contact", pile::WARM).map(|row| row.contacts_a_second);
    let pairs = of("contact", pile::COLD).map(|row| row.pairs_a_second);
    let programs = of("step", pile::ONE_CORE).filter_map(|row| row.share_of_programs);
    let mut cut = of("cut", kernels::CUBE).filter(|row| row.count >= 100_000);
    let ratio = of("step", kernels::AMONG_FIVE).filter_map(|row| row.ratio);
    // The exponent of the last row covers all counts.
    let exponent = |says, kernel, variant| {
        let last = of(kernel, variant).next_back();
        Target::at_most(says, last.and_then(|row| row.exponent), 1.1)
    };
    [
        Target::at_least("warm ≥ 200 000 contacts/s", contacts.reduce(f64::min), 2e5),
        Target::at_least("cold ≥ 15 000 pairs/s", pairs.reduce(f64::min), 1.5e4),
        Target::at_most(
            "LP for ≤ 3 % of the pairs",
            programs.map(|share| 100.0 * share).reduce(f64::max),
            3.0,
        ),
        exponent("exponent of the step ≤ 1.1", "step", pile::ONE_CORE),
        exponent(
            "exponent of the host's broadphase, sizes 1:1 ≤ 1.1",
            "broadphase",
            "host, sizes 1:1",
        ),
        exponent(
            "exponent of the host's broadphase, sizes 1:100 ≤ 1.1",
            "broadphase",
            "host, sizes 1:100",
        ),
        exponent(
            "exponent of the device's broadphase, sizes 1:1 ≤ 1.1",
            "broadphase",
            "device, sizes 1:1",
        ),
        exponent(
            "exponent of the device's broadphase, sizes 1:100 ≤ 1.1",
            "broadphase",
            "device, sizes 1:100",
        ),
        Target::at_most(
            "10⁵ blocks cut in ≤ 10 s",
            cut.next().map(|row| 1e-3 * row.ms),
            10.0,
        ),
        Target::at_most(
            "five fixed blocks cost ≤ 1.2 of one",
            ratio.reduce(f64::max),
            1.2,
        ),
    ]
}
