//! The forward models, and the self-contained variant of one that a worker evaluates.
//!
//! # Layout
//! - `kind`: the models by name; [`settings`]: the table `[model]` of a job; [`spatial`]: settings of the three-dimensional
//!   model; `external`, `external_table`, `external_effects`: external models.
//! - [`grouser_key`]: the key that makes the quasi-static model roll grousers; `rolled_grousers`: the grousers that it has a
//!   form of.
//! - [`effects`]: the effects of a job, their order and their parameters.
//! - `error`: errors of a model's set-up.
//! - `names`: the meaning of parameter names, and the check that a set of them is complete.
//! - `variant`: [`ModelVariant`], with the runs and readings (`condition`) to simulate; `capability`: the check that its
//!   model can express it.
//! - `drawn`: a calibrated model with its draws, for other programs.
//! - `low_fidelity`: the quasi-static variant of a three-dimensional one.

mod capability;
mod condition;
mod drawn;
pub mod effects;
mod error;
mod external;
mod external_effects;
mod external_table;
pub mod grouser_key;
mod kind;
mod low_fidelity;
mod names;
mod rolled_grousers;
pub mod settings;
pub mod spatial;
mod variant;

pub use condition::{PlateCondition, RingCondition, RunCondition, TransientCondition};
pub use drawn::DrawnModel;
pub use effects::{EffectSet, EffectText};
pub use error::ModelError;
pub use external::{ExternalModel, ExternalParameter, ExternalSource, RunInput};
pub use kind::ModelKind;
pub use names::{ParameterScope, check_complete, lookup};
pub use settings::ModelSettings;
pub use spatial::SpatialSettings;
pub use variant::{ModelVariant, equations_of, hash_of};
