//! The depth of a search: which candidates each phase fits, and by which plans of steps.

use crate::laplace::fit::{FitStep, LaplaceFit};
use crate::settings::Smoothness;

/// The depth of a search, phase by phase.
#[derive(Debug)]
pub(crate) struct Depth {
    pub(crate) base: BaseDepth,
    pub(crate) screen: ScreenDepth,
    pub(crate) extension: ExtensionDepth,
    pub(crate) refinement: RefinementDepth,
    /// A candidate whose log Bayes factor, by screen and fit, lies further below that of the best fit, and below a quarter of it, is neither
    /// fitted nor refined \[nats\]; before the first fits, that of the best screen counts. `None`: every candidate may be.
    pub(crate) within: Option<f64>,
    /// `None`: the search ends with the refinement.
    pub(crate) confirmation: Option<ConfirmationDepth>,
}

/// The fits of the base before its numerical noise is known.
#[derive(Debug, Clone, Copy)]
pub(crate) struct BaseDepth {
    pub(crate) plan: &'static [FitStep],
    /// How many of these fits, the most probable, continue once the noise is known.
    pub(crate) max_continued: usize,
}

/// The grid of the screen.
#[derive(Debug, Clone, Copy)]
pub(crate) struct ScreenDepth {
    /// Steps of a single strength, in standard deviations of its prior, the longest first. An effect that acts like a square root
    /// near zero shows its size at short steps only.
    pub(crate) strengths: &'static [f64],
    /// Coordinates of the shapes; several shapes have the same coordinate, unless `second_shapes` has others.
    pub(crate) shapes: &'static [f64],
    /// Coordinates of the second of two shapes, each combined with each of the first. Empty: the second has that of the first.
    pub(crate) second_shapes: &'static [f64],
    /// How many candidates, the best of a screen without the model, are screened on it.
    pub(crate) max_on_model: usize,
}

/// The first fits of candidates.
#[derive(Debug, Clone, Copy)]
pub(crate) struct ExtensionDepth {
    /// How many candidates, the best of the screen, are fitted in any case.
    pub(crate) max_count: usize,
    /// A further candidate is fitted if its screened log Bayes factor exceeds this share of the best fitted one, or of a detection: the screen is
    /// linear and may find too little, but rarely a quarter of the right value. `None`: no further candidates.
    pub(crate) reach: Option<f64>,
    pub(crate) plan: &'static [FitStep],
    /// Whether shapes are held at the screen's values at first: between two levels of a design a threshold changes nothing, so a
    /// finite difference of a shape has no information.
    pub(crate) holds_shapes: bool,
}

/// The second fits of the best candidates, with new derivatives.
#[derive(Debug, Clone, Copy)]
pub(crate) struct RefinementDepth {
    pub(crate) max_count: usize,
    pub(crate) plan: &'static [FitStep],
}

/// The fits of the best candidates from several starts.
#[derive(Debug)]
pub(crate) struct ConfirmationDepth {
    /// How many candidates are confirmed at most, unless the best fit contradicts the data.
    pub(crate) max_count: usize,
    /// A candidate whose fitted or screened log Bayes factor lies within this distance of the best is confirmed too, because a fit
    /// that has not converged may be the best \[nats\].
    pub(crate) within: f64,
    /// The same distance where a parameter of the base lies at a bound \[nats\].
    pub(crate) within_if_pressed: f64,
    /// Whether uncertain evidences are computed by importance sampling. The weights of a rough model scatter as its log-likelihood
    /// does, so that few draws dominate.
    pub(crate) samples: bool,
    pub(crate) usual: Confirmation,
    /// Used where the best fit contradicts the data: a fit that is far off says little about its rank.
    pub(crate) if_wrong: Confirmation,
}

/// The confirmation of one candidate.
#[derive(Debug)]
pub(crate) struct Confirmation {
    /// How many candidates, the best, are confirmed in any case.
    pub(crate) min_count: usize,
    /// How many starts of a candidate, the most probable, are fitted.
    pub(crate) max_starts: usize,
    pub(crate) plan: &'static [FitStep],
    /// Whether these fits begin with the Jacobian of the candidate's best fit.
    pub(crate) keeps_jacobian: bool,
}

impl Confirmation {
    /// Continues a fit by the plan of this confirmation.
    pub(crate) fn continued(&self, fit: &LaplaceFit) -> LaplaceFit {
        if self.keeps_jacobian {
            fit.continued(self.plan)
        } else {
            fit.measured_again(self.plan)
        }
    }
}

