//! What a journey asks of whatever moves: a fluid, blocks, or both.

use super::{
    pace::Pace,
    recorder::{Notes, Recorder},
    rock::Rock,
    summary::Summary,
};
use anyhow::Result;
use riprap::scene::{Quantity, Scene};
use std::path::Path;

/// The recorders of an engine.
pub type Recorders<E> = Vec<Box<dyn Recorder<E>>>;

/// A scene that moves on in steps.
pub trait Engine: Sized + 'static {
    /// The scene.
    fn scene(&self) -> &Scene;

    /// Steps done.
    fn step(&self) -> u64;

    /// Steps of its fluid done, of which a step of the scene may take several.
    fn fluid_steps(&self) -> u64 {
        self.step()
    }

    /// Length of a step, s.
    fn time_step(&self) -> f64;

    /// Simulated time, s.
    fn time(&self) -> f64;

    /// Its blocks as they are now, if it has any.
    fn rock(&self) -> Option<Rock<'_>>;

    /// Whether its state is worth writing after steps that have left the range of the method.
    fn is_good(&self) -> bool;

    /// Takes `steps` steps; the device is idle at their end.
    fn advance(&mut self, steps: u64) -> riprap::Result<()>;

    /// Restores the state in the file.
    fn restore(&mut self, path: &Path) -> riprap::Result<()>;

    /// Writes the state, from which a run goes on to the same bits.
    fn checkpoint(&mut self, path: &Path) -> riprap::Result<()>;

    /// The present values of `quantities`.
    fn values(&mut self, quantities: &[Quantity], notes: &mut Notes) -> riprap::Result<Vec<f64>>;

    /// What writes the files of its own kind, until the step `last`.
    fn recorders(&mut self, folder: &Path, last: u64) -> Result<Recorders<Self>>;

    /// What is known before the first step.
    fn summary(&self) -> Result<Summary>;

    /// Tells, on standard error, what will run on what.
    fn announce(&self, summary: &Summary, folder: &Path, last: u64);

    /// How fast it runs, in a few words.
    fn describe_pace(&self, summary: &Summary, pace: &Pace) -> String;

    /// What is known after the last step.
    fn conclude(&mut self, summary: &mut Summary, notes: &Notes, pace: &Pace);
}
