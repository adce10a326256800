//! Static solids on the grid: which cells they fill.
//!
//! A cell is solid if its centre is inside. Surfaces are half-open, like intervals: of two boxes
//! that share a face every centre on that face belongs to exactly one.

mod cells;
mod mask;
mod overlap;
mod shapes;

pub use mask::Mask;

use crate::error::{Error, Result};
use crate::geometry::TriangleMesh;
use crate::scene::{Scene, Shape};

impl Scene {
    /// The cells that the solids of the scene fill.
    ///
    /// # Errors
    /// If the file of a mesh cannot be read, a mesh is open or lies wholly outside the domain, or
    /// no fluid is left.
    pub fn solid_mask(&self) -> Result<Mask> {
        let mut mask = Mask::new(self.cells())?;
        for (index, solid) in self.solids.iter().enumerate() {
            let key = format!("solids[{index}]");
            let filled = !solid.void;
            match &solid.shape {
                Shape::Mesh {
                    file,
                    scale,
                    translate,
                } => {
                    let mesh = TriangleMesh::read(&self.dir().join(file), *scale, *translate)?;
                    let (min, max) = mesh.bounds();
                    self.check_reach(&format!("{key} ({})", file.display()), min, max)?;
                    mesh.closed()
                        .map_err(|message| Error::file(self.dir().join(file), message))?;
                    cells::inside(&mesh, &self.domain, |cell| mask.set(cell, filled));
                }
                shape => shapes::inside(shape, &self.domain, |cell| mask.set(cell, filled)),
            }
        }
        if mask.solid_count() == mask.as_slice().len() {
            return Err(Error::scene(
                "solids",
                "the solids fill the whole domain; leave some fluid, for example turn a half \
                 space by reversing its normal (it points out of the solid)",
            ));
        }
        Ok(mask)
    }
}
