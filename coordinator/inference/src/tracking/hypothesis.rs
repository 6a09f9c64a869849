//! Filters that share the time of the last new draw, one for each size of the walk.

use nalgebra::DVector;

use super::gaussian::Gaussian;
use super::linearisation::Linearisation;

/// Largest number of linearisations for one block.
const MAX_LINEARISATIONS: usize = 5;

/// A filter with its weight.
#[derive(Debug, Clone)]
pub(super) struct Member {
    pub(super) state: Gaussian,
    pub(super) weight: f64,
}

/// The filters of one time of the last new draw.
#[derive(Debug, Clone)]
pub(super) struct Hypothesis {
    /// Number of the block before which the parameters were drawn anew; 0: never.
    pub(super) born: usize,
    /// A filter for each size of the walk.
    pub(super) members: Vec<Member>,
}

impl Hypothesis {
    pub(super) fn weight(&self) -> f64 {
        self.members.iter().map(|member| member.weight).sum()
    }

    /// Returns the filter with the largest weight.
    pub(super) fn leader(&self) -> &Member {
        let first = &self.members[0];
        self.members
            .iter()
            .fold(first, |best, member| match member.weight > best.weight {
                true => member,
                false => best,
            })
    }

    /// Makes the weights of the sizes more even, as time makes what was learnt of them uncertain.
    ///
    /// # Arguments
    /// - `power`: to which the weights are raised, in (0, 1].
    pub(super) fn forget(&mut self, power: f64) {
        let total = self.weight();
        if total <= 0.0 {
            return;
        }
        for member in &mut self.members {
            member.weight = libm::pow(member.weight / total, power);
        }
        let scale = total / self.weight();
        self.members.iter_mut().for_each(|member| member.weight *= scale);
    }

    /// Takes measured values. Returns the log-density of these by each filter; `None` if the model refuses the hypothesis.
    ///
    /// The model is linearised over the distribution of the leading filter after the values, which is searched by repetition.
    pub(super) fn update(
        &mut self,
        values: &DVector<f64>,
        variances: &DVector<f64>,
        model: &mut dyn FnMut(&DVector<f64>) -> Option<Vec<f64>>,
    ) -> Option<Vec<f64>> {
        let before = self.leader().state.clone();
        let mut linear = Linearisation::over(&before, model)?;
        let mut over = before.clone();
        for _ in 1..MAX_LINEARISATIONS {
            let (after, _) = before.updated(&linear, values, variances)?;
            if over.is_near(&after) {
                break;
            }
            // Where the model refuses the new distribution, the last one stands.
            let Some(next) = Linearisation::over(&after, model) else {
                break;
            };
            (linear, over) = (next, after);
        }
        let mut log_densities = Vec::with_capacity(self.members.len());
        for member in &mut self.members {
            let (state, log_density) = member.state.updated(&linear, values, variances)?;
            member.state = state;
            log_densities.push(log_density);
        }
        Some(log_densities)
    }
}
