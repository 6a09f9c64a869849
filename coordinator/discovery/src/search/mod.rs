//! The whole search: one effect, combinations, laws outside the library, and the runs to make next.
//!
//! 1. Single effects: [`EffectSearch`](crate::EffectSearch) over the library.
//! 2. Base reduction: the model without each of its own effects.
//! 3. Families: effects of one quantity together, where no single effect explains the data.
//! 4. Beam search: quick searches for one more effect beyond the best combinations, where these leave misfit.
//! 5. Backward elimination: the best combination without each of its effects. Exchanges, where the model scatters: with another of
//!    the same class in the place of each.
//! 6. Laws outside the library, where it leaves misfit: curves, each of one quantity along one variable, then simple forms of the best.
//! 7. Cross-validation of a law: levels of the design are left out and predicted.
//! 8. Laws beyond the best combination, by the same steps, where it contradicts the data.
//! 9. Predictions of left-out levels by the leading sets.
//! 10. Next runs: the information of runs that the rig could make on the explanations that remain.
//!
//! # Layout
//! - `discovery`: the interface. `query`: what the model is asked. `branch`: a search for one effect that is part of this one.
//! - `stage`: the stages. `state`: task and hypotheses. `effects`, `families`, `exchange`, `laws`, `last_stages`: from one stage to the
//!   next.
//! - `hypotheses`: combinations and laws found so far. `weighing`: their probabilities. `noise_support`: whether inferred noise supports
//!   a claim. `verdict`, `conclusion`: the result.
//! - `cross_validation`: fits without some of the data. `next_run`: the choice of runs not yet made; `run_information`: what they
//!   would tell.

mod branch;
pub(crate) mod conclusion;
mod cross_validation;
pub(crate) mod discovery;
mod effects;
mod exchange;
mod families;
mod hypotheses;
mod last_stages;
mod laws;
pub(crate) mod next_run;
mod noise_support;
pub(crate) mod query;
mod run_information;
mod stage;
mod state;
pub(crate) mod verdict;
pub(crate) mod weighing;
