//! The forward models, and the self-contained variant of one that a worker evaluates.
//!
//! # Layout
//! - `kind`: the models by name; [`settings`]: the table `[model]` of a job; [`spatial`]: settings of the
//!   three-dimensional model; `external`, `external_table`, `external_effects`: models
//!   that are not ours.
//! - [`grouser_key`]: whether the quasi-static model rolls grousers; `rolled_grousers`: those that it has a form of.
//! - [`effects`]: the effects of a job, their order and their parameters.
//! - `error`: why a model cannot be set up.
//! - `names`: what parameter names mean, and whether a set of them is complete.
//! - `variant`: [`ModelVariant`], with the runs and readings (`condition`) to simulate; `capability`: whether its model can
//!   express it.
//! - `companion`, `metamodel`: the quasi-static model beside the three-dimensional one.

mod capability;
mod companion;
mod condition;
pub mod effects;
mod error;
mod external;
mod external_effects;
mod external_table;
pub mod grouser_key;
mod kind;
mod metamodel;
mod names;
mod rolled_grousers;
pub mod settings;
pub mod spatial;
mod variant;

pub use companion::Companion;
pub use condition::{PlateCondition, RingCondition, RunCondition};
pub use effects::{EffectSet, EffectText};
pub use error::ModelError;
pub use external::{ExternalModel, ExternalParameter, ExternalSource, RunInput};
pub use kind::ModelKind;
pub use names::{ParameterScope, check_complete, lookup};
pub use settings::ModelSettings;
pub use spatial::SpatialSettings;
pub use variant::{ModelVariant, equations_of, hash_of};
