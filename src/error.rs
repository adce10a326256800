//! Every error of the library, made once where it is known.
//!
//! Misuse of a function or a setup is an [`Error::Argument`], which names the argument or field; what is wrong with a scene is an
//! [`Error::Scene`], which names the key and, for scenes from text, the line.
//!
//! ```
//! use riprap::{Error, lattice::{Grid, Setup}};
//!
//! let error = Grid::new(&Setup::periodic([0, 16, 16], 0.01)).unwrap_err();
//! assert!(matches!(error, Error::Argument { ref what, .. } if what == "cells"));
//! ```

use std::{fmt, path::PathBuf};

/// What went wrong, where, and what to change.
#[non_exhaustive]
#[derive(thiserror::Error, Debug)]
pub enum Error {
    /// A scene, or a value in it, cannot be used.
    #[error("{}{message}", Place::prefix(place.as_ref(), key))]
    Scene {
        /// Where the scene was read, if that is known.
        place: Option<Place>,
        /// Key such as `boundaries.x_min`; empty if the text as a whole cannot be read.
        key: String,
        /// What is wrong and what would be right.
        message: String,
    },
    /// An argument, or a field of a setup, cannot be used.
    #[error("{what}: {message}")]
    Argument {
        /// Name of the argument or field, such as `faces.x_min`.
        what: String,
        /// What is wrong and what would be right.
        message: String,
    },
    /// A file cannot be read or written.
    #[error("{}: {message}", path.display())]
    File {
        /// The file.
        path: PathBuf,
        /// What the system said, and the remedy.
        message: String,
    },
    /// A kernel does not compile.
    #[error("{file}:{line}: {message}")]
    Shader {
        /// File under `kernels/`.
        file: String,
        /// Line in that file, from 1.
        line: u32,
        /// The compiler's words.
        message: String,
    },
    /// The adapter cannot hold or run what was requested.
    #[error("{name}: wants {wants}, the adapter has {has}; {remedy}")]
    Limit {
        /// Name of the limit.
        name: String,
        /// What is needed.
        wants: u64,
        /// What there is.
        has: u64,
        /// What to change.
        remedy: String,
    },
    /// A structure of the host and its twin in WGSL differ.
    #[error("struct {structure}: {message}")]
    Layout {
        /// Name in WGSL.
        structure: String,
        /// What differs.
        message: String,
    },
    /// A buffer or number given to a kernel does not exist under that name, is missing, or cannot be.
    #[error("kernel {kernel}: binding {binding}: {message}")]
    Binding {
        /// Entry point.
        kernel: String,
        /// Name of the variable in WGSL.
        binding: String,
        /// What is wrong.
        message: String,
    },
    /// The flow left the range in which the method is stable.
    #[error(
        "diverged at step {step} (t = {time} s) in cell ({}, {}, {}) at ({:.4}, {:.4}, {:.4}) m: {cause}; {remedy}",
        cell[0], cell[1], cell[2], position[0], position[1], position[2]
    )]
    Diverged {
        /// Step, from 0.
        step: u64,
        /// Time of that step, s.
        time: f64,
        /// Cell, counted from the lower corner of the domain.
        cell: [u32; 3],
        /// Centre of that cell, m.
        position: [f64; 3],
        /// Likely cause.
        cause: String,
        /// What to change.
        remedy: String,
    },
    /// The water of particles left the range in which the method is stable.
    #[error("diverged at step {step}: {}{cause}; {remedy}", particle.map_or_else(String::new, |id| format!("particle {id}: ")))]
    ParticleLost {
        /// Its number at the start, if it is one of them.
        particle: Option<u32>,
        /// Step of the water, from 0.
        step: u64,
        /// Likely cause.
        cause: String,
        /// What to change.
        remedy: String,
    },
    /// Two blocks overlap by more than hard blocks may.
    #[error(
        "{first} and {second} overlap by {} m, more than {} m, which hard blocks may; {remedy}",
        unlike(*depth, *limit)[0], unlike(*depth, *limit)[1]
    )]
    DeepOverlap {
        /// One block.
        first: String,
        /// The other.
        second: String,
        /// Overlap along the contact normal, m.
        depth: f64,
        /// Largest overlap that is allowed, m.
        limit: f64,
        /// What to change.
        remedy: String,
    },
    /// Blocks overlap at the start.
    #[error(
        "blocks overlap at the start in {} places, deepest first: {}; move them apart, or relax them (`rock.relax = true` in a scene)",
        pairs.len(), Overlap::list(pairs)
    )]
    Overlaps {
        /// The pairs, deepest first.
        pairs: Vec<Overlap>,
    },
    /// The step is too long for the springs of the contacts, or for the elasticity of a block.
    #[error(
        "time_step = {requested:.3e} s is too long for the springs of {block}, its contacts and its own elasticity: at most {bound:.3e} s \
         ({usual:.3e} s is usual), or a lower stiffness"
    )]
    TimeStep {
        /// Step, s.
        requested: f64,
        /// Longest step allowed, s.
        bound: f64,
        /// Step taken without `time_step`, s.
        usual: f64,
        /// Block that is the stiffest for its mass.
        block: String,
    },
    /// A block that deforms has been crushed to nothing.
    #[error(
        "{block} is turned inside out at t = {time} s: what presses it is beyond its elasticity; take a \
         greater youngs_modulus, or less load"
    )]
    Inverted {
        /// Block, with its index.
        block: String,
        /// Time, s.
        time: f64,
    },
    /// The motion of a block is no longer a number.
    #[error("{block} has a pose or velocity that is not finite at t = {time} s; {remedy}")]
    NotFinite {
        /// Block, with its index.
        block: String,
        /// Time, s.
        time: f64,
        /// What to change.
        remedy: String,
    },
    /// The device did not answer in time.
    #[error("the device did not finish {what} within {seconds} s; {remedy}")]
    Timeout {
        /// What was waited for.
        what: String,
        /// How long.
        seconds: f64,
        /// What to change.
        remedy: String,
    },
    /// The device is gone.
    #[error("device lost: {0}; open a device anew, and go on from the last checkpoint")]
    DeviceLost(String),
    /// The device refused an allocation or a command.
    #[error("device: {0}")]
    Device(String),
}

