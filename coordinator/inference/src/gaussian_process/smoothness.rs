//! The smoothness of a process: length scales and noise, chosen by leaving out one observation after the other.

use nalgebra::{Cholesky, DVector};

use super::kernel::Kernel;
use super::observation::Observation;
use super::representative::{levels, representative};

/// Length scales that are tried, over the range of each coordinate.
const LENGTHS: [f64; 6] = [0.1, 0.2, 0.4, 0.8, 1.6, 3.2];
/// Variances of the noise of one measurement that are tried, over that of the process.
const NOISES: [f64; 5] = [1e-4, 1e-3, 1e-2, 1e-1, 1.0];
/// Number of distinct values below which a coordinate does not determine its length scale, and has the longest one.
const MIN_LEVELS: usize = 3;
/// Maximum number of rounds over all coordinates.
const ROUNDS: usize = 8;
/// Maximum number of observations that determine the kernel: the cost grows with the cube of their number.
const MAX_OBSERVATIONS: usize = 150;

/// Returns the kernel with the least squared errors of the observations left out one by one, by steps along one coordinate at a
/// time.
pub(super) fn smoothest(observations: &[Observation], dimension: usize) -> Kernel {
    let points: Vec<&[f64]> = observations.iter().map(|o| o.point.as_slice()).collect();
    let chosen = representative(&points, MAX_OBSERVATIONS).into_iter();
    let chosen: Vec<Observation> = chosen.map(|i| observations[i].clone()).collect();
    let is_free = |k: &usize| levels(&points, *k).len() >= MIN_LEVELS;
    let free: Vec<usize> = (0..dimension).filter(is_free).collect();
    let length = |k: usize| match free.contains(&k) {
        true => LENGTHS[LENGTHS.len() / 2],
        false => LENGTHS[LENGTHS.len() - 1],
    };
    let mut best = Kernel {
        lengths: (0..dimension).map(length).collect(),
        noise: NOISES[NOISES.len() / 2],
    };
    let mut lowest = left_out_squares(&chosen, &best);
    for _ in 0..ROUNDS {
        let before = best.clone();
        for &coordinate in free.iter().chain([&dimension]) {
            for trial in trials(&best, coordinate) {
                let squares = left_out_squares(&chosen, &trial);
                if squares < lowest {
                    (best, lowest) = (trial, squares);
                }
            }
        }
        if best == before {
            break;
        }
    }
    best
}

/// Returns copies of a kernel, one with each value that is tried for a coordinate; the coordinate after the last one is the noise.
fn trials(kernel: &Kernel, coordinate: usize) -> Vec<Kernel> {
    let values: &[f64] = match coordinate < kernel.lengths.len() {
        true => &LENGTHS,
        false => &NOISES,
    };
    let trial = |&value: &f64| {
        let mut trial = kernel.clone();
        match trial.lengths.get_mut(coordinate) {
            Some(length) => *length = value,
            None => trial.noise = value,
        }
        trial
    };
    values.iter().map(trial).filter(|trial| trial != kernel).collect()
}

/// Returns the squared errors of the observations, each predicted from the others: `sum ((K^-1 y)_i / (K^-1)_ii)^2`; infinite
/// where K is singular to rounding.
fn left_out_squares(observations: &[Observation], kernel: &Kernel) -> f64 {
    let Some(factor) = Cholesky::new(kernel.matrix(observations)) else {
        return f64::INFINITY;
    };
    let values = DVector::from_iterator(observations.len(), observations.iter().map(|o| o.value));
    let weights = factor.solve(&values);
    let inverse = factor.inverse();
    let errors = weights
        .iter()
        .enumerate()
        .map(|(i, weight)| weight / inverse[(i, i)]);
    errors.map(|error| error * error).sum()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn observations(value: impl Fn(f64, f64) -> f64) -> Vec<Observation> {
        let grid = (0..5).flat_map(|i| (0..4).map(move |j| [f64::from(i) / 4.0, f64::from(j) / 3.0]));
        grid.map(|[x, y]| Observation {
            point: vec![x, y],
            value: value(x, y),
            repeats: 1,
        })
        .collect()
    }

    #[test]
    fn leaving_one_out_by_the_inverse_is_leaving_it_out() {
        let all = observations(|x, y| libm::sin(3.0 * x) + y * y);
        let kernel = Kernel {
            lengths: vec![0.4, 0.8],
            noise: 0.01,
        };
        let mut squares = 0.0;
        for left in 0..all.len() {
            let mut rest = all.clone();
            let left_out = rest.remove(left);
            let factor = Cholesky::new(kernel.matrix(&rest)).unwrap();
            let weights = factor.solve(&DVector::from_iterator(rest.len(), rest.iter().map(|o| o.value)));
            let terms = rest.iter().zip(weights.iter());
            let mean: f64 = terms
                .map(|(o, weight)| weight * kernel.covariance(&o.point, &left_out.point))
                .sum();
            squares += (left_out.value - mean) * (left_out.value - mean);
        }
        let by_inverse = left_out_squares(&all, &kernel);
        assert!(
            (by_inverse - squares).abs() < 1e-8 * squares,
            "{by_inverse} {squares}"
        );
    }

    #[test]
    fn a_coordinate_of_two_levels_has_the_longest_scale() {
        let mut all = observations(|x, y| libm::sin(6.0 * x) * y);
        all.retain(|o| o.point[1] < 0.01 || o.point[1] > 0.99);
        assert!((smoothest(&all, 2).lengths[1] - 3.2).abs() < f64::EPSILON);
    }

    #[test]
    fn a_coordinate_that_does_nothing_gets_a_longer_scale_than_one_that_does() {
        let lengths = smoothest(&observations(|x, _| libm::sin(6.0 * x)), 2).lengths;
        assert!(lengths[1] > lengths[0], "{lengths:?}");
    }
}
