//! The fluid in a view.

use super::super::slices::SliceQuantity;
use super::{
    super::scene_run::SceneRun,
    shown::{immersed, placed},
};
use crate::{
    picture::{Plane, Section, Trace, traces},
    render::{Colours, FluidPlane, Traces},
};
use anyhow::Result;
use riprap::{
    geometry::Pose,
    output::ImageData,
    scene::{Field, Scene, SliceField, View, ViewSlice},
    simulation::probe::Layer,
};

/// The cells of the fluid that a view shows.
pub struct Fluid {
    slices: Vec<(ViewSlice, Layer)>,
    coarse: Option<Coarse>,
    /// Number of streamlines.
    count: u32,
    /// Range of the colours of speeds without a range of their own, m/s.
    speeds: Option<[f64; 2]>,
    solids: bool,
    /// Speed of the last colour, m/s, if the view gives one.
    speed: Option<f64>,
}

impl Fluid {
    /// The fluid of `scene` as shown in `view`.
    pub fn new(scene: &Scene, view: &View) -> Self {
        let layer = |slice: &ViewSlice| {
            let middle = scene.domain.middle()[slice.axis.index()];
            let layer = Layer::new(scene, slice.axis, slice.position.unwrap_or(middle));
            (slice.clone(), layer)
        };
        // Slices and lines of one quantity share a colour bar.
        let of_speed = view.slices.iter().filter(|s| s.field == SliceField::Speed);
        let given = of_speed.filter_map(|slice| slice.range).next();
        Self {
            slices: view.slices.iter().map(layer).collect(),
            coarse: (view.traces > 0).then(|| Coarse::new(scene)),
            count: view.traces,
            speeds: given.or(view.speed.map(|speed| [0.0, speed])),
            solids: !scene.solids.is_empty(),
            speed: view.speed,
        }
    }

    /// Speed of the last colour, m/s, if the view gives one.
    pub fn speed(&self) -> Option<f64> {
        self.speed
    }

    /// The present planes through the fluid among blocks at `poses`.
    pub fn planes(&self, run: &mut SceneRun, poses: &[Pose]) -> Result<Vec<FluidPlane>> {
        let sampled = run.simulation.samples() > 0;
        let is_known = |field: SliceField| sampled || !field.field().is_statistical();
        let slices = self
            .slices
            .iter()
            .filter(|(slice, _)| is_known(slice.field));
        slices
            .map(|(slice, layer)| {
                let shown = SliceQuantity::of(slice.field);
                let image = self.image(run, shown.field, layer.cells(), layer.frame())?;
                let axis = slice.axis.index();
                let plane = Plane {
                    normal: axis,
                    position: image.origin[axis] + 0.5 * image.spacing,
                };
                let mut section = Section::new(&image, plane, shown.quantity())?;
                // Solids cover their cells as blocks do.
                section.leave_out(&placed(run, poses));
                let range = match slice.field {
                    SliceField::Speed => slice.range.or(self.speeds),
                    _ => slice.range,
                };
                Ok(FluidPlane::of(&section, plane, shown.colours(range)))
            })
            .collect()
    }

    /// The present streamlines among blocks at `poses`, if the view shows any.
    pub fn traces(&self, run: &mut SceneRun, poses: &[Pose]) -> Result<Option<Traces>> {
        let Some(coarse) = &self.coarse else {
            return Ok(None);
        };
        let image = self.image(run, Field::Velocity, coarse.cells(), coarse.frame())?;
        let lines: Vec<Trace> = traces(&image, &immersed(run, poses), self.count);
        let colours: Colours = SliceQuantity::of(SliceField::Speed).colours(self.speeds);
        Ok(Some(Traces { lines, colours }))
    }

    /// `field` and the solid cells among `cells`, in the image `frame`.
    fn image(
        &self,
        run: &mut SceneRun,
        field: Field,
        cells: &[u32],
        frame: ImageData,
    ) -> Result<ImageData> {
        let mut fields = vec![field];
        if self.solids {
            fields.push(Field::Solid);
        }
        Ok(ImageData {
            arrays: run.read(&fields, cells)?,
            ..frame
        })
    }
}

/// Most cells through which streamlines are followed: 64 MB of velocities, and more than a picture has pixels.
const MOST_CELLS: f64 = 4e6;

/// Every n-th cell of a scene along each axis, as an image of its own.
struct Coarse {
    frame: ImageData,
    cells: Vec<u32>,
}

impl Coarse {
    /// All cells of `scene`, or as many as fit.
    fn new(scene: &Scene) -> Self {
        let counts = scene.cells();
        let all: f64 = counts.iter().map(|n| f64::from(*n)).product();
        let stride = (all / MOST_CELLS).cbrt().ceil().max(1.0) as u32;
        // The middle cell of each group, so that the coarse cells are centred on their groups.
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
            frame: ImageData {
                origin,
                spacing,
                cells: taken.map(|along| along.count()),
                arrays: Vec::new(),
            },
        }
    }

    /// Indices of its cells in an array over the domain, x fastest.
    fn cells(&self) -> &[u32] {
        &self.cells
    }

    /// The coarse cells as an image without arrays, to be filled on [`Self::cells`].
    fn frame(&self) -> ImageData {
        self.frame.clone()
    }
}