/// A place in the text of a scene.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Place {
    /// Name of the text, which is its file where it has one.
    pub file: String,
    /// Line and column, from 1, if the key is known to stand there.
    pub position: Option<[usize; 2]>,
}

impl Place {
    /// What precedes the message of an error.
    fn prefix(place: Option<&Self>, key: &str) -> String {
        let place = place.map(|place| format!("{place}: "));
        let key = (!key.is_empty()).then(|| format!("{key}: "));
        place.into_iter().chain(key).collect()
    }
}

impl fmt::Display for Place {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.file)?;
        match self.position {
            Some([line, column]) => write!(f, ":{line}:{column}"),
            None => Ok(()),
        }
    }
}

/// Two blocks that overlap.
#[derive(Clone, Debug, PartialEq)]
pub struct Overlap {
    /// First block, with its index.
    pub first: String,
    /// Second block, with its index.
    pub second: String,
    /// Overlap, m.
    pub depth: f64,
}

impl Overlap {
    /// The first few, as they stand in a message.
    fn list(pairs: &[Self]) -> String {
        let few = pairs.iter().take(3);
        let names: Vec<_> = few
            .map(|pair| match pair.depth.is_finite() {
                true => format!("{} and {} by {:.3e} m", pair.first, pair.second, pair.depth),
                // No plane is near to part them.
                false => format!(
                    "{} and {}, of which one lies inside the other",
                    pair.first, pair.second
                ),
            })
            .collect();
        names.join(", ")
    }
}

/// Two numbers with as many digits as it takes to tell them apart, four at least.
fn unlike(a: f64, b: f64) -> [String; 2] {
    let written = |digits: usize| [a, b].map(|x| format!("{x:.digits$e}"));
    let distinct = (3..16).map(written).find(|[a, b]| a != b);
    distinct.unwrap_or_else(|| written(3))
}

impl Error {
    /// An error of the value at `key` of a scene.
    pub fn scene(key: impl Into<String>, message: impl Into<String>) -> Self {
        Self::Scene {
            place: None,
            key: key.into(),
            message: message.into(),
        }
    }

    /// An error of an argument or field.
    pub fn argument(what: impl Into<String>, message: impl Into<String>) -> Self {
        Self::Argument {
            what: what.into(),
            message: message.into(),
        }
    }

    /// The same error of an argument that is part of `outer`: `faces[2]` becomes `volumes[0].faces[2]`. Other errors stay
    /// as they are.
    pub fn within(self, outer: &str) -> Self {
        match self {
            Self::Argument { what, message } => Self::Argument {
                what: format!("{outer}.{what}"),
                message,
            },
            other => other,
        }
    }

    /// The error of a scene for an argument that was made from it; `key` says from which key. Other errors stay as they
    /// are.
    pub(crate) fn at_key(self, key: impl FnOnce(&str) -> String) -> Self {
        match self {
            Self::Argument { what, message } => Self::scene(key(&what), message),
            other => other,
        }
    }

    /// An error of a file.
    pub fn file(path: impl Into<PathBuf>, message: impl ToString) -> Self {
        Self::File {
            path: path.into(),
            message: message.to_string(),
        }
    }
}

/// What a device says of an error, with its causes, in one line.
pub(crate) fn error_chain(error: &wgpu::Error) -> String {
    let first: &dyn std::error::Error = error;
    let causes = std::iter::successors(Some(first), |error| error.source());
    let lines: Vec<String> = causes.map(ToString::to_string).collect();
    let mut words: Vec<&str> = Vec::new();
    for line in &lines {
        // The first lines may hold the causes already.
        if !words.join(" ").contains(line.trim()) {
            words.extend(line.split_whitespace());
        }
    }
    words.join(" ")
}

/// What `make` gives, and what `device` refused while it was made: memory, or else an invalid use. A bind group of a
/// buffer without memory is invalid too, so that the memory error takes precedence.
pub(crate) async fn refused<T>(
    device: &wgpu::Device,
    make: impl Future<Output = T>,
) -> (T, Option<wgpu::Error>) {
    let memory = device.push_error_scope(wgpu::ErrorFilter::OutOfMemory);
    let validity = device.push_error_scope(wgpu::ErrorFilter::Validation);
    let made = make.await;
    let [validity, memory] = [validity.pop(), memory.pop()];
    let (validity, memory) = (validity.await, memory.await);
    (made, memory.or(validity))
}

/// `std::result::Result` with the library's [`Error`].
pub type Result<T, E = Error> = std::result::Result<T, E>;

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_have_the_digits_that_tell_them_apart() {
        assert_eq!(unlike(8.3334e-5, 8.333e-5), ["8.3334e-5", "8.3330e-5"]);
        assert_eq!(unlike(2.0, 1.0), ["2.000e0", "1.000e0"]);
        assert_eq!(unlike(1.0, 1.0), ["1.000e0", "1.000e0"]);
    }

    #[test]
    fn a_block_inside_another_has_no_depth() {
        let pairs = [f64::INFINITY, 0.5].map(|depth| Overlap {
            first: "a".into(),
            second: "b".into(),
            depth,
        });
        let list = Overlap::list(&pairs);
        assert_eq!(
            list,
            "a and b, of which one lies inside the other, a and b by 5.000e-1 m"
        );
    }
}
