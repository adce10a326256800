//! Blocks: dry ones against exact solutions, contact geometry, and the search for pairs.

mod affine;
mod bond;
mod broadphase;
mod contact;
mod continuity;
mod corner;
mod deformable;
mod deformable_faults;
mod energy_ledger;
mod faults;
mod film;
mod fixture;
mod free_body;
mod guide;
mod incline;
mod law;
mod periodic;
mod rebound;
mod reproducibility;
mod rest;
mod rolling;
mod safety;
mod sleep;
mod toppling;
mod wedge;
