//! An axis: a range, its ticks at 1-2-5 steps, and where a value lies on the picture.

use crate::words::number::{self, magnitude};

/// Scale of an axis.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum AxisScale {
    /// Equal steps.
    Linear,
    /// Equal steps, ticks at whole numbers alone.
    Whole,
    /// Equal ratios.
    Log,
}

/// A range of values, laid out from pixel `start` to pixel `end`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct ChartAxis {
    pub(super) low: f64,
    pub(super) high: f64,
    scale: AxisScale,
    start: f64,
    end: f64,
}

impl ChartAxis {
    /// An axis of exactly this range; an empty or unusable one is widened until it has a length.
    pub(super) fn new(low: f64, high: f64, scale: AxisScale) -> Self {
        let (low, high) = if low.is_finite() && high.is_finite() {
            (low, high)
        } else {
            (0.0, 1.0)
        };
        let (low, high) = if scale == AxisScale::Log && low <= 0.0 {
            (high.abs() * 1e-3, high.abs())
        } else {
            (low, high)
        };
        let least = 1e-9 * low.abs().max(high.abs());
        let (low, high) = match scale {
            _ if high - low > least => (low, high),
            AxisScale::Log if low > 0.0 => (0.5 * low, 2.0 * low),
            AxisScale::Log => (0.1, 1.0),
            _ => (low - 0.05 * low.abs().max(1e-9), low + 0.05 * low.abs().max(1e-9)),
        };
        ChartAxis {
            low,
            high,
            scale,
            start: 0.0,
            end: 1.0,
        }
    }

    /// An axis around all finite values, with a margin on both sides as a share of the range.
    pub(super) fn around(values: impl IntoIterator<Item = f64>, margin: f64, scale: AxisScale) -> Self {
        let usable = |v: &f64| v.is_finite() && (scale != AxisScale::Log || *v > 0.0);
        let (low, high) = values
            .into_iter()
            .filter(usable)
            .fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), v| {
                (low.min(v), high.max(v))
            });
        let axis = ChartAxis::new(low, high, scale);
        let pad = margin * (axis.forward(axis.high) - axis.forward(axis.low));
        let (low, high) = (axis.forward(axis.low) - pad, axis.forward(axis.high) + pad);
        ChartAxis {
            low: axis.backward(low),
            high: axis.backward(high),
            ..axis
        }
    }

    /// The same axis on other pixels.
    pub(super) fn on(self, start: f64, end: f64) -> Self {
        ChartAxis { start, end, ..self }
    }

    /// Pixel of a value; a value outside the range lies on the nearer end.
    pub(super) fn at(self, value: f64) -> f64 {
        let (low, high) = (self.forward(self.low), self.forward(self.high));
        let share = (self.forward(value.max(self.low).min(self.high)) - low) / (high - low);
        self.start + share * (self.end - self.start)
    }

    /// Value at a share of the range, as the axis lays it out.
    pub(super) fn value(self, share: f64) -> f64 {
        let (low, high) = (self.forward(self.low), self.forward(self.high));
        self.backward(low + share * (high - low))
    }

    /// Whether a value lies within the range.
    pub(super) fn holds(self, value: f64) -> bool {
        (self.low..=self.high).contains(&value)
    }

    /// Whether the axis shows equal ratios.
    pub(super) fn is_log(self) -> bool {
        self.scale == AxisScale::Log
    }

    /// About so many ticks with their labels; none for 0.
    pub(super) fn ticks(self, about: usize) -> Vec<(f64, String)> {
        match self.scale {
            _ if about == 0 => Vec::new(),
            AxisScale::Log => self.log_ticks(about),
            _ => self.linear_ticks(about),
        }
    }

    fn linear_ticks(self, about: usize) -> Vec<(f64, String)> {
        let mut step = nice_step((self.high - self.low) / about as f64);
        if self.scale == AxisScale::Whole {
            step = step.max(1.0);
        }
        let decimals = -magnitude(step * 1.000_001);
        let first = (self.low / step - 1e-9).ceil() as i64;
        let last = (self.high / step + 1e-9).floor() as i64;
        let large = self.low.abs().max(self.high.abs()) >= 1e5 || decimals > 4;
        let label = |v: f64| {
            if large {
                exponential(v, step)
            } else {
                number::fixed(v, decimals)
            }
        };
        (first..=last)
            .map(|k| k as f64 * step)
            .map(|v| (v, minus(&label(v))))
            .collect()
    }

    fn log_ticks(self, about: usize) -> Vec<(f64, String)> {
        let (first, last) = (magnitude(self.low), magnitude(self.high) + 1);
        let decades = (self.high / self.low).log10();
        let every = (decades / about as f64).ceil().max(1.0) as i32;
        let parts: &[f64] = if decades < 2.5 { &[1.0, 2.0, 5.0] } else { &[1.0] };
        let label = |v: f64, k: i32| {
            if (-3..=4).contains(&k) {
                number::fixed(v, -k)
            } else {
                format!("{}e{k}", number::fixed(v / power(k), 0))
            }
        };
        (first..=last)
            .filter(|k| k.rem_euclid(every) == 0)
            .flat_map(|k| parts.iter().map(move |part| (part * power(k), k)))
            .filter(|(v, _)| self.holds(*v))
            .map(|(v, k)| (v, minus(&label(v, k))))
            .collect()
    }

    fn forward(self, value: f64) -> f64 {
        if self.scale == AxisScale::Log {
            value.ln()
        } else {
            value
        }
    }

    fn backward(self, u: f64) -> f64 {
        if self.scale == AxisScale::Log { u.exp() } else { u }
    }
}

