//! The task of a discovery: a model, its data, the candidates and the runs that the rig could make.

use crate::candidate::Candidate;
use crate::laplace::coordinate::NormalFrame;
use crate::laplace::fit::LaplaceFit;
use crate::probability::DETECTED;
use crate::settings::SearchSettings;
use crate::suspected_error::SuspectedError;
use statistics::likelihood::Likelihood;
use statistics::prior::Prior;

/// A search for what a model is missing.
#[derive(Debug, Clone)]
pub struct SearchTask {
    /// Prior of the model's parameters; inferred noise sds are among them.
    pub prior: Prior,
    /// The data with their error model.
    pub likelihood: Likelihood,
    /// The effects that may be missing.
    pub library: Vec<Candidate>,
    /// Laws outside the library.
    pub laws: Vec<LawCandidate>,
    /// Indices of the model's parameters that are strengths of effects which it has.
    pub strengths: Vec<usize>,
    /// The model without one of its effects, for each effect that may be dropped.
    pub reductions: Vec<Reduction>,
    /// The data of each level of the design, left out together in the cross-validation.
    pub levels: Vec<Vec<usize>>,
    /// The data of each condition of the rig; repeated runs are one condition.
    pub conditions: Vec<Vec<usize>>,
    /// Runs that the rig could make.
    pub proposed: ProposedRuns,
    /// Errors that runs may share, beyond those of the likelihood: each is judged beside the best explanation.
    pub suspected_errors: Vec<SuspectedError>,
    /// Maximum number of effects in a combination.
    pub max_effects: usize,
    /// Starts, seed and properties of the model.
    pub settings: SearchSettings,
}

/// A quantity that may depend on a variable in a way that no effect of the library has.
#[derive(Debug, Clone)]
pub struct LawCandidate {
    /// The dependence as a curve: every parameter is the strength of a knot.
    pub curve: Candidate,
    /// The dependence in simple forms.
    pub forms: Vec<Candidate>,
    /// Whether the law changes a measured channel instead of a stress. Such a law describes what a change of the physics may explain:
    /// it has lower prior odds, and is claimed only if every explanation without such a law falls short by far.
    pub is_description: bool,
}

/// The model without one of its effects.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Reduction {
    /// The parameters of the model that remain, by index, ascending. Every inferred sd of the likelihood must be among them; without one,
    /// the reduction is not fitted.
    pub parameters: Vec<usize>,
    /// The effects of the library that the model may have in the place of this one.
    pub substitutes: Vec<usize>,
}

/// Runs that could be made next.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct ProposedRuns {
    /// Number of the runs.
    pub runs: usize,
    /// How far each run lies beyond the measured range of wheel load and rim speed: the logarithm of the ratio, 0 within the range.
    pub beyond: Vec<f64>,
    /// The measured channels, by their index in the data.
    pub channels: Vec<usize>,
    /// Noise sd of each measured channel, in its unit.
    pub noise_sds: Vec<f64>,
}

impl ProposedRuns {
    /// Returns the number of predicted values: each channel of the first run, then of the next.
    pub(crate) fn values(&self) -> usize {
        self.runs * self.noise_sds.len()
    }
}

impl SearchTask {
    /// Returns all candidates: the library, then the curve and the forms of each law. Other items name a candidate by its index
    /// in this list.
    #[must_use]
    pub fn candidates(&self) -> Vec<Candidate> {
        let outside = self
            .laws
            .iter()
            .flat_map(|law| std::iter::once(&law.curve).chain(&law.forms));
        self.library.iter().chain(outside).cloned().collect()
    }

    /// Returns the strength of a library effect of a fit that contradicts its prior, and its coordinate. The prior of a law is no
    /// knowledge about it.
    ///
    /// # Arguments
    /// - `members`: the candidates of the fit, in its order. `is_claimed`: whether the strength of a candidate counts.
    pub(crate) fn implausible_strength(
        &self,
        fit: &LaplaceFit,
        members: &[usize],
        is_claimed: impl Fn(usize) -> bool,
    ) -> Option<(usize, f64)> {
        let candidates = self.candidates();
        let single = members.iter().filter(|k| candidates[**k].strengths.len() == 1);
        let counts: Vec<bool> = single.map(|k| !self.is_law(*k) && is_claimed(*k)).collect();
        fit.frame.implausible_strength(&fit.point.position, &counts)
    }

    /// Returns the likelihood of a reduction; `None` if the reduction lacks the parameter of an inferred sd.
    pub(crate) fn reduced_likelihood(&self, reduction: &Reduction) -> Option<Likelihood> {
        self.likelihood.with_parameters(&reduction.parameters).ok()
    }

    /// Returns the coordinates of the base.
    pub(crate) fn frame(&self) -> NormalFrame {
        NormalFrame::base(&self.prior, self.settings.smoothness)
            .with_low_fidelity(self.settings.has_low_fidelity)
    }

    /// Returns the index of a law's curve among the candidates.
    pub(crate) fn curve(&self, law: usize) -> usize {
        let before = self.laws[..law].iter().map(|law| 1 + law.forms.len());
        self.library.len() + before.sum::<usize>()
    }

    /// Returns indices of a law's forms among the candidates.
    pub(crate) fn forms(&self, law: usize) -> std::ops::Range<usize> {
        let first = self.curve(law) + 1;
        first..first + self.laws[law].forms.len()
    }

    /// Returns the log prior odds of a law that changes a stress over this law \[nats\].
    pub(crate) fn handicap(&self, law: usize) -> f64 {
        if self.laws[law].is_description {
            DETECTED
        } else {
            0.0
        }
    }

    /// Returns whether no member of a set is a law that changes a measured channel.
    pub(crate) fn is_physical(&self, members: &[usize]) -> bool {
        let mut laws = members.iter().filter_map(|k| self.law_of(*k));
        laws.all(|law| !self.laws[law].is_description)
    }

    /// Returns the effects of a set that change the quantity of a law of the set: law and effect may be factors of one law of two
    /// variables.
    pub(crate) fn factors_of_law(&self, members: &[usize]) -> Vec<usize> {
        let laws: Vec<usize> = members.iter().filter_map(|k| self.law_of(*k)).collect();
        let of_library = members.iter().copied().filter(|k| !self.is_law(*k));
        of_library
            .filter(|k| {
                let mut laws = laws.iter();
                laws.any(|law| self.library[*k].shares_quantity(&self.laws[*law].curve))
            })
            .collect()
    }

    /// Returns whether a candidate is a law outside the library.
    pub(crate) fn is_law(&self, candidate: usize) -> bool {
        candidate >= self.library.len()
    }

    /// Returns the law whose curve or form a candidate is; `None` for an effect of the library.
    pub(crate) fn law_of(&self, candidate: usize) -> Option<usize> {
        (0..self.laws.len()).find(|&law| candidate == self.curve(law) || self.forms(law).contains(&candidate))
    }
}
