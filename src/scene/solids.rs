//! Static solids.

use std::path::PathBuf;

use schemars::JsonSchema;
use serde::Deserialize;
use toml::de::DeTable;

use super::Scene;
use super::block_shape::metre;
use super::rules::{Point, direction, finite, names, ordered, positive, refuse};
use super::tagged::Kind;
use crate::error::Result;

/// A static solid, or a hole in the solids listed before it.
///
/// A cell is solid if its centre lies in a solid, unless `surface` is `exact`; later entries override earlier ones.
/// For blocks, a solid is a fixed block; a half-space then extends beyond the domain by the longest edge of the
/// domain.
#[derive(Clone, Debug, PartialEq, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[non_exhaustive]
pub struct Solid {
    /// Name for messages and reports. Default none.
    #[serde(default)]
    pub name: Option<String>,
    /// Whether the shape carves fluid out of the earlier solids. Default false.
    #[serde(default)]
    pub void: bool,
    /// The shape.
    #[serde(rename = "kind")]
    #[schemars(flatten)]
    pub shape: Shape,
    /// Name of the material that blocks touch. Default the first one.
    #[serde(default)]
    pub material: Option<String>,
    /// Surface for the fluid. Default `exact` for a terrain and `staircase` for other shapes.
    #[serde(default)]
    pub surface: Option<SolidSurface>,
    /// Equivalent sand roughness k_s, m, for `numerics.wall_model`. Default 0, smooth.
    #[serde(default)]
    pub roughness: f64,
}

impl Solid {
    /// A solid of this shape with the defaults of all other keys.
    pub fn new(shape: Shape) -> Self {
        Self {
            name: None,
            void: false,
            shape,
            material: None,
            surface: None,
            roughness: 0.0,
        }
    }
}

/// Surface of a static solid for the fluid.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum SolidSurface {
    /// The true surface: cells that the solid fills in part are partially saturated.
    Exact,
    /// A cell is solid if its centre lies inside.
    Staircase,
}

/// Shape of a solid or of a region.
#[derive(Clone, Debug, PartialEq, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
#[schemars(tag = "kind")]
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
        #[serde(default = "metre")]
        scale: f64,
        /// Where the file's origin goes, m, after scaling. Default (0, 0, 0).
        #[serde(default)]
        translate: [f64; 3],
    },
    /// The volume below heights along z, from a survey.
    Terrain {
        /// XYZ file of a regular grid, ESRI ASCII grid (.asc) or GeoTIFF, relative to the scene's file.
        file: PathBuf,
        /// Length of the file's unit, m. Default 1.
        #[serde(default = "metre")]
        scale: f64,
        /// Where the file's origin goes, m, after scaling. Default (0, 0, 0).
        #[serde(default)]
        translate: [f64; 3],
    },
}

impl Shape {
    pub(super) const KINDS: &[Kind] = &[
        ("box", "min max", ""),
        ("half_space", "point normal", ""),
        ("sphere", "center radius", ""),
        ("mesh", "file", "scale translate"),
        ("terrain", "file", "scale translate"),
    ];
}

/// Checks that a region has only the keys of a solid for its shape and position.
pub(super) fn check_region(region: &DeTable<'_>, _: &str) -> Result<(), String> {
    let mut others = ["name", "void", "material", "surface", "roughness"].iter();
    match others.find(|key| region.contains_key(**key)) {
        Some(key) => Err(format!("`{key}` has no meaning for a region; remove it")),
        None => Ok(()),
    }
}

impl Scene {
    pub(super) fn check_solids(&self) -> Result<()> {
        let named = self.solids.iter().enumerate();
        names(
            "solids",
            named.filter_map(|(i, solid)| Some((i, solid.name.as_deref()?))),
        )?;
        for (index, solid) in self.solids.iter().enumerate() {
            let key = format!("solids[{index}]");
            self.check_region(&key, &solid.shape)?;
            self.check_roughness(&format!("{key}.roughness"), solid.roughness)?;
            if solid.void && self.has_blocks() {
                return refuse(
                    format!("{key}.void"),
                    "blocks meet solids one by one, so none can have a hole; give a mesh with the \
                     hole, or several solids around it",
                );
            }
            if self.has_fluid() {
                self.check_place(&key, &solid.shape)?;
            }
            if self.has_blocks() || solid.material.is_some() {
                self.material(&format!("{key}.material"), solid.material.as_deref())?;
            }
        }
        Ok(())
    }

    /// Checks the numbers of a shape.
    pub(super) fn check_region(&self, key: &str, shape: &Shape) -> Result<()> {
        match shape {
            Shape::Box { min, max } => ordered(key, *min, *max),
            Shape::HalfSpace { point, normal } => {
                finite(format!("{key}.point"), point)?;
                direction(format!("{key}.normal"), normal)
            }
            Shape::Sphere { center, radius } => {
                finite(format!("{key}.center"), center)?;
                positive(format!("{key}.radius"), *radius, "m")
            }
            Shape::Mesh {
                scale, translate, ..
            }
            | Shape::Terrain {
                scale, translate, ..
            } => {
                positive(format!("{key}.scale"), *scale, "m")?;
                finite(format!("{key}.translate"), translate)
            }
        }
    }

    /// Checks that a shape without a file reaches into the domain.
    fn check_place(&self, key: &str, shape: &Shape) -> Result<()> {
        match shape {
            Shape::Box { min, max } => self.check_reach(key, *min, *max),
            Shape::Sphere { center, radius } => {
                let corner = |sign: f64| center.map(|c| c + sign * radius);
                self.check_reach(key, corner(-1.0), corner(1.0))
            }
            Shape::HalfSpace { .. } | Shape::Mesh { .. } | Shape::Terrain { .. } => Ok(()),
        }
    }

    /// A shape between the corners `min` and `max` (m) must reach into the domain.
    pub(crate) fn check_reach(&self, key: &str, min: [f64; 3], max: [f64; 3]) -> Result<()> {
        let (origin, end) = (self.domain.origin, self.domain.end());
        if (0..3).all(|a| min[a] < end[a] && max[a] > origin[a]) {
            return Ok(());
        }
        refuse(
            key,
            format!(
                "the solid reaches from {} to {} m and so lies wholly outside the domain, which \
                 reaches from {} to {} m; move it or remove it",
                Point(min),
                Point(max),
                Point(origin),
                Point(end)
            ),
        )
    }
}
