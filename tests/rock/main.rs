//! Rock blocks: dry motion against exact solutions, contact geometry, and the broadphase.

mod affine;
mod bond;
mod broadphase;
mod contact;
mod corner;
mod deformable;
mod energy_ledger;
mod faults;
mod film;
mod fixture;
mod free_body;
mod guide;
mod law;
mod periodic;
mod reproducibility;
mod restitution;
mod rolling;
mod safety;
mod stack;
