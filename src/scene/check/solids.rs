//! Solids have an extent, and some of it in the domain.

use super::rules::{Point, direction, finite, names, ordered, positive, refuse};
use crate::error::Result;
use crate::scene::{Scene, Shape};

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

    /// The numbers of a shape.
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
            } => {
                positive(format!("{key}.scale"), *scale, "m")?;
                finite(format!("{key}.translate"), translate)
            }
        }
    }

    /// Whether a shape without a file is where the domain is.
    fn check_place(&self, key: &str, shape: &Shape) -> Result<()> {
        match shape {
            Shape::Box { min, max } => self.check_reach(key, *min, *max),
            Shape::Sphere { center, radius } => {
                let corner = |sign: f64| center.map(|c| c + sign * radius);
                self.check_reach(key, corner(-1.0), corner(1.0))
            }
            Shape::HalfSpace { .. } | Shape::Mesh { .. } => Ok(()),
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
