//! How far a search goes, and the plans of its fits.

use crate::effect_search::base;
use crate::laplace::fit::{FitStep, LaplaceFit};
use crate::settings::Roughness;

/// The confirmation of a model from several starts.
#[derive(Debug)]
pub(crate) struct Confirmation {
    /// How many models are confirmed in any case, the best.
    pub(crate) least: usize,
    /// Most starts of a model from which a fit continues, the most probable.
    pub(crate) most_starts: usize,
    /// The plan of these fits.
    pub(crate) plan: &'static [FitStep],
    /// Whether they begin with the Jacobian of the model's best fit.
    pub(crate) keeps_jacobian: bool,
}

impl Confirmation {
    /// The fit continued by this plan.
    pub(crate) fn continued(&self, fit: &LaplaceFit) -> LaplaceFit {
        if self.keeps_jacobian {
            fit.continued(self.plan)
        } else {
            fit.measured_again(self.plan)
        }
    }
}

/// As thorough as the base's fit.
const THOROUGH: Confirmation = Confirmation {
    least: 4,
    most_starts: 6,
    plan: &[FitStep::Rounds { most: 3, trials: 12 }, FitStep::Differences],
    keeps_jacobian: false,
};

/// How far a search goes.
#[derive(Debug)]
pub(crate) struct Depth {
    /// The plan of the base's fits before the numerical noise is known, and how many of them go on after that, the best.
    pub(crate) base: &'static [FitStep],
    pub(crate) most_bases: usize,
    /// Steps of a single strength that the screen tries, in standard deviations of its prior, the longest first. An effect that acts
    /// like a square root near zero shows its size at short steps only.
    pub(crate) strengths: &'static [f64],
    /// How many candidates are fitted, the best of the screen.
    pub(crate) most_extended: usize,
    /// Of the others, those are fitted to which the screen promises more than this share of the best fit's log Bayes factor: the screen
    /// is linear and may promise too little, but not four times too little. `None`: no others.
    pub(crate) reach: Option<f64>,
    /// Coordinates of the shape parameters that the screen tries.
    pub(crate) shapes: &'static [f64],
    /// The plan of an extension's fit.
    pub(crate) extension: &'static [FitStep],
    /// Whether shapes are held at the screen's values at first: between two levels of a design a threshold changes nothing, so a
    /// finite difference of a shape has no information.
    pub(crate) holds_shapes: bool,
    /// How many of the best are polished, and the plan of that fit.
    pub(crate) most_polished: usize,
    pub(crate) polish: &'static [FitStep],
    /// Whether the best are confirmed from several starts, and whether doubtful evidences are sampled: the weights of a rough model
    /// scatter as its log-likelihood does, so that few draws stand for all.
    pub(crate) confirms: bool,
    /// Whatever lies, or promises to lie, within so many nats of the best is confirmed, too: a fit that stuck may lead.
    pub(crate) within: f64,
    pub(crate) samples: bool,
    /// How a model is confirmed, and how where the best fit contradicts the data: a fit that is far off tells little of its rank.
    pub(crate) confirmation: Confirmation,
    pub(crate) confirmation_if_wrong: Confirmation,
}

impl Depth {
    /// Of the search for one effect.
    pub(crate) fn of(roughness: Roughness) -> &'static Self {
        match roughness {
            Roughness::Smooth => &FULL,
            Roughness::Rough | Roughness::Unknown => &SPARING,
        }
    }
}

/// Every candidate, confirmed.
pub(crate) const FULL: Depth = Depth {
    base: &base::PLAN,
    most_bases: usize::MAX,
    strengths: &[1.0, 0.3, 0.1],
    most_extended: usize::MAX,
    reach: None,
    shapes: &[0.0, -1.0, 1.0],
    // Broyden's steps alone, the first to the linear solution.
    extension: &[FitStep::Trials(9)],
    holds_shapes: false,
    most_polished: 3,
    polish: &[FitStep::Differences, FitStep::Trials(6)],
    confirms: true,
    within: 10.0,
    samples: true,
    confirmation: THOROUGH,
    confirmation_if_wrong: THOROUGH,
};

/// Every candidate of a rough model, whose evaluations are dear and whose evidences are no sharper than its scatter.
pub(crate) const SPARING: Depth = Depth {
    base: &[FitStep::Rounds { most: 2, trials: 6 }],
    most_bases: 1,
    strengths: &[1.0, 0.3],
    most_extended: 8,
    reach: Some(0.25),
    extension: &[FitStep::Trials(6)],
    within: 5.0,
    samples: false,
    confirmation: Confirmation {
        least: 2,
        most_starts: 2,
        plan: &[
            FitStep::Trials(6),
            FitStep::Differences,
            FitStep::Trials(4),
            FitStep::Differences,
        ],
        keeps_jacobian: true,
    },
    confirmation_if_wrong: Confirmation {
        most_starts: 3,
        ..THOROUGH
    },
    ..FULL
};

/// The best of the screen, fitted and polished.
pub(crate) const QUICK: Depth = Depth {
    most_extended: 8,
    // Nothing is confirmed, so these fits must converge.
    most_polished: 5,
    polish: &[FitStep::Rounds { most: 3, trials: 8 }],
    confirms: false,
    ..FULL
};

/// The best of a shorter screen, from which few promise more.
pub(crate) const GLANCE: Depth = Depth {
    strengths: &[1.0, 0.3],
    most_extended: 6,
    shapes: &[0.0],
    most_polished: 2,
    ..QUICK
};

/// The best curves outside the library, where the misfit is small and the linear screen reliable.
pub(crate) const CURVES: Depth = Depth {
    most_extended: 8,
    ..QUICK
};

/// All curves, where the misfit is too large for the linear screen.
pub(crate) const ALL_CURVES: Depth = Depth {
    most_extended: usize::MAX,
    ..QUICK
};

/// Simple forms, with thresholds at about every tenth of their priors.
pub(crate) const FORMS: Depth = Depth {
    most_extended: 12,
    shapes: &[0.0, -0.25, 0.25, -0.55, 0.55, -0.85, 0.85, -1.3, 1.3],
    extension: &[
        FitStep::Trials(6),
        FitStep::Release,
        FitStep::Differences,
        FitStep::Trials(6),
    ],
    holds_shapes: true,
    confirms: false,
    ..FULL
};
