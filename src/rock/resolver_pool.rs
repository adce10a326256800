//! Resolvers for all threads.

use crate::rock::contact::{Counts, Options, Resolver};
use std::{
    fmt,
    sync::{Mutex, PoisonError},
};

/// One resolver a thread.
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

    /// What all of them have done.
    pub fn counts(&self) -> Counts {
        let mut sum = Counts::default();
        for resolver in &self.one_a_thread {
            let resolver = resolver.lock().unwrap_or_else(PoisonError::into_inner);
            sum += resolver.counts();
        }
        sum
    }

    /// Makes as many as there are `threads`.
    pub fn prepare(&mut self, threads: usize) {
        let options = self.options;
        let new = || Mutex::new(Resolver::new(options));
        while self.one_a_thread.len() < threads {
            self.one_a_thread.push(new());
        }
    }

    /// Lends this thread's to `work`.
    pub fn with<T>(&self, work: impl FnOnce(&mut Resolver) -> T) -> T {
        let thread = rayon::current_thread_index().unwrap_or(0);
        let resolver = &self.one_a_thread[thread % self.one_a_thread.len()];
        // A resolver holds nothing from one pair to the next: one that a panic left is as good.
        work(&mut resolver.lock().unwrap_or_else(PoisonError::into_inner))
    }
}
