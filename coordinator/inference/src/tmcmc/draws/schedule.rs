//! The schedule of a stage of draws: the next tempering exponent of weighted draws.

use super::sample::WeightedSample;

/// Smallest and largest ESS/N of the draws at the next exponent.
const SHARES: [f64; 2] = [0.2, 0.5];

/// Effective draws for each free number of the mixture: a component has d + 1 numbers for each dimension, or fewer.
const DRAWS_A_NUMBER: f64 = 6.0;

/// If the fit at the present exponent was poor, the next exponent must leave at least this share of its effective draws.
const KEPT: f64 = 0.1;

/// Number of bisections on the logarithm of the step, which determine it to a relative 1e-12.
const BISECTIONS: usize = 48;

/// Returns the exponent above `exponent` that leaves enough effective draws for the next fit; at most 1.
///
/// Six draws for each component and each of its d + 1 numbers suffice, if the next fit takes as many `components` as the last,
/// but at least 20 % and at most 50 % of the draws that the model accepts. If fewer are effective at `exponent` already, 30 to 60
/// % of these suffice.
pub(crate) fn next_exponent(sample: &WeightedSample, exponent: f64, components: usize) -> f64 {
    let share = |exponent: f64| sample.weights(exponent).map_or(0.0, |weights| weights.share());
    let dimension = sample.states.first().map_or(0, |state| state.coordinates.len());
    let enough = DRAWS_A_NUMBER * (components * (dimension + 1)) as f64 / sample.states.len() as f64;
    let enough = enough.clamp(SHARES[0], SHARES[1]);
    let target = (enough * sample.possible()).min((KEPT + enough) * share(exponent));
    if share(1.0) >= target {
        return 1.0;
    }
    let finite = || {
        let values = sample.states.iter().map(|state| state.log_likelihood);
        values.filter(|l| !l.is_impossible()).map(|l| l.value())
    };
    let (min, max) = (
        finite().fold(f64::INFINITY, f64::min),
        finite().fold(f64::NEG_INFINITY, f64::max),
    );
    let remaining = 1.0 - exponent;
    // A step over which no weight changes by more than a few per cent keeps nearly all draws.
    let lowest = (0.01 / (max - min).min(f64::MAX)).min(remaining);
    let (mut low, mut high) = (libm::log(lowest), libm::log(remaining));
    for _ in 0..BISECTIONS {
        let middle = 0.5 * (low + high);
        if share(exponent + libm::exp(middle)) < target {
            high = middle;
        } else {
            low = middle;
        }
    }
    exponent + libm::exp(low)
}
