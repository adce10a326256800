//! Thousands of corrupted scenes and meshes: each is either read or refused with a place, without a panic, a hang or a
//! large allocation.

mod meshes;
mod scenes;

use riprap::{Error, Result};
use std::{
    panic::{AssertUnwindSafe, catch_unwind},
    sync::{Arc, Mutex, mpsc},
    time::Duration,
};

/// Pseudorandom numbers, the same in every run (Steele, Lea & Flood 2014, SplitMix64).
struct Dice(u64);

impl Dice {
    fn roll(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ (z >> 31)
    }

    /// Below `n`, which is not 0.
    fn below(&mut self, n: usize) -> usize {
        (self.roll() % n as u64) as usize
    }

    fn pick<'a, T>(&mut self, all: &'a [T]) -> &'a T {
        &all[self.below(all.len())]
    }
}

/// Longest time for one input: a thousand times that of the slowest valid one.
const PATIENCE: Duration = Duration::from_secs(20);
/// Largest peak memory of the process, bytes; valid inputs take a tenth.
const MEMORY: u64 = 1 << 30;

/// Runs `read` on each input and checks the result.
fn judge<T: Send + 'static>(
    inputs: impl Iterator<Item = T> + Send + 'static,
    bytes: fn(&T) -> &[u8],
    read: impl Fn(&T) -> Result<()> + Send + 'static,
) {
    let (tell, heard) = mpsc::channel();
    let present = Arc::new(Mutex::new(Vec::new()));
    let kept = Arc::clone(&present);
    // In its own thread: an input that hangs cannot be stopped, only timed out.
    std::thread::spawn(move || {
        let (mut good, mut refused) = (0, 0);
        for (number, input) in inputs.enumerate() {
            bytes(&input).clone_into(&mut kept.lock().unwrap());
            if number % 500 == 0 {
                // Shows the last input if the process is killed.
                println!("input {number}");
            }
            let verdict = match catch_unwind(AssertUnwindSafe(|| read(&input))) {
                Err(_) => Err("it panicked".to_owned()),
                Ok(Ok(())) => {
                    good += 1;
                    Ok(())
                }
                Ok(Err(error)) => {
                    refused += 1;
                    has_a_place(&error)
                }
            };
            let verdict = verdict.and_then(|()| small());
            let shown = verdict.map_err(|why| {
                let text = String::from_utf8_lossy(bytes(&input)).into_owned();
                format!("input {number}: {why}\n{text}")
            });
            if tell.send(shown.map(|()| (good, refused))).is_err() {
                return;
            }
        }
    });
    let mut counts = (0, 0);
    loop {
        match heard.recv_timeout(PATIENCE) {
            Ok(Ok(now)) => counts = now,
            Ok(Err(why)) => panic!("{why}"),
            Err(mpsc::RecvTimeoutError::Disconnected) => break,
            Err(mpsc::RecvTimeoutError::Timeout) => panic!(
                "no answer within {PATIENCE:?} to:\n{}",
                String::from_utf8_lossy(&present.lock().unwrap())
            ),
        }
    }
    println!("{} read, {} refused", counts.0, counts.1);
    // Both must occur for the inputs to be a test.
    assert!(counts.0 > 20 && counts.1 > 100, "{counts:?}");
}

/// Checks that an error names a line, a key, a file or a block, and has a message.
fn has_a_place(error: &Error) -> std::result::Result<(), String> {
    let named = match error {
        Error::Scene {
            place,
            key,
            message,
        } => (place.is_some() || !key.is_empty()) && message.len() > 10,
        Error::Argument { what, message } => !what.is_empty() && message.len() > 10,
        Error::File { path, message } => path.file_name().is_some() && message.len() > 10,
        Error::Overlaps { pairs } => !pairs.is_empty(),
        Error::TimeStep { block, .. } => !block.is_empty(),
        Error::DeepOverlap { first, second, .. } => !first.is_empty() && !second.is_empty(),
        Error::Limit { name, .. } => !name.is_empty(),
        _ => false,
    };
    match named {
        true => Ok(()),
        false => Err(format!("its error names no place: {error}")),
    }
}

/// Checks that the process has used little memory, if the system reports it.
fn small() -> std::result::Result<(), String> {
    let status = std::fs::read_to_string("/proc/self/status").unwrap_or_default();
    let line = status.lines().find_map(|line| line.strip_prefix("VmHWM:"));
    let kib = line.and_then(|line| line.trim().strip_suffix("kB")?.trim().parse::<u64>().ok());
    match kib {
        Some(kib) if 1024 * kib > MEMORY => Err(format!("the process took {kib} KiB")),
        _ => Ok(()),
    }
}
