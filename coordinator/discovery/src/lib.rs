//! The discovery of missing effects: a model is compared, by its evidence, with itself plus candidate effects.
//!
//! Nothing here runs a model. A search lists the parameter vectors of a round, and takes their predicted values in any order.
//!
//! | steps of docs/discovery.md | what happens | type | folder |
//! |---|---|---|---|
//! | 1–5 | the search for one effect: base, screen, extensions, refinement, confirmation | [`EffectSearch`] | `effect_search` |
//! | 6–13 | base reduction, combinations, laws outside the library, predictions, next runs, verdict | [`DiscoverySearch`] | `stages` |
//!
//! [`DiscoverySearch`] begins with the search for one effect. The pages of both folders name the file of each phase and stage.
//!
//! The evidence of a model is Laplace's approximation, in coordinates in which every prior is standard normal or, for a strength of
//! one sign, half-normal; the truncation is integrated exactly.
//!
//! # Layout
//! - `candidate`, `suspected_error`, `task`, `settings`: the model, its data, the candidates, and how they are searched.
//! - `effect_search`: the search for one effect. `stages`: the whole discovery.
//! - `laplace`: the fit of a model and its evidence. `chi_square`: goodness of fit. `probability`: posterior probabilities.

mod candidate;
mod chi_square;
mod effect_search;
mod laplace;
mod probability;
mod settings;
mod stages;
mod suspected_error;
mod task;

pub use candidate::{Candidate, CandidateError};
pub use chi_square::FitChiSquare;
pub use effect_search::ask_tell::EffectRequest;
pub use effect_search::ranking::{EffectRanking, EvaluationCounts, EvidenceMethod, RankedEffect};
pub use effect_search::state::EffectSearch;
pub use probability::DETECTED;
pub use settings::{SearchSettings, Smoothness, Starts};
pub use stages::ask_tell::DiscoverySearch;
pub use stages::conclusion::{Conclusion, OutsideLaw, PosteriorModel};
pub use stages::formula_fit::{FormulaFit, FormulaRequest};
pub use stages::law_curve::LawCurve;
pub use stages::law_forms::WeighedForm;
pub use stages::leaders::Leader;
pub use stages::next_run::InformativeRun;
pub use stages::prior_sensitivity::AlternativePrior;
pub use stages::query::{QueriedModel, Query};
pub use stages::replacement::Replacement;
pub use stages::shared_errors::{GroupError, JudgedError, SharedErrorSource};
pub use stages::verdict::{NAMED, SearchVerdict};
pub use stages::weighing::WeighedSet;
pub use suspected_error::{SuspectedError, SuspectedShift};
pub use task::{LawCandidate, ProposedRuns, Reduction, SearchTask};
