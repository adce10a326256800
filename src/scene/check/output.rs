//! What is asked for can be written.

use super::rules::{distinct, finite, interval, names, refuse};
use crate::error::Result;
use crate::scene::{Axis, EddyViscosity, Field, Scene, Slice, SliceField};

impl Scene {
    pub(super) fn check_output(&self) -> Result<()> {
        let output = &self.output;
        interval("output.every", output.every)?;
        distinct("output.fields", &output.fields)?;
        self.check_eddy(
            "output.fields",
            output.fields.contains(&Field::EddyViscosity),
        )?;
        let named = output.slices.iter().map(|slice| slice.name.as_str());
        names("output.slices", named.enumerate())?;
        for (index, slice) in output.slices.iter().enumerate() {
            self.check_slice(&format!("output.slices[{index}]"), slice)?;
        }
        for (index, history) in output.histories.iter().enumerate() {
            let key = format!("output.histories[{index}]");
            distinct(&format!("{key}.quantities"), &history.quantities)?;
            interval(format!("{key}.every"), history.every)?;
            let of_blocks = history.quantities.iter().find(|q| q.is_of_blocks());
            if let (Some(quantity), false) = (of_blocks, self.has_blocks()) {
                return refuse(
                    format!("{key}.quantities"),
                    format!(
                        "{} is of blocks, and there are none; leave it out",
                        quantity.name()
                    ),
                );
            }
        }
        Ok(())
    }

    fn check_slice(&self, key: &str, slice: &Slice) -> Result<()> {
        interval(format!("{key}.every"), slice.every)?;
        self.check_plane(key, slice.axis, slice.position, slice.field, slice.range)
    }

    /// A plane of the domain can be shown.
    pub(super) fn check_plane(
        &self,
        key: &str,
        axis: Axis,
        position: Option<f64>,
        field: SliceField,
        range: Option<[f64; 2]>,
    ) -> Result<()> {
        self.check_eddy(&format!("{key}.field"), field == SliceField::EddyViscosity)?;
        if let Some(range) = range {
            finite(format!("{key}.range"), &range)?;
            if range[0] >= range[1] {
                return refuse(
                    format!("{key}.range"),
                    format!(
                        "reaches from {} to {}; the first must be the smaller",
                        range[0], range[1]
                    ),
                );
            }
        }
        let mut point = self.domain.middle();
        if let Some(position) = position {
            point[axis.index()] = position;
        }
        super::rules::inside(format!("{key}.position"), &self.domain, point)
    }

    /// The eddy viscosity can be written only where there is a model of it.
    pub(super) fn check_eddy(&self, key: &str, wanted: bool) -> Result<()> {
        if wanted && self.numerics.eddy_viscosity == EddyViscosity::None {
            return refuse(
                key,
                "there is no eddy_viscosity in this scene; set numerics.eddy_viscosity = \
                 \"wale\" or leave the field out",
            );
        }
        Ok(())
    }
}
