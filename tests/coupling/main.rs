//! Blocks and fluid together: conservation, reproducibility, skipped work and errors.

mod conservation;
mod deformable;
mod density;
mod external_load;
mod faces;
mod faults;
mod fixture;
mod inlets;
mod joint_modes;
mod joint_seal;
mod joint_stability;
mod periodic_images;
mod places;
mod processors;
mod reproducibility;
mod rocking;
mod skipped_work;
mod sliding;
