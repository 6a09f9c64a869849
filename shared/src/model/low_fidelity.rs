//! The quasi-static model as the low-fidelity model of a metamodel for the three-dimensional one.

use serde::{Deserialize, Serialize};
use statistics::Metamodel;
use utoipa::ToSchema;

use crate::predicted::PredictedValue;

/// The low-fidelity, quasi-static model for a variant of the three-dimensional model.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, ToSchema)]
#[serde(deny_unknown_fields)]
pub struct LowFidelityModel {
    /// The predicted values of both models that are compared, in the order of the likelihood.
    pub values: Vec<PredictedValue>,
    /// The metamodel of a stage; absent before the first stage: then both models are evaluated, and no moves are taken.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schema(value_type = Option<Object>)]
    pub metamodel: Option<Box<Metamodel>>,
}
