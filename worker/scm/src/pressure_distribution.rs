//! Distribution of the pressure over a footprint: gamma, zero at the border, highest in the middle, of mean one.

use crate::elementary::fraction_pow;

/// The law `g(u) = u^m` of the distance from the border, u = 1 at the deepest point of the footprint.
///
/// gamma is g divided by its mean over the footprint's area, so that k* keeps its meaning of a plate's
/// modulus; m = 0 makes gamma 1 everywhere.
///
/// # Source
/// Krenn & Hirzinger's model requires a weight that is highest in the middle and vanishes at the border, without giving a
/// formula; this power law is a choice of this crate.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum PressureDistribution {
    /// The exponent m is 0.
    Uniform,
    /// m = 1/2: a square root instead of a power.
    Root,
    /// The exponent m is 1.
    Linear,
    /// Any other m > 0.
    Power(f64),
}

impl PressureDistribution {
    /// Returns the law with exponent m ≥ 0.
    pub fn new(exponent: f64) -> Self {
        const HALF: u64 = 0.5_f64.to_bits();
        const ONE: u64 = 1.0_f64.to_bits();
        match exponent.to_bits() {
            HALF => Self::Root,
            ONE => Self::Linear,
            _ if exponent > 0.0 => Self::Power(exponent),
            _ => Self::Uniform,
        }
    }

    /// Returns the exponent m `[–]`.
    pub fn exponent(self) -> f64 {
        match self {
            Self::Uniform => 0.0,
            Self::Root => 0.5,
            Self::Linear => 1.0,
            Self::Power(exponent) => exponent,
        }
    }

    /// Returns `g(u)` for a block of distances u from the border relative to the largest one, each in (0, 1].
    #[inline]
    pub fn shape<const N: usize>(self, relative_distance: [f64; N]) -> [f64; N] {
        match self {
            Self::Uniform => [1.0; N],
            Self::Root => relative_distance.map(f64::sqrt),
            Self::Linear => relative_distance,
            Self::Power(exponent) => relative_distance.map(|u| fraction_pow(u, exponent)),
        }
    }
}

/// gamma of a rectangular footprint, averaged across its width, as a function of the place along it.
///
/// With dx the distance to the nearer end, B half the width and D = min(dx, B), the distance from the
/// border is min(D, distance to the side), whose power averages over the width to
/// `q (1 − D m / ((m + 1) B))`, `q = (D / D_max)^m`, `D_max = min(l/2, B)`. The mean of that over the
/// length is known in closed form too, so gamma has mean 1 to rounding.
///
/// Checked by `quadrature::gamma_has_mean_one`.
#[derive(Debug, Clone, Copy)]
pub struct RectangleDistribution {
    law: PressureDistribution,
    half_width: f64,
    per_deepest: f64,
    side_loss: f64,
    per_mean: f64,
}

impl RectangleDistribution {
    /// Returns the distribution over a footprint of the given length and half width `[m]`, both > 0.
    #[inline]
    pub fn new(law: PressureDistribution, length: f64, half_width: f64) -> Self {
        let m = law.exponent();
        let half_length = 0.5 * length;
        let mean = if half_length <= half_width {
            (1.0 - m * half_length / ((m + 2.0) * half_width)) / (m + 1.0)
        } else {
            (1.0 - m * half_width / ((m + 2.0) * half_length)) / (m + 1.0)
        };
        Self {
            law,
            half_width,
            per_deepest: 1.0 / half_length.min(half_width),
            side_loss: m / ((m + 1.0) * half_width),
            per_mean: 1.0 / mean,
        }
    }

    /// Returns gamma `[–]` at distances `[m]` from the nearer end, each in (0, l/2].
    #[inline]
    pub fn gamma<const N: usize>(&self, from_end: [f64; N]) -> [f64; N] {
        let distance = from_end.map(|dx| if dx < self.half_width { dx } else { self.half_width });
        let mut gamma = self.law.shape(distance.map(|d| d * self.per_deepest));
        for i in 0..N {
            gamma[i] *= (1.0 - distance[i] * self.side_loss) * self.per_mean;
        }
        gamma
    }
}
