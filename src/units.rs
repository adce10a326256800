//! The border between SI and lattice units.
