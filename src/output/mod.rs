//! Files that others read: VTI, VTU, VTP and PVD for ParaView, CSV for probes.
//!
//! A run fills an [`Image`] with cell data and hands it to [`write_vti`]; a [`Pvd`] collects the
//! images over time, a [`Csv`] the numbers of a probe. An image or a collection replaces its
//! predecessor only when complete, and [`Pvd::resume`] and [`Csv::resume`] continue after a
//! restart as if there had been none.
//!
//! ```
//! use riprap::output::{Array, Image, write_vti};
//! let folder = std::env::temp_dir().join(format!("riprap_doc_{}", std::process::id()));
//! std::fs::create_dir_all(&folder).expect("a temporary folder");
//! let image = Image {
//!     origin: [0.0; 3],
//!     spacing: 0.5,
//!     cells: [2, 1, 1],
//!     arrays: vec![Array { name: "pressure".into(), components: 1, values: vec![1.0, 3.0] }],
//! };
//! assert_eq!(image.sample("pressure", [0.5, 0.25, 0.25]), Some(vec![2.0]));
//! write_vti(folder.join("flow.vti"), &image)?;
//! # std::fs::remove_dir_all(&folder).expect("the folder made above");
//! # Ok::<(), riprap::Error>(())
//! ```

mod csv;
mod image;
mod pvd;
mod replace;
mod vtk;

pub use csv::{Csv, Table};
pub use image::{Array, Image, VelocityQuantities};
pub use pvd::Pvd;
pub(crate) use replace::failure;
pub use replace::replace;
pub use vtk::{Cloud, Polyhedra, Surface, write_surface, write_vti, write_vtp, write_vtu};
