//! Probes lie in the domain.

use super::rules::{distinct, inside, interval, names, ordered, positive, refuse};
use crate::error::Result;
use crate::scene::{Field, Probe, ProbePlace, Scene};

impl Scene {
    pub(super) fn check_probes(&self) -> Result<()> {
        let named = self.probes.iter().map(|probe| probe.name.as_str());
        names("probes", named.enumerate())?;
        for (index, probe) in self.probes.iter().enumerate() {
            self.check_probe(&format!("probes[{index}]"), probe)?;
        }
        let asks = |probe: &&Probe| matches!(probe.place, ProbePlace::Block { faces: true, .. });
        for asking in self.probes.iter().filter(asks) {
            let faces = format!("{}_faces", asking.name);
            if let Some(index) = self.probes.iter().position(|probe| probe.name == faces) {
                return refuse(
                    format!("probes[{index}].name"),
                    format!(
                        "`{faces}` is the table of the faces of `{}`; give it another name",
                        asking.name
                    ),
                );
            }
        }
        Ok(())
    }

    fn check_probe(&self, key: &str, probe: &Probe) -> Result<()> {
        interval(format!("{key}.every"), probe.every)?;
        distinct(&format!("{key}.fields"), &probe.fields)?;
        self.check_eddy(
            &format!("{key}.fields"),
            probe.fields.contains(&Field::EddyViscosity),
        )?;
        let within = |part: &str, point| inside(format!("{key}.{part}"), &self.domain, point);
        match &probe.place {
            ProbePlace::Point { at } => within("at", *at),
            ProbePlace::Line { from, to, count } => {
                within("from", *from)?;
                within("to", *to)?;
                if *count < 2 {
                    return refuse(
                        format!("{key}.count"),
                        format!("a line has at least 2 points, not {count}"),
                    );
                }
                Ok(())
            }
            ProbePlace::Plane { axis, position } => {
                let mut point = self.domain.middle();
                point[axis.index()] = *position;
                within("position", point)
            }
            ProbePlace::Block { faces: true, .. } if !self.has_fluid() => refuse(
                format!("{key}.faces"),
                "there is no fluid in this scene that could load the faces of a block; remove `faces`, or \
                 add [fluid]",
            ),
            ProbePlace::Block { faces: true, .. } if self.has_particles() => refuse(
                format!("{key}.faces"),
                "particles load blocks as a whole, and not face by face; remove `faces`, or use a lattice fluid",
            ),
            // Whether there is a block of that name, only the blocks themselves can tell.
            ProbePlace::Block { .. } if self.has_blocks() => Ok(()),
            ProbePlace::Block { .. } => refuse(
                format!("{key}.block"),
                "there are no blocks in this scene; remove the probe, or add [[blocks]]",
            ),
            ProbePlace::Gauge { at: [x, y] } => within("at", [*x, *y, self.domain.middle()[2]]),
            ProbePlace::Sensor { at, size, .. } => {
                if let Some(size) = size {
                    positive(format!("{key}.size"), *size, "m")?;
                }
                within("at", *at)
            }
            ProbePlace::Box { min, max }
            | ProbePlace::Face { min, max, .. }
            | ProbePlace::RunUp { min, max, .. } => {
                ordered(key, *min, *max)?;
                within("min", *min)?;
                within("max", *max)
            }
        }
    }
}
