//! Inference data: groups of variables, as ArviZ names them.

use std::collections::BTreeMap;

use serde::{Deserialize, Serialize};
use utoipa::ToSchema;

use crate::error::ExportError;
use crate::variable::Variable;

/// A calibration as ArviZ takes it: groups of variables with named dimensions.
///
/// Names of groups, of the dimensions `chain` and `draw`, and where what belongs follow the schema of ArviZ
/// (<https://python.arviz.org/en/stable/schema/schema.html>).
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, ToSchema)]
pub struct InferenceData {
    /// What is said of the whole: calibration, model, evidence.
    pub attrs: BTreeMap<String, String>,
    /// The groups.
    pub groups: Vec<VariableGroup>,
}

/// Variables that belong together.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, ToSchema)]
pub struct VariableGroup {
    /// Its name, as `posterior`.
    pub name: String,
    /// The labels of its dimensions.
    pub coords: Vec<Variable>,
    /// Its variables.
    pub data_vars: Vec<Variable>,
}

impl VariableGroup {
    /// Labels and variables.
    pub fn variables(&self) -> impl Iterator<Item = &Variable> {
        self.coords.iter().chain(&self.data_vars)
    }
}

impl InferenceData {
    /// The group of a name.
    ///
    /// # Errors
    /// [`ExportError::Group`].
    pub fn group(&self, name: &'static str) -> Result<&VariableGroup, ExportError> {
        let found = self.groups.iter().find(|group| group.name == name);
        found.ok_or(ExportError::Group(name))
    }

    /// Checks that every variable has a value for each place; what a service has sent may be anything.
    ///
    /// # Errors
    /// [`ExportError::Shape`].
    pub fn check(&self) -> Result<(), ExportError> {
        let mut variables = self.groups.iter().flat_map(VariableGroup::variables);
        variables.try_for_each(Variable::check)
    }
}
