//! Every finder of pairs gives the list that follows from the definition.

mod host;
mod scenes;
