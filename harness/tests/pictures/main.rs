//! Pictures show the data at the right places, and what cannot be drawn is reported.

mod axis;
mod render;
mod section;
