//! A target of the project beside its measured value.

use std::fmt;

use super::rate::{Rate, mean, median};

/// One line of the table.
#[derive(Debug, Clone)]
pub struct Target {
    pub what: &'static str,
    pub measured: f64,
    /// Its 95 % interval, or its spread.
    shown: String,
    floor: f64,
    aim: f64,
    /// Whether less is better.
    is_least: bool,
}

impl Target {
    /// A share with Wilson's interval; `None` of nothing.
    pub fn rate(what: &'static str, rate: Rate, [floor, aim]: [f64; 2]) -> Option<Self> {
        let [low, high] = rate.interval();
        (rate.of > 0).then(|| Self {
            what,
            measured: rate.share(),
            shown: format!("{} of {}, {low:.3} to {high:.3}", rate.count, rate.of),
            floor,
            aim,
            is_least: false,
        })
    }

    /// A target that is the better the smaller.
    pub fn least(self) -> Self {
        Self {
            is_least: true,
            ..self
        }
    }

    /// A mean with its standard error; `None` of nothing. Less is better.
    pub fn mean(what: &'static str, values: &[f64], [floor, aim]: [f64; 2]) -> Option<Self> {
        let [average, error] = mean(values);
        let most = values.iter().copied().fold(0.0, f64::max);
        (!values.is_empty()).then(|| Self {
            what,
            measured: average,
            shown: format!("± {error:.3}, median {:.3}, most {most:.2}", median(values)),
            floor,
            aim,
            is_least: true,
        })
    }

    /// Ratio of sums, robust against a few extreme ratios; `None` of nothing. Less is better.
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
            is_least: true,
        })
    }

    /// Whether the floor is reached.
    pub fn holds(&self) -> bool {
        self.reaches(self.floor)
    }

    fn reaches(&self, goal: f64) -> bool {
        if self.is_least {
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
