//! A quantity along an edge of a plot: range, ticks and their labels.

/// How values map to lengths along an axis.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Scale {
    /// Equal differences have equal lengths.
    #[default]
    Linear,
    /// Equal ratios have equal lengths; for positive values.
    Logarithmic,
}

/// An axis with its quantity.
#[derive(Clone, Debug, PartialEq)]
pub struct Axis {
    quantity: String,
    unit: String,
    range: [f64; 2],
    scale: Scale,
    /// Labels show values divided by 10 to this power.
    exponent: i32,
}

/// A tick's value, and the text beside it.
pub type Tick = (f64, String);

impl Axis {
    /// An axis from `range[0]` to `range[1]`, both in `unit` (empty for a pure number).
    pub fn new(quantity: &str, unit: &str, range: [f64; 2], scale: Scale) -> Self {
        let largest = range[0].abs().max(range[1].abs());
        // Up to four digits before the decimal point, or two after it, are readable without a factor.
        let plain = largest == 0.0 || (1e-2..1e4).contains(&largest);
        let exponent = if plain || scale == Scale::Logarithmic {
            0
        } else {
            3 * (largest.log10() / 3.0).floor() as i32
        };
        Self {
            quantity: quantity.to_owned(),
            unit: unit.to_owned(),
            range,
            scale,
            exponent,
        }
    }

    /// An axis that holds all `values`, with a small margin; values that are not finite, or not positive on a logarithmic
    /// scale, are ignored.
    pub fn around(
        quantity: &str,
        unit: &str,
        values: impl IntoIterator<Item = f64>,
        scale: Scale,
    ) -> Self {
        let [low, high] = extremes(values.into_iter().filter(|value| scale.holds(*value)));
        let range = match scale {
            Scale::Linear => {
                let room = 0.05 * (high - low);
                [low - room, high + room]
            }
            Scale::Logarithmic if low > 0.0 => {
                let room = (high / low).powf(0.05).max(1.25);
                [low / room, high * room]
            }
            Scale::Logarithmic => [1.0, 10.0],
        };
        Self::new(quantity, unit, range, scale)
    }

    /// Position of `value`: 0 at the start of the axis, 1 at its end.
    pub fn fraction(&self, value: f64) -> f64 {
        let [low, high] = self.range.map(|end| self.scale.stretch(end));
        (self.scale.stretch(value) - low) / (high - low)
    }

    /// The value at `fraction` of a linear axis.
    pub fn value(&self, fraction: f64) -> f64 {
        self.range[0] + fraction * (self.range[1] - self.range[0])
    }

    /// Whether `value` can be drawn on this axis's scale.
    pub fn holds(&self, value: f64) -> bool {
        self.scale.holds(value)
    }

    /// The quantity with its unit, and the power of ten by which to multiply the labels.
    pub fn title(&self) -> String {
        let factor = match self.exponent {
            0 => String::new(),
            exponent => power_of_ten(exponent),
        };
        let unit = [factor.as_str(), self.unit.as_str()]
            .into_iter()
            .filter(|part| !part.is_empty())
            .collect::<Vec<_>>()
            .join(" ");
        if unit.is_empty() {
            self.quantity.clone()
        } else {
            format!("{} ({unit})", self.quantity)
        }
    }

    /// About `most` ticks at round values, never more.
    pub fn ticks(&self, most: usize) -> Vec<Tick> {
        match self.scale {
            Scale::Linear => self.linear_ticks(most),
            Scale::Logarithmic => self.logarithmic_ticks(most),
        }
    }

    fn linear_ticks(&self, most: usize) -> Vec<Tick> {
        let unit = 10_f64.powi(self.exponent);
        let [low, high] = self.range.map(|end| end / unit);
        let decade = ((high - low) / most.max(1) as f64).log10().floor() as i32;
        // The finest step with few enough ticks; the last candidate is ten times the required one.
        let powers = decade..=decade + 2;
        for (power, lead) in powers.flat_map(|power| [1.0, 2.0, 5.0].map(|lead| (power, lead))) {
            let step = lead * 10_f64.powi(power);
            // Rounding must not remove a tick at an end.
            let begin = (low / step - 1e-6).ceil() as i64;
            let end = (high / step + 1e-6).floor() as i64;
            if end - begin < most.max(1) as i64 {
                let decimals = (-power).max(0) as usize;
                return (begin..=end)
                    .map(|count| {
                        let value = count as f64 * step;
                        (value * unit, minus(&format!("{value:.decimals$}")))
                    })
                    .collect();
            }
        }
        Vec::new()
    }

    fn logarithmic_ticks(&self, most: usize) -> Vec<Tick> {
        let [low, high] = self.range.map(f64::log10);
        let begin = (low - 1e-6).ceil() as i32;
        let end = (high + 1e-6).floor() as i32;
        let decades = (end - begin + 1).max(0) as usize;
        if decades >= 2 {
            let stride = decades.div_ceil(most.max(1));
            return (begin..=end)
                .step_by(stride)
                .map(|power| (10_f64.powi(power), power_of_ten(power)))
                .collect();
        }
        // Within one decade, powers of ten alone are too few ticks.
        (begin - 1..=end)
            .flat_map(|power| [1.0, 2.0, 5.0].map(|lead| (lead, power)))
            .filter_map(|(lead, power)| {
                let value = lead * 10_f64.powi(power);
                let label = match power {
                    -3..=3 => format!("{value:.0$}", (-power).max(0) as usize),
                    _ => format!("{lead:.0}·{}", power_of_ten(power)),
                };
                (self.range[0]..=self.range[1])
                    .contains(&value)
                    .then_some((value, label))
            })
            .collect()
    }
}

impl Scale {
    fn stretch(self, value: f64) -> f64 {
        match self {
            Scale::Linear => value,
            Scale::Logarithmic => value.log10(),
        }
    }

    fn holds(self, value: f64) -> bool {
        value.is_finite() && (self == Scale::Linear || value > 0.0)
    }
}

/// Smallest and largest of `values`, widened if they are equal; 0 to 1 if there are none.
pub fn extremes(values: impl Iterator<Item = f64>) -> [f64; 2] {
    let [low, high] = values
        .filter(|value| value.is_finite())
        .fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], value| {
            [low.min(value), high.max(value)]
        });
    // Fields are f32: a smaller span is rounding.
    let noise = f64::from(f32::EPSILON) * low.abs().max(high.abs());
    if low > high {
        [0.0, 1.0]
    } else if high == 0.0 && low == 0.0 {
        [-1.0, 1.0]
    } else if high - low <= noise {
        let half = 0.1 * low.abs().max(high.abs());
        [low - half, high + half]
    } else {
        [low, high]
    }
}

/// 10 to `exponent`, as it is printed.
fn power_of_ten(exponent: i32) -> String {
    let raised = |digit: char| match digit {
        '-' => '⁻',
        '1' => '¹',
        '2' => '²',
        '3' => '³',
        '0' | '4'..='9' => char::from_u32(digit as u32 - '0' as u32 + '⁰' as u32).unwrap_or(digit),
        other => other,
    };
    format!(
        "10{}",
        exponent.to_string().chars().map(raised).collect::<String>()
    )
}

/// `number` with a minus sign as wide as a plus, and none before zero.
fn minus(number: &str) -> String {
    match number.strip_prefix('-') {
        Some(rest) if rest.chars().all(|digit| matches!(digit, '0' | '.')) => rest.to_owned(),
        Some(rest) => format!("−{rest}"),
        None => number.to_owned(),
    }
}
