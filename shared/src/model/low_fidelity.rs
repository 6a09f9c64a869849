//! The quasi-static model as the low-fidelity model of a metamodel for the three-dimensional one.

use serde::{Deserialize, Serialize};
use statistics::Metamodel;
use utoipa::ToSchema;

use crate::predicted::PredictedValue;

/// The low-fidelity (quasi-static) model of a variant, whose high-fidelity model is the three-dimensional one.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, ToSchema)]
#[serde(deny_unknown_fields)]
pub struct LowFidelityModel {
    /// The predicted values in which the two models are compared, in the order of the likelihood.
    pub values: Vec<PredictedValue>,
    /// The metamodel of a stage. It is absent before the first stage; the worker then evaluates both models and proposes no
    /// moves.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schema(value_type = Option<Object>)]
    pub metamodel: Option<Box<Metamodel>>,
}
