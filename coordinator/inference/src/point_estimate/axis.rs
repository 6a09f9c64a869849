//! An axis: one parameter in units of its prior's width.

use statistics::prior::Marginal;

/// One parameter of the model, with t = u / width; u is the sampling coordinate of its marginal.
#[derive(Debug, Clone)]
pub(crate) struct PriorAxis {
    pub(crate) parameter: usize,
    pub(crate) lower: f64,
    pub(crate) upper: f64,
    marginal: Marginal,
    width: f64,
}

impl PriorAxis {
    pub(crate) fn new(parameter: usize, marginal: &Marginal) -> Self {
        let width = marginal.width();
        let (lower, upper) = marginal.support();
        Self {
            parameter,
            lower: marginal.coordinate(lower) / width,
            upper: marginal.coordinate(upper) / width,
            marginal: marginal.clone(),
            width,
        }
    }

    /// Returns t of a parameter; exact at a bound.
    pub(crate) fn position(&self, x: f64) -> f64 {
        let t = self.marginal.coordinate(x) / self.width;
        t.max(self.lower).min(self.upper)
    }

    /// Returns the parameter at t; exact at a bound.
    pub(crate) fn value(&self, t: f64) -> f64 {
        let (lower, upper) = self.marginal.support();
        if t <= self.lower {
            lower
        } else if t >= self.upper {
            upper
        } else {
            self.marginal.inside(t * self.width)
        }
    }

    /// Returns whether t lies at a bound.
    pub(crate) fn is_bound(&self, t: f64) -> bool {
        t <= self.lower || t >= self.upper
    }

    /// Returns the slope and curvature of -ln p(x) along t.
    pub(crate) fn slope(&self, t: f64) -> (f64, f64) {
        let (slope, curvature) = self.marginal.slope(t * self.width);
        (slope * self.width, curvature * self.width * self.width)
    }

    /// Returns dx/dt at t.
    pub(crate) fn rate(&self, t: f64) -> f64 {
        self.marginal.rate(self.value(t)) * self.width
    }
}
