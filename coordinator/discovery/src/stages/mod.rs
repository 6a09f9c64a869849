//! The stages of a discovery: one effect, combinations, laws outside the library, and the runs to make next.
//!
//! A stage asks the model in rounds (`Stage::queries`). Its `after_` function keeps the results and selects the next stage. The
//! steps are those of docs/discovery.md:
//!
//! | step | stage | file |
//! |---|---|---|
//! | 1–5 | single effects: an [`EffectSearch`](crate::EffectSearch) over the library | `crate::effect_search` |
//! | 6 | base reduction: the model is fitted without each of its effects | `base_reduction` |
//! | 7 | families: if no single effect explains the data, effects of one quantity are fitted together | `families` |
//! | 8 | beam search: beyond the best combinations, one more effect is searched while misfit remains | `beam_search` |
//! | 8 | backward elimination: the best combination is fitted without each of its effects | `backward_elimination` |
//! | 8 | exchanges: with numerical noise, each effect is replaced by a member of its class | `exchanges` |
//! | 9 | curves and forms of laws outside the library, if misfit remains | `laws` |
//! | 10 | cross-validation of the best laws by levels of the design that were left out | `laws`, `cross_validation` |
//! | 11 | laws beyond the leading effects, effects beyond the best laws, the forms of the law of the best such set, effects in the place of that law, and its cross-validation | `laws`, `law_beside_effects`, `law_substitutes` |
//! | 12 | replacements: the base with a leading effect in the place of one of its effects | `replacement_fits` |
//! | 12 | predictions of left-out levels by the leading sets | `last_stages`, `cross_validation` |
//! | 12 | formulas of the law that is claimed, which the caller makes of its curve | `law_formulas`, `formula_fit` |
//! | 13 | next runs: the runs that discriminate best between the explanations | `last_stages`, `next_run`, `run_information` |
//! | 13 | errors that runs share, beside the best explanation | `shared_errors` |
//! | 13 | probabilities, verdict and conclusion | `weighing`, `replacement`, `prior_sensitivity`, `noise_support`, `held_back`, `claimable_law`, `law_places`, `law_curve`, `law_forms`, `verdict`, `conclusion` |
//!
//! # Layout
//! - `ask_tell`: how a discovery is asked and told. `query`: a request to the model.
//! - `stage`: the stage that a discovery is in. `branch`: a search for one effect, or a fit, that is part of a stage.
//! - `state`: the task and the results so far. `hypotheses`: the fitted combinations and laws among them.
//! - `scored_fit`: a fit with the likelihood that scores it.

pub(crate) mod ask_tell;
mod backward_elimination;
mod base_reduction;
mod beam_search;
mod branch;
mod claimable_law;
pub(crate) mod conclusion;
mod cross_validation;
mod exchanges;
mod families;
pub(crate) mod formula_fit;
mod held_back;
mod hypotheses;
mod last_stages;
mod law_beside_effects;
pub(crate) mod law_curve;
pub(crate) mod law_forms;
mod law_formulas;
mod law_places;
mod law_substitutes;
mod laws;
pub(crate) mod leaders;

pub(crate) mod next_run;
mod noise_support;
pub(crate) mod prior_sensitivity;
pub(crate) mod query;
pub(crate) mod replacement;
mod replacement_fits;
mod run_information;
mod scored_fit;
pub(crate) mod shared_errors;
mod stage;
mod state;
pub(crate) mod verdict;
pub(crate) mod weighing;
