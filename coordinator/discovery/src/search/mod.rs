//! The whole search: one effect, combinations, laws outside the library, and the runs to make next.
//!
//! Each stage asks the model in rounds (`Stage::queries`); its `after_` function keeps the results and selects the next stage. The
//! numbers in brackets are the steps of docs/discovery.md.
//!
//! 1. **Single effects** (1 to 5): [`EffectSearch`](crate::EffectSearch) over the library; `after_single_effects`.
//! 2. **Base reduction** (6): the model is fitted without each of its effects; `after_base_reduction`.
//! 3. **Families** (7): if no single effect explains the data, effects of one quantity are fitted together; `families`.
//! 4. **Beam search** (8): beyond the best combinations, quick searches look for one more effect while misfit remains; `beam_search`.
//! 5. **Backward elimination and exchanges** (8): the best combination is fitted without each of its effects, and with numerical
//!    noise also with each effect replaced by a member of its class; `backward_elimination`, `exchanges`.
//! 6. **Laws outside the library** (9): if misfit remains, curves of one quantity along one variable are fitted, then simple forms
//!    of the best; `curves`, `after_curves`, `after_forms`.
//! 7. **Cross-validation** (10): the best laws predict levels of the design that were left out; `cross_validation`.
//! 8. **Laws beyond the best combination** (11): steps 6 and 7 are repeated beyond the best combination if it contradicts the data;
//!    `further_curves`, `after_scan`.
//! 9. **Predictions** (12): the leading sets predict left-out levels; `predictions`.
//! 10. **Next runs** (13): the expected information of runs that the rig could make selects those that discriminate best;
//!     `next_runs`. `Conclusion::new` derives probabilities and verdict.
//!
//! # Layout
//! - `discovery`: the interface. `query`: a request to the model. `branch`: a search for one effect that is part of this one.
//! - `stage`: the stages. `state`: task and hypotheses. `effects`, `families`, `exchange`, `laws`, `last_stages`: the functions of
//!   each stage.
//! - `hypotheses`: combinations and laws so far. `weighing`: their probabilities. `noise_support`: whether inferred noise supports
//!   a claim. `verdict`, `conclusion`: the result.
//! - `cross_validation`: fits without some of the data. `next_run`: the choice of runs to make; `run_information`: their information.

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