impl Depth {
    /// Returns the depth of the search for one effect of the library.
    pub(crate) fn for_smoothness(smoothness: Smoothness) -> &'static Self {
        match smoothness {
            Smoothness::Smooth => &FULL,
            Smoothness::Rough | Smoothness::Unknown => &SPARING,
        }
    }
}

/// The final fit of the base. It ends once a new Jacobian predicts no gain: every candidate is compared with this fit.
pub(crate) const BASE_PLAN: [FitStep; 2] = [FitStep::Rounds { max: 6, trials: 12 }, FitStep::Differences];

/// Fits as thorough as that of the base.
const THOROUGH: Confirmation = Confirmation {
    min_count: 4,
    max_starts: 6,
    plan: &[FitStep::Rounds { max: 3, trials: 12 }, FitStep::Differences],
    keeps_jacobian: false,
};

/// The linear screen finds at least this share of a log Bayes factor, with rare exceptions.
pub(crate) const MIN_SCREENED_SHARE: f64 = 0.25;

/// All candidates of a smooth model are fitted, and the best are confirmed.
pub(crate) const FULL: Depth = Depth {
    base: BaseDepth {
        plan: &BASE_PLAN,
        max_continued: usize::MAX,
    },
    screen: ScreenDepth {
        strengths: &[1.0, 0.3, 0.1],
        shapes: &[0.0, -1.0, 1.0],
        second_shapes: &[],
        max_on_model: usize::MAX,
    },
    extension: ExtensionDepth {
        max_count: usize::MAX,
        reach: None,
        // Broyden's steps alone, the first to the linear solution.
        plan: &[FitStep::Trials(9)],
        holds_shapes: false,
    },
    refinement: RefinementDepth {
        max_count: 3,
        plan: &[FitStep::Differences, FitStep::Trials(6)],
    },
    within: None,
    confirmation: Some(ConfirmationDepth {
        max_count: usize::MAX,
        within: 10.0,
        within_if_pressed: 30.0,
        samples: true,
        usual: THOROUGH,
        if_wrong: THOROUGH,
    }),
};

/// The best candidates of a rough model are fitted: its evaluations are expensive, and its evidences no sharper than its noise.
const SPARING: Depth = Depth {
    base: BaseDepth {
        plan: &[FitStep::Rounds { max: 2, trials: 6 }],
        max_continued: 1,
    },
    screen: ScreenDepth {
        strengths: &[1.0, 0.3],
        max_on_model: 8,
        ..FULL.screen
    },
    extension: ExtensionDepth {
        max_count: 8,
        reach: Some(MIN_SCREENED_SHARE),
        plan: &[FitStep::Trials(6)],
        ..FULL.extension
    },
    confirmation: Some(ConfirmationDepth {
        max_count: 8,
        within: 5.0,
        within_if_pressed: 5.0,
        samples: false,
        usual: Confirmation {
            min_count: 2,
            max_starts: 2,
            plan: &[
                FitStep::Trials(6),
                FitStep::Differences,
                FitStep::Trials(4),
                FitStep::Differences,
            ],
            keeps_jacobian: true,
        },
        if_wrong: Confirmation {
            max_starts: 3,
            ..THOROUGH
        },
    }),
    ..FULL
};

/// A further effect beyond one of the best combinations. Nothing is confirmed, so the refinement must converge.
pub(crate) const QUICK: Depth = Depth {
    screen: ScreenDepth {
        max_on_model: 48,
        ..FULL.screen
    },
    extension: ExtensionDepth {
        max_count: 8,
        ..FULL.extension
    },
    refinement: RefinementDepth {
        max_count: 5,
        plan: &[FitStep::Rounds { max: 3, trials: 8 }],
    },
    within: Some(8.0),
    confirmation: None,
    ..FULL
};

/// A further effect of a rough model beyond one of the best combinations.
const SPARING_QUICK: Depth = Depth {
    screen: ScreenDepth {
        max_on_model: 4,
        ..SPARING.screen
    },
    extension: ExtensionDepth {
        max_count: 4,
        reach: None,
        ..SPARING.extension
    },
    refinement: RefinementDepth {
        max_count: 2,
        plan: &[FitStep::Rounds { max: 2, trials: 6 }],
    },
    confirmation: None,
    ..SPARING
};

