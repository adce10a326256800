//! Laminar flows without blocks.

use super::class::{Class, Found, Point, Reference, seconds};
use crate::validate::{Method, cavity, decay, plane_walls};

const METHODS: [Method; 6] = [
    Method::DEFAULT,
    Method::BGK,
    Method::SUGA,
    Method::ORDER_2,
    Method::MAGIC,
    Method::HALF,
];

/// Each method on each grid.
fn all(grids: &[u32], run: impl Fn(Method, u32) -> Point, finest: (u32, &[Method])) -> Vec<Point> {
    let usual = METHODS
        .iter()
        .flat_map(|method| grids.iter().map(|n| run(*method, *n)));
    let finest = finest.1.iter().map(|method| run(*method, finest.0));
    usual.chain(finest).collect()
}

/// Decaying vortices.
pub fn taylor_green(full: bool) -> Class {
    let run = |method, n: u32| {
        Point::by(method, n.into(), move |context| {
            let found = decay::taylor_green_on(context, n, method)?;
            Ok(Found {
                value: found.error,
                tau: Some(decay::TAU_OF_VORTICES),
                y_plus: None,
                trial: found.trial,
            })
        })
    };
    let (grids, finest): (&[u32], u32) = match full {
        true => (&[16, 32, 64, 128], 256),
        false => (&[16, 32], 64),
    };
    Class {
        name: "taylor-green",
        title: "Vortices of Taylor & Green, periodic",
        error: "L2 error of the velocity when an eighth is left, against the exact solution",
        resolution: "cells an edge",
        update: "cell",
        reference: Reference::None,
        seconds: seconds(full, 18.0),
        points: all(grids, run, (finest, &METHODS)),
    }
}

/// Relaxation time of Poiseuille flow, within the range of the operator of Suga et al., 4e-4 to 0.059 above ½.
const CHANNEL_TAU: f64 = 0.55;

/// A channel driven by a force.
pub fn poiseuille(full: bool) -> Class {
    let run = |method, height: u32| {
        Point::by(method, height.into(), move |context| {
            let (trial, error) = plane_walls::poiseuille_on(context, height, CHANNEL_TAU, method)?;
            Ok(Found {
                trial,
                value: error,
                tau: Some(CHANNEL_TAU),
                y_plus: None,
            })
        })
    };
    // The number of steps grows with the square of the height: the third grid is for methods whose error does not fall as h².
    let (grids, finest): (&[u32], _) = match full {
        true => (&[4, 8, 16, 32], (64, &METHODS[..])),
        false => (
            &[4, 8],
            (12, &[Method::DEFAULT, Method::MAGIC, Method::HALF][..]),
        ),
    };
    Class {
        name: "poiseuille",
        title: "Poiseuille flow between walls",
        error: "L2 error of the velocity, against the exact parabola",
        resolution: "cells across",
        update: "cell",
        reference: Reference::None,
        seconds: seconds(full, 18.0),
        points: all(grids, run, finest),
    }
}

/// The cavity at Re = 100.
pub fn cavity(full: bool) -> Class {
    let run = |method, n: u32| {
        Point::by(method, n.into(), move |context| {
            let found = cavity::measure(context, n, (100.0, "Re100"), method)?;
            Ok(Found {
                value: found.errors[2],
                tau: Some(cavity::tau(n, 100.0)),
                y_plus: None,
                trial: found.trial,
            })
        })
    };
    let (grids, finest): (&[u32], u32) = match full {
        true => (&[16, 32, 64], 128),
        // Beyond 24 cells the digits of the table dominate the error.
        false => (&[12, 16], 24),
    };
    Class {
        name: "cavity",
        title: "Lid-driven cavity, Re 100",
        error: "r.m.s. error of u and v on the centre lines over U, against Ghia, Ghia & Shin (1982)",
        resolution: "cells an edge",
        update: "cell",
        reference: Reference::None,
        seconds: seconds(full, 28.0),
        points: all(grids, run, (finest, &METHODS)),
    }
}
