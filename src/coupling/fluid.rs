//! What blocks ask of the fluid that they are in, whichever it is.

use super::{Felt, Rock};
use crate::{Result, bodies::Pose};
use std::future::Future;

/// How often blocks want to meet their fluid.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Pace {
    /// Nothing can move: what the fluid does is for those who ask, at the end.
    Still,
    /// All that can move sleeps: a look each so many steps of the fluid.
    Asleep(u64),
    /// Each so many steps of the fluid.
    Awake(u64),
}

/// A fluid with blocks in it: poses in, loads out.
pub trait Fluid {
    /// Simulated time, s.
    fn time(&self) -> f64;

    /// Goes on until it meets the blocks, at the time `end` (s) at the latest, beside blocks that are at `poses` and
    /// move as these say. Says what each block felt on average since the last time, or nothing if they do
    /// not meet yet.
    fn advance(
        &mut self,
        poses: &[Pose],
        pace: Pace,
        end: f64,
    ) -> impl Future<Output = Result<Option<Vec<Felt>>>>;
}

/// Fluid and rock together until the time `end` (s).
///
/// # Errors
/// Those of the fluid, and of [`Rock::meet`].
pub async fn run(fluid: &mut impl Fluid, rock: &mut Rock, end: f64) -> Result<()> {
    while fluid.time() < end {
        let felt = fluid.advance(&rock.poses(), rock.pace(), end).await?;
        if let Some(felt) = felt {
            rock.meet(&felt, fluid.time()).await?;
        }
    }
    Ok(())
}
