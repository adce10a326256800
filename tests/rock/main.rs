//! Dry blocks against exact solutions.

mod affine;
mod bond;
mod continuity;
mod corner;
mod deformable;
mod deformable_faults;
mod faults;
mod film;
mod free_body;
mod guide;
mod incline;
mod law;
mod ledger;
mod periodic;
mod rebound;
mod repeat;
mod rest;
mod rig;
mod rolling;
mod safety;
mod sleep;
mod toppling;
mod wedge;
