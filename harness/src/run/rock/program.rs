//! What a linear program of two blocks takes here.

use glam::{DQuat, DVec3};
use riprap::{
    Result,
    geometry::{Polyhedron, Pose},
    rock::contact::{Cache, Options, Placed, Resolver},
};
use std::time::Instant;

/// Times that the pair is looked at.
const TIMES: u32 = 200;

/// Seconds of a program, with what belongs to it, for two cubes whose edges meet and whose pair is new each time.
///
/// # Errors
/// None that is known of.
pub fn seconds() -> Result<f64> {
    let shape = Polyhedron::cuboid(DVec3::ONE)?;
    let placed = |centre: DVec3, rotation: DQuat| {
        let mut placed = Placed::default();
        let pose = Pose::rigid(centre, rotation, DVec3::ZERO, DVec3::ZERO);
        placed.update(&shape, DVec3::ZERO, &pose);
        placed
    };
    // The lower one has an edge above, along y; that of the upper one crosses it, along x.
    let lower = placed(DVec3::ZERO, DQuat::from_rotation_y(0.75));
    let upper = placed(DVec3::new(0.1, 0.1, 1.40), DQuat::from_rotation_x(0.8));
    let mut resolver = Resolver::new(Options::default());
    let begin = Instant::now();
    for _ in 0..TIMES {
        resolver.resolve(&lower, &upper, &mut Cache::default())?;
    }
    let spent = begin.elapsed().as_secs_f64();
    Ok(match resolver.counts().programs {
        0 => 0.0,
        programs => spent / programs as f64,
    })
}

#[cfg(test)]
mod tests {
    #[test]
    fn two_edges_want_a_program() {
        assert!(super::seconds().unwrap() > 0.0);
    }
}
