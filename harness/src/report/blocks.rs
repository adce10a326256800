//! Blocks in a flow.

use super::class::{Class, Found, Point, Reference};
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

/// Where all methods are compared.
const ARRAY_TAU: f64 = 0.6;
/// K = 4.292 of Zick & Homsy has four digits.
const ARRAY_DIGITS: f64 = 5e-4 / 4.292;

/// Spheres in creeping flow.
pub fn array(full: bool) -> Class {
    let run = |method: Method, edge: u32, tau: f64| {
        let array = Array::new(USUAL, edge, tau).by(method);
        let point = Point::by(method, array.diameter(), move |stand| {
            let drag = array.measure(stand)?;
            Ok(Found {
                value: drag.ratio,
                tau: Some(tau),
                y_plus: None,
                trial: drag.trial,
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
        // It is made for less.
        let tau = if method.name == Method::SUGA.name {
            0.55
        } else {
            ARRAY_TAU
        };
        points.extend(on(edges, method, tau));
    }
    let best = [
        Method::DEFAULT,
        Method::NOBLE,
        Method::BGK,
        Method::ORDER_2,
        Method::MAGIC,
    ];
    for method in best {
        points.extend(on(finest, method, ARRAY_TAU));
    }
    for tau in [0.52, 0.55, 0.8, 1.0, 1.5] {
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
        points,
    }
}

/// A cube in a stream.
pub fn cube(full: bool, reynolds: f64) -> Class {
    let run = |method: Method, size: u32| {
        Point::by(method, size.into(), move |stand| {
            let drag = obstacle::cube_on(stand, size, reynolds, method)?;
            Ok(Found {
                value: drag.coefficient,
                tau: Some(drag.tau),
                y_plus: drag.y_plus,
                trial: drag.trial,
            })
        })
    };
    // The second Reynolds number is there for its larger y⁺.
    let slow = reynolds < 50.0;
    let (halved, others): ([u32; 3], &[u32]) = match (full, slow) {
        (true, _) => ([6, 12, 24], &[4, 8, 16]),
        (false, true) => ([3, 6, 12], &[4, 8]),
        (false, false) => ([3, 6, 12], &[4]),
    };
    let default = halved.iter().chain(others);
    let mut points: Vec<Point> = default.map(|size| run(Method::DEFAULT, *size)).collect();
    let methods: &[Method] = if slow { &METHODS[1..] } else { &METHODS[1..2] };
    let sizes: &[u32] = if full { &[6, 8, 12] } else { &[4, 6] };
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
        reference: Reference::Limit,
        points,
    }
}

/// A sphere that settles: largest velocity.
pub fn settling(full: bool) -> Class {
    let run = |method: Method, cells: u32| {
        let across = f64::from(cells) * 2.0 * settling::RADIUS / settling::EDGE;
        Point::by(method, across, move |stand| {
            let grid = (cells, settling::SPEED);
            let fall = settling::E1.fall(stand, grid, settling::E1_FASTEST, method)?;
            Ok(Found {
                value: fall.fastest / settling::E1.fastest,
                tau: Some(fall.tau),
                y_plus: fall.y_plus,
                trial: fall.trial,
            })
        })
    };
    let (halved, others): ([u32; 3], &[u32]) = match full {
        true => ([40, 80, 160], &[20, 60, 120]),
        false => ([15, 30, 60], &[20, 40]),
    };
    let default = halved.iter().chain(others);
    let mut points: Vec<Point> = default.map(|cells| run(Method::DEFAULT, *cells)).collect();
    let grids: [u32; 3] = if full { [40, 60, 80] } else { [15, 20, 30] };
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
        points.extend(grids.map(|cells| run(method, cells)));
    }
    Class {
        name: "settling",
        title: "Settling sphere E1 of ten Cate et al. (2002)",
        error: "error of the largest velocity, against the limit of three grids each twice as fine (Richardson \
            1911), or the finest where their numbers swing; the value is that over the measured one",
        resolution: "cells across the sphere",
        update: "cell",
        reference: Reference::Limit,
        points,
    }
}
