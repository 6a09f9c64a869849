//! A mixture of t-densities: its density and its draws.

use super::component::{Component, DEGREES_OF_FREEDOM, log_constant};
use statistics::rng::Stream;

/// A mixture of t-densities; the weights of the components sum to one.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Mixture {
    pub(super) components: Vec<Component>,
    /// Weight over root determinant of each component, relative to the largest.
    pub(super) factors: Vec<f64>,
    /// ln of the scale of the factors, with the constant of the t-density.
    log_scale: f64,
}

impl Mixture {
    /// Scales the weights of the components to a sum of one. `None` without components.
    pub(super) fn new(mut components: Vec<Component>) -> Option<Self> {
        let total: f64 = components.iter().map(|component| component.weight).sum();
        for component in &mut components {
            component.weight /= total;
        }
        let log_factor = |c: &Component| libm::log(c.weight) - c.log_root_determinant;
        let largest = components.iter().map(log_factor).reduce(f64::max)?;
        let factors = components
            .iter()
            .map(|c| libm::exp(log_factor(c) - largest))
            .collect();
        let log_scale = largest + log_constant(components.first()?.mean.len());
        Some(Self {
            components,
            factors,
            log_scale,
        })
    }

    pub(crate) fn size(&self) -> usize {
        self.components.len()
    }

    /// Moves the weight of every component by `share` towards the mean weight (a defensive mixture), so that a region whose weight
    /// was underestimated keeps its draws.
    pub(crate) fn defensive(&self, share: f64) -> Self {
        let level = share / self.components.len() as f64;
        let mut components = self.components.clone();
        for component in &mut components {
            component.weight = (1.0 - share) * component.weight + level;
        }
        Self::new(components).unwrap_or_else(|| self.clone())
    }

    /// Returns ln q(x).
    pub(crate) fn log_density(&self, x: &[f64], scratch: &mut Vec<f64>) -> f64 {
        let pairs = self.components.iter().zip(&self.factors);
        let sum: f64 = pairs
            .map(|(component, factor)| factor * component.kernel(component.square_distance(x, scratch)))
            .sum();
        self.log_scale + libm::log(sum)
    }

    pub(crate) fn draw(&self, stream: &mut Stream) -> Vec<f64> {
        let mut rest = stream.uniform();
        let last = self.components.len() - 1;
        let chosen = self.components[..last].iter().find(|component| {
            rest -= component.weight;
            rest < 0.0
        });
        let component = chosen.unwrap_or(&self.components[last]);
        let dimension = component.mean.len();
        let normals = stream.normals(dimension + DEGREES_OF_FREEDOM);
        let (direction, rest) = normals.split_at(dimension);
        let chi_square: f64 = rest.iter().map(|z| z * z).sum();
        component.at(direction, (DEGREES_OF_FREEDOM as f64 / chi_square).sqrt())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mixture::{WeightedPoints, fitted};

    /// Draws of a fitted mixture, weighted by q'/q of another mixture, average to one.
    #[test]
    fn density_and_draws_belong_together() {
        let mut stream = Stream::new(1, 0, 0, 0);
        let coordinates: Vec<f64> = stream.normals(2000).iter().map(|z| 3.0 + z).collect();
        let points = |coordinates| WeightedPoints::new(2, coordinates, vec![0.0; 1000], vec![1.0; 1000]);
        let (wide, _) = fitted(&points(coordinates), 1, &mut stream).unwrap();
        let shifted: Vec<f64> = stream.normals(2000).iter().map(|z| 3.3 + 0.8 * z).collect();
        let (reference, _) = fitted(&points(shifted), 4, &mut stream).unwrap();
        let mut scratch = Vec::new();
        let ratios: Vec<f64> = (0..40_000)
            .map(|draw| {
                let x = wide.draw(&mut Stream::new(2, 0, draw, 0));
                libm::exp(reference.log_density(&x, &mut scratch) - wide.log_density(&x, &mut scratch))
            })
            .collect();
        let (mean, sd) = crate::diagnostics::mean_and_sd(&ratios).unwrap();
        assert!((mean - 1.0).abs() < 4.0 * sd / 200.0, "{mean}, sd {sd}");
    }

    #[test]
    fn levelling_keeps_a_density() {
        let mut stream = Stream::new(1, 0, 0, 0);
        let points = WeightedPoints::new(1, stream.normals(500), vec![0.0; 500], vec![1.0; 500]);
        let (mixture, _) = fitted(&points, 8, &mut stream).unwrap();
        let defensive = mixture.defensive(0.3);
        let mut scratch = Vec::new();
        let mut integral = |mixture: &Mixture| -> f64 {
            (-4000..4000)
                .map(|i| 0.01 * libm::exp(mixture.log_density(&[0.01 * f64::from(i)], &mut scratch)))
                .sum()
        };
        // The tails beyond 40 hold 1e-6.
        for mixture in [&mixture, &defensive] {
            let sum = integral(mixture);
            assert!((sum - 1.0).abs() < 1e-3, "{sum}");
        }
    }
}
