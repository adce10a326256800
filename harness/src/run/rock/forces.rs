//! What is drawn of a block that a probe follows: the forces and torques on it over time.

use crate::picture::Track;

/// Of every block: what its contacts do.
pub const FORCES: [Track<'_>; 2] = [
    Track {
        quantity: "force of contacts",
        unit: "N",
        columns: &["force_x", "force_y", "force_z"],
    },
    Track {
        quantity: "torque of contacts",
        unit: "N m",
        columns: &["torque_x", "torque_y", "torque_z"],
    },
];

/// Of a block in a fluid as well, and before them: its drag and lift.
pub const IN_FLUID: [Track<'_>; 2] = [
    Track {
        quantity: "force of fluid",
        unit: "N",
        columns: &["fluid_force_x", "fluid_force_y", "fluid_force_z"],
    },
    Track {
        quantity: "torque of fluid",
        unit: "N m",
        columns: &["fluid_torque_x", "fluid_torque_y", "fluid_torque_z"],
    },
];
