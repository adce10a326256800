//! Links `.wgsl` files into one shader: resolves names, fills slots and unrolls loops.
//!
//! The head of a file lists its dependencies: `// needs lattice, grid, $eddy`. A name is a file of `kernels/`; `$eddy` is a
//! slot that the [`Program`] fills with a file. Each file is included once, after its dependencies. A loop whose head ends in
//! `// unroll` is unrolled, with its counter replaced by literals: an indexed `array<f32, 27>` would cost two to three times
//! as much.

use crate::{Error, Result};
use std::{
    collections::{BTreeMap, BTreeSet},
    sync::Arc,
};

mod sources;
mod unroll;

pub use sources::{SOURCES, source};

/// The input of the linker: a file with an entry point, and the files that fill its slots.
#[derive(Clone, Debug, Default, PartialEq, Eq, Hash)]
pub struct Program {
    entry: String,
    slots: BTreeMap<String, String>,
    texts: BTreeMap<String, String>,
}

impl Program {
    /// The program of the entry file `file`, a name without folder and extension.
    pub fn new(file: &str) -> Self {
        Self {
            entry: file.into(),
            ..Self::default()
        }
    }

    /// Fills the slot `name` (without the dollar sign) with `file`.
    #[must_use]
    pub fn slot(mut self, name: &str, file: &str) -> Self {
        self.slots.insert(name.into(), file.into());
        self
    }

    /// Adds a file that is not in `kernels/`, or replaces a file of `kernels/`.
    #[must_use]
    pub fn text(mut self, name: &str, text: impl Into<String>) -> Self {
        self.texts.insert(name.into(), text.into());
        self
    }

    /// Links, parses and validates.
    ///
    /// # Errors
    /// [`Error::Shader`] with the file and line in the source text.
    pub fn link(&self) -> Result<Linked> {
        let mut linked = Linking {
            program: self,
            done: BTreeSet::new(),
            slots: BTreeMap::new(),
            text: String::new(),
            lines: Vec::new(),
        };
        linked.take(&self.entry, &self.entry, 1)?;
        let Linking {
            slots, text, lines, ..
        } = linked;
        let (module, info) = check(&text, &lines)?;
        Ok(Linked {
            file: self.entry.clone(),
            slots,
            text,
            module: Arc::new(module),
            info: Arc::new(info),
        })
    }
}

/// A linked and validated shader.
#[derive(Clone, Debug)]
pub struct Linked {
    /// Name of the entry file.
    pub file: String,
    /// The slots of the program, each with the file that fills it.
    pub slots: BTreeMap<String, String>,
    /// The complete WGSL text.
    pub text: String,
    /// The parsed module.
    pub module: Arc<naga::Module>,
    /// The result of naga's validation.
    pub info: Arc<naga::valid::ModuleInfo>,
}

impl Linked {
    /// Whether the program declares the constant (WGSL override) `name`.
    pub fn declares(&self, name: &str) -> bool {
        let mut overrides = self.module.overrides.iter();
        overrides.any(|(_, o)| o.name.as_deref() == Some(name))
    }

    /// The value of the u32 `const` of this name, if the program has one.
    pub fn constant(&self, name: &str) -> Option<u32> {
        let mut constants = self.module.constants.iter();
        let (_, found) = constants.find(|(_, c)| c.name.as_deref() == Some(name))?;
        match self.module.global_expressions[found.init] {
            naga::Expression::Literal(naga::Literal::U32(value)) => Some(value),
            _ => None,
        }
    }

    /// The constants of a family of kernels that this program declares. [`crate::gpu::kernel::Kernel::new`] rejects the
    /// program if it declares a constant that is not in `family`.
    pub fn constants_of<'a>(&self, family: &[(&'a str, f64)]) -> Vec<(&'a str, f64)> {
        let declared = family.iter().filter(|(name, _)| self.declares(name));
        declared.copied().collect()
    }
}

struct Linking<'a> {
    program: &'a Program,
    done: BTreeSet<String>,
    slots: BTreeMap<String, String>,
    text: String,
    /// File and line that each line of `text` came from.
    lines: Vec<(String, u32)>,
}

impl Linking<'_> {
    fn take(&mut self, name: &str, wanted_by: &str, at: u32) -> Result<()> {
        let name = match name.strip_prefix('$') {
            None => name.to_owned(),
            Some(slot) => {
                let file = self.program.slots.get(slot).ok_or_else(|| Error::Shader {
                    file: wanted_by.into(),
                    line: at,
                    message: format!("the slot ${slot} is empty; fill it with Program::slot"),
                })?;
                self.slots.insert(slot.into(), file.clone());
                file.clone()
            }
        };
        if !self.done.insert(name.clone()) {
            return Ok(());
        }
        let text = match self.program.texts.get(&name) {
            Some(text) => text.as_str(),
            None => source(&name).ok_or_else(|| Error::Shader {
                file: wanted_by.into(),
                line: at,
                message: format!("no file is called {name}"),
            })?,
        };
        for (line, needed) in needs(text) {
            self.take(needed, &name, line)?;
        }
        let written: Vec<(u32, String)> = (1..).zip(text.lines().map(str::to_owned)).collect();
        for (line, written) in unroll::unroll(written, &name)? {
            self.text.push_str(&written);
            self.text.push('\n');
            self.lines.push((name.clone(), line));
        }
        Ok(())
    }
}

/// The names in the `// needs` lines of a file, each with its line.
pub fn needs(text: &str) -> impl Iterator<Item = (u32, &str)> {
    (1..)
        .zip(text.lines())
        .filter_map(|(line, written)| Some((line, written.strip_prefix("// needs ")?)))
        .flat_map(|(line, list)| list.split(',').map(move |name| (line, name.trim())))
}

fn check(text: &str, lines: &[(String, u32)]) -> Result<(naga::Module, naga::valid::ModuleInfo)> {
    let locate = |line: Option<u32>, message: String| {
        let (file, line) = line
            .and_then(|line| lines.get(line as usize - 1).cloned())
            .unwrap_or_default();
        Error::Shader {
            file,
            line,
            message,
        }
    };
    let module = naga::front::wgsl::parse_str(text)
        .map_err(|e| locate(e.location(text).map(|l| l.line_number), e.message().into()))?;
    let info = naga::valid::Validator::new(
        naga::valid::ValidationFlags::all(),
        // For unpack2x16float and 64-bit words; wgpu checks both against the adapter.
        naga::valid::Capabilities::default()
            | naga::valid::Capabilities::SHADER_FLOAT16_IN_FLOAT32
            | naga::valid::Capabilities::SHADER_INT64,
    )
    .validate(&module)
    .map_err(|e| {
        let mut message = e.as_inner().to_string();
        let mut cause = std::error::Error::source(e.as_inner());
        while let Some(inner) = cause {
            message = format!("{message}: {inner}");
            cause = inner.source();
        }
        locate(e.location(text).map(|l| l.line_number), message)
    })?;
    Ok((module, info))
}
