//! The frame of a fit: the coordinates in which a mixture is fitted to draws.

use statistics::prior::{LN_SQRT_TAU, Prior};
use statistics::rng::Stream;

use super::sample::{ImportanceWeights, WeightedSample};
use crate::mixture::{Mixture, WeightedPoints, fitted};

/// The coordinates of a fit.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Frame {
    /// The coordinates of the sampler. A straight ridge of uniform parameters is straight here, however thin.
    Sampling,
    /// The normal score of each parameter under its prior. A posterior at a bound of the prior is one tail of a normal density
    /// here.
    NormalScores,
}

impl Frame {
    /// Returns the coordinates of a state, from those of the sampler.
    fn coordinates(self, prior: &Prior, sampling: &[f64]) -> Vec<f64> {
        match self {
            Self::Sampling => sampling.to_vec(),
            Self::NormalScores => {
                let pairs = prior.marginals().iter().zip(sampling);
                pairs
                    .map(|(marginal, &u)| marginal.normal_score(marginal.value(u)))
                    .collect()
            }
        }
    }

    /// Returns the inverse of [`Frame::coordinates`].
    fn sampling(self, prior: &Prior, coordinates: Vec<f64>) -> Vec<f64> {
        match self {
            Self::Sampling => coordinates,
            Self::NormalScores => {
                let pairs = prior.marginals().iter().zip(&coordinates);
                pairs
                    .map(|(marginal, &z)| marginal.coordinate(marginal.from_normal_score(z)))
                    .collect()
            }
        }
    }

    /// Returns ln of the prior density in these coordinates.
    fn log_prior(self, prior: &Prior, coordinates: &[f64]) -> f64 {
        match self {
            Self::Sampling => prior.log_density_of_coordinates(coordinates),
            Self::NormalScores => coordinates.iter().map(|z| -0.5 * z * z - LN_SQRT_TAU).sum(),
        }
    }
}

/// A mixture in the coordinates that suit it.
#[derive(Debug, Clone)]
pub(crate) struct Fit {
    frame: Frame,
    mixture: Mixture,
}

impl Fit {
    /// Returns the fit to weighted draws, in the coordinates in which it predicts better. `None` if the draws do not span the
    /// space.
    ///
    /// Scores of correlated priors are not independent: these are fitted in the sampling coordinates.
    pub(crate) fn new(
        sample: &WeightedSample,
        weights: &ImportanceWeights,
        prior: &Prior,
        components: usize,
        stream: &mut Stream,
    ) -> Option<Self> {
        let frames = if prior.is_correlated() {
            &[Frame::Sampling][..]
        } else {
            &[Frame::Sampling, Frame::NormalScores]
        };
        let mut best: Option<(f64, Self)> = None;
        for &frame in frames {
            if let Some((score, fit)) = Self::in_frame(frame, (sample, weights), prior, components, stream)
                && best.as_ref().is_none_or(|(highest, _)| score > *highest)
            {
                best = Some((score, fit));
            }
        }
        best.map(|(_, fit)| fit)
    }

    /// Returns the fit in given coordinates, and how well it predicts: the mean of ln (density / prior density).
    fn in_frame(
        frame: Frame,
        (sample, weights): (&WeightedSample, &ImportanceWeights),
        prior: &Prior,
        components: usize,
        stream: &mut Stream,
    ) -> Option<(f64, Self)> {
        let rows = sample.states.iter();
        let rows: Vec<Vec<f64>> = rows
            .map(|state| frame.coordinates(prior, &state.coordinates))
            .collect();
        let references = rows.iter().map(|row| frame.log_prior(prior, row)).collect();
        let points = WeightedPoints::new(
            prior.dimension(),
            rows.concat(),
            references,
            weights.normalised.clone(),
        );
        let (mixture, score) = fitted(&points, components, stream)?;
        Some((score, Self { frame, mixture }))
    }

    pub(crate) fn size(&self) -> usize {
        self.mixture.size()
    }

    /// Returns this fit with a defensive share of weight moved from heavy to light components.
    pub(crate) fn defensive(&self, share: f64) -> Self {
        Self {
            frame: self.frame,
            mixture: self.mixture.defensive(share),
        }
    }

    /// Returns a draw, in sampling coordinates.
    pub(crate) fn draw(&self, prior: &Prior, stream: &mut Stream) -> Vec<f64> {
        self.frame.sampling(prior, self.mixture.draw(stream))
    }

    /// Returns ln (density / prior density) at sampling coordinates inside the support.
    pub(crate) fn log_relative_density(
        &self,
        prior: &Prior,
        sampling: &[f64],
        scratch: &mut Vec<f64>,
    ) -> f64 {
        let coordinates = self.frame.coordinates(prior, sampling);
        self.mixture.log_density(&coordinates, scratch) - self.frame.log_prior(prior, &coordinates)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use statistics::{Distribution, Marginal};

    fn prior() -> Prior {
        let uniform = Distribution::Uniform {
            lower: 2.0,
            upper: 5.0,
        };
        let lognormal = Distribution::Lognormal {
            median: 2.0,
            factor: 1.5,
        };
        let marginals = [uniform, lognormal].map(|distribution| Marginal::new(distribution, None).unwrap());
        Prior::new(marginals.to_vec())
    }

    #[test]
    fn scores_lead_back_to_where_they_came_from() {
        let prior = prior();
        for x in [[2.001, 0.1], [3.3, 0.7], [4.999, 2.0], [4.0, 5.6], [4.0, -4.2]] {
            let back = Frame::NormalScores.sampling(&prior, Frame::NormalScores.coordinates(&prior, &x));
            assert!(back.iter().zip(&x).all(|(a, b)| (a - b).abs() < 1e-9), "{back:?}");
        }
    }

    /// In either frame the mean of prior / q over draws from q is one.
    #[test]
    fn draws_of_both_frames_weigh_the_prior() {
        let prior = prior();
        let mut stream = Stream::new(1, 0, 0, 0);
        let mut sample = WeightedSample::default();
        for particle in 0..1000 {
            let theta = prior.sample(&mut Stream::new(2, 0, particle, 0));
            sample.push_evaluated(prior.coordinates(&theta), 0.0);
        }
        let weights = sample.weights(0.0).unwrap();
        for frame in [Frame::Sampling, Frame::NormalScores] {
            let (_, fit) = Fit::in_frame(frame, (&sample, &weights), &prior, 4, &mut stream).unwrap();
            let mut scratch = Vec::new();
            let ratios: Vec<f64> = (0..20_000)
                .map(|draw| {
                    let x = fit.draw(&prior, &mut Stream::new(3, 0, draw, 0));
                    if prior.log_density_of_coordinates(&x) > f64::NEG_INFINITY {
                        libm::exp(-fit.log_relative_density(&prior, &x, &mut scratch))
                    } else {
                        0.0
                    }
                })
                .collect();
            let (mean, sd) = crate::diagnostics::mean_and_sd(&ratios).unwrap();
            assert!(
                (mean - 1.0).abs() < 5.0 * sd / 141.0,
                "{frame:?}: {mean}, sd {sd}"
            );
        }
    }
}
