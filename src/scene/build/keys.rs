//! Maps fields of setups to the keys of scenes that set them.

/// The key of a scene that sets the field `what` of a [`lattice::Setup`](crate::lattice::Setup) or of the initial
/// [`lattice::State`](crate::lattice::State).
pub(crate) fn lattice_key(what: &str) -> String {
    match what {
        "cells" => "domain.cell".into(),
        "nu" => "fluid.viscosity".into(),
        "force" => "fluid.acceleration".into(),
        "wale" => "numerics.wale_constant".into(),
        "lanes" | "lambda" | "wall_lambda" | "solid_lambda" | "odd_rate_floor"
        | "solid_operator" | "solid_weight" | "wale_interval" | "wall_model" | "sloping_faces" => {
            format!("numerics.{what}")
        }
        "joint_aperture" => "coupling.joint_aperture".into(),
        "excess" => "initial.pressure".into(),
        "solid" => "solids".into(),
        _ => match (what.strip_prefix("faces."), what.strip_prefix("velocity.")) {
            (Some(face), _) => format!("boundaries.{face}"),
            (_, Some(axis)) => format!("initial.velocity.{axis}"),
            _ => what.into(),
        },
    }
}

/// The key of a scene that sets the field `what` of an [`sph::Setup`](crate::sph::Setup).
#[cfg(feature = "sph")]
pub(crate) fn particle_key(what: &str) -> String {
    match what {
        "spacing"
        | "smoothing"
        | "sound_speed"
        | "courant"
        | "artificial_viscosity"
        | "density_diffusion" => format!("particles.{what}"),
        "density" => "fluid.density".into(),
        "laminar_viscosity" | "scheme.viscosity" => "fluid.viscosity".into(),
        "gravity" => "fluid.acceleration".into(),
        "origin" => "domain.origin".into(),
        "size" | "size.x" | "size.y" | "size.z" => "domain.size".into(),
        "faces" => "boundaries".into(),
        "bodies" => "blocks".into(),
        "positions" => "water".into(),
        _ => what.into(),
    }
}

/// The key of a scene that sets the field `what` of a [`rock::Setup`](crate::rock::Setup).
#[cfg(feature = "rock")]
pub(crate) fn rock_key(what: &str) -> String {
    match what {
        "time_step" | "skin" | "largest_overlap" | "corner_area" | "gravity" | "sleep.speed" => {
            format!("rock.{what}")
        }
        "damping" => "rock.mass_damping".into(),
        "sleep.after" => "rock.sleep.time".into(),
        _ => match what.strip_prefix("pairs[") {
            Some(pair) => format!("material_pairs[{pair}"),
            None => what.into(),
        },
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Error;

    #[test]
    fn errors_of_setups_name_keys_of_scenes() {
        let of_scene = |what: &str, key: fn(&str) -> String| {
            Error::argument(what, "is 0").at_key(key).to_string()
        };
        for (what, key) in [
            ("nu", "fluid.viscosity"),
            ("faces.x_min", "boundaries.x_min"),
            ("velocity.y", "initial.velocity.y"),
            ("lanes", "numerics.lanes"),
        ] {
            assert_eq!(of_scene(what, lattice_key), format!("{key}: is 0"));
        }
        #[cfg(feature = "rock")]
        assert_eq!(
            of_scene("pairs[2].normal_stiffness", rock_key),
            "material_pairs[2].normal_stiffness: is 0"
        );
        #[cfg(feature = "sph")]
        assert_eq!(of_scene("spacing", particle_key), "particles.spacing: is 0");
    }
}
