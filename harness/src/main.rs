//! riprap
fn main() {}
