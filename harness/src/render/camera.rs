//! The camera of a picture.

use glam::DVec3;
use riprap::{Error, Result};

/// A camera with perspective.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Camera {
    /// Position of the eye, m.
    pub from: DVec3,
    /// The point in the middle of the picture, m.
    pub to: DVec3,
    /// The direction that is up in the picture; also the normal of the ground.
    pub up: DVec3,
    /// Angle between the upper and the lower edge of the view, rad.
    pub field_of_view: f64,
}

/// A viewing direction.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Look {
    /// Direction from the eye into the picture.
    pub direction: DVec3,
    /// The direction that is up in the picture; also the normal of the ground.
    pub up: DVec3,
    /// Angle between the upper and the lower edge of the view, rad.
    pub field_of_view: f64,
}

impl Default for Look {
    /// Along +y, from the right and above, with z up and the field of view of a portrait lens: a wider one would make the
    /// nearest blocks look larger than the others.
    fn default() -> Self {
        Self {
            direction: DVec3::new(-0.45, 0.8, -0.4),
            up: DVec3::Z,
            field_of_view: 25_f64.to_radians(),
        }
    }
}

/// Axes of a camera: orthogonal unit vectors.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Axes {
    /// To the right in the picture.
    pub right: DVec3,
    /// Up in the picture.
    pub up: DVec3,
    /// Into the picture.
    pub forward: DVec3,
}

impl Axes {
    fn new(direction: DVec3, up: DVec3) -> Option<Self> {
        let forward = direction.try_normalize()?;
        // A view along `up` within 1e-6 rad does not define the right.
        let right = forward.cross(up.try_normalize()?);
        let right = (right.length() > 1e-6).then(|| right.normalize())?;
        Some(Self {
            right,
            up: right.cross(forward),
            forward,
        })
    }
}

impl Camera {
    /// Its axes.
    pub(super) fn axes(&self) -> Result<Axes> {
        check_angle(self.field_of_view)?;
        let axes = Axes::new(self.to - self.from, self.up);
        axes.filter(|_| self.from.is_finite() && self.to.is_finite())
            .ok_or_else(|| {
                let message = format!(
                    "from {} to {}, up {}: give two distinct points and an up that is not parallel \
                     to the line between them",
                    self.from, self.to, self.up
                );
                Error::argument("camera", message)
            })
    }

    /// Distance of the target, m.
    pub fn distance(&self) -> f64 {
        (self.to - self.from).length()
    }

    /// Pixels per metre at the distance of the target, in a view `height` pixels high.
    pub fn pixels_per_metre(&self, height: f64) -> f64 {
        0.5 * height / (self.distance() * (0.5 * self.field_of_view).tan())
    }
}

impl Look {
    /// The nearest camera whose view of `aspect` (width over height) holds all balls (centre and
    /// radius, m) with a `margin` (part of the view) around them; the ball of one metre around
    /// the origin if there are none.
    pub(super) fn framing(
        &self,
        balls: impl Iterator<Item = (DVec3, f64)>,
        aspect: f64,
        margin: f64,
    ) -> Result<Camera> {
        check_angle(self.field_of_view)?;
        let Some(axes) = Axes::new(self.direction, self.up) else {
            let message = format!(
                "direction {}, up {}: give two directions that are not parallel",
                self.direction, self.up
            );
            return Err(Error::argument("look", message));
        };
        // A ball (x, y, z; r) in the camera's axes is left of the right edge plane through the eye e
        // if (x − e_x) cos θ + r ≤ (z − e_z) sin θ, where θ is half of the view's angle, and likewise
        // for the other edges. Each pair of opposite edges bounds e_z from above, and gives the
        // position of e between them at that bound.
        let tangent = (0.5 * self.field_of_view).tan() * (1.0 - margin);
        let planes = [tangent * aspect, tangent].map(|tangent| tangent.atan().sin_cos());
        let mut extremes = [[f64::NEG_INFINITY; 2]; 2];
        let mut depths = [f64::INFINITY, f64::NEG_INFINITY];
        // Relative to the bodies rather than the origin, so that distant ones keep their digits.
        let mut balls = balls.peekable();
        let (origin, first) = balls.peek().copied().unwrap_or((DVec3::ZERO, 1.0));
        for (centre, radius) in balls.chain([(origin, first)]) {
            let offset = centre - origin;
            let z = axes.forward.dot(offset);
            depths = [depths[0].min(z - radius), depths[1].max(z + radius)];
            let across = [axes.right.dot(offset), axes.up.dot(offset)];
            for (pair, ((sin, cos), side)) in extremes.iter_mut().zip(planes.iter().zip(across)) {
                pair[0] = pair[0].max(side * cos - z * sin + radius);
                pair[1] = pair[1].max(-side * cos - z * sin + radius);
            }
        }
        let nearest = |[a, b]: [f64; 2], (sin, _): (f64, f64)| -0.5 * (a + b) / sin;
        let middle = |[a, b]: [f64; 2], (_, cos): (f64, f64)| 0.5 * (a - b) / cos;
        let size = depths[1] - depths[0];
        // In front of all bodies, also if the edges alone would let the eye into them.
        let z = nearest(extremes[0], planes[0])
            .min(nearest(extremes[1], planes[1]))
            .min(depths[0] - 0.05 * size);
        let x = middle(extremes[0], planes[0]);
        let y = middle(extremes[1], planes[1]);
        let from = origin + x * axes.right + y * axes.up + z * axes.forward;
        let distance = (0.5 * (depths[0] + depths[1]) - z).max(f64::MIN_POSITIVE);
        Ok(Camera {
            from,
            to: from + distance * axes.forward,
            up: self.up,
            field_of_view: self.field_of_view,
        })
    }
}

fn check_angle(field_of_view: f64) -> Result<()> {
    if field_of_view > 0.0 && field_of_view < 0.95 * std::f64::consts::PI {
        return Ok(());
    }
    let message = format!("is {field_of_view} rad; give an angle between 0 and 0.95 π");
    Err(Error::argument("field_of_view", message))
}
