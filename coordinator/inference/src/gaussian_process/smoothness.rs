//! Length scales and noise, chosen by leaving out one observation after the other.

use nalgebra::{Cholesky, DVector};

use super::kernel::Kernel;
use super::observation::Observation;

/// Length scales that are tried, over the range of each coordinate.
const LENGTHS: [f64; 6] = [0.1, 0.2, 0.4, 0.8, 1.6, 3.2];
/// Variances of the noise of one measurement that are tried, over that of the process.
const NOISES: [f64; 5] = [1e-4, 1e-3, 1e-2, 1e-1, 1.0];
/// A coordinate of fewer levels says nothing of its scale, and has the longest.
const LEAST_LEVELS: usize = 3;
/// Values within so much of the range are one level.
const ONE_LEVEL: f64 = 0.1;
/// Most rounds over all coordinates.
const ROUNDS: usize = 8;
/// Of more observations so many choose: the cost grows with the cube of their number.
const MOST: usize = 150;

/// The kernel with the least squared errors of the observations left out one by one, by steps along one coordinate at a time.
pub(super) fn smoothest(observations: &[Observation], dimension: usize) -> Kernel {
    let chosen = representative(observations, dimension, MOST);
    let is_free = |k: &usize| levels(observations, *k).len() >= LEAST_LEVELS;
    let free: Vec<usize> = (0..dimension).filter(is_free).collect();
    let length = |k: usize| match free.contains(&k) {
        true => LENGTHS[LENGTHS.len() / 2],
        false => LENGTHS[LENGTHS.len() - 1],
    };
    let mut best = Kernel {
        lengths: (0..dimension).map(length).collect(),
        noise: NOISES[NOISES.len() / 2],
    };
    let mut least = left_out_squares(&chosen, &best);
    for _ in 0..ROUNDS {
        let before = best.clone();
        for &coordinate in free.iter().chain([&dimension]) {
            for trial in trials(&best, coordinate) {
                let squares = left_out_squares(&chosen, &trial);
                if squares < least {
                    (best, least) = (trial, squares);
                }
            }
        }
        if best == before {
            break;
        }
    }
    best
}

/// The least values of the levels of a coordinate, ascending: a value further than [`ONE_LEVEL`] above the first of its level opens
/// the next, so values without a gap are many levels.
fn levels(observations: &[Observation], coordinate: usize) -> Vec<f64> {
    let mut values: Vec<f64> = observations.iter().map(|o| o.point[coordinate]).collect();
    values.sort_by(f64::total_cmp);
    let mut levels: Vec<f64> = Vec::new();
    for value in values {
        if levels.last().is_none_or(|first| value - first > ONE_LEVEL) {
            levels.push(value);
        }
    }
    levels
}

/// At most so many observations, in their order, which represent every level of every coordinate: the next is the one whose least
/// represented level is represented least, then the one whose levels together are, then the first.
fn representative(observations: &[Observation], dimension: usize, most: usize) -> Vec<Observation> {
    if observations.len() <= most {
        return observations.to_vec();
    }
    let starts: Vec<Vec<f64>> = (0..dimension).map(|k| levels(observations, k)).collect();
    let place = |o: &Observation, k: usize| starts[k].partition_point(|start| *start <= o.point[k]);
    let places: Vec<Vec<usize>> = observations
        .iter()
        .map(|o| (0..dimension).map(|k| place(o, k)).collect())
        .collect();
    let mut chosen_at: Vec<Vec<usize>> = starts.iter().map(|own| vec![0; own.len() + 1]).collect();
    let mut left: Vec<usize> = (0..observations.len()).collect();
    let mut chosen = Vec::new();
    for _ in 0..most {
        let counts = |i: usize| places[i].iter().zip(&chosen_at).map(|(&at, own)| own[at]);
        let next = (0..left.len()).min_by_key(|&k| (counts(left[k]).min(), counts(left[k]).sum::<usize>()));
        let Some(next) = next.map(|k| left.remove(k)) else {
            break;
        };
        for (&at, own) in places[next].iter().zip(&mut chosen_at) {
            own[at] += 1;
        }
        chosen.push(next);
    }
    chosen.sort_unstable();
    chosen.into_iter().map(|i| observations[i].clone()).collect()
}

/// A kernel with every other value of one coordinate, the noise being the last.
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

/// The squared errors of the observations, each predicted from the others: `sum ((K^-1 y)_i / (K^-1)_ii)^2`; infinite where K is
/// singular to rounding.
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
            let mut others = all.clone();
            let own = others.remove(left);
            let factor = Cholesky::new(kernel.matrix(&others)).unwrap();
            let weights = factor.solve(&DVector::from_iterator(
                others.len(),
                others.iter().map(|o| o.value),
            ));
            let terms = others.iter().zip(weights.iter());
            let mean: f64 = terms
                .map(|(o, weight)| weight * kernel.covariance(&o.point, &own.point))
                .sum();
            squares += (own.value - mean) * (own.value - mean);
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
        assert_eq!(levels(&all, 0).len(), 5);
        assert!((smoothest(&all, 2).lengths[1] - 3.2).abs() < f64::EPSILON);
    }

    #[test]
    fn values_that_scatter_about_two_levels_are_two_and_those_without_a_gap_many() {
        let along = |values: &[f64]| -> Vec<Observation> {
            let at = |&x: &f64| Observation {
                point: vec![x],
                value: 0.0,
                repeats: 1,
            };
            values.iter().map(at).collect()
        };
        assert_eq!(levels(&along(&[0.06, 0.0, 0.97, 0.03, 1.0]), 0).len(), 2);
        let dense: Vec<f64> = (0..=25).map(|i| 0.04 * f64::from(i)).collect();
        assert!(levels(&along(&dense), 0).len() >= 5);
    }

    #[test]
    fn of_many_observations_those_that_choose_have_every_level() {
        // In this order every second one, and every third one, is at one level of the second coordinate.
        let at = |i: u32| Observation {
            point: vec![f64::from(i / 6 % 5) / 4.0, f64::from(i % 6) / 5.0],
            value: f64::from(i),
            repeats: 1,
        };
        let all: Vec<Observation> = (0..360).map(at).collect();
        let chosen = representative(&all, 2, 150);
        assert_eq!(chosen.len(), 150);
        for (coordinate, of_each) in [(0, 30), (1, 25)] {
            for level in levels(&all, coordinate) {
                let own = chosen
                    .iter()
                    .filter(|o| (o.point[coordinate] - level).abs() < 0.01);
                assert_eq!(own.count(), of_each, "coordinate {coordinate} at {level}");
            }
        }
        assert!(chosen.windows(2).all(|pair| pair[0].value < pair[1].value));
        // A level of one observation among thousands.
        let mut rare = all;
        rare[77].point[1] = 1.7;
        assert!(representative(&rare, 2, 20).iter().any(|o| o.point[1] > 1.5));
    }

    #[test]
    fn a_coordinate_that_does_nothing_gets_a_longer_scale_than_one_that_does() {
        let lengths = smoothest(&observations(|x, _| libm::sin(6.0 * x)), 2).lengths;
        assert!(lengths[1] > lengths[0], "{lengths:?}");
    }
}
