//! The search for one missing effect: each candidate effect, added to the base model, is compared with the base model by its evidence.
//!
//! Nothing runs the model here. `EffectSearch` asks for a round of predictions and, told all of them, moves on to the next phase
//! (`EffectSearch::advance`). The phases follow docs/discovery.md, steps 1 to 5:
//!
//! 1. **Base.** Starts that fill the prior are evaluated (`base::starts`), and fits begin at the best (`take_base_starts`,
//!    `fit_base`). For a rough model, predictions along a line through the best fit give the numerical noise (`measure_noise`,
//!    `take_noise`), which is added to the noise of the data before the fit continues (`continue_base`).
//! 2. **Screen.** Each candidate is evaluated at a few strengths and shapes about the base's fit (`screen`, `take_screen`). Its log
//!    Bayes factor is that of the model linear in the strength, after projection out of the changes that the base can imitate. If a
//!    rough model has a low-fidelity model, that screens all candidates first (`screen_low_fidelity`, `take_low_fidelity_screen`), and
//!    only the best are screened on the model.
//! 3. **Extensions.** The best candidates are fitted together with the base, by Gauss-Newton steps with Broyden's update of the Jacobian
//!    (`begin_extensions`, `fit_extensions`). With an unknown discrepancy and a smooth model, a fit with a reduced discrepancy precedes
//!    (`fit_reduced_discrepancy`). Candidates whose screen promises a part of the best result are fitted next (`fit_within_reach`).
//! 4. **Refinement.** The best few are fitted again with new derivatives (`refine`).
//! 5. **Confirmation.** The best, and all near them, are fitted from several starts (`unconfirmed`, `begin_confirmation`,
//!    `take_confirmation_starts`, `confirm`). Where Laplace's approximation is uncertain, importance sampling replaces it (`samplers`,
//!    `sample`, `take_sample`). The ranking with classes and probabilities ends the search (`finish`).
//!
//! A fit itself is `laplace::fit`. How much each phase spends is a `Depth`: for the whole library of a smooth or a rough model, and
//! shorter for one more effect beyond a combination, for curves and for simple forms.
//!
//! # Layout
//! - `search`: the interface. `state`: the state and the phases. `phases`: the functions of each phase. `depth`: how much a search spends.
//! - `base`, `screen`, `extension`, `confirmation`: the positions or fits of one phase. `low_fidelity_screen`: the screen by a
//!   control variate. `numerical_noise`: its measurement.
//! - `selection`: which candidates are kept, confirmed and ranked. `sampling`: which evidences are sampled. `ranking`: the result.
//! - `projection`: changes of the predictions beyond those of the base. `class`: effects that the data cannot distinguish.

pub(crate) mod base;
pub(crate) mod class;
mod confirmation;
pub(crate) mod depth;
mod extension;
mod low_fidelity_screen;
mod numerical_noise;
mod phases;
pub(crate) mod projection;
pub(crate) mod ranking;
mod sampling;
mod screen;
pub(crate) mod search;
mod selection;
pub(crate) mod state;
