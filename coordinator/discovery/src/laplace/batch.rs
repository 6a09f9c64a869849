//! A batch of fits whose evaluations share rounds, although each fit takes a different number of steps.

use crate::laplace::fit::LaplaceFit;
use statistics::likelihood::Likelihood;

/// A position to evaluate.
#[derive(Debug, Clone)]
pub(crate) struct PositionRequest {
    /// The candidate that is switched on; `None`: the base.
    pub(crate) candidate: Option<usize>,
    pub(crate) position: Vec<f64>,
    /// Whether the low-fidelity model is asked, in place of the model.
    pub(crate) is_low_fidelity: bool,
}

impl PositionRequest {
    /// Makes a request to the model itself.
    pub(crate) fn for_model(candidate: Option<usize>, position: Vec<f64>) -> Self {
        Self {
            candidate,
            position,
            is_low_fidelity: false,
        }
    }

    /// Returns requests to the model itself.
    pub(crate) fn all_for_model(
        candidate: Option<usize>,
        positions: Vec<Vec<f64>>,
    ) -> impl Iterator<Item = Self> {
        positions
            .into_iter()
            .map(move |position| Self::for_model(candidate, position))
    }
}

/// Fits of the base (`None`) or of candidates.
#[derive(Debug, Clone)]
pub(crate) struct FitBatch {
    pub(crate) fits: Vec<(Option<usize>, LaplaceFit)>,
    /// How many evaluations each fit waits for.
    waiting: Vec<usize>,
}

impl FitBatch {
    pub(crate) fn new(fits: Vec<(Option<usize>, LaplaceFit)>) -> Self {
        Self {
            fits,
            waiting: Vec::new(),
        }
    }

    /// Returns the positions to evaluate next, each with its model; none once all fits are complete.
    pub(crate) fn ask(&mut self, likelihood: &Likelihood) -> Vec<PositionRequest> {
        let mut requests = Vec::new();
        self.waiting.clear();
        for (candidate, fit) in &mut self.fits {
            let positions = fit.ask(likelihood);
            self.waiting.push(positions.len());
            let is_low_fidelity = fit.asks_low_fidelity();
            requests.extend(positions.into_iter().map(|position| PositionRequest {
                candidate: *candidate,
                position,
                is_low_fidelity,
            }));
        }
        requests
    }

    /// Takes the answers in the order of the positions.
    pub(crate) fn tell(&mut self, likelihood: &Likelihood, answers: Vec<Option<Vec<f64>>>) {
        let mut answers = answers.into_iter();
        for ((_, fit), count) in self.fits.iter_mut().zip(&self.waiting) {
            if *count > 0 {
                fit.tell(likelihood, answers.by_ref().take(*count).collect());
            }
        }
    }

    /// Returns the most probable fit; of equal ones the first.
    pub(crate) fn best(&self) -> Option<&LaplaceFit> {
        let fits = self.fits.iter().map(|(_, fit)| fit);
        fits.reduce(|a, b| if b.point.value < a.point.value { b } else { a })
    }

    /// Returns the number of evaluations of the model in all fits.
    pub(crate) fn evaluations(&self) -> usize {
        self.fits.iter().map(|(_, fit)| fit.evaluations).sum()
    }
}
