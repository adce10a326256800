//! Warnings about the resolution and stability of blocks in a fluid.

use super::{Coupled, Gap, gaps::narrowest};
use crate::{
    geometry::Form,
    rock::{Block, Motion},
    scene::{Advice, Scene, Warning},
};
use glam::DVec3;

/// Fewest cells across a resolved block: in a cube of this width, 42 % of the cells contain no surface.
const MIN_CELLS_ACROSS: f64 = 8.0;
/// Tolerance of [`MIN_CELLS_ACROSS`], cells: a width that is printed as 8.0 passes.
const WIDTH_TOLERANCE: f64 = 0.05;

/// The block with the smallest value among those below a limit.
struct Ranked {
    count: usize,
    name: String,
    value: f64,
}

impl Ranked {
    /// `None` if no value is below `limit`.
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

impl Coupled<'_> {
    /// Warnings about unresolved blocks and gaps, blocks lighter than the fluid, and blocks in inflow cells.
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
        let domain = self.domain_size();
        let widths = blocks
            .clone()
            .map(|block| (block.name.clone(), width(block, domain) / cell));
        if let Some(thin) = Ranked::below(MIN_CELLS_ACROSS - WIDTH_TOLERANCE, widths) {
            warn(
                "domain.cell",
                format!(
                    "{} blocks are fewer than {MIN_CELLS_ACROSS} cells across, {} only {:.1}: the loads on them \
                     are inaccurate; use cell ≤ {:.3e} m",
                    thin.count,
                    thin.name,
                    thin.value,
                    cell * thin.value / MIN_CELLS_ACROSS
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
        // Measured with a cube of eight cells between its own images, which trap sound: density ratios of 0.3, 0.6 and 1
        // are stable with 1, 2 and 4 steps between exchanges; 0.5 with 2 and 0.8 with 4 are not.
        let safe = 1.0 - 0.5 / f64::from(scene.coupling.interval);
        if let Some(light) = Ranked::below(1.0, ratios) {
            warn(
                "materials",
                format!(
                    "{} blocks are lighter than the fluid, {} has {:.2} of its density: they float, and \
                     their added mass exceeds their mass, so that they accelerate more slowly than they should, and below \
                     {safe} of its density, with coupling.interval = {}, may oscillate; use a density above \
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

    /// Width of the narrowest block in the fluid, m: the smallest distance between two parallel planes that enclose it,
    /// one of them along a face. The length of a block that spans the domain is none. `None` without blocks.
    pub fn narrowest(&self) -> Option<f64> {
        let blocks = self.setup().setup.blocks[..self.in_fluid()].iter();
        let widths = blocks.map(|block| width(block, self.domain_size()));
        widths.filter(|w| w.is_finite()).min_by(f64::total_cmp)
    }

    /// Edges of the domain, m.
    fn domain_size(&self) -> DVec3 {
        let (cells, _) = self.solid_cells().domain();
        self.solid_cells().frame().units.cell * DVec3::from_array(cells.map(f64::from))
    }

    /// The narrowest open gap between a block in the fluid and another block, a wall, or a periodic image; `None` if all are
    /// wider than `within` (m).
    pub fn narrowest_gap(&self, within: f64) -> Option<Gap> {
        let cell = self.solid_cells().frame().units.cell;
        narrowest(
            &self.setup().setup,
            self.blocks(),
            (self.in_fluid(), cell, within),
        )
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
                    "gaps between blocks narrower than a cell: {}, the narrowest {:.2e} m ({:.2} cells) \
                     between {a} and {b}: the grid does not resolve the flow and the pressure in them; use \
                     cell ≤ {:.1e} m, or close them. Pairs that touch, with no water between them: {}",
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

/// Fraction of the domain from which a block spans it.
const SPANS: f64 = 0.99;

/// Smallest distance between two parallel planes that enclose a block, one of them along a face, m; not along an axis along which
/// the block spans the domain.
fn width(block: &Block, domain: DVec3) -> f64 {
    let shape = &block.shape;
    let faces = shape.parts().iter().flat_map(|part| match &part.form {
        Form::Sphere { .. } => vec![DVec3::X, DVec3::Y, DVec3::Z],
        Form::Convex(shape) => shape.faces().iter().map(|face| face.normal).collect(),
    });
    let widths = faces.filter_map(|n| {
        let [low, high] = shape.extent(n);
        let world = block.rotation * n;
        let axis = (0..3).find(|&axis| world[axis].abs() > 1.0 - 1e-9);
        let spans = axis.is_some_and(|axis| high - low >= SPANS * domain[axis]);
        (!spans).then_some(high - low)
    });
    widths.fold(f64::INFINITY, f64::min)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::{Polyhedron, Shape};

    #[test]
    fn width_of_a_plate_a_sphere_and_a_tetrahedron() {
        let width_in =
            |shape: &Shape, domain| width(&Block::new("block", shape.clone(), DVec3::ZERO), domain);
        let width = |shape: &Shape| width_in(shape, DVec3::splat(4.0));
        let plate: Shape = Polyhedron::cuboid(DVec3::new(3.0, 0.2, 1.0))
            .unwrap()
            .into();
        assert!((width(&plate) - 0.2).abs() < 1e-12);
        assert!((width_in(&plate, DVec3::new(4.0, 0.2, 4.0)) - 1.0).abs() < 1e-12);
        assert!((width(&Shape::sphere(0.7).unwrap()) - 1.4).abs() < 1e-12);
        // Between a face and the corner opposite to it: edge · √(2/3).
        let tetrahedron: Shape = Polyhedron::tetrahedron(1.0).unwrap().into();
        assert!((width(&tetrahedron) - (2.0f64 / 3.0).sqrt()).abs() < 1e-12);
    }

    #[test]
    fn the_smallest_value_and_the_count_below_a_limit() {
        let all = [("a", 3.0), ("b", 1.0), ("c", 9.0), ("d", 2.0)];
        let all = all.iter().map(|(name, value)| ((*name).into(), *value));
        let found = Ranked::below(5.0, all.clone()).unwrap();
        assert_eq!((found.count, found.name.as_str()), (3, "b"));
        assert!(Ranked::below(1.0, all).is_none());
    }
}
