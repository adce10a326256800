//! Some of the cells of a large lattice.

use riprap::{output::Image, scene::Scene};

/// Most cells that lines along a flow are followed through: 64 MB of velocities, and more than a picture has pixels.
const MOST: f64 = 4e6;

/// Every n-th cell of a scene along each axis, as an image of its own.
pub struct Coarse {
    frame: Image,
    cells: Vec<u32>,
}

impl Coarse {
    /// All cells of `scene`, or as many as fit.
    pub fn new(scene: &Scene) -> Self {
        let counts = scene.cells();
        let all: f64 = counts.iter().map(|n| f64::from(*n)).product();
        let stride = (all / MOST).cbrt().ceil().max(1.0) as u32;
        // The middle one of each group, so that the cells have the place of the group.
        let taken = counts.map(|n| (stride.min(n) / 2..n).step_by(stride as usize));
        let [x, y, z] = taken.clone();
        let index = |i: u32, j: u32, k: u32| i + counts[0] * (j + counts[1] * k);
        let cells = z.flat_map(|k| {
            let x = &x;
            y.clone()
                .flat_map(move |j| x.clone().map(move |i| index(i, j, k)))
        });
        let spacing = scene.domain.cell * f64::from(stride);
        let mut first = taken.clone();
        let origin = std::array::from_fn(|axis| {
            let centre = f64::from(first[axis].next().unwrap_or(0)) + 0.5;
            scene.domain.origin[axis] + scene.domain.cell * centre - 0.5 * spacing
        });
        Self {
            cells: cells.collect(),
            frame: Image {
                origin,
                spacing,
                cells: taken.map(|along| along.count()),
                arrays: Vec::new(),
            },
        }
    }

    /// Its cells as places in an array over the domain, x fastest.
    pub fn cells(&self) -> &[u32] {
        &self.cells
    }

    /// The cells as an image without arrays, to be filled on [`Self::cells`].
    pub fn frame(&self) -> Image {
        self.frame.clone()
    }
}
