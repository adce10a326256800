//! Bonds: contacts of faces that pull, where the faces touched at the start.

use super::{narrow::Scene, touch::Touch};
use crate::rock::{
    contact::{Placed, Seam},
    law::{self, History},
};
use glam::DVec3;

impl Scene<'_> {
    /// A bond where its parts are now; none where it breaks.
    pub(super) fn held(
        &self,
        (parts, blocks, way): ([u32; 2], [u32; 2], DVec3),
        [first, second]: [&Placed; 2],
        seam: &Seam,
        before: Option<&Touch>,
    ) -> Option<Touch> {
        let now = seam.of(first, second);
        let joint = self.joint(blocks);
        let section = law::Section {
            normal: now.normal,
            overlap: now.overlap,
            area: seam.area,
            elastic_area: seam.area,
            rolls: false,
            gape: now.overlap - now.least(seam),
        };
        let fresh = History {
            bonded: true,
            ..History::default()
        };
        let history = before.map_or(fresh, |touch| touch.force.history);
        let motion = self.motion(blocks, now.point, way);
        let force = law::force(joint, &section, &motion, &history);
        force.history.bonded.then(|| Touch {
            parts,
            blocks,
            way,
            point: now.point,
            pressure_centre: now.point,
            normal: now.normal,
            overlap: now.overlap,
            area: seam.area,
            section: seam.area,
            width: seam.width(),
            limit: 0.1 * first.smallest_distance.min(second.smallest_distance),
            force: law::Force {
                bending: joint.normal_stiffness * now.moment(seam),
                ..force
            },
            seam: *seam,
            stored: before.map_or(0.0, |touch| touch.stored),
            power: before.map_or(0.0, |touch| touch.power),
        })
    }
}

/// What a contact remembers once it is no bond, or no more.
pub(super) fn unbonded(touch: &Touch) -> History {
    History {
        bonded: false,
        slip: 0.0,
        ..touch.force.history
    }
}
