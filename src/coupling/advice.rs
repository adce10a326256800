//! What may disappoint in blocks in a fluid, in numbers.

use super::{Coupled, Gap};
use crate::{
    block::{Form, Shape},
    bodies::Motion,
    scene::{Advice, Scene, Warning},
};
use glam::DVec3;

/// Cells across the thinnest block that is resolved: of a cube of so many, 42 % of the cells have no
/// surface in them.
const ACROSS: f64 = 8.0;
/// Cells by which one may miss that, rounded as scenes write their numbers: it shows as 8.0.
const ROUNDED: f64 = 0.05;

/// Blocks by a number, the one with the smallest first.
struct Ranked {
    count: usize,
    name: String,
    value: f64,
}

impl Ranked {
    /// Those whose value is below `limit`.
    fn below(limit: f64, all: impl Iterator<Item = (String, f64)>) -> Option<Self> {
        let low: Vec<_> = all.filter(|(_, value)| *value < limit).collect();
        let count = low.len();
        let least = low.into_iter().min_by(|a, b| a.1.total_cmp(&b.1))?;
        Some(Self {
            count,
            name: least.0,
            value: least.1,
        })
    }
}

impl Coupled {
    /// Warns of blocks that the grid does not resolve, of gaps that it does not, of blocks lighter than the
    /// fluid, and of those that lie where fluid enters.
    pub fn advise(&self, scene: &Scene) -> Advice {
        let mut advice = Advice::new();
        let mut warn = |place: &str, message: String| {
            advice.push(Warning {
                place: place.into(),
                message,
            });
        };
        let cell = scene.domain.cell;
        let setup = &self.setup().setup;
        let blocks = setup.blocks[..self.in_fluid()].iter();
        let widths = blocks
            .clone()
            .map(|block| (block.name.clone(), width(&block.shape) / cell));
        if let Some(thin) = Ranked::below(ACROSS - ROUNDED, widths) {
            warn(
                "domain.cell",
                format!(
                    "{} blocks are fewer than {ACROSS} cells across, {} only {:.1}: what the fluid does to \
                     them is rough; use cell ≤ {:.3e} m",
                    thin.count,
                    thin.name,
                    thin.value,
                    cell * thin.value / ACROSS
                ),
            );
        }
        self.warn_of_gaps(cell, &mut warn);
        let fluid = scene.fluid.density;
        let free = blocks.filter(|block| block.motion == Motion::Free);
        let ratios = free.map(|block| {
            let density = setup.materials[block.material].density;
            (block.name.clone(), density / fluid)
        });
        // Found with a cube of eight cells between its own images, where sound stays: 0.3, 0.6 and 1 are steady with 1, 2
        // and 4 steps between exchanges, 0.5 with 2 and 0.8 with 4 are not.
        let safe = 1.0 - 0.5 / f64::from(scene.coupling.interval);
        if let Some(light) = Ranked::below(1.0, ratios) {
            warn(
                "materials",
                format!(
                    "{} blocks are lighter than the fluid, {} has {:.2} of its density: they float, and the \
                     water that they drag along outweighs them, so that they gain speed more slowly than they \
                     should, and below {safe} of its density, with coupling.interval = {}, may swing; use a density above \
                     {fluid} kg/m³, or at least above {}",
                    light.count,
                    light.name,
                    light.value,
                    scene.coupling.interval,
                    safe * fluid
                ),
            );
        }
        self.warn_of_inlets(&mut advice);
        advice
    }

    /// Width of the narrowest block in the fluid, m: the smallest distance between two parallel planes that hold it,
    /// one of them along a face. None where there is no block.
    pub fn narrowest(&self) -> Option<f64> {
        let blocks = self.setup().setup.blocks[..self.in_fluid()].iter();
        blocks
            .map(|block| width(&block.shape))
            .min_by(f64::total_cmp)
    }

    fn warn_of_gaps(&self, cell: f64, warn: &mut impl FnMut(&str, String)) {
        let (closed, open): (Vec<&Gap>, Vec<&Gap>) =
            self.gaps().iter().partition(|gap| gap.is_closed(cell));
        let narrowest = open.iter().min_by(|a, b| a.width.total_cmp(&b.width));
        if let Some(gap) = narrowest {
            let [a, b] = gap.blocks.map(|block| self.blocks().name(block));
            warn(
                "domain.cell",
                format!(
                    "{} gaps between blocks are narrower than a cell, the narrowest {:.2e} m ({:.2} cells) \
                     between {a} and {b}: the grid does not resolve the flow and the pressure in them; use \
                     cell ≤ {:.1e} m, or close them. {} pairs touch, and no water stands between these",
                    open.len(),
                    gap.width,
                    gap.width / cell,
                    gap.width,
                    closed.len()
                ),
            );
        }
    }
}

/// Smallest distance between two parallel planes that hold a shape, one of them along a face, m.
fn width(shape: &Shape) -> f64 {
    // How far the shape reaches along a direction.
    let reach = |n: DVec3| {
        let part = |part: &crate::block::Part| {
            part.offset.dot(n)
                + match &part.form {
                    Form::Sphere { radius } => *radius,
                    Form::Convex(shape) => {
                        let corners = shape.vertices().iter().map(|v| v.dot(n));
                        corners.fold(f64::NEG_INFINITY, f64::max)
                    }
                }
        };
        shape
            .parts()
            .iter()
            .map(part)
            .fold(f64::NEG_INFINITY, f64::max)
    };
    let faces = shape.parts().iter().flat_map(|part| match &part.form {
        Form::Sphere { .. } => vec![DVec3::X, DVec3::Y, DVec3::Z],
        Form::Convex(shape) => shape.faces().iter().map(|face| face.normal).collect(),
    });
    faces
        .map(|n| reach(n) + reach(-n))
        .fold(f64::INFINITY, f64::min)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::block::Polyhedron;

    #[test]
    fn a_shape_is_as_wide_as_its_thinnest_side() {
        let plate: Shape = Polyhedron::cuboid(DVec3::new(3.0, 0.2, 1.0))
            .unwrap()
            .into();
        assert!((width(&plate) - 0.2).abs() < 1e-12);
        assert!((width(&Shape::sphere(0.7).unwrap()) - 1.4).abs() < 1e-12);
        // Between a face and the corner opposite to it: edge · √(2/3).
        let tetrahedron: Shape = Polyhedron::tetrahedron(1.0).unwrap().into();
        assert!((width(&tetrahedron) - (2.0f64 / 3.0).sqrt()).abs() < 1e-12);
    }

    #[test]
    fn the_smallest_comes_first_and_all_are_counted() {
        let all = [("a", 3.0), ("b", 1.0), ("c", 9.0), ("d", 2.0)];
        let all = all.iter().map(|(name, value)| ((*name).into(), *value));
        let found = Ranked::below(5.0, all.clone()).unwrap();
        assert_eq!((found.count, found.name.as_str()), (3, "b"));
        assert!(Ranked::below(1.0, all).is_none());
    }
}
