//! Content of a picture.

use super::camera::{Camera, Look};
use super::drops::Drops;
use super::fluid_plane::FluidPlane;
use super::mesh::{Mesh, Vertex};
use crate::picture::colour_bar::ColourBar;
use crate::picture::{Palette, Trace};
use glam::{DMat3, DVec3};
use riprap::{Error, Result};

/// Everything in a picture. Lengths are metres; large coordinates keep their digits, since all are taken relative to the
/// camera's target before they are rounded to f32.
#[derive(Clone, Debug, Default)]
pub struct Drawing<'a> {
    /// The shapes of bodies.
    pub meshes: &'a [Mesh],
    /// The bodies.
    pub instances: Vec<Instance>,
    /// Planes through a fluid.
    pub planes: Vec<FluidPlane>,
    /// Lines along a flow.
    pub traces: Option<Traces>,
    /// Many small balls.
    pub drops: Option<Drops>,
    /// Other lines.
    pub lines: Vec<Line>,
    /// The view.
    pub view: View,
    /// A plane with a grid below the bodies.
    pub ground: Option<Ground>,
    /// The background.
    pub background: Background,
    /// Direction towards the sun; above the viewer's left shoulder if `None`.
    pub sun: Option<DVec3>,
    /// Whether to draw a scale bar for the distance of the camera's target.
    pub scale_bar: bool,
    /// Title above the picture.
    pub title: String,
    /// Time, s, drawn next to the title.
    pub time: Option<f64>,
    /// Meaning of the bodies' values; without it they have no colour bar.
    pub colours: Option<Colours>,
}

/// A body: a mesh at a position.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Instance {
    /// Index of the mesh.
    pub mesh: usize,
    /// Position of the mesh's origin, m.
    pub centre: DVec3,
    /// Rotation, and stretch if any: a point X of the mesh is at `centre` + `deformation` X.
    pub deformation: DMat3,
    /// The value shown by its colour, in the unit of [`Colours`]; the colour of stone if `None`.
    pub value: Option<f64>,
    /// A body that does not move is drawn in neutral grey, whatever its value.
    pub fixed: bool,
}

/// Lines along a flow, coloured by its speed.
#[derive(Clone, Debug, PartialEq)]
pub struct Traces {
    /// The lines.
    pub lines: Vec<Trace>,
    /// Meaning of their colours.
    pub colours: Colours,
}

impl Traces {
    pub(super) fn bar(&self) -> Result<ColourBar> {
        let speeds = self.lines.iter().flat_map(|trace| &trace.speeds);
        (self.colours).bar("traces", speeds.copied(), Palette::Sequential, true)
    }

    fn check(&self) -> std::result::Result<(), String> {
        for (index, trace) in self.lines.iter().enumerate() {
            check_finite(&trace.points).map_err(|message| format!("line {index}: {message}"))?;
            if trace.points.len() != trace.speeds.len() {
                return Err(format!("line {index}: give each point one speed"));
            }
        }
        Ok(())
    }
}

/// A straight line in space.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Line {
    /// Ends, m.
    pub ends: [DVec3; 2],
    /// Colour, sRGB.
    pub colour: [u8; 3],
    /// Width, pixels.
    pub width: f64,
}

/// How the camera is chosen.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum View {
    /// A camera.
    From(Camera),
    /// The nearest camera in a direction from which all bodies, planes and lines are in view.
    Framing(Look),
}

impl Default for View {
    fn default() -> Self {
        Self::Framing(Look::default())
    }
}

/// A plane with a grid: the points x with x · up = `height`, up being the camera's.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ground {
    /// Distance from the origin along the camera's up direction, m.
    pub height: f64,
}

/// What is behind everything.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Background {
    /// White, for print.
    #[default]
    White,
    /// Pale blue, darker upwards.
    Sky,
}

/// Meaning of the values of bodies, planes, lines or balls.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Colours {
    /// Name of the quantity.
    pub label: String,
    /// Its unit.
    pub unit: String,
    /// Range of the colour map; that of the values if `None`. With opposite ends the map diverges around zero.
    pub range: Option<[f64; 2]>,
}

