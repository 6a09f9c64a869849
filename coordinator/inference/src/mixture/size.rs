//! The number of components, by cross-validation.

use super::density::Mixture;
use super::fit::em;
use super::points::WeightedPoints;
use statistics::rng::Stream;

/// Rounds of a fit that is only compared.
const TRIAL_ROUNDS: usize = 12;
/// Rounds of the fit that is used.
const ROUNDS: usize = 25;
/// Number of sizes in a row that may predict worse than the best one before the search ends.
const PATIENCE: usize = 2;

/// Returns the mixture of 1, 2, 4, ... up to `max` components whose fit to one half of the points predicts the other best, and
/// the quality of that prediction: the mean of ln (q / reference) over both halves.
///
/// # Returns
/// `None` if the points' scatter is singular.
pub(crate) fn fitted(points: &WeightedPoints, max: usize, stream: &mut Stream) -> Option<(Mixture, f64)> {
    let halves = [points.half(0), points.half(1)];
    let (mut best, mut size_of_best, mut worse) = (f64::NEG_INFINITY, 1, 0);
    let mut size = 1;
    while size <= max && worse < PATIENCE {
        match score(&halves, size, stream) {
            Some(value) if value > best => (best, size_of_best, worse) = (value, size, 0),
            _ => worse += 1,
        }
        size *= 2;
    }
    Some((em(points, size_of_best, ROUNDS, stream)?, best))
}

/// Returns the mean ln (q / reference) of each half under the fit to the other.
fn score(halves: &[WeightedPoints; 2], size: usize, stream: &mut Stream) -> Option<f64> {
    let [first, second] = halves;
    let mut scratch = Vec::new();
    let mut predict = |from: &WeightedPoints, to: &WeightedPoints| -> Option<f64> {
        let mixture = em(from, size, TRIAL_ROUNDS, stream)?;
        let terms = to.rows().zip(&to.references).zip(&to.weights);
        let gains =
            terms.map(|((x, reference), weight)| weight * (mixture.log_density(x, &mut scratch) - reference));
        Some(gains.sum())
    };
    Some(0.5 * (predict(first, second)? + predict(second, first)?))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_normal_sample_takes_few_components_and_separate_modes_as_many_as_they_are() {
        let mut stream = Stream::new(5, 0, 0, 0);
        let normal = WeightedPoints::new(3, stream.normals(1500), vec![0.0; 500], vec![1.0; 500]);
        let (mixture, score) = fitted(&normal, 32, &mut stream).unwrap();
        assert!(mixture.size() <= 2);
        // The entropy of three standard normals is 4.26.
        assert!((score + 4.26).abs() < 0.2, "{score}");
        let modes: Vec<f64> = stream
            .normals(1600)
            .chunks_exact(2)
            .enumerate()
            .flat_map(|(i, z)| [20.0 * ((i / 2 % 8) as f64) + z[0], z[1]])
            .collect();
        let points = WeightedPoints::new(2, modes, vec![0.0; 800], vec![1.0; 800]);
        assert!(fitted(&points, 32, &mut stream).unwrap().0.size() >= 8);
    }
}
