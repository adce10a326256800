//! Records of speed and validation, and the short cases of validation. No time is looked at.

mod bench;
mod cases;
mod validate;