impl Colours {
    /// The colour bar of values in the part `name` of a drawing, by `palette` unless the values are around zero; the range of
    /// a `length` begins at zero.
    pub(super) fn bar(
        &self,
        name: &str,
        values: impl Iterator<Item = f64>,
        palette: Palette,
        length: bool,
    ) -> Result<ColourBar> {
        let bar = ColourBar::fitting(&self.label, &self.unit, self.range, values, length);
        let mut bar = bar.map_err(|error| {
            let key = format!("{name}.colours.range");
            Error::argument(key.trim_start_matches('.'), error.to_string())
        })?;
        if bar.palette == Palette::Sequential {
            bar.palette = palette;
        }
        Ok(bar)
    }
}

impl Drawing<'_> {
    /// Checks that everything can be drawn.
    pub(super) fn check(&self) -> Result<()> {
        for (index, body) in self.instances.iter().enumerate() {
            let place = || format!("instances[{index}]");
            if body.mesh >= self.meshes.len() {
                let message = format!("mesh {} of {}", body.mesh, self.meshes.len());
                return Err(Error::argument(place(), message + "; count from 0"));
            }
            if !body.centre.is_finite() || !body.deformation.is_finite() {
                let message = format!(
                    "its pose is not finite (centre {}, deformation {}); did the motion diverge?",
                    body.centre, body.deformation
                );
                return Err(Error::argument(place(), message));
            }
            if let Some(value) = body.value.filter(|value| !value.is_finite()) {
                let message = format!("its value is {value}; give a finite one or none");
                return Err(Error::argument(place(), message));
            }
        }
        for (index, mesh) in self.meshes.iter().enumerate() {
            let ends = mesh.edges.iter().flatten();
            check_surface(&mesh.vertices, &mesh.triangles)
                .and_then(|()| check_finite(ends))
                .map_err(|message| Error::argument(format!("meshes[{index}]"), message))?;
        }
        let planes = self.planes.iter().enumerate();
        let planes = planes.map(|(index, plane)| (format!("planes[{index}]"), plane.check()));
        let traces = self.traces.iter().map(|t| ("traces".into(), t.check()));
        let drops = self.drops.iter().map(|d| ("drops".into(), d.check()));
        for (place, checked) in planes.chain(traces).chain(drops) {
            checked.map_err(|message| Error::argument(place, message))?;
        }
        for (index, line) in self.lines.iter().enumerate() {
            let place = || format!("lines[{index}]");
            check_finite(&line.ends).map_err(|message| Error::argument(place(), message))?;
            if !(line.width.is_finite() && line.width > 0.0) {
                let message = format!("a width of {} pixels; give a positive one", line.width);
                return Err(Error::argument(place(), message));
            }
        }
        if let Some(ground) = self.ground.filter(|ground| !ground.height.is_finite()) {
            let message = format!("is {}; give a finite one", ground.height);
            return Err(Error::argument("ground.height", message));
        }
        if let Some(sun) = self.sun.filter(|sun| sun.try_normalize().is_none()) {
            let message = format!("{sun} is no direction; give a vector towards the sun");
            return Err(Error::argument("sun", message));
        }
        Ok(())
    }
}

fn check_surface(vertices: &[Vertex], triangles: &[[u32; 3]]) -> std::result::Result<(), String> {
    check_finite(vertices.iter().flat_map(|v| [&v.position, &v.normal]))?;
    let count = vertices.len();
    match triangles.iter().flatten().find(|&&v| v as usize >= count) {
        Some(index) => Err(format!("a triangle has vertex {index} of {count}")),
        None => Ok(()),
    }
}

pub(super) fn check_finite<'a>(
    points: impl IntoIterator<Item = &'a DVec3>,
) -> std::result::Result<(), String> {
    match points.into_iter().find(|point| !point.is_finite()) {
        Some(point) => Err(format!("{point} is not finite")),
        None => Ok(()),
    }
}
