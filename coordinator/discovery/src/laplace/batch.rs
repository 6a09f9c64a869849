//! Several fits side by side, each at its own pace.

use crate::laplace::fit::LaplaceFit;
use statistics::likelihood::Likelihood;

/// A position to evaluate.
#[derive(Debug, Clone)]
pub(crate) struct Asked {
    /// The candidate that is switched on; `None`: the base.
    pub(crate) candidate: Option<usize>,
    pub(crate) position: Vec<f64>,
    /// Of the model's companion.
    pub(crate) is_companion: bool,
}

impl Asked {
    /// Of the model itself.
    pub(crate) fn of_model(candidate: Option<usize>, position: Vec<f64>) -> Self {
        Self {
            candidate,
            position,
            is_companion: false,
        }
    }

    /// Each of these positions, of the model itself.
    pub(crate) fn all_of_model(
        candidate: Option<usize>,
        positions: Vec<Vec<f64>>,
    ) -> impl Iterator<Item = Self> {
        positions
            .into_iter()
            .map(move |position| Self::of_model(candidate, position))
    }
}

/// Fits of the base (`None`) or of candidates.
#[derive(Debug, Clone)]
pub(crate) struct FitBatch {
    pub(crate) fits: Vec<(Option<usize>, LaplaceFit)>,
    /// How many evaluations each waits for.
    waiting: Vec<usize>,
}

impl FitBatch {
    pub(crate) fn new(fits: Vec<(Option<usize>, LaplaceFit)>) -> Self {
        Self {
            fits,
            waiting: Vec::new(),
        }
    }

    /// The positions to evaluate next, each with its model; none once all fits are complete.
    pub(crate) fn ask(&mut self, likelihood: &Likelihood) -> Vec<Asked> {
        let mut asked = Vec::new();
        self.waiting.clear();
        for (candidate, fit) in &mut self.fits {
            let positions = fit.ask(likelihood);
            self.waiting.push(positions.len());
            let is_companion = fit.asks_companion();
            asked.extend(positions.into_iter().map(|position| Asked {
                candidate: *candidate,
                position,
                is_companion,
            }));
        }
        asked
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

    /// The most probable fit, the first of equal ones.
    pub(crate) fn best(&self) -> Option<&LaplaceFit> {
        let fits = self.fits.iter().map(|(_, fit)| fit);
        fits.reduce(|a, b| if b.point.value < a.point.value { b } else { a })
    }

    /// Evaluations spent by all.
    pub(crate) fn evaluations(&self) -> usize {
        self.fits.iter().map(|(_, fit)| fit.evaluations).sum()
    }
}
