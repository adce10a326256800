//! The device: linking of kernels, layouts of structs, timestamps, devices that are too small, full or lost.

mod layout;
mod link;
mod lost_device;
mod memory;
mod timer;
