//! The prior of one parameter: a truncated distribution, and the coordinate in which the sampler moves.

use super::bound::at_bound;
use super::density::{Density, SamplingCoordinate, window};
use super::distribution::{Distribution, ordered};
use super::error::PriorError;
use super::moments;
use super::normal;
use crate::rng::Stream;

/// The prior of one parameter: a distribution, truncated to its bounds and renormalised.
#[derive(Debug, Clone, PartialEq)]
pub struct Marginal {
    distribution: Distribution,
    /// Support of x, from `lower` to `upper`.
    lower: f64,
    upper: f64,
    coordinate: SamplingCoordinate,
    density: Density,
    mean: f64,
    sd: f64,
}

impl Marginal {
    /// Creates a distribution, truncated to `bounds` and renormalised.
    ///
    /// # Errors
    /// [`PriorError`] names the number, its value and its bound: ends out of order, sd or scale <= 0, factor <= 1, a number
    /// that is not finite, bounds outside the support or without probability. Nothing is adjusted.
    pub fn new(distribution: Distribution, bounds: Option<[f64; 2]>) -> Result<Self, PriorError> {
        distribution.check()?;
        let (mut lower, mut upper) = distribution.support();
        if let Some([low, high]) = bounds {
            ordered(low, high)?;
            if low < lower || high > upper {
                let (support_lower, support_upper) = (lower, upper);
                return Err(PriorError::OutsideSupport {
                    lower: low,
                    upper: high,
                    support_lower,
                    support_upper,
                });
            }
            (lower, upper) = (low, high);
        }
        let coordinate = match distribution {
            Distribution::Loguniform { .. } | Distribution::Lognormal { .. } => SamplingCoordinate::Log,
            _ => SamplingCoordinate::Identity,
        };
        let (low, high) = (coordinate.transform(lower), coordinate.transform(upper));
        let gaussian = |mean: f64, sd: f64| {
            let (low, high) = ((low - mean) / sd, (high - mean) / sd);
            Density::Normal {
                mean,
                sd,
                low,
                high,
                mass: normal::mass(low, high),
            }
        };
        let density = match distribution {
            Distribution::Uniform { .. } | Distribution::Loguniform { .. } => Density::Uniform {
                lower: low,
                width: high - low,
            },
            Distribution::Normal { mean, sd } => gaussian(mean, sd),
            Distribution::Lognormal { median, factor } => gaussian(libm::log(median), libm::log(factor)),
            Distribution::HalfNormal { scale } => gaussian(0.0, scale),
        };
        let has_mass = match density {
            Density::Uniform { width, .. } => width > 0.0,
            // Beyond 37 standard deviations the tail of the normal density is a subnormal number.
            Density::Normal { mass, .. } => mass >= f64::MIN_POSITIVE,
        };
        if !has_mass {
            return Err(PriorError::NoMass { lower, upper });
        }
        let mut marginal = Self {
            distribution,
            lower,
            upper,
            coordinate,
            density,
            mean: 0.0,
            sd: 0.0,
        };
        (marginal.mean, marginal.sd) = marginal.moments();
        for (name, value) in [("prior mean", marginal.mean), ("prior sd", marginal.sd)] {
            if !value.is_finite() {
                return Err(PriorError::NotFinite { name, value });
            }
        }
        Ok(marginal)
    }

    /// Returns the distribution before truncation.
    #[must_use]
    pub fn distribution(&self) -> Distribution {
        self.distribution
    }

    /// Returns the interval outside which the density is zero; ends may be infinite.
    #[must_use]
    pub fn support(&self) -> (f64, f64) {
        (self.lower, self.upper)
    }

    /// Returns the mean of the truncated distribution.
    #[must_use]
    pub fn mean(&self) -> f64 {
        self.mean
    }

    /// Returns the standard deviation of the truncated distribution.
    #[must_use]
    pub fn sd(&self) -> f64 {
        self.sd
    }

    /// Returns ln p(x); minus infinity outside the support.
    #[must_use]
    pub fn log_density(&self, x: f64) -> f64 {
        if !(self.lower <= x && x <= self.upper) || (self.coordinate == SamplingCoordinate::Log && x <= 0.0) {
            return f64::NEG_INFINITY;
        }
        let u = self.coordinate.transform(x);
        let jacobian = if self.coordinate == SamplingCoordinate::Log {
            -u
        } else {
            0.0
        };
        self.density.log_at(u) + jacobian
    }

    /// Returns the quantile x of probability `p`; the ends of the support for `p` <= 0 and >= 1.
    #[must_use]
    pub fn quantile(&self, p: f64) -> f64 {
        if p >= 1.0 {
            self.upper
        } else if p > 0.0 {
            // Rounding of exp(ln x) may exceed an end by one unit in the last place.
            self.inside(self.density.quantile(p))
        } else {
            self.lower
        }
    }

    /// Returns the share of the probability below x; 0 and 1 outside the support.
    #[must_use]
    pub fn cumulative(&self, x: f64) -> f64 {
        self.tails(x)[0]
    }

    /// Returns the normal score of x: `Phi^-1(P(X < x))`.
    ///
    /// Scores of draws from this distribution are standard normal. An x on an end of the support, or outside, has the score of the
    /// smallest representable probability, +-37.5. Checked by `priors::scores_are_normal_quantiles`.
    #[must_use]
    pub fn normal_score(&self, x: f64) -> f64 {
        let [below, above] = self.tails(x).map(|p| p.max(f64::MIN_POSITIVE));
        if below < above {
            normal::lower_quantile(below)
        } else {
            -normal::lower_quantile(above)
        }
    }

