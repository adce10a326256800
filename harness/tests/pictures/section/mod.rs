//! Sections and charts.

mod blocks;
mod charts;
mod fixture;
mod slices;
mod streamlines;
