//! The search for one missing effect (steps 1 to 5 of docs/discovery.md): each candidate effect, added to the base model, is
//! compared with the base model by its evidence.
//!
//! Nothing runs the model here. `EffectSearch` asks for a round of predictions and, told all of them, moves on to the next phase
//! (`ask_tell`). Each phase has a file with the rounds that it asks for:
//!
//! 1. **Base** (`base`). Starts that fill the prior are evaluated, and fits begin at the best. For a rough model, predictions
//!    along a line through the best fit give the numerical noise (`numerical_noise`), which is added to the noise of the data
//!    before the fit continues.
//! 2. **Screen** (`screen`). Each candidate is evaluated at a few strengths and shapes about the base's fit. Its log Bayes factor
//!    (`screen_result`) is that of the model linear in the strength, after projection out of the changes that the base can imitate. If
//!    a rough model has a low-fidelity model, that screens all candidates first (`low_fidelity_screen`), and only the best are
//!    screened on the model.
//! 3. **Extensions** (`extension`). The best candidates are fitted together with the base, by Gauss-Newton steps with Broyden's
//!    update of the Jacobian. With an unknown discrepancy and a smooth model, a fit with a reduced discrepancy precedes.
//!    Candidates whose screened log Bayes factor exceeds a share of the best one are fitted next; beyond a combination, those far below the
//!    best are left out.
//! 4. **Refinement** (`refinement`). The best few are fitted again with new derivatives.
//! 5. **Confirmation** (`confirmation`). The best, and all near them, are fitted from several starts. Where Laplace's
//!    approximation is uncertain, importance sampling replaces it (`sampling`). The ranking with classes and probabilities ends
//!    the search (`selection`).
//!
//! # Layout
//! - `ask_tell`: how the search is asked and told. `state`: its state, and the phases. `depth`: how many evaluations each phase may
//!   spend: for the whole library of a smooth or a rough model, and fewer beyond a combination, for curves and for simple forms.
//! - `base`, `screen`, `low_fidelity_screen`, `extension`, `refinement`, `confirmation`, `sampling`: the phases.
//! - `change`: the screen of a rough model beyond a combination.
//! - `numerical_noise`, `screen_result`: the results of one evaluated line or candidate.
//! - `selection`: the candidates that are kept, confirmed and ranked. `ranking`: the result.
//! - `projection`: changes of the predictions beyond those of the base. `class`: effects that the data cannot distinguish.

pub(crate) mod ask_tell;
pub(crate) mod base;
pub(crate) mod change;
pub(crate) mod class;
mod confirmation;
pub(crate) mod depth;
mod extension;
mod low_fidelity_screen;
pub(crate) mod projection;
pub(crate) mod ranking;
mod refinement;
mod sampling;
mod screen;
mod screen_result;
mod selection;
pub(crate) mod state;
