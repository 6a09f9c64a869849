//! Weighted expectation-maximisation of a mixture of t-densities.

use super::component::{Component, DEGREES_OF_FREEDOM};
use super::density::Mixture;
use super::points::WeightedPoints;
use statistics::rng::Stream;

/// Number of effective points below which a component is dropped.
const MIN_POINTS: f64 = 0.2;

/// Number of effective points, for each dimension and two more, with which the mean scatter within components enters each
/// component's scatter: a component of few points takes the common shape.
const COMMON_POINTS: f64 = 1.0;

/// Returns a mixture of `size` components after `rounds` rounds; components that lose their points are dropped.
///
/// The start: means drawn by weight and square distance from the means so far (k-means++, Arthur & Vassilvitskii 2007), scatters
/// that of all points, shrunk by `size^(-2/d)`. Each round updates weights, means and scatters as Peel and `McLachlan` 2000 do
/// (Stat. Comput. 10:339, doi:10.1023/A:1008981510081), each point counted by its weight. `None` if the points' scatter is
/// singular.
pub(super) fn em(
    points: &WeightedPoints,
    size: usize,
    rounds: usize,
    stream: &mut Stream,
) -> Option<Mixture> {
    let mut mixture = Mixture::new(start(points, size, stream)?)?;
    for _ in 0..rounds {
        mixture = Mixture::new(round(&mixture, points)?)?;
    }
    Some(mixture)
}

/// Draws the components of the first round.
fn start(points: &WeightedPoints, size: usize, stream: &mut Stream) -> Option<Vec<Component>> {
    let all = Moments::new(
        points,
        points.weights.iter().copied(),
        points.weights.iter().copied(),
    );
    let pool = Component::new(1.0, all.mean, all.scatter)?;
    if size == 1 {
        return Some(vec![pool]);
    }
    let shrink = libm::pow(size as f64, -2.0 / points.dimension as f64);
    let scatter: Vec<f64> = pool.scatter.iter().map(|c| shrink * c).collect();
    let mut scratch = Vec::new();
    let mut distances = vec![f64::INFINITY; points.weights.len()];
    let mut components = Vec::with_capacity(size);
    for index in 0..size {
        let chance = |i: usize| {
            if index == 0 {
                points.weights[i]
            } else {
                points.weights[i] * distances[i]
            }
        };
        let mut rest = stream.uniform() * (0..distances.len()).map(chance).sum::<f64>();
        let chosen = (0..distances.len()).find(|&i| {
            rest -= chance(i);
            rest < 0.0
        });
        let mean = points.row(chosen.unwrap_or(distances.len() - 1)).to_vec();
        let component = Component::new(1.0, mean, scatter.clone())?;
        for (distance, x) in distances.iter_mut().zip(points.rows()) {
            *distance = distance.min(component.square_distance(x, &mut scratch));
        }
        components.push(component);
    }
    Some(components)
}

/// Updates all components by one round of expectation-maximisation.
fn round(mixture: &Mixture, points: &WeightedPoints) -> Option<Vec<Component>> {
    let (size, dimension) = (mixture.components.len(), points.dimension as f64);
    let nu = DEGREES_OF_FREEDOM as f64;
    let effective = points.effective_number();
    // By point, then component: the share of the point's weight, and that share times the t-density's own weight.
    let mut shares = Vec::with_capacity(points.weights.len() * size);
    let mut pulls = Vec::with_capacity(points.weights.len() * size);
    let mut scratch = Vec::new();
    for (x, weight) in points.rows().zip(&points.weights) {
        let first = shares.len();
        for (component, factor) in mixture.components.iter().zip(&mixture.factors) {
            let square = component.square_distance(x, &mut scratch);
            shares.push(factor * component.kernel(square));
            pulls.push((nu + dimension) / (nu + square));
        }
        let sum: f64 = shares[first..].iter().sum();
        for (share, pull) in shares[first..].iter_mut().zip(&mut pulls[first..]) {
            *share *= weight / sum;
            *pull *= *share;
        }
    }
    let updates: Vec<Moments> = (0..size)
        .map(|k| {
            let of_component =
                |values: &'_ [f64]| values.iter().skip(k).step_by(size).copied().collect::<Vec<f64>>();
            Moments::new(
                points,
                of_component(&shares).into_iter(),
                of_component(&pulls).into_iter(),
            )
        })
        .filter(|update| update.weight * effective > MIN_POINTS)
        .collect();
    let total: f64 = updates.iter().map(|update| update.weight).sum();
    let common: Vec<f64> = (0..points.dimension * points.dimension)
        .map(|i| updates.iter().map(|u| u.weight * u.scatter[i]).sum::<f64>() / total)
        .collect();
    let prior = COMMON_POINTS * (dimension + 2.0);
    let components: Vec<Component> = updates
        .into_iter()
        .filter_map(|update| {
            let points = update.weight * effective;
            let scatter = update.scatter.iter().zip(&common);
            let scatter = scatter.map(|(c, common)| (points * c + prior * common) / (points + prior));
            Component::new(update.weight, update.mean, scatter.collect())
        })
        .collect();
    (!components.is_empty()).then_some(components)
}

