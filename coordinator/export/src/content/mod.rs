//! The content of an export, group by group.
//!
//! # Layout
//! - `draws`: posterior, prior and statistics of the sampler.
//! - `runs`: measured and modelled values of the runs, and their conditions.

mod draws;
mod runs;

use std::collections::BTreeMap;

use result::{CampaignWords, FinishedCalibration};

use crate::error::ExportError;
use crate::inference_data::InferenceData;
use runs::Part;

/// Converts a finished calibration to inference data.
///
/// # Errors
/// [`ExportError::NoDraws`] for a fit without draws.
pub fn inference_data(calibration: &FinishedCalibration) -> Result<InferenceData, ExportError> {
    if calibration.posterior().is_empty() {
        return Err(ExportError::NoDraws(calibration.row.id));
    }
    let fitted = Part::fitted(calibration);
    let mut groups = vec![
        draws::posterior(calibration),
        draws::sample_stats(calibration),
        draws::prior(calibration),
        fitted.log_likelihood(),
        fitted.predictive("posterior_predictive"),
        fitted.measured("observed_data"),
        fitted.conditions("constant_data"),
    ];
    // Predictions of holdout runs are exported with the measurements to judge them.
    if !calibration.spec.holdout_runs.is_empty() {
        let held_out = Part::held_out(calibration);
        groups.push(held_out.predictive("predictions"));
        let mut constant = held_out.conditions("predictions_constant_data");
        constant
            .data_vars
            .extend(held_out.measured("observed_data").data_vars);
        groups.push(constant);
    }
    Ok(InferenceData {
        attrs: attributes(calibration),
        groups,
    })
}

fn attributes(calibration: &FinishedCalibration) -> BTreeMap<String, String> {
    let row = &calibration.row;
    let campaign = calibration
        .spec
        .experiment
        .campaign
        .as_ref()
        .map(CampaignWords::from);
    let attributes = [
        (
            "created_by",
            Some(concat!("grouser ", env!("CARGO_PKG_VERSION")).to_owned()),
        ),
        ("calibration", Some(row.id.to_string())),
        ("name", Some(row.name.clone())),
        ("model_kind", Some(calibration.spec.model.kind.name().to_owned())),
        ("model_version", row.model_version.clone()),
        (
            "measurements",
            campaign.as_ref().map(|words| words.citation.clone()),
        ),
        ("digitised", campaign.and_then(|words| words.digitised)),
        ("log_evidence", row.log_evidence.map(|value| value.to_string())),
        (
            "log_evidence_se",
            row.log_evidence_se.map(|value| value.to_string()),
        ),
        (
            "posterior",
            Some(match calibration.approximated() {
                Some(_) => "draws of a normal approximation".to_owned(),
                None => "equally weighted draws of a sample".to_owned(),
            }),
        ),
    ];
    let attributes = attributes.into_iter();
    attributes
        .filter_map(|(name, value)| Some((name.to_owned(), value?)))
        .collect()
}
