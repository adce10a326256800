//! What stands still in the flow.

use std::path::PathBuf;

use schemars::JsonSchema;
use serde::Deserialize;

use super::tagged::{need, refuse_others, through};

/// A static solid, or a hole in the solids listed before it.
///
/// A cell is solid if its centre lies in a solid; later entries win over earlier ones. For blocks, a
/// solid is a fixed block; a half-space then reaches as far beyond the domain as the domain is wide.
#[derive(Clone, Debug, PartialEq, JsonSchema)]
#[schemars(deny_unknown_fields)]
pub struct Solid {
    /// Name for messages and reports. Default none.
    #[schemars(default)]
    pub name: Option<String>,
    /// Whether the shape carves fluid out of the earlier solids. Default false.
    #[schemars(default)]
    pub void: bool,
    /// The shape.
    #[schemars(flatten)]
    pub shape: Shape,
    /// Name of the material that blocks touch. Default the first one.
    #[schemars(default)]
    pub material: Option<String>,
}

/// Shape of a solid or of a region.
#[derive(Clone, Debug, PartialEq, JsonSchema)]
#[schemars(tag = "kind", rename_all = "snake_case")]
pub enum Shape {
    /// A box along the axes.
    Box {
        /// Lower corner, m.
        min: [f64; 3],
        /// Upper corner, m.
        max: [f64; 3],
    },
    /// Everything on one side of a plane.
    HalfSpace {
        /// A point of the plane, m.
        point: [f64; 3],
        /// Normal of the plane, of any length; it points out of the solid.
        normal: [f64; 3],
    },
    /// A sphere.
    Sphere {
        /// Centre, m.
        center: [f64; 3],
        /// Radius, m.
        radius: f64,
    },
    /// A closed triangle mesh.
    Mesh {
        /// STL or OBJ file, relative to the scene's file.
        file: PathBuf,
        /// Length of the file's unit, m. Default 1.
        #[schemars(default = "metre")]
        scale: f64,
        /// Where the file's origin goes, m, after scaling. Default (0, 0, 0).
        #[schemars(default)]
        translate: [f64; 3],
    },
}

fn metre() -> f64 {
    1.0
}

#[derive(Clone, Copy, Deserialize)]
#[serde(rename_all = "snake_case")]
enum Kind {
    Box,
    HalfSpace,
    Sphere,
    Mesh,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Flat {
    kind: Kind,
    name: Option<String>,
    void: Option<bool>,
    material: Option<String>,
    min: Option<[f64; 3]>,
    max: Option<[f64; 3]>,
    point: Option<[f64; 3]>,
    normal: Option<[f64; 3]>,
    center: Option<[f64; 3]>,
    radius: Option<f64>,
    file: Option<PathBuf>,
    scale: Option<f64>,
    translate: Option<[f64; 3]>,
}

impl Flat {
    fn shape(&mut self) -> Result<Shape, String> {
        let given = [
            ("min", self.min.is_some()),
            ("max", self.max.is_some()),
            ("point", self.point.is_some()),
            ("normal", self.normal.is_some()),
            ("center", self.center.is_some()),
            ("radius", self.radius.is_some()),
            ("file", self.file.is_some()),
            ("scale", self.scale.is_some()),
            ("translate", self.translate.is_some()),
        ];
        let only = |kind, allowed: &[&str]| refuse_others(kind, allowed, &given);
        Ok(match self.kind {
            Kind::Box => {
                only("box", &["min", "max"])?;
                Shape::Box {
                    min: need(self.min, "min", "box")?,
                    max: need(self.max, "max", "box")?,
                }
            }
            Kind::HalfSpace => {
                only("half_space", &["point", "normal"])?;
                Shape::HalfSpace {
                    point: need(self.point, "point", "half_space")?,
                    normal: need(self.normal, "normal", "half_space")?,
                }
            }
            Kind::Sphere => {
                only("sphere", &["center", "radius"])?;
                Shape::Sphere {
                    center: need(self.center, "center", "sphere")?,
                    radius: need(self.radius, "radius", "sphere")?,
                }
            }
            Kind::Mesh => {
                only("mesh", &["file", "scale", "translate"])?;
                Shape::Mesh {
                    file: need(self.file.take(), "file", "mesh")?,
                    scale: self.scale.unwrap_or_else(metre),
                    translate: self.translate.unwrap_or_default(),
                }
            }
        })
    }

    fn typed(mut self) -> Result<Solid, String> {
        Ok(Solid {
            shape: self.shape()?,
            name: self.name,
            void: self.void.unwrap_or_default(),
            material: self.material,
        })
    }
}

through!(Flat => Solid);

/// The keys of a region: those of a solid that say where it is.
#[derive(Deserialize)]
#[serde(transparent)]
struct Region(Flat);

impl Region {
    fn typed(mut self) -> Result<Shape, String> {
        let solid = &self.0;
        let others = [
            ("name", solid.name.is_some()),
            ("void", solid.void.is_some()),
            ("material", solid.material.is_some()),
        ];
        match others.iter().find(|(_, given)| *given) {
            Some((key, _)) => Err(format!("`{key}` has no meaning for a region; remove it")),
            None => self.0.shape(),
        }
    }
}

through!(Region => Shape);
