//! A calibrated model that other programs simulate: one condition, and the parameters at each draw of the posterior.

use serde::{Deserialize, Serialize};
use utoipa::ToSchema;

use super::{ModelVariant, hash_of};

/// A calibrated model with the draws of its posterior.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, ToSchema)]
#[serde(deny_unknown_fields)]
pub struct DrawnModel {
    /// Id of the calibration.
    pub calibration: i64,
    /// Kind of the model, with its effects.
    pub name: String,
    /// Version of the equations that the calibration was computed by.
    pub model_version: String,
    /// The model with one condition, which stands for what other programs set: slip, load and speed are the medians
    /// of the fitted runs unless they were stated.
    pub variant: ModelVariant,
    /// The parameters at each draw, in the order of the variant's free parameters.
    pub draws: Vec<Vec<f64>>,
    /// What a simulator identifies the model by: the hash of the variant and its draws.
    pub token: String,
}

impl DrawnModel {
    /// Returns a model with its token.
    pub fn new(
        calibration: i64,
        name: String,
        model_version: String,
        variant: ModelVariant,
        draws: Vec<Vec<f64>>,
    ) -> Self {
        let bytes = draws.iter().flatten().flat_map(|value| value.to_le_bytes());
        let token = hash_of(&variant.text().into_iter().chain(bytes).collect::<Vec<u8>>());
        DrawnModel {
            calibration,
            name,
            model_version,
            variant,
            draws,
            token,
        }
    }

    /// Returns a parameter at a draw: a free one, or its fixed value.
    pub fn parameter(&self, name: &str, draw: usize) -> Option<f64> {
        let free = self.variant.parameters.iter().position(|free| free == name);
        match free {
            Some(position) => self.draws.get(draw)?.get(position).copied(),
            None => self.variant.fixed.get(name).copied(),
        }
    }
}
