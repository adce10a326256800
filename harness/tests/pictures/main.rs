//! Pictures: what they show is where and what the data are, and what cannot be shown is reported.

mod axis;
mod render;
mod section;
