//! Bonds: contacts of faces that carry tension, where the faces touched at the start.

use super::{
    contact_list::Contact,
    narrowphase::{Narrowphase, PairIds},
};
use crate::rock::{
    contact::{Bond, Placed},
    law::{self, History},
};

impl Narrowphase<'_> {
    /// The contact of a bond at the present poses of its parts; none where it breaks.
    pub(super) fn bonded_contact(
        &self,
        ids: PairIds,
        [first, second]: [&Placed; 2],
        bond: &Bond,
        before: Option<&Contact>,
    ) -> Option<Contact> {
        let PairIds {
            parts,
            blocks,
            image_shift,
        } = ids;
        let now = bond.state(first, second);
        let joint = self.joint(blocks);
        let section = law::Section {
            normal: now.normal,
            overlap: now.overlap,
            area: bond.area,
            elastic_area: bond.area,
            rolls: false,
            opening: now.overlap - now.smallest_overlap(bond),
        };
        let fresh = History {
            bonded: true,
            ..History::default()
        };
        let history = before.map_or(fresh, |contact| contact.force.history);
        let motion = self.motion(blocks, now.point, image_shift);
        let force = law::force(joint, &section, &motion, &history);
        force.history.bonded.then(|| Contact {
            parts,
            blocks,
            image_shift,
            point: now.point,
            pressure_centre: now.point,
            normal: now.normal,
            overlap: now.overlap,
            area: bond.area,
            section: bond.area,
            width: bond.width(),
            limit: 0.1 * first.smallest_distance.min(second.smallest_distance),
            force: law::Force {
                bending: joint.normal_stiffness * now.moment(bond),
                ..force
            },
            bond: *bond,
            stored: before.map_or(0.0, |contact| contact.stored),
            power: before.map_or(0.0, |contact| contact.power),
        })
    }
}

/// History of a contact without a bond.
pub(super) fn unbonded(contact: &Contact) -> History {
    History {
        bonded: false,
        slip: 0.0,
        ..contact.force.history
    }
}
