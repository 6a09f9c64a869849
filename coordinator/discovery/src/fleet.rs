//! Run several descents side by side, each at its own pace.

use crate::descent::Descent;
use statistics::likelihood::Likelihood;

/// Descents of the base (`None`) or of candidates.
#[derive(Debug, Clone)]
pub(crate) struct Fleet {
    pub(crate) descents: Vec<(Option<usize>, Descent)>,
    /// How many evaluations each waits for.
    waiting: Vec<usize>,
}

impl Fleet {
    pub(crate) fn new(descents: Vec<(Option<usize>, Descent)>) -> Self {
        Self {
            descents,
            waiting: Vec::new(),
        }
    }

    /// Whose positions are to be evaluated next; none when all are done.
    pub(crate) fn ask(&mut self, likelihood: &Likelihood) -> Vec<(Option<usize>, Vec<f64>)> {
        let mut asked = Vec::new();
        self.waiting.clear();
        for (candidate, descent) in &mut self.descents {
            let positions = descent.ask(likelihood);
            self.waiting.push(positions.len());
            asked.extend(positions.into_iter().map(|position| (*candidate, position)));
        }
        asked
    }

    /// Takes the answers in the order of the positions.
    pub(crate) fn tell(&mut self, likelihood: &Likelihood, answers: Vec<Option<Vec<f64>>>) {
        let mut answers = answers.into_iter();
        for ((_, descent), count) in self.descents.iter_mut().zip(&self.waiting) {
            if *count > 0 {
                descent.tell(likelihood, answers.by_ref().take(*count).collect());
            }
        }
    }

    /// Evaluations spent by all.
    pub(crate) fn evaluations(&self) -> usize {
        self.descents.iter().map(|(_, descent)| descent.evaluations).sum()
    }
}