/// Weight, mean and scatter of a component's points.
struct Moments {
    weight: f64,
    mean: Vec<f64>,
    scatter: Vec<f64>,
}

impl Moments {
    /// Returns mean = sum p x / sum p and scatter = sum p (x - mean)(x - mean)' / sum r, with shares r and pulls p.
    fn new(
        points: &WeightedPoints,
        shares: impl Iterator<Item = f64>,
        pulls: impl Iterator<Item = f64> + Clone,
    ) -> Self {
        let dimension = points.dimension;
        let weight: f64 = shares.sum();
        let (mut mean, mut total) = (vec![0.0; dimension], 0.0);
        for (x, pull) in points.rows().zip(pulls.clone()) {
            total += pull;
            for (sum, x) in mean.iter_mut().zip(x) {
                *sum += pull * x;
            }
        }
        for sum in &mut mean {
            *sum /= total;
        }
        let mut scatter = vec![0.0; dimension * dimension];
        for (x, pull) in points.rows().zip(pulls) {
            for row in 0..dimension {
                let scaled = pull * (x[row] - mean[row]);
                for column in 0..=row {
                    scatter[row * dimension + column] += scaled * (x[column] - mean[column]);
                }
            }
        }
        for row in 0..dimension {
            for column in 0..=row {
                let value = scatter[row * dimension + column] / weight;
                scatter[row * dimension + column] = value;
                scatter[column * dimension + row] = value;
            }
        }
        Self {
            weight,
            mean,
            scatter,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Two heaps of unequal weight: both are found where they are.
    #[test]
    fn two_heaps_are_found() {
        let mut stream = Stream::new(3, 0, 0, 0);
        let mut coordinates: Vec<f64> = stream.normals(400).iter().map(|z| -5.0 + z).collect();
        coordinates.extend(stream.normals(400).iter().map(|z| 5.0 + 0.1 * z));
        let weights = (0..400).map(|i| if i < 200 { 1.0 } else { 3.0 }).collect();
        let points = WeightedPoints::new(2, coordinates, vec![0.0; 400], weights);
        let mixture = em(&points, 2, 25, &mut stream).unwrap();
        let mut heaps: Vec<(f64, f64)> = mixture.components.iter().map(|c| (c.mean[0], c.weight)).collect();
        heaps.sort_by(|a, b| a.0.total_cmp(&b.0));
        let [(left, small), (right, large)] = heaps[..] else {
            panic!("{heaps:?}");
        };
        assert!(
            (left + 5.0).abs() < 0.3 && (right - 5.0).abs() < 0.05,
            "{heaps:?}"
        );
        assert!(
            (small - 0.25).abs() < 0.01 && (large - 0.75).abs() < 0.01,
            "{heaps:?}"
        );
    }

    #[test]
    fn points_on_a_line_have_no_fit() {
        let coordinates = (0..20).flat_map(|i| [f64::from(i), 2.0 * f64::from(i)]).collect();
        let points = WeightedPoints::new(2, coordinates, vec![0.0; 20], vec![1.0; 20]);
        assert_eq!(em(&points, 2, 5, &mut Stream::new(1, 0, 0, 0)), None);
    }
}
