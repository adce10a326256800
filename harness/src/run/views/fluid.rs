//! What a view shows of a fluid.

use super::super::slice_field::SliceQuantity;
use super::coarse::Coarse;
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
    output::Image,
    scene::{Field, Scene, SliceField, View, ViewSlice},
    simulation::probe::Layer,
};

/// The cells that a view shows.
pub struct Fluid {
    slices: Vec<(ViewSlice, Layer)>,
    coarse: Option<Coarse>,
    /// Number of lines.
    count: u32,
    /// Ends of the colours of speeds that have none of their own, m/s.
    speeds: Option<[f64; 2]>,
    solids: bool,
    /// Speed of the last colour, m/s, if the view gives one.
    speed: Option<f64>,
}

impl Fluid {
    /// What `view` shows of `scene`.
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
        let slices = self.slices.iter();
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
                // Solids stand before their cells as blocks do.
                section.leave_out(&placed(run, poses), plane);
                let range = match slice.field {
                    SliceField::Speed => slice.range.or(self.speeds),
                    _ => slice.range,
                };
                Ok(FluidPlane::of(&section, plane, shown.colours(range)))
            })
            .collect()
    }

    /// The present lines along the flow among blocks at `poses`, if the view shows any.
    pub fn traces(&self, run: &mut SceneRun, poses: &[Pose]) -> Result<Option<Traces>> {
        let Some(coarse) = &self.coarse else {
            return Ok(None);
        };
        let image = self.image(run, Field::Velocity, coarse.cells(), coarse.frame())?;
        let lines: Vec<Trace> = traces(&image, &immersed(run, poses), self.count);
        let colours: Colours = SliceQuantity::of(SliceField::Speed).colours(self.speeds);
        Ok(Some(Traces { lines, colours }))
    }

    /// `field` and what is solid on `cells`, which `frame` is made of.
    fn image(
        &self,
        run: &mut SceneRun,
        field: Field,
        cells: &[u32],
        frame: Image,
    ) -> Result<Image> {
        let mut fields = vec![field];
        if self.solids {
            fields.push(Field::Solid);
        }
        Ok(Image {
            arrays: run.read(&fields, cells)?,
            ..frame
        })
    }
}
