//! Inference data: groups of variables, as ArviZ names them.

use std::collections::BTreeMap;

use serde::{Deserialize, Serialize};
use utoipa::ToSchema;

use crate::error::ExportError;
use crate::variable::Variable;

/// A calibration as ArviZ represents it: groups of variables with named dimensions.
///
/// The names of groups and of the dimensions `chain` and `draw`, and the contents of groups, follow the schema of ArviZ
/// (<https://python.arviz.org/en/stable/schema/schema.html>).
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, ToSchema)]
pub struct InferenceData {
    /// Attributes of the whole: calibration, model, evidence.
    pub attrs: BTreeMap<String, String>,
    /// The groups.
    pub groups: Vec<VariableGroup>,
}

/// Variables that belong together.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, ToSchema)]
pub struct VariableGroup {
    /// Name, for example `posterior`.
    pub name: String,
    /// Variables that label the dimensions.
    pub coords: Vec<Variable>,
    /// Variables with data.
    pub data_vars: Vec<Variable>,
}

impl VariableGroup {
    /// Returns the labels, then the variables.
    pub fn variables(&self) -> impl Iterator<Item = &Variable> {
        self.coords.iter().chain(&self.data_vars)
    }
}

impl InferenceData {
    /// Returns the group of a name.
    ///
    /// # Errors
    /// [`ExportError::Group`] if it is missing.
    pub fn group(&self, name: &'static str) -> Result<&VariableGroup, ExportError> {
        let group = self.groups.iter().find(|group| group.name == name);
        group.ok_or(ExportError::Group(name))
    }

    /// Checks that every variable has a value for each place, and that no name leads out of a folder; the data may come from any service.
    ///
    /// # Errors
    /// [`ExportError::Shape`] or [`ExportError::Name`].
    pub fn check(&self) -> Result<(), ExportError> {
        let variables = || self.groups.iter().flat_map(VariableGroup::variables);
        let names = variables().map(|variable| &variable.name);
        for name in names.chain(self.groups.iter().map(|group| &group.name)) {
            let is_path = name.contains(['/', '\\', '\0']) || ["", ".", ".."].contains(&name.as_str());
            if is_path {
                return Err(ExportError::Name(name.clone()));
            }
        }
        variables().try_for_each(Variable::check)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::variable::Values;

    #[test]
    fn a_name_that_leads_out_of_the_folder_is_refused() {
        let named = |group: &str, variable: &str| InferenceData {
            attrs: BTreeMap::new(),
            groups: vec![VariableGroup {
                name: group.into(),
                coords: Vec::new(),
                data_vars: vec![Variable::labels(variable, Values::Whole(vec![1]))],
            }],
        };
        for (group, variable) in [
            ("../../x", "n"),
            ("/x", "n"),
            ("prior", ".."),
            ("prior", "a\\b"),
            ("", "n"),
        ] {
            let refused = named(group, variable).check().unwrap_err();
            assert!(matches!(refused, ExportError::Name(_)), "{refused}");
        }
        named("prior", "bevameter.ln_transfer").check().unwrap();
    }
}
