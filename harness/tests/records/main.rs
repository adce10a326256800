//! Records of speed and validation, and the short validation cases. Times are not checked.

mod bench;
mod cases;
mod validate;
