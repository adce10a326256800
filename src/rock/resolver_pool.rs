//! Resolvers of contacts, one per thread.

use crate::rock::contact::{Counts, Options, Resolver};
use std::{
    fmt,
    sync::{Mutex, PoisonError},
};

/// One resolver per thread.
pub(super) struct ResolverPool {
    options: Options,
    one_a_thread: Vec<Mutex<Resolver>>,
}

impl fmt::Debug for ResolverPool {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Resolvers")
            .field("options", &self.options)
            .field("threads", &self.one_a_thread.len())
            .finish()
    }
}

impl ResolverPool {
    pub fn new(options: Options) -> Self {
        Self {
            options,
            one_a_thread: Vec::new(),
        }
    }

    /// Counters summed over all threads.
    pub fn counts(&self) -> Counts {
        let mut sum = Counts::default();
        for resolver in &self.one_a_thread {
            let resolver = resolver.lock().unwrap_or_else(PoisonError::into_inner);
            sum += resolver.counts();
        }
        sum
    }

    /// Creates resolvers until there is one for each of the `threads`.
    pub fn prepare(&mut self, threads: usize) {
        let options = self.options;
        let new = || Mutex::new(Resolver::new(options));
        while self.one_a_thread.len() < threads {
            self.one_a_thread.push(new());
        }
    }

    /// Runs `work` with the resolver of this thread.
    pub fn with<T>(&self, work: impl FnOnce(&mut Resolver) -> T) -> T {
        let thread = rayon::current_thread_index().unwrap_or(0);
        let resolver = &self.one_a_thread[thread % self.one_a_thread.len()];
        // A resolver keeps no state between pairs, so that it is still valid after a panic.
        work(&mut resolver.lock().unwrap_or_else(PoisonError::into_inner))
    }
}
