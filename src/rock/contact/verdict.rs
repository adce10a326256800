//! What is decided of a pair.

use glam::DVec3;

/// A contact, vectors along the world's axes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ContactGeometry {
    /// A point deep inside the overlap, its analytic centre, m.
    pub point: DVec3,
    /// Unit normal from the first block to the second.
    pub normal: DVec3,
    /// Overlap u_n along the normal, m. In a face contact its mean over the section, so that
    /// `area` × `overlap` is the volume of overlap.
    pub overlap: f64,
    /// Area of the section of the overlap, m².
    pub area: f64,
    /// Where the resultant of a pressure that grows with the overlap acts, m.
    pub pressure_centre: DVec3,
    /// Largest extent of the section, m.
    pub width: f64,
    /// Overlap beyond which the blocks are no longer hard, a tenth of the smallest distance of a
    /// face from the centroid of its block, m.
    pub limit: f64,
}

impl ContactGeometry {
    /// Whether the overlap is beyond its limit: the stiffness is too low, or the step too long.
    /// Whoever knows the blocks' names makes an [`Error::DeepOverlap`](crate::Error::DeepOverlap).
    pub fn is_deep(&self) -> bool {
        self.overlap > self.limit
    }

    /// The same contact with the blocks in the other order.
    pub(super) fn swapped(self) -> Self {
        Self {
            normal: -self.normal,
            ..self
        }
    }
}

/// Whether two blocks overlap, with proof.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Verdict {
    /// A plane keeps the blocks apart.
    Apart,
    /// Neither plane nor point is found: the gap or overlap is within rounding. No force acts, and
    /// the history of the contact is kept.
    Undecided,
    /// A point is inside both.
    Contact(ContactGeometry),
}
