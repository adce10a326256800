//! A contact as it is shown.

use super::touch::Touch;
use glam::DVec3;

/// One contact at the end of the last step.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ContactPoint {
    /// First and second block.
    pub blocks: [usize; 2],
    /// First and second part, among the parts of all blocks.
    pub parts: [usize; 2],
    /// Where the force acts, m, beside the first block.
    pub point: DVec3,
    /// Way by which the second block is moved to be beside the first, m: none, or that of whole periods.
    pub way: DVec3,
    /// Unit normal from the first block to the second.
    pub normal: DVec3,
    /// Force on the second block, N; the first gets the opposite.
    pub force: DVec3,
    /// Overlap, m.
    pub overlap: f64,
    /// Area that its springs count with, m².
    pub area: f64,
    /// Area of the section itself, m², with which cohesion counts: less than `area` where that is of a corner.
    pub section: f64,
    /// Whether its tensile strength still holds.
    pub bonded: bool,
}

impl ContactPoint {
    pub(super) fn of(touch: &Touch) -> Self {
        Self {
            blocks: touch.blocks.map(|block| block as usize),
            parts: touch.parts.map(|part| part as usize),
            point: touch.pressure_centre,
            way: touch.way,
            normal: touch.normal,
            force: touch.force.total(),
            overlap: touch.overlap,
            area: touch.area,
            section: touch.section,
            bonded: touch.force.history.bonded,
        }
    }
}
