//! Name and unit of a parameter, to label an axis of a figure.

use job::FreeParameter;

/// Name and unit of a parameter, to label an axis of a figure.
#[derive(Debug, Clone, PartialEq, serde::Serialize, utoipa::ToSchema)]
pub struct AxisParameter {
    /// Name of the parameter.
    pub name: String,
    /// Unit of the parameter.
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
