//! Files and numbers of free water (SPH).

mod clouds;
mod energies;
mod gauges;
mod water_summary;

pub use clouds::Clouds;
pub use energies::Energies;
pub use gauges::GaugeTable;
pub use water_summary::WaterSummary;
