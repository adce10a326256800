//! Tables whose `kind` decides which keys belong to them.
//!
//! They are read through a flat table of optional keys: serde's own tagged enums buffer their
//! content and lose the line and column of an error.

/// A key that is there but belongs to another kind.
pub(super) fn refuse_others(
    kind: &str,
    allowed: &[&str],
    given: &[(&str, bool)],
) -> Result<(), String> {
    match given
        .iter()
        .find(|(key, set)| *set && !allowed.contains(key))
    {
        None => Ok(()),
        Some((key, _)) if allowed.is_empty() => Err(format!(
            "`{key}` has no meaning for kind `{kind}`; remove it"
        )),
        Some((key, _)) => Err(format!(
            "`{key}` has no meaning for kind `{kind}`, which takes {}; remove it or change the kind",
            allowed.join(", ")
        )),
    }
}

/// A key that the kind cannot do without.
pub(super) fn need<T>(value: Option<T>, key: &str, kind: &str) -> Result<T, String> {
    value.ok_or_else(|| format!("kind `{kind}` needs the key `{key}`"))
}

/// Deserialises a type through its flat table.
macro_rules! through {
    ($flat:ty => $typed:ty) => {
        impl<'de> serde::Deserialize<'de> for $typed {
            fn deserialize<D: serde::Deserializer<'de>>(from: D) -> Result<Self, D::Error> {
                <$flat as serde::Deserialize>::deserialize(from)?
                    .typed()
                    .map_err(serde::de::Error::custom)
            }
        }
    };
}
pub(super) use through;
