//! Densities and quantiles in the sampling coordinate.

use super::normal::{self, LN_SQRT_TAU};

/// Exponent below the peak at which the moments' integrals are cut: exp(-45) = 3e-20.
const TAIL_NATS: f64 = 45.0;

/// u(x): the coordinate in which the prior is uniform or normal.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum SamplingCoordinate {
    Identity,
    Log,
}

/// The density of u, on the truncated support.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Density {
    Uniform {
        lower: f64,
        width: f64,
    },
    /// `low` and `high` are the standardised ends, `mass` the probability between them.
    Normal {
        mean: f64,
        sd: f64,
        low: f64,
        high: f64,
        mass: f64,
    },
}

impl SamplingCoordinate {
    pub(super) fn transform(self, x: f64) -> f64 {
        match self {
            Self::Identity => x,
            Self::Log => libm::log(x),
        }
    }

    pub(super) fn value(self, u: f64) -> f64 {
        match self {
            Self::Identity => u,
            Self::Log => libm::exp(u),
        }
    }
}

impl Density {
    pub(super) fn log_at(&self, u: f64) -> f64 {
        match *self {
            Self::Uniform { width, .. } => -libm::log(width),
            Self::Normal { mean, sd, mass, .. } => {
                let z = (u - mean) / sd;
                -0.5 * z * z - LN_SQRT_TAU - libm::log(sd) - libm::log(mass)
            }
        }
    }

    /// Returns the probabilities below and above u, which lies inside.
    pub(super) fn tails(&self, u: f64) -> [f64; 2] {
        match *self {
            Self::Uniform { lower, width } => [(u - lower) / width, (lower + width - u) / width],
            Self::Normal {
                mean,
                sd,
                low,
                high,
                mass,
            } => {
                let z = (u - mean) / sd;
                [normal::mass(low, z) / mass, normal::mass(z, high) / mass]
            }
        }
    }

    /// Returns the quantile for 0 < p < 1.
    pub(super) fn quantile(&self, p: f64) -> f64 {
        self.quantile_of([p, 1.0 - p])
    }

    /// Returns the point with the probability 0 < `tail` <= 1/2 above it, or below it.
    pub(super) fn tail_quantile(&self, tail: f64, above: bool) -> f64 {
        let rest = 1.0 - tail;
        self.quantile_of(if above { [rest, tail] } else { [tail, rest] })
    }

    /// Returns the point with these probabilities below and above it.
    fn quantile_of(&self, [p, q]: [f64; 2]) -> f64 {
        match *self {
            Self::Uniform { lower, width } => lower + width * p,
            Self::Normal {
                mean,
                sd,
                low,
                high,
                mass,
            } => {
                // The nearer tail keeps the digits of the probability.
                let below = normal::cdf(low) + p * mass;
                let above = normal::cdf(-high) + q * mass;
                let z = if below < above {
                    normal::lower_quantile(below)
                } else {
                    -normal::lower_quantile(above)
                };
                mean + sd * z
            }
        }
    }
}

/// Returns the part of [low, high] where a unit normal around `centre` is within [`TAIL_NATS`] of its maximum there.
pub(super) fn window(low: f64, high: f64, centre: f64) -> (f64, f64) {
    let peak = centre.max(low).min(high);
    let offset = (peak - centre).abs();
    let reach = (offset * offset + 2.0 * TAIL_NATS).sqrt() - offset;
    (low.max(peak - reach), high.min(peak + reach))
}
