//! Discovery of missing effects, by ask and tell.
//!
//! Nothing here runs a model. A search lists the parameter vectors of a round, and takes the predicted values in any order.
//! - [`EffectSearch`] finds which single effect of a library is missing: base, screen, extensions, refinement, confirmation. The
//!   page of `effect_search` describes these phases.
//! - [`DiscoverySearch`] begins with that search and adds combinations of effects, laws outside the library and the runs to make
//!   next. The page of `search` describes its stages.
//!
//! The evidence of a model is Laplace's approximation, in coordinates in which every prior is standard normal or, for a strength of
//! one sign, half-normal; the truncation is integrated exactly.
//!
//! # Layout
//! - `candidate`, `task`, `settings`: what is searched.
//! - `laplace`: the fit of a model and its evidence. `chi_square`: goodness of fit. `probability`: posterior probabilities.
//! - `effect_search`: the search for one effect. `search`: the whole search.

mod candidate;
mod chi_square;
mod effect_search;
mod laplace;
mod probability;
mod search;
mod settings;
mod task;

pub use candidate::{Candidate, CandidateError};
pub use chi_square::FitChiSquare;
pub use effect_search::ranking::{EffectRanking, EvaluationCounts, EvidenceMethod, RankedEffect};
pub use effect_search::search::EffectRequest;
pub use effect_search::state::EffectSearch;
pub use probability::DETECTED;
pub use search::conclusion::{Conclusion, OutsideLaw, PosteriorModel};
pub use search::discovery::DiscoverySearch;
pub use search::next_run::InformativeRun;
pub use search::query::{QueriedModel, Query};
pub use search::verdict::SearchVerdict;
pub use search::weighing::WeighedSet;
pub use settings::{SearchSettings, Smoothness, Starts};
pub use task::{LawCandidate, ProposedRuns, Reduction, SearchTask};
