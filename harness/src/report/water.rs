//! Free water by particles, with both schemes.

use super::class::{Class, Found, Point, Reference, seconds};
use crate::validate::{
    CaseContext, Trial,
    water::{dam, still, wave},
};
use riprap::scene::Scheme;

/// Both schemes on each number of layers.
fn both(
    layers: &[u32],
    run: impl Fn(&CaseContext, u32, Scheme) -> anyhow::Result<(Trial, f64)> + Copy + 'static,
) -> Vec<Point> {
    let point = |(name, scheme), layers: u32| Point {
        setting: String::from(name),
        default: scheme == Scheme::default(),
        resolution: layers.into(),
        run: Box::new(move |context| {
            let (trial, value) = run(context, layers, scheme)?;
            Ok(Found {
                trial,
                value,
                tau: None,
                y_plus: None,
            })
        }),
    };
    [("delta", Scheme::Delta), ("mueller", Scheme::Mueller)]
        .into_iter()
        .flat_map(|scheme| layers.iter().map(move |layers| point(scheme, *layers)))
        .collect()
}

/// Water at rest.
pub fn still(full: bool) -> Class {
    let layers: &[u32] = match full {
        true => &[10, 20, 40, 80],
        false => &[5, 8, 12],
    };
    Class {
        name: "still-tank",
        title: "Still tank",
        error: "L2 error of the pressure, of its norm",
        resolution: "spacings of depth",
        update: "particle",
        reference: Reference::None,
        seconds: seconds(full, 17.0),
        points: both(layers, |context, layers, scheme| {
            let found = still::measure(context, layers, scheme)?;
            Ok((found.trial, found.miss))
        }),
    }
}

/// A standing wave, the first mode of a tank.
pub fn wave(full: bool) -> Class {
    let layers: &[u32] = match full {
        true => &[10, 25, 50],
        false => &[6, 8, 12],
    };
    Class {
        name: "standing-wave",
        title: "Standing wave, four depths long",
        error: "error of the period, against ω² = g k tanh kH",
        resolution: "spacings of depth",
        update: "particle",
        reference: Reference::Known(1.0, 0.0),
        seconds: seconds(full, 20.0),
        points: both(layers, |context, layers, scheme| {
            let found = wave::measure(context, layers, wave::LENGTHS[0], scheme)?;
            Ok((found.trial, found.period))
        }),
    }
}

/// A dam break.
pub fn dam(full: bool) -> Class {
    let columns: &[u32] = match full {
        true => &[10, 20, 40, 80],
        false => &[8, 12, 16],
    };
    Class {
        name: "dam-break",
        title: "Dam break",
        error: "error of the speed of the front, against Martin & Moyce (1952)",
        resolution: "spacings of the column's width",
        update: "particle",
        reference: Reference::Known(dam::SPEED, 0.0),
        seconds: seconds(full, 8.0),
        points: both(columns, |context, columns, scheme| {
            let (trial, [speed, _]) = dam::front(context, columns, scheme)?;
            Ok((trial, speed))
        }),
    }
}