/// The nearest, as ratios go, of 1, 2, 5, 10 times a power of ten.
fn nice_step(rough: f64) -> f64 {
    let unit = power(magnitude(rough));
    let ends = [
        (1.0, std::f64::consts::SQRT_2),
        (2.0, 10f64.sqrt()),
        (5.0, 50f64.sqrt()),
    ];
    let factor = ends
        .into_iter()
        .find(|(_, end)| rough < end * unit)
        .map_or(10.0, |(factor, _)| factor);
    factor * unit
}

fn power(k: i32) -> f64 {
    10f64.powi(k)
}

/// A label with an exponent and the digits that tell neighbours apart.
fn exponential(v: f64, step: f64) -> String {
    if v.abs() < 0.5 * step {
        return "0".into();
    }
    let digits = (magnitude(v * 1.000_001) - magnitude(step * 1.000_001)).max(0) as usize;
    format!("{v:.digits$e}")
}

/// The typographic minus sign.
fn minus(text: &str) -> String {
    text.replace('-', "\u{2212}")
}

#[cfg(test)]
mod tests {
    use super::*;

    fn labels(low: f64, high: f64, scale: AxisScale) -> Vec<String> {
        ChartAxis::new(low, high, scale)
            .ticks(5)
            .into_iter()
            .map(|t| t.1)
            .collect()
    }

    #[test]
    fn linear_ticks_step_by_one_two_or_five() {
        assert_eq!(
            labels(0.0, 1.0, AxisScale::Linear),
            ["0.0", "0.2", "0.4", "0.6", "0.8", "1.0"]
        );
        assert_eq!(
            labels(-27.0, 12.0, AxisScale::Linear),
            ["\u{2212}20", "\u{2212}10", "0", "10"]
        );
        assert_eq!(
            labels(20.0, 32.0, AxisScale::Linear),
            ["20", "22", "24", "26", "28", "30", "32"]
        );
        assert_eq!(
            labels(0.0575, 0.0623, AxisScale::Linear),
            ["0.058", "0.059", "0.060", "0.061", "0.062"]
        );
        assert_eq!(
            labels(0.0, 2.1e6, AxisScale::Linear),
            ["0", "5e5", "1.0e6", "1.5e6", "2.0e6"]
        );
    }

    #[test]
    fn whole_and_log_ticks() {
        assert_eq!(labels(1.0, 3.0, AxisScale::Whole), ["1", "2", "3"]);
        assert_eq!(
            labels(1e-4, 1.0, AxisScale::Log),
            ["1e\u{2212}4", "0.001", "0.01", "0.1", "1"]
        );
        assert_eq!(labels(0.8, 12.0, AxisScale::Log), ["1", "2", "5", "10"]);
    }

    #[test]
    fn every_range_has_a_length_and_every_value_a_finite_place() {
        for (low, high) in [
            (0.0, 0.0),
            (3.0, 3.0),
            (f64::NAN, 1.0),
            (f64::INFINITY, f64::NEG_INFINITY),
            (-2.0, -2.0),
        ] {
            for scale in [AxisScale::Linear, AxisScale::Whole, AxisScale::Log] {
                let axis = ChartAxis::new(low, high, scale).on(0.0, 100.0);
                assert!(axis.high > axis.low, "{low} {high} {scale:?}");
                for value in [low, high, -1.0, 0.0, 1e9] {
                    assert!(axis.at(value).is_finite(), "{low} {high} {scale:?} {value}");
                }
            }
        }
    }

    #[test]
    fn values_outside_lie_on_the_edge() {
        let axis = ChartAxis::new(0.0, 10.0, AxisScale::Linear).on(100.0, 0.0);
        let pixels = [-5.0, 2.5, 20.0].map(|v| axis.at(v).round() as i32);
        assert_eq!(pixels, [100, 75, 0]);
    }
}
