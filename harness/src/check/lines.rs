//! Lines of a name and a text, from which the reports are built.

use crate::adapters::Adapter;
use std::fmt::Display;

/// A title and the lines below it.
pub struct Lines(String);

impl Lines {
    /// A title alone.
    pub fn titled(title: &str) -> Self {
        Self(format!("{title}\n"))
    }

    /// Adds a line; without a name it continues the one above.
    pub fn add(&mut self, name: &str, what: impl Display) {
        self.0 += &format!("{name:12} {what}\n");
    }

    /// Adds the adapter.
    pub fn adapter(&mut self, adapter: &Adapter) {
        let Adapter {
            name,
            backend,
            driver,
            ..
        } = adapter;
        self.add("adapter", format_args!("{name} ({backend}, {driver})"));
    }

    /// Adds the warnings.
    pub fn warnings(&mut self, warnings: &[String]) {
        for warning in warnings {
            self.add("warning", warning);
        }
    }

    /// All lines as one text.
    pub fn text(self) -> String {
        self.0
    }
}