/// A further effect beyond a set of a lower rank, in a wide beam or beside a law, by a shorter screen.
pub(crate) const GLANCE: Depth = Depth {
    screen: ScreenDepth {
        strengths: &[1.0, 0.3],
        shapes: &[0.0],
        max_on_model: 24,
        ..FULL.screen
    },
    extension: ExtensionDepth {
        max_count: 6,
        ..QUICK.extension
    },
    refinement: RefinementDepth {
        max_count: 2,
        ..QUICK.refinement
    },
    ..QUICK
};

/// All curves outside the library, where the misfit is too large for the linear screen.
const ALL_CURVES: Depth = Depth {
    extension: ExtensionDepth {
        max_count: usize::MAX,
        ..QUICK.extension
    },
    within: None,
    ..QUICK
};

impl Depth {
    /// Returns the depth of the search for a further effect beyond a combination.
    pub(crate) fn beyond(smoothness: Smoothness) -> &'static Self {
        match smoothness {
            Smoothness::Smooth => &QUICK,
            Smoothness::Rough | Smoothness::Unknown => &SPARING_QUICK,
        }
    }

    /// Returns the depth of the search for a curve.
    ///
    /// # Arguments
    /// - `is_wrong`: whether the best fit so far contradicts the data, so that the linear screen is not reliable; all curves of a
    ///   rough model would cost too much even then.
    pub(crate) fn of_curves(smoothness: Smoothness, is_wrong: bool) -> &'static Self {
        match smoothness {
            Smoothness::Rough | Smoothness::Unknown => &SPARING_QUICK,
            Smoothness::Smooth if is_wrong => &ALL_CURVES,
            Smoothness::Smooth => &QUICK,
        }
    }

    /// Returns the depth of the search for curve and form of one law beside effects.
    pub(crate) fn of_law(smoothness: Smoothness) -> &'static Self {
        match smoothness {
            Smoothness::Smooth => &ONE_LAW,
            Smoothness::Rough | Smoothness::Unknown => &SPARING_FORMS,
        }
    }

    /// Returns the depth of the search for the forms of the best laws.
    pub(crate) fn of_forms(smoothness: Smoothness) -> &'static Self {
        match smoothness {
            Smoothness::Smooth => &FORMS,
            Smoothness::Rough | Smoothness::Unknown => &SPARING_FORMS,
        }
    }
}

/// Simple forms, with thresholds and centres at about every tenth of their priors, and three widths at each centre.
const FORMS: Depth = Depth {
    screen: ScreenDepth {
        shapes: &[0.0, -0.25, 0.25, -0.55, 0.55, -0.85, 0.85, -1.3, 1.3],
        second_shapes: &[0.0, -1.0, 1.0],
        ..FULL.screen
    },
    extension: ExtensionDepth {
        max_count: 16,
        plan: &[
            FitStep::Trials(6),
            FitStep::Release,
            FitStep::Differences,
            FitStep::Trials(6),
        ],
        holds_shapes: true,
        ..FULL.extension
    },
    within: QUICK.within,
    confirmation: None,
    ..FULL
};

/// Curve and forms of one law. Without a fit of its curve a law is not kept.
const ONE_LAW: Depth = Depth {
    within: None,
    ..FORMS
};

/// Simple forms of the laws of a rough model.
const SPARING_FORMS: Depth = Depth {
    screen: ScreenDepth {
        max_on_model: 8,
        ..FORMS.screen
    },
    extension: ExtensionDepth {
        max_count: 6,
        ..FORMS.extension
    },
    refinement: SPARING_QUICK.refinement,
    within: None,
    ..FORMS
};

/// Formulas of a located law, with positive strengths. Half a standard deviation is the strength that the curve has, and the constants have
/// the values of the curve in the middle of their priors, so that a fit begins near its end.
pub(crate) const FORMULAS: Depth = Depth {
    screen: ScreenDepth {
        strengths: &[0.5],
        shapes: &[0.0],
        ..FULL.screen
    },
    extension: ExtensionDepth {
        plan: &[FitStep::Rounds { max: 2, trials: 6 }],
        ..FULL.extension
    },
    refinement: RefinementDepth {
        max_count: 16,
        plan: &[FitStep::Rounds { max: 3, trials: 8 }],
    },
    confirmation: None,
    ..FULL
};
