//! Axes and the six faces of the domain.

use glam::DVec3;
use schemars::JsonSchema;
use serde::Deserialize;

/// A coordinate axis.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Axis {
    /// Along x.
    X,
    /// Along y.
    Y,
    /// Along z.
    Z,
}

impl Axis {
    /// All axes, in order.
    pub const ALL: [Self; 3] = [Self::X, Self::Y, Self::Z];

    /// 0, 1 or 2.
    pub fn index(self) -> usize {
        self as usize
    }

    /// The two other axes, the lower one first.
    pub fn others(self) -> [Self; 2] {
        match self {
            Self::X => [Self::Y, Self::Z],
            Self::Y => [Self::X, Self::Z],
            Self::Z => [Self::X, Self::Y],
        }
    }

    /// `x`, `y` or `z`.
    pub fn name(self) -> &'static str {
        ["x", "y", "z"][self.index()]
    }
}

/// One of the six directions along the axes.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Deserialize, JsonSchema)]
pub enum Direction {
    /// Towards smaller x.
    #[serde(rename = "-x")]
    MinusX,
    /// Towards larger x.
    #[serde(rename = "+x")]
    PlusX,
    /// Towards smaller y.
    #[serde(rename = "-y")]
    MinusY,
    /// Towards larger y.
    #[serde(rename = "+y")]
    PlusY,
    /// Towards smaller z.
    #[serde(rename = "-z")]
    MinusZ,
    /// Towards larger z.
    #[serde(rename = "+z")]
    PlusZ,
}

impl Direction {
    /// The axis along which it points.
    pub fn axis(self) -> Axis {
        Axis::ALL[self as usize / 2]
    }

    /// Its name in a scene: `-x`, `+x`, ….
    pub fn name(self) -> &'static str {
        ["-x", "+x", "-y", "+y", "-z", "+z"][self as usize]
    }

    /// Unit vector.
    pub fn vector(self) -> DVec3 {
        DVec3::AXES[self.axis().index()] * f64::from(self.sign())
    }

    /// −1 or 1 along [`Self::axis`].
    pub fn sign(self) -> i32 {
        if (self as usize).is_multiple_of(2) {
            -1
        } else {
            1
        }
    }
}

/// A face of the domain.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Face {
    /// The face at the smallest x.
    XMin,
    /// The face at the largest x.
    XMax,
    /// The face at the smallest y.
    YMin,
    /// The face at the largest y.
    YMax,
    /// The face at the smallest z.
    ZMin,
    /// The face at the largest z.
    ZMax,
}

impl Face {
    /// All faces: x_min, x_max, y_min, y_max, z_min, z_max.
    pub const ALL: [Self; 6] = [
        Self::XMin,
        Self::XMax,
        Self::YMin,
        Self::YMax,
        Self::ZMin,
        Self::ZMax,
    ];

    /// The axis to which the face is normal.
    pub fn axis(self) -> Axis {
        Axis::ALL[self as usize / 2]
    }

    /// Whether it lies at the upper end of its axis.
    pub fn is_max(self) -> bool {
        !(self as usize).is_multiple_of(2)
    }

    /// −1 or 1: the outward normal along [`Self::axis`].
    pub fn outward(self) -> f64 {
        if self.is_max() { 1.0 } else { -1.0 }
    }

    /// The face at the other end of the axis.
    pub fn opposite(self) -> Self {
        Self::ALL[self as usize ^ 1]
    }

    /// Its key in a scene: `x_min`, ….
    pub fn name(self) -> &'static str {
        ["x_min", "x_max", "y_min", "y_max", "z_min", "z_max"][self as usize]
    }
}
