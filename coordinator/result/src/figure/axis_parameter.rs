//! A parameter on an axis.

use job::FreeParameter;

/// A parameter on an axis.
#[derive(Debug, Clone, PartialEq, serde::Serialize, utoipa::ToSchema)]
pub struct AxisParameter {
    /// Its name.
    pub name: String,
    /// Its unit.
    pub unit: String,
}

impl From<&FreeParameter> for AxisParameter {
    fn from(parameter: &FreeParameter) -> Self {
        AxisParameter {
            name: parameter.name.clone(),
            unit: parameter.unit.clone(),
        }
    }
}
