//! How far a search goes, and the plans of its fits.

use crate::laplace::fit::FitStep;

/// How far a search goes.
#[derive(Debug)]
pub(crate) struct Depth {
    /// How many candidates are fitted, the best of the screen.
    pub(crate) most_extended: usize,
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
    /// Whether the best are confirmed from several starts, and by importance sampling.
    pub(crate) confirms: bool,
}

/// Every candidate, confirmed.
pub(crate) const FULL: Depth = Depth {
    most_extended: usize::MAX,
    shapes: &[0.0, -1.0, 1.0],
    // Broyden's steps alone, the first to the linear solution.
    extension: &[FitStep::Trials(9)],
    holds_shapes: false,
    most_polished: 3,
    polish: &[FitStep::Differences, FitStep::Trials(6)],
    confirms: true,
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
