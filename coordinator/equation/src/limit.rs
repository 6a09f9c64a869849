//! What a formula says beyond the range of its curve, and where two formulas differ most.

use crate::answer::FittedFormula;
use crate::curve::{Host, LocatedCurve};
use crate::prior::PARAMETERS;

/// Beyond this many ranges a law is followed.
const FAR: [f64; 3] = [1e3, 1e4, 1e5];
/// A limit is reached where the law changes by less than this share of its size from one of these to the next.
const REACHED: f64 = 0.02;
/// With a smaller exponent, of either sign, a law changes as a logarithm does.
const LEAST_EXPONENT: f64 = 0.08;
/// Above this exponent a law grows as an exponential does.
const MAX_EXPONENT: f64 = 12.0;
/// Conditions that are compared, from half the lowest to twice the highest value of the range.
const CONDITIONS: usize = 121;
/// Step of a coordinate in a derivative.
const STEP: f64 = 1e-4;

/// Where a law tends to at one end of its variable.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Limit {
    /// It tends to a value: of the factor, or of the addition.
    Value(f64),
    /// It goes with this power of the variable, with this sign.
    Power {
        /// Exponent: where the variable grows, a negative one is that of a law that falls to 0; where the variable falls, a positive one.
        exponent: f64,
        /// Sign of the law.
        sign: f64,
    },
    /// It changes more slowly than any power, with this sign.
    Logarithm {
        /// Sign of the law.
        sign: f64,
    },
    /// It grows faster than any power, with this sign.
    Exponential {
        /// Sign of the law.
        sign: f64,
    },
    /// It is undefined, or a factor is negative, from this value of the variable on.
    Ends(f64),
}

/// A condition at which two formulas differ.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SplittingCondition {
    /// Value of the variable.
    pub at: f64,
    /// The laws there: factors, or additions.
    pub laws: [f64; 2],
    /// Their difference over its sd: of both formulas, and of a run that shows the law as well as the curve does.
    pub sds: f64,
}

impl FittedFormula {
    /// Returns the law at a value of the variable: the factor, or the addition. NaN where it is undefined.
    #[must_use]
    pub fn law(&self, curve: &LocatedCurve, at: f64) -> f64 {
        self.shown(curve, self.value(curve, &self.fit.place, at))
    }

    /// Turns a value of the curve into a law.
    fn shown(&self, curve: &LocatedCurve, value: f64) -> f64 {
        match curve.host {
            Host::Factor => libm::exp(value),
            Host::Addition => value,
        }
    }

    /// Returns the law as the curve has it: of a factor the logarithm.
    fn value(&self, curve: &LocatedCurve, place: &[f64; PARAMETERS], at: f64) -> f64 {
        let problem = self.problem(curve);
        problem.law(place, problem.size(place), at / curve.scale)
    }

    /// Returns the sd of the law as the curve has it, by its parameters.
    fn sd(&self, curve: &LocatedCurve, at: f64) -> f64 {
        let slopes: [f64; PARAMETERS] = std::array::from_fn(|k| {
            if k > self.tree.constants {
                return 0.0;
            }
            let moved = |by: f64| {
                let mut place = self.fit.place;
                place[k] += by;
                self.value(curve, &place, at)
            };
            (moved(STEP) - moved(-STEP)) / (2.0 * STEP)
        });
        let mut variance = 0.0;
        for (j, a) in slopes.iter().enumerate() {
            for (k, b) in slopes.iter().enumerate() {
                variance += a * b * self.fit.covariance[(j, k)];
            }
        }
        variance.max(0.0).sqrt()
    }

    /// Returns where the law tends to as the variable grows. Checked by `limit::laws_tend_to_what_their_formulas_say`.
    #[must_use]
    pub fn limit_above(&self, curve: &LocatedCurve) -> Limit {
        let highest = curve.range()[1].abs().max(f64::MIN_POSITIVE);
        // Where it ends, to a third of an octave.
        let ends = (0..=51).map(|k| highest * libm::exp2(f64::from(k) / 3.0));
        if let Some(end) = ends.clone().find(|at| self.law(curve, *at).is_nan()) {
            return Limit::Ends(end);
        }
        self.tends(curve, FAR.map(|far| self.law(curve, far * highest)), 1.0)
    }

    /// Returns where the law tends to as the variable goes to 0; `None` if the range reaches 0 or below. Checked by
    /// `limit::powers_have_the_exponent_of_the_variable_at_both_ends`.
    #[must_use]
    pub fn limit_below(&self, curve: &LocatedCurve) -> Option<Limit> {
        let lowest = curve.range()[0];
        if lowest <= 0.0 {
            return None;
        }
        let mut halved = (0..=51).map(|k| lowest * libm::exp2(-f64::from(k) / 3.0));
        if let Some(end) = halved.find(|at| self.law(curve, *at).is_nan()) {
            return Some(Limit::Ends(end));
        }
        Some(self.tends(curve, FAR.map(|far| self.law(curve, lowest / far)), -1.0))
    }

    /// Returns where the law tends to by its values at 1e3, 1e4 and 1e5 ranges.
    ///
    /// # Arguments
    /// - `direction`: 1 where the variable grows tenfold from one to the next, -1 where it falls to a tenth.
    fn tends(&self, curve: &LocatedCurve, laws: [f64; 3], direction: f64) -> Limit {
        let [_, near, far] = laws;
        let size = match curve.host {
            Host::Factor => 1.0,
            Host::Addition => curve.size,
        };
        if (far - near).abs() < REACHED * size.min(far.abs().max(REACHED * size))
            || (far - near).abs() < 1e-3 * size
        {
            return Limit::Value(far);
        }
        let sign = far.signum();
        let growth = libm::log10((far / near).abs());
        if growth.is_nan() || growth >= MAX_EXPONENT {
            Limit::Exponential { sign }
        } else if growth <= -MAX_EXPONENT {
            Limit::Value(0.0)
        } else if growth.abs() < LEAST_EXPONENT {
            Limit::Logarithm { sign }
        } else {
            Limit::Power {
                exponent: direction * growth,
                sign,
            }
        }
    }
}

/// Returns the condition at which two formulas differ most, from half the lowest to twice the highest value of the range; `None` where
/// one of them is undefined at all.
#[must_use]
pub fn splitting(curve: &LocatedCurve, a: &FittedFormula, b: &FittedFormula) -> Option<SplittingCondition> {
    let [lowest, highest] = curve.range();
    let (from, to) = (if lowest > 0.0 { 0.5 * lowest } else { lowest }, 2.0 * highest);
    // A run shows the law about as well as the curve is known in its middle.
    let mut sds = curve.sds.clone();
    sds.sort_by(f64::total_cmp);
    let of_run = sds[sds.len() / 2];
    let conditions = (0..CONDITIONS).map(|k| {
        let share = k as f64 / (CONDITIONS - 1) as f64;
        from + (to - from) * share
    });
    let differing = conditions.filter_map(|at| {
        let values = [a, b].map(|formula| formula.value(curve, &formula.fit.place, at));
        let spread = [a, b].map(|formula| formula.sd(curve, at));
        let sd = (spread[0] * spread[0] + spread[1] * spread[1] + of_run * of_run).sqrt();
        let sds = (values[0] - values[1]).abs() / sd;
        sds.is_finite().then(|| SplittingCondition {
            at,
            laws: values.map(|value| a.shown(curve, value)),
            sds,
        })
    });
    differing.reduce(|best, next| if next.sds > best.sds { next } else { best })
}
