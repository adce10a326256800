//! Contact of convex blocks.

mod caches;
mod closed_forms;
mod faults;
mod laws;
mod normal;
mod pressure;
mod random_pairs;
mod rock_mass;
mod spheres;
mod volume;

use riprap::rock::contact::{Cache, ContactGeometry, Options, Placed, Resolver, Verdict};

/// Verdict of a new resolver without a cache.
fn verdict(a: &Placed, b: &Placed) -> Verdict {
    let mut resolver = Resolver::new(Options::default());
    let found = resolver.resolve(a, b, &mut Cache::default());
    found.expect("finite blocks")
}

/// The contact of two blocks that overlap.
fn contact(a: &Placed, b: &Placed) -> ContactGeometry {
    match verdict(a, b) {
        Verdict::Contact(contact) => contact,
        other => panic!("{other:?}"),
    }
}
