//! Solid fractions of a sphere that moves on: tiles, their cells, and the velocity of the solid there.

use super::turns::Turns;
use glam::{DQuat, DVec3};
use riprap::{
    geometry::{Pose, Shape},
    lattice::{Lattice, Setup, SolidOperator},
    psm::{Frame, SolidBlock, SolidCells},
    units::Units,
};
use std::sync::Arc;

/// A way of a third of a cell, so that each place in a cell comes.
const STRIDE: f64 = 0.37;

/// What was found of a sphere.
pub struct Found {
    /// Seconds of one time.
    pub seconds: f64,
    /// Cells that its surface is in, on average 3/2 of its area.
    pub surface: f64,
}

/// The solid fractions of a sphere of `across` cells.
///
/// # Errors
/// If the device fails.
pub fn measure(turns: &Turns, across: u32) -> anyhow::Result<Found> {
    let (device, queue) = (&turns.device, &turns.queue);
    let edge = (across + 16).next_multiple_of(16);
    let mut setup = Setup::periodic([edge; 3], 0.03);
    setup.solid_operator = Some(SolidOperator::Holdych);
    let mut lattice = Lattice::new(device, setup)?;
    let frame = Frame {
        origin: DVec3::ZERO,
        units: Units {
            cell: 1.0,
            time_step: 1.0,
            density: 1.0,
        },
    };
    let across = f64::from(across);
    let shape: Arc<Shape> = Arc::new(Shape::sphere(0.5 * across)?);
    let blocks = vec![SolidBlock {
        shape,
        loaded: false,
        faces: false,
    }];
    let mut cells = SolidCells::new(device, &lattice, frame, blocks)?;
    let mut place = DVec3::splat(0.5 * f64::from(edge));
    let mut once = |times: u32| -> anyhow::Result<()> {
        for _ in 0..times {
            place += STRIDE * DVec3::new(0.5, 0.3, 0.8);
            let pose = Pose::rigid(place, DQuat::IDENTITY, DVec3::ZERO, DVec3::ZERO);
            cells.place(device, queue, &mut lattice, &[pose])?;
            let mut encoder = device.create_command_encoder(&Default::default());
            cells.record_cells(&mut encoder.begin_compute_pass(&Default::default()));
            queue.submit([encoder.finish()]);
            turns.wait()?;
        }
        Ok(())
    };
    once(4)?;
    let mut seconds = f64::INFINITY;
    const TIMES: u32 = 16;
    for _ in 0..turns.rounds {
        seconds = seconds.min(turns.time(|| once(TIMES))? / f64::from(TIMES));
    }
    Ok(Found {
        seconds,
        surface: 1.5 * std::f64::consts::PI * across * across,
    })
}
