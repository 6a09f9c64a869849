//! A variable: values over named dimensions.

use serde::{Deserialize, Serialize};
use utoipa::ToSchema;

use crate::error::ExportError;

/// Values over named dimensions, the last one varying fastest.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, ToSchema)]
pub struct Variable {
    /// Name of the variable; if it labels a dimension, the name of the dimension.
    pub name: String,
    /// Names of the dimensions.
    pub dims: Vec<String>,
    /// Lengths of the dimensions.
    pub shape: Vec<usize>,
    /// Unit of the values; empty for values without a unit.
    pub unit: String,
    /// Meaning in words.
    pub meaning: String,
    /// Values, the last dimension varying fastest.
    pub values: Values,
}

/// The values of a variable.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, ToSchema)]
#[serde(rename_all = "snake_case")]
pub enum Values {
    /// Real numbers; a missing one is null in JSON and NaN elsewhere.
    #[serde(with = "nullable")]
    #[schema(value_type = Vec<Option<f64>>)]
    Real(Vec<f64>),
    /// Whole numbers.
    Whole(Vec<i64>),
    /// Texts.
    Text(Vec<String>),
}

impl Variable {
    /// Makes a variable over dimensions with their lengths.
    pub fn new(name: &str, dims: &[(&str, usize)], unit: &str, meaning: &str, values: Values) -> Self {
        Variable {
            name: name.to_owned(),
            dims: dims.iter().map(|(dim, _)| (*dim).to_owned()).collect(),
            shape: dims.iter().map(|(_, length)| *length).collect(),
            unit: unit.to_owned(),
            meaning: meaning.to_owned(),
            values,
        }
    }

    /// Makes the labels of a dimension.
    pub fn labels(dim: &str, values: Values) -> Self {
        let length = values.len();
        Variable::new(dim, &[(dim, length)], "", "", values)
    }

    /// Checks that there is a value for each place.
    ///
    /// # Errors
    /// [`ExportError::Shape`] if their numbers differ.
    pub fn check(&self) -> Result<(), ExportError> {
        let expected = self.shape.iter().product();
        let actual = self.values.len();
        if actual == expected && self.dims.len() == self.shape.len() {
            return Ok(());
        }
        Err(ExportError::Shape {
            name: self.name.clone(),
            shape: self.shape.clone(),
            actual,
            expected,
        })
    }
}

impl Values {
    /// Returns the number of values.
    pub fn len(&self) -> usize {
        match self {
            Values::Real(values) => values.len(),
            Values::Whole(values) => values.len(),
            Values::Text(values) => values.len(),
        }
    }

    /// Returns whether there is no value.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }
}

/// Serialisation of numbers; those that JSON cannot express become null.
mod nullable {
    use serde::{Deserialize, Deserializer, Serializer};

    pub(super) fn serialize<S: Serializer>(values: &[f64], serializer: S) -> Result<S::Ok, S::Error> {
        serializer.collect_seq(values.iter().map(|value| value.is_finite().then_some(value)))
    }

    pub(super) fn deserialize<'de, D: Deserializer<'de>>(deserializer: D) -> Result<Vec<f64>, D::Error> {
        let values = Vec::<Option<f64>>::deserialize(deserializer)?;
        Ok(values
            .into_iter()
            .map(|value| value.unwrap_or(f64::NAN))
            .collect())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn values_come_back_to_the_bit_and_what_is_no_number_as_nan() {
        let values = vec![0.1, f64::NAN, -1.0, 1e-300, f64::NEG_INFINITY];
        let variable = Variable::new("x", &[("draw", 5)], "m", "a length", Values::Real(values.clone()));
        let text = serde_json::to_string(&variable).unwrap();
        assert!(
            text.contains(r#""values":{"real":[0.1,null,-1.0,1e-300,null]}"#),
            "{text}"
        );
        let Values::Real(read) = serde_json::from_str::<Variable>(&text).unwrap().values else {
            panic!("{text}");
        };
        for (a, b) in values.iter().zip(&read) {
            assert!(a.to_bits() == b.to_bits() || (!a.is_finite() && b.is_nan()));
        }
    }

    #[test]
    fn a_variable_with_too_few_values_is_refused() {
        let short = Variable::new(
            "x",
            &[("chain", 1), ("draw", 3)],
            "",
            "",
            Values::Whole(vec![1, 2]),
        );
        assert_eq!(
            short.check().unwrap_err().to_string(),
            "variable x has 2 values, its shape [1, 3] asks for 3"
        );
    }
}
