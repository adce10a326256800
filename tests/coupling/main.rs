//! Blocks and fluid together: what must be conserved, repeated, left alone and refused.

mod around;
mod balance;
mod buoyancy;
mod closed;
mod crowd;
mod density;
mod faces;
mod faults;
mod flux;
mod images;
mod inlets;
mod places;
mod repeat;
mod rest;
mod rocking;
mod sliding;
mod world;
