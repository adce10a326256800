//! Dry blocks against exact solutions.

mod continuity;
mod corner;
mod faults;
mod free_body;
mod incline;
mod law;
mod ledger;
mod rebound;
mod repeat;
mod rest;
mod rig;
mod safety;
mod sleep;
mod toppling;
mod wedge;
