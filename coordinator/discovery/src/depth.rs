//! How deep a search goes.

use crate::descent::Step;
use crate::{extension, polish};

/// How deep a search goes.
#[derive(Debug)]
pub(crate) struct Depth {
    /// How many candidates are fitted, the most promising of the screen.
    pub(crate) most_extended: usize,
    /// Coordinates of shape parameters that the screen tries.
    pub(crate) shapes: &'static [f64],
    /// How an extension is fitted.
    pub(crate) plan: &'static [Step],
    /// Whether shapes stay where the screen has them at first: between two levels of a design a threshold changes nothing, so a
    /// difference of shapes leads nowhere.
    pub(crate) holds_shapes: bool,
    /// How many of the best are polished, and how.
    pub(crate) polished: usize,
    pub(crate) polish: &'static [Step],
    /// Whether the best are confirmed from several starts, and by draws.
    pub(crate) confirms: bool,
}

/// Every candidate, confirmed.
pub(crate) const WHOLE: Depth = Depth {
    most_extended: usize::MAX,
    shapes: &[0.0, -1.0, 1.0],
    plan: &extension::PLAN,
    holds_shapes: false,
    polished: 3,
    polish: &polish::PLAN,
    confirms: true,
};

/// The most promising, fitted and polished.
pub(crate) const QUICK: Depth = Depth {
    most_extended: 8,
    // Nothing is confirmed, so that what is kept must have come to its end.
    polished: 5,
    polish: &polish::TWICE,
    confirms: false,
    ..WHOLE
};

/// Curves outside the library, where it leaves little misfit: their screen is linear and sees that much.
pub(crate) const CURVES: Depth = Depth {
    most_extended: 8,
    ..QUICK
};

/// All of them, where the misfit is beyond what is linear.
pub(crate) const ALL_CURVES: Depth = Depth {
    most_extended: usize::MAX,
    ..QUICK
};

/// Simple forms, whose thresholds are tried at about every tenth of their priors.
pub(crate) const FORMS: Depth = Depth {
    most_extended: 12,
    shapes: &[0.0, -0.25, 0.25, -0.55, 0.55, -0.85, 0.85, -1.3, 1.3],
    plan: &extension::HELD,
    holds_shapes: true,
    confirms: false,
    ..WHOLE
};
