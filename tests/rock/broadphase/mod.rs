//! Every finder of pairs gives the list that follows from the definition.

mod degenerate;
mod device;
mod finders;
mod host;
mod kernels;
mod layout;
mod refusals;
mod scan;