    /// Returns the value of a normal score, the inverse of [`Marginal::normal_score`], from the nearer tail.
    ///
    /// Checked by `frame::tests::scores_lead_back_to_where_they_came_from`.
    #[must_use]
    pub fn from_normal_score(&self, z: f64) -> f64 {
        let tail = normal::cdf(-z.abs());
        if tail > 0.0 {
            self.inside(self.density.tail_quantile(tail, z > 0.0))
        } else if z > 0.0 {
            self.upper
        } else {
            self.lower
        }
    }

    /// Returns the mean and standard deviation of the sampling coordinate.
    #[must_use]
    pub fn coordinate_moments(&self) -> (f64, f64) {
        match self.density {
            Density::Uniform { lower, width } => (lower + 0.5 * width, width / 12.0_f64.sqrt()),
            Density::Normal {
                mean, sd, low, high, ..
            } => {
                let (from, to) = window(low, high, 0.0);
                let peak = 0.0_f64.max(low).min(high);
                let log_density = |z: f64| 0.5 * (peak - z) * (peak + z);
                moments::mean_and_sd(from, to, log_density, |z| mean + sd * z)
            }
        }
    }

    /// Returns the probabilities below and above x, each to full relative accuracy.
    pub fn tails(&self, x: f64) -> [f64; 2] {
        if x <= self.lower {
            [0.0, 1.0]
        } else if x >= self.upper {
            [1.0, 0.0]
        } else {
            self.density.tails(self.coordinate.transform(x))
        }
    }

    /// Draws one value, by inversion.
    pub fn sample(&self, stream: &mut Stream) -> f64 {
        self.quantile(stream.uniform())
    }

    /// Returns the sampling coordinate of x: ln x for lognormal and log-uniform marginals, else x.
    #[must_use]
    pub fn coordinate(&self, x: f64) -> f64 {
        self.coordinate.transform(x)
    }

    /// Returns whether an interval from `q05` to `q95` touches a bound: nearer than 2 % of the range, in the sampling coordinate.
    /// False if the range is not finite.
    #[must_use]
    pub fn at_bound(&self, q05: f64, q95: f64) -> bool {
        let u = |x| self.coordinate.transform(x);
        at_bound(u(q05), u(q95), (u(self.lower), u(self.upper)))
    }

    /// Returns the slope and curvature of -ln p(x(u)) along the sampling coordinate u; p is the density of x, not of u.
    ///
    /// In its coordinate every distribution here has a parabolic or linear log-density, so the curvature is constant and
    /// never negative. A log coordinate adds u, because there ln p(x) = ln p(u) - u.
    pub fn slope(&self, u: f64) -> (f64, f64) {
        let jacobian = if self.coordinate == SamplingCoordinate::Log {
            1.0
        } else {
            0.0
        };
        match self.density {
            Density::Uniform { .. } => (jacobian, 0.0),
            Density::Normal { mean, sd, .. } => ((u - mean) / sd / sd + jacobian, 1.0 / sd / sd),
        }
    }

    /// Returns the mean and standard deviation of the sampling coordinate, if it is normal and not truncated.
    pub(super) fn untruncated_normal(&self) -> Option<(f64, f64)> {
        match self.density {
            Density::Normal {
                mean, sd, low, high, ..
            } if low == f64::NEG_INFINITY && high == f64::INFINITY => Some((mean, sd)),
            _ => None,
        }
    }

    /// Returns the width of the sampling coordinate: its standard deviation, or that of a uniform density between the
    /// bounds if they are narrower.
    pub fn width(&self) -> f64 {
        match self.density {
            Density::Uniform { width, .. } => width / 12.0_f64.sqrt(),
            Density::Normal { sd, low, high, .. } => sd * ((high - low) / 12.0_f64.sqrt()).min(1.0),
        }
    }

    /// Returns whether the sampling coordinate is ln x.
    pub fn is_logarithmic(&self) -> bool {
        self.coordinate == SamplingCoordinate::Log
    }

    /// Returns dx/du.
    pub fn rate(&self, x: f64) -> f64 {
        match self.coordinate {
            SamplingCoordinate::Identity => 1.0,
            SamplingCoordinate::Log => x,
        }
    }

    /// Returns x of a sampling coordinate inside the support; rounding cannot exceed an end.
    pub fn inside(&self, u: f64) -> f64 {
        self.coordinate.value(u).max(self.lower).min(self.upper)
    }

    /// Returns x of a sampling coordinate.
    pub fn value(&self, u: f64) -> f64 {
        self.coordinate.value(u)
    }

    /// Returns the log-density of the sampling coordinate; minus infinity if u or its x is outside the support.
    pub(super) fn log_density_of_coordinate(&self, u: f64) -> f64 {
        let x = self.coordinate.value(u);
        if self.lower <= x && x <= self.upper {
            self.density.log_at(u)
        } else {
            f64::NEG_INFINITY
        }
    }

    /// Returns the mean and sd of x by quadrature over the relevant part of the support.
    fn moments(&self) -> (f64, f64) {
        match self.density {
            Density::Uniform { lower, width } => {
                moments::mean_and_sd(lower, lower + width, |_| 0.0, |u| self.coordinate.value(u))
            }
            Density::Normal {
                mean, sd, low, high, ..
            } => {
                // x^2 = exp(2u) moves the peak of the integrand up by twice the variance.
                let shift = if self.coordinate == SamplingCoordinate::Log {
                    2.0 * sd
                } else {
                    0.0
                };
                let (from, to) = (window(low, high, 0.0).0, window(low, high, shift).1);
                let peak = 0.0_f64.max(low).min(high);
                let log_density = |z: f64| 0.5 * (peak - z) * (peak + z);
                moments::mean_and_sd(from, to, log_density, |z| self.coordinate.value(mean + sd * z))
            }
        }
    }
}
