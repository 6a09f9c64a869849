//! The search for one effect: every candidate is compared with the base model by its evidence.
//!
//! 1. Base: the most probable parameters, from starts that fill the prior.
//!    Where the model has numerical noise: its size, which is added to that of the data, and the fit again.
//! 2. Screen: each candidate at one standard deviation of its strength's prior, projected out of what the base absorbs. Where a rough
//!    model has a companion, all are screened on that first, and only those near the best on the model.
//! 3. Extensions: base and candidate fitted together, with Broyden's update of the Jacobian.
//! 4. Polish: the best again, with new Jacobians. Now the effect has a name.
//! 5. Confirmation: the best from several starts; where two are close or one is at a bound, by importance sampling.
//!
//! # Layout
//! - `state`: the state of a search. `search`: its interface. `phases`: from one phase to the next.
//! - `base`, `screen`, `extension`, `confirmation`: the positions or fits of one phase. `depth`: how far a search goes.
//! - `companion_screen`: which candidates are worth evaluations of the model.
//! - `numerical_noise`: the scatter of the model's predictions.
//! - `selection`: the candidates that are kept, confirmed and ranked. `sampling`: those whose evidence is sampled. `ranking`: the result.
//! - `projection`: changes of the predictions beyond what the base absorbs. `class`: effects that the data cannot distinguish by them.

pub(crate) mod base;
pub(crate) mod class;
mod companion_screen;
mod confirmation;
pub(crate) mod depth;
mod extension;
mod numerical_noise;
mod phases;
pub(crate) mod projection;
pub(crate) mod ranking;
mod sampling;
mod screen;
pub(crate) mod search;
mod selection;
pub(crate) mod state;
