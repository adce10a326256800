//! What the library says of a flow before it runs.

use riprap::{Error, scene::Scene, units::Units};
use std::path::Path;

/// What a user would be told.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Advice {
    /// Nothing.
    Silent,
    /// Warnings, with their keys.
    Warned(String),
    /// The run is refused, at this key.
    Refused(String),
}

impl Advice {
    /// Of a box of `cells` fluid cells with the lattice viscosity `nu`, the largest speed `speed` (cells a step) and
    /// these `numerics`, lines of TOML.
    ///
    /// # Errors
    /// If the scene is none.
    pub fn of(cells: [u32; 3], nu: f64, speed: f64, numerics: &str) -> anyhow::Result<Self> {
        let text = format!(
            "run = {{ steps = 1 }}\n[domain]\nsize = {cells:?}\ncell = 1\n[fluid]\ndensity = 1\nviscosity = {nu:e}\n\
             [numerics]\ntime_step = 1\nvelocity_scale = {speed:e}\n{numerics}"
        );
        let scene = Scene::from_toml(&text, Path::new("."), "stress")?;
        Ok(match scene.advise(&Units::of(&scene)?) {
            Err(Error::Scene { key, .. }) => Self::Refused(key),
            Err(other) => return Err(other.into()),
            Ok(warnings) if warnings.is_empty() => Self::Silent,
            Ok(warnings) => {
                let places: Vec<_> = warnings.into_iter().map(|warning| warning.place).collect();
                Self::Warned(places.join(" "))
            }
        })
    }

    /// In words, for [`super::Cell::warned`].
    pub fn words(&self) -> String {
        match self {
            Self::Silent => String::new(),
            Self::Warned(places) => format!("warned {places}"),
            Self::Refused(place) => format!("refused {place}"),
        }
    }

    /// Whether it fits a run that ended well or badly: what ends badly wants a warning at least, and what ends well is
    /// not to be refused. A warning of what ends well may be one of accuracy.
    pub fn fits(&self, well: bool) -> bool {
        match self {
            Self::Silent => well,
            Self::Warned(_) => true,
            Self::Refused(_) => !well,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn advice_is_that_of_the_scene() {
        let of = |nu, speed, numerics: &str| Advice::of([8, 8, 8], nu, speed, numerics).unwrap();
        assert_eq!(of(0.01, 0.02, ""), Advice::Silent);
        let warned = of(1e-5, 0.02, "");
        assert_eq!(warned, Advice::Warned("domain.cell".into()));
        let refused = of(0.01, 0.2, "");
        assert_eq!(refused, Advice::Refused("numerics.time_step".into()));
        assert_eq!(refused.words(), "refused numerics.time_step");
    }

    #[test]
    fn only_silence_before_a_fall_and_refusals_of_what_holds_are_wrong() {
        let (warned, refused) = (Advice::Warned("a".into()), Advice::Refused("a".into()));
        assert!(Advice::Silent.fits(true) && !Advice::Silent.fits(false));
        assert!(warned.fits(true) && warned.fits(false));
        assert!(!refused.fits(true) && refused.fits(false));
    }
}
