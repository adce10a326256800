//! The kernels of immersed blocks against the formulas in f64.

mod layout;
