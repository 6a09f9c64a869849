//! What is to be searched.

use crate::candidate::Candidate;
use crate::settings::Settings;
use statistics::likelihood::Likelihood;
use statistics::prior::Marginal;

/// A search for what a model is missing.
#[derive(Debug, Clone)]
pub struct Task {
    /// Priors of the model's parameters, independent; noise sds that are inferred among them.
    pub prior: Vec<Marginal>,
    /// The data.
    pub likelihood: Likelihood,
    /// The effects that may be missing.
    pub library: Vec<Candidate>,
    /// The laws outside the library.
    pub pairs: Vec<Pair>,
    /// The model without one of its effects, for each that may be dropped.
    pub reductions: Vec<Reduction>,
    /// The data of each level of the design, to be left out together.
    pub levels: Vec<Vec<usize>>,
    /// Runs that the rig could make.
    pub proposed: Proposed,
    /// Most effects that are looked for together.
    pub max_effects: usize,
    /// Starts and seed.
    pub settings: Settings,
}

/// A quantity that may depend on a variable in a way that no effect of the library has.
#[derive(Debug, Clone)]
pub struct Pair {
    /// The dependence as a curve: every parameter is the strength of a knot.
    pub curve: Candidate,
    /// The same by simple forms.
    pub forms: Vec<Candidate>,
    /// Whether it changes what is measured and not what brings it about: a description, and no explanation where there is one.
    pub is_description: bool,
}

/// The model without one of its effects.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Reduction {
    /// The base's parameters that are left, by index.
    pub parameters: Vec<usize>,
}

/// Runs that were not made yet.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Proposed {
    /// How many.
    pub runs: usize,
    /// Which runs are much alike: of each group at most one is proposed. One entry for each run.
    pub groups: Vec<usize>,
    /// Noise sd of each channel that the rig measures, in its unit.
    pub noise_sds: Vec<f64>,
}

impl Proposed {
    /// Number of values that answer for all runs: each channel of the first, then of the next.
    pub(super) fn values(&self) -> usize {
        self.runs * self.noise_sds.len()
    }
}

impl Task {
    /// Every candidate: the library, then for each pair its curve and its forms. Their positions name them.
    #[must_use]
    pub fn candidates(&self) -> Vec<Candidate> {
        let pairs = self.pairs.iter();
        let outside = pairs.flat_map(|pair| std::iter::once(&pair.curve).chain(&pair.forms));
        self.library.iter().chain(outside).cloned().collect()
    }

    /// The position of a pair's curve; its forms follow.
    pub(super) fn curve(&self, pair: usize) -> usize {
        let before = self.pairs[..pair].iter().map(|pair| 1 + pair.forms.len());
        self.library.len() + before.sum::<usize>()
    }
}
