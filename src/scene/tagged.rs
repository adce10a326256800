//! Tables whose `kind` decides which keys belong to them.
//!
//! serde's internally tagged enums buffer their content and lose the line and column of an error. So before a document is read
//! into types, the kind of such a table becomes an external tag: `{ kind = "sphere", radius = 1, name = "a" }` becomes
//! `{ kind = { sphere = { radius = 1 } }, name = "a" }`; all values keep their positions in the text.

use toml::Spanned;
use toml::de::{DeString, DeTable, DeValue};

use super::parse::{Refusal, unknown};
use super::{BlockShape, Boundary, Face, ProbePlace, Shape, Volume, blocks, probes, solids};

/// A kind of a table: its name, its required keys and its optional keys.
pub(super) type Kind = (&'static str, &'static str, &'static str);

/// Additional check of a table of a kind.
type Rule = fn(&DeTable<'_>, &str) -> Result<(), String>;

/// Tables with a kind.
struct Tagged {
    /// Path of keys from the scene to the tables, joined by dots. It passes through lists; `*` stands for all faces.
    path: &'static str,
    /// All keys of these tables, whatever the kind.
    keys: &'static str,
    kinds: &'static [Kind],
    /// Whether all keys of these tables belong to their kinds.
    is_enum: bool,
    rule: Rule,
}

/// All tables with a kind, inner ones first.
const TAGGED: [Tagged; 10] = [
    Tagged {
        path: "boundaries.*",
        keys: "kind velocity roughness pressure reflecting turbulence",
        kinds: Boundary::KINDS,
        is_enum: true,
        rule: |_, _| Ok(()),
    },
    PART,
    Tagged {
        path: "blocks",
        rule: |_, _| Ok(()),
        ..PART
    },
    Tagged {
        path: "water.parts",
        ..PART
    },
    Tagged {
        path: "water",
        keys: "kind size vertices faces edge radius file scale hull parts position rotation velocity",
        kinds: BlockShape::KINDS,
        is_enum: false,
        rule: |_, _| Ok(()),
    },
    REGION,
    Tagged {
        path: "rock_masses.removed",
        ..REGION
    },
    Tagged {
        path: "rock_masses",
        keys: "kind name min max vertices faces file scale translate joints seed up north smallest_volume \
               smallest_thickness aperture fixed removed material deformable initial_stress",
        kinds: Volume::KINDS,
        is_enum: false,
        rule: |_, _| Ok(()),
    },
    Tagged {
        path: "solids",
        is_enum: false,
        rule: |_, _| Ok(()),
        ..REGION
    },
    Tagged {
        path: "probes",
        keys: "kind name fields every at from to count axis position min max normal direction size block faces safety",
        kinds: ProbePlace::KINDS,
        is_enum: false,
        rule: probes::check_keys,
    },
];

/// Parts of compounds; the rule refuses keys that belong to the whole block.
const PART: Tagged = Tagged {
    path: "blocks.parts",
    keys: "kind name size vertices faces edge radius file scale hull parts position rotation motion velocity spin \
           material deformable initial_stress fixed_points point_loads acceleration guide repeat",
    kinds: BlockShape::KINDS,
    is_enum: false,
    rule: blocks::check_part,
};

/// Regions; the rule refuses keys of solids other than shape and position.
const REGION: Tagged = Tagged {
    path: "rock_masses.fixed",
    keys: "kind name void material surface roughness min max point normal center radius file scale translate",
    kinds: Shape::KINDS,
    is_enum: true,
    rule: solids::check_region,
};

/// Gives all tables with a kind in a document external tags.
pub(super) fn tag(document: &mut Spanned<DeValue<'_>>) -> Result<(), Refusal> {
    TAGGED
        .iter()
        .try_for_each(|tagged| tagged.tag_all(document, tagged.path, ""))
}

impl Tagged {
    /// Gives all tables at `path`, from the `value` at `key` on, an external tag.
    fn tag_all(
        &self,
        value: &mut Spanned<DeValue<'_>>,
        path: &str,
        key: &str,
    ) -> Result<(), Refusal> {
        if let DeValue::Array(list) = value.get_mut() {
            let mut all = list.iter_mut();
            return all.try_for_each(|value| self.tag_all(value, path, key));
        }
        if path.is_empty() {
            return self.tag(key, value);
        }
        let (first, rest) = path.split_once('.').unwrap_or((path, ""));
        let DeValue::Table(table) = value.get_mut() else {
            return Ok(());
        };
        for (name, value) in table.iter_mut() {
            let is_face = || Face::ALL.iter().any(|face| face.name() == name.get_ref());
            if name.get_ref() == first || first == "*" && is_face() {
                let key = format!("{key}.{}", name.get_ref());
                self.tag_all(value, rest, key.trim_start_matches('.'))?;
            }
        }
        Ok(())
    }

    /// Gives the table `value` at `key` an external tag, if its keys fit its kind.
    fn tag(&self, key: &str, value: &mut Spanned<DeValue<'_>>) -> Result<(), Refusal> {
        let span = value.span();
        let refuse = |message: String| Refusal {
            span: Some(span.clone()),
            key: key.into(),
            message,
        };
        let DeValue::Table(table) = value.get_mut() else {
            // serde refuses another type for a struct with its own message, but would read an enum from a word.
            return match self.is_enum {
                true => Err(refuse("is not a table; give one with a `kind`".into())),
                false => Ok(()),
            };
        };
        let keys: Vec<&str> = self.keys.split_whitespace().collect();
        let mut names = table.keys();
        if let Some(name) = names.find(|name| !keys.contains(&name.get_ref().as_ref())) {
            return Err(Refusal {
                span: Some(name.span()),
                ..refuse(unknown("key", name.get_ref(), &keys))
            });
        }
        let Some(kind) = table.get("kind").cloned() else {
            return Err(refuse("the key `kind` is missing; add it".into()));
        };
        let word = kind.get_ref().as_str();
        (self.rule)(table, word.unwrap_or_default()).map_err(refuse)?;
        let Some(known) = self.kinds.iter().find(|(name, ..)| word == Some(name)) else {
            let words: Vec<&str> = self.kinds.iter().map(|kind| kind.0).collect();
            return Err(Refusal {
                span: Some(kind.span()),
                key: format!("{key}.kind"),
                message: match word {
                    Some(word) => unknown("word", word, &words),
                    None => format!("is not a word; possible are {}", words.join(", ")),
                },
            });
        };
        let mut of_kinds = keys;
        of_kinds.retain(|key| self.kinds.iter().any(|kind| has(kind, key)));
        fits(table, &of_kinds, known).map_err(refuse)?;
        let content = Spanned::new(kind.span(), content(table, known));
        if self.is_enum {
            *value = content;
        } else if let Some(kind) = table.get_mut("kind") {
            *kind = content;
        }
        Ok(())
    }
}

/// Whether a kind has a key.
fn has((_, needs, may_have): &Kind, key: &str) -> bool {
    let mut keys = needs.split_whitespace().chain(may_have.split_whitespace());
    keys.any(|own| own == key)
}

/// Checks that `table` has the required keys of its kind, and none of the keys `of_kinds` that belong to other kinds only.
fn fits(table: &DeTable<'_>, of_kinds: &[&str], kind: &Kind) -> Result<(), String> {
    let (word, needs, may_have) = kind;
    let foreign = |key: &&&str| table.contains_key(**key) && !has(kind, key);
    if let Some(key) = of_kinds.iter().find(foreign) {
        let own: Vec<&str> = needs
            .split_whitespace()
            .chain(may_have.split_whitespace())
            .collect();
        return Err(match own.join(", ") {
            none if none.is_empty() => {
                format!("`{key}` has no meaning for kind `{word}`; remove it")
            }
            own => format!(
                "`{key}` has no meaning for kind `{word}`, which takes {own}; remove it or change the kind"
            ),
        });
    }
    match needs
        .split_whitespace()
        .find(|key| !table.contains_key(*key))
    {
        Some(key) => Err(format!("kind `{word}` needs the key `{key}`")),
        None => Ok(()),
    }
}

/// Moves the keys of a kind from `table` to a table below the name of the kind; only the name if the kind has no keys.
fn content<'i>(table: &mut DeTable<'i>, (word, needs, may_have): &Kind) -> DeValue<'i> {
    let word = DeString::Borrowed(*word);
    if needs.is_empty() && may_have.is_empty() {
        return DeValue::String(word);
    }
    let mut keys = DeTable::new();
    for key in needs.split_whitespace().chain(may_have.split_whitespace()) {
        if let Some((name, value)) = table.remove_entry(key) {
            keys.insert(name, value);
        }
    }
    let keys = Spanned::new(0..0, DeValue::Table(keys));
    DeValue::Table([(Spanned::new(0..0, word), keys)].into_iter().collect())
}
