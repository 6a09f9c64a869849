//! The proposal density of a stage: a fit, cut at the ends of the prior's support.

use statistics::prior::Prior;
use statistics::rng::Stream;

use super::frame::Fit;

/// Trial draws per particle, without evaluations, which measure the share inside the support.
const TRIALS: usize = 16;
/// Trial draws per particle for the proposal of the posterior's draws, whose evidence is reported.
const LAST_TRIALS: usize = 64;
/// If all these trial draws are inside, the support cuts nothing off.
const ENOUGH: usize = 4000;
/// Smallest share inside the support.
const MIN_INSIDE: f64 = 0.01;

/// Share of the draws that come from the fit of the exponent before (a defensive mixture).
const DEFENSIVE: f64 = 0.1;

/// Step number of the first of these random streams; moves count theirs from 1.
const FIRST_STEP: u64 = 1 << 32;
/// Streams of a proposal's trials and of its fit; candidates never reach these numbers.
const TRIAL_STREAM: u64 = u64::MAX - 1;
const FIT_STREAM: u64 = u64::MAX - 2;

/// The key of a proposal's random numbers: `attempt` counts the proposals of a stage.
#[derive(Debug, Clone, Copy)]
pub(crate) struct DrawKey {
    seed: u64,
    stage: usize,
    attempt: usize,
}

impl DrawKey {
    pub(crate) fn new(seed: u64, stage: usize, attempt: usize) -> Self {
        Self { seed, stage, attempt }
    }

    fn stream(self, particle: u64) -> Stream {
        Stream::new(
            self.seed,
            self.stage as u64,
            particle,
            FIRST_STEP + self.attempt as u64,
        )
    }

    /// Returns the stream of the fit that leads to this proposal.
    pub(crate) fn fit(self) -> Stream {
        self.stream(FIT_STREAM)
    }
}

/// A draw before its evaluation.
#[derive(Debug, Clone)]
pub(crate) struct Draw {
    pub(crate) coordinates: Vec<f64>,
    /// ln of the prior density of the coordinates.
    pub(crate) log_prior: f64,
    /// ln (prior density / proposal density).
    pub(crate) log_ratio: f64,
}

/// A fit, with a share of the fit before it, cut at the ends of the prior's support.
#[derive(Debug, Clone)]
pub(crate) struct DrawProposal {
    fit: Fit,
    /// The fit of the exponent before, which is wider.
    defence: Option<Fit>,
    key: DrawKey,
    /// Number of candidates so far, inside the support or not.
    candidates: u64,
    /// ln of the share inside the support.
    log_inside: f64,
    pub(crate) inside_variance: f64,
}

impl DrawProposal {
    /// Measures the share inside the support. `None` if it is below 1 %.
    ///
    /// # Arguments
    /// - `last`: whether the evidence that is reported rests on this proposal.
    pub(crate) fn new(
        (fit, defence): (Fit, Option<Fit>),
        prior: &Prior,
        key: DrawKey,
        particles: usize,
        last: bool,
    ) -> Option<Self> {
        let mut proposal = Self {
            fit,
            defence,
            key,
            candidates: 0,
            log_inside: 0.0,
            inside_variance: 0.0,
        };
        let trials = particles * if last { LAST_TRIALS } else { TRIALS };
        let mut stream = key.stream(TRIAL_STREAM);
        let (mut tried, mut inside) = (0_usize, 0_usize);
        while tried < trials && !(tried == ENOUGH && inside == tried) {
            let candidate = proposal.candidate(prior, &mut stream);
            inside += usize::from(prior.log_density_of_coordinates(&candidate) > f64::NEG_INFINITY);
            tried += 1;
        }
        let share = inside as f64 / tried as f64;
        proposal.log_inside = libm::log(share);
        proposal.inside_variance = (1.0 - share) / (share * tried as f64);
        (share >= MIN_INSIDE).then_some(proposal)
    }

    fn candidate(&self, prior: &Prior, stream: &mut Stream) -> Vec<f64> {
        let from = match &self.defence {
            Some(defence) if stream.uniform() < DEFENSIVE => defence,
            _ => &self.fit,
        };
        from.draw(prior, stream)
    }

    /// Returns ln (density / prior density) before the cut.
    fn log_relative_density(&self, prior: &Prior, coordinates: &[f64], scratch: &mut Vec<f64>) -> f64 {
        let fitted = self.fit.log_relative_density(prior, coordinates, scratch);
        let Some(defence) = &self.defence else {
            return fitted;
        };
        let defensive = defence.log_relative_density(prior, coordinates, scratch);
        let largest = fitted.max(defensive);
        let sum =
            (1.0 - DEFENSIVE) * libm::exp(fitted - largest) + DEFENSIVE * libm::exp(defensive - largest);
        largest + libm::log(sum)
    }

    /// Returns ln (density / prior density) at sampling coordinates inside the support.
    pub(crate) fn log_density_ratio(&self, prior: &Prior, coordinates: &[f64]) -> f64 {
        self.log_relative_density(prior, coordinates, &mut Vec::new()) - self.log_inside
    }

    /// Returns the next draws inside the support.
    pub(crate) fn draws(&mut self, count: usize, prior: &Prior) -> Vec<Draw> {
        let mut draws = Vec::with_capacity(count);
        let mut scratch = Vec::new();
        while draws.len() < count {
            let coordinates = self.candidate(prior, &mut self.key.stream(self.candidates));
            self.candidates += 1;
            let log_prior = prior.log_density_of_coordinates(&coordinates);
            if log_prior > f64::NEG_INFINITY {
                let relative = self.log_relative_density(prior, &coordinates, &mut scratch);
                draws.push(Draw {
                    coordinates,
                    log_prior,
                    log_ratio: self.log_inside - relative,
                });
            }
        }
        draws
    }
}
