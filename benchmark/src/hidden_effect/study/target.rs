//! A target of the project beside its measured value.

use std::fmt;

use super::rate::{Rate, mean, median};

/// One line of the table.
#[derive(Debug, Clone)]
pub struct Target {
    pub what: &'static str,
    pub measured: f64,
    /// The 95 % interval or the spread of the measured value.
    shown: String,
    floor: f64,
    aim: f64,
    /// Whether smaller values are better.
    is_bounded_above: bool,
}

impl Target {
    /// Returns a share with Wilson's interval; `None` without a case.
    pub fn rate(what: &'static str, rate: Rate, [floor, aim]: [f64; 2]) -> Option<Self> {
        let [low, high] = rate.interval();
        (rate.total > 0).then(|| Self {
            what,
            measured: rate.share(),
            shown: format!("{} of {}, {low:.3} to {high:.3}", rate.count, rate.total),
            floor,
            aim,
            is_bounded_above: false,
        })
    }

    /// Returns the same target, of which smaller values are better.
    pub fn least(self) -> Self {
        Self {
            is_bounded_above: true,
            ..self
        }
    }

    /// Returns a mean with its standard error, of which smaller values are better; `None` without a value.
    pub fn mean(what: &'static str, values: &[f64], [floor, aim]: [f64; 2]) -> Option<Self> {
        let [average, error] = mean(values);
        let max = values.iter().copied().fold(0.0, f64::max);
        (!values.is_empty()).then(|| Self {
            what,
            measured: average,
            shown: format!("± {error:.3}, median {:.3}, most {max:.2}", median(values)),
            floor,
            aim,
            is_bounded_above: true,
        })
    }

    /// Returns a ratio of sums, which is robust against a few extreme ratios and of which smaller values are better; `None` without a
    /// pair.
    pub fn ratio(what: &'static str, pairs: &[[f64; 2]], [floor, aim]: [f64; 2]) -> Option<Self> {
        let sum = |k: usize| pairs.iter().map(|pair| pair[k]).sum::<f64>();
        let ratios: Vec<f64> = pairs.iter().map(|[after, before]| after / before).collect();
        (!pairs.is_empty()).then(|| Self {
            what,
            measured: sum(0) / sum(1),
            shown: format!(
                "of sums over {}; median ratio {:.3}",
                pairs.len(),
                median(&ratios)
            ),
            floor,
            aim,
            is_bounded_above: true,
        })
    }

    /// Returns whether the floor is reached.
    pub fn holds(&self) -> bool {
        self.reaches(self.floor)
    }

    fn reaches(&self, goal: f64) -> bool {
        if self.is_bounded_above {
            self.measured <= goal
        } else {
            self.measured >= goal
        }
    }
}

impl fmt::Display for Target {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let reached = match (self.reaches(self.aim), self.holds()) {
            (true, _) => "aim",
            (false, true) => "floor",
            (false, false) => "SHORT",
        };
        write!(
            f,
            "{:<44} {:>8.3}  {:<40} {:>7} {:>7}  {reached}",
            self.what, self.measured, self.shown, self.floor, self.aim
        )
    }
}
