//! Records of speed and validation. No time is looked at.

mod bench;
mod validate;
