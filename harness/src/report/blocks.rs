//! Blocks in a flow.

use super::class::{Class, Found, Point, Reference, seconds};
use crate::validate::{
    Method,
    solids::{
        array::{Array, USUAL},
        obstacle, settling,
    },
};

/// Every operator and collision for blocks that do not move.
const METHODS: [Method; 8] = [
    Method::DEFAULT,
    Method::NOBLE,
    Method::SUPERPOSITION,
    Method::BGK,
    Method::SUGA,
    Method::ORDER_2,
    Method::MAGIC,
    Method::HALF,
];

/// Relaxation time at which all methods are compared.
const ARRAY_TAU: f64 = 0.6;
/// K = 4.292 of Zick & Homsy has four digits.
const ARRAY_DIGITS: f64 = 5e-4 / 4.292;

/// Spheres in creeping flow.
pub fn array(full: bool) -> Class {
    let run = |method: Method, edge: u32, tau: f64| {
        let array = Array::new(USUAL, edge, tau).by(method);
        let point = Point::by(method, array.diameter(), move |context| {
            let found = array.measure(context)?;
            Ok(Found {
                value: found.ratio,
                tau: Some(tau),
                y_plus: None,
                trial: found.drag.trial,
            })
        });
        match tau == ARRAY_TAU {
            true => point,
            false => point.with(&format!("τ = {tau}")),
        }
    };
    let (edges, finest): (&[u32], &[u32]) = match full {
        true => (&[8, 12, 16, 24], &[32, 48]),
        false => (&[8, 12, 16], &[24]),
    };
    let on = |edges: &[u32], method: Method, tau: f64| {
        let points = edges.iter().map(|edge| run(method, *edge, tau));
        points.collect::<Vec<_>>()
    };
    let mut points = Vec::new();
    for method in METHODS {
        // The operator is made for smaller values.
        let tau = if method.name == Method::SUGA.name {
            0.55
        } else {
            ARRAY_TAU
        };
        points.extend(on(edges, method, tau));
    }
    let best: &[Method] = &[
        Method::DEFAULT,
        Method::NOBLE,
        Method::BGK,
        Method::ORDER_2,
        Method::MAGIC,
    ];
    // The short form only has those that are within 2 % on it.
    let best = if full { best } else { &best[..1] };
    for method in best {
        points.extend(on(finest, *method, ARRAY_TAU));
    }
    // The number of steps grows as 1/(τ − ½).
    let (slow, edges): (&[u32], &[u32]) = match full {
        true => (edges, edges),
        false => (&[8, 12], &[8, 16]),
    };
    points.extend(on(slow, Method::DEFAULT, 0.52));
    for tau in [0.55, 0.8, 1.0, 1.5] {
        points.extend(on(edges, Method::DEFAULT, tau));
    }
    points.extend(on(finest, Method::DEFAULT, 1.0));
    for method in [Method::NOBLE, Method::SUPERPOSITION] {
        points.extend(on(edges, method, 1.0));
    }
    Class {
        name: "sphere-array",
        title: "Drag of a cubic array of spheres, c = 0.125, creeping flow; τ = 0.6 unless said",
        error: "error of the drag, against Zick & Homsy (1982)",
        resolution: "cells across a sphere",
        update: "cell",
        reference: Reference::Known(1.0, ARRAY_DIGITS),
        seconds: seconds(full, 65.0),
        points,
    }
}

/// Drag coefficients of the cube with the defaults on 3, 6 and 12 cells, the last of which takes half a minute.
const RE_20: [f64; 3] = [3.294302, 3.478134, 3.455875];
/// The same at Re 100.
const RE_100: [f64; 3] = [1.547133, 1.567968, 1.445005];
/// Largest velocity of the settling sphere over the measured one with the defaults on 2.25, 4.5 and 9 cells across.
const SETTLING: [f64; 3] = [1.252528, 1.011002, 0.969997];

/// A cube in a stream.
pub fn cube(full: bool, reynolds: f64) -> Class {
    let run = |method: Method, size: u32| {
        Point::by(method, size.into(), move |context| {
            let drag = obstacle::cube_on(context, size, reynolds, method)?;
            Ok(Found {
                value: drag.coefficient,
                tau: Some(drag.tau),
                y_plus: drag.y_plus,
                trial: drag.trial,
            })
        })
    };
    // The second Reynolds number is included for its larger y⁺.
    let slow = reynolds < 50.0;
    // The first three are those of the limit.
    let default: &[u32] = match (full, slow) {
        (true, _) => &[6, 12, 24, 4, 8, 16],
        (false, true) => &[3, 4, 5, 6],
        (false, false) => &[3, 4, 6],
    };
    let mut points: Vec<Point> = default
        .iter()
        .map(|size| run(Method::DEFAULT, *size))
        .collect();
    let methods: &[Method] = if slow { &METHODS[1..] } else { &METHODS[1..2] };
    let sizes: &[u32] = match (full, slow) {
        (true, _) => &[6, 8, 12],
        (false, true) => &[3, 5],
        (false, false) => &[4, 6],
    };
    for method in methods {
        points.extend(sizes.iter().map(|size| run(*method, *size)));
    }
    let (name, title) = match slow {
        true => ("cube-re20", "Drag of a cube in a stream, Re 20"),
        false => ("cube-re100", "Drag of a cube in a stream, Re 100"),
    };
    Class {
        name,
        title,
        error: "error of the drag, against the limit of three grids each twice as fine (Richardson 1911), or the finest \
            where their numbers swing",
        resolution: "cells an edge of the cube",
        update: "cell",
        reference: match (full, slow) {
            (true, _) => Reference::Limit,
            (false, true) => Reference::Recorded(RE_20),
            (false, false) => Reference::Recorded(RE_100),
        },
        seconds: seconds(full, if slow { 30.0 } else { 12.0 }),
        points,
    }
}

/// A sphere that settles: largest velocity.
pub fn settling(full: bool) -> Class {
    let run = |method: Method, cells: u32| {
        let across = f64::from(cells) * 2.0 * settling::RADIUS / settling::EDGE;
        Point::by(method, across, move |context| {
            let grid = (cells, settling::SPEED);
            let fall = settling::E1.fall(context, grid, settling::E1_FASTEST, method)?;
            Ok(Found {
                value: fall.fastest / settling::E1.fastest,
                tau: Some(fall.tau),
                y_plus: fall.y_plus,
                trial: fall.trial,
            })
        })
    };
    // The first three are those of the limit.
    let default: &[u32] = match full {
        true => &[40, 80, 160, 20, 60, 120],
        false => &[15, 20, 30, 40],
    };
    let mut points: Vec<Point> = default
        .iter()
        .map(|cells| run(Method::DEFAULT, *cells))
        .collect();
    let grids: &[u32] = if full { &[40, 60, 80] } else { &[15, 30] };
    let moving = [
        Method::NOBLE,
        Method::SUPERPOSITION,
        Method::BGK,
        Method::ORDER_2,
        Method::MAGIC,
        Method::HALF,
        Method::EVERY_2,
        Method::EVERY_8,
    ];
    for method in moving {
        points.extend(grids.iter().map(|cells| run(method, *cells)));
    }
    Class {
        name: "settling",
        title: "Settling sphere E1 of ten Cate et al. (2002)",
        error: "error of the largest velocity, against the limit of three grids each twice as fine (Richardson \
            1911), or the finest where their numbers swing; the value is that over the measured one",
        resolution: "cells across the sphere",
        update: "cell",
        reference: match full {
            true => Reference::Limit,
            false => Reference::Recorded(SETTLING),
        },
        seconds: seconds(full, 40.0),
        points,
    }
}
