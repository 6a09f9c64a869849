//! The model variants that workers evaluate: one for the fitted runs and readings, one for the holdout runs.

use shared::experiment::Experiment;
use shared::model::ModelVariant;
use shared::parameters::NOISE_PREFIX;

use super::fitted::Fitted;
use super::parameters::Parameters;
use crate::data::bevameter_readings::BevameterReadings;
use crate::data::outside_model;
use crate::data::shared_error::BY_STIFFNESS;
use crate::data::transient_readings::TransientReadings;

/// The variants of a calibration.
pub(super) struct Variants {
    /// The variant of the fitted runs and readings.
    pub(super) fit: ModelVariant,
    /// The variant of the holdout runs, if there are any.
    pub(super) holdout: Option<ModelVariant>,
}

impl Variants {
    /// # Errors
    /// A sentence: the model cannot express the experiment.
    pub(super) fn new(
        experiment: &Experiment,
        (bevameter, transients): (&BevameterReadings, &TransientReadings),
        parameters: &Parameters,
        fitted: &Fitted,
    ) -> Result<Variants, String> {
        let model = &parameters.model;
        if let Some(external) = &model.external {
            outside_model::check(external, experiment, &fitted.fit_runs, &fitted.likelihood)?;
        }
        let mut fit = variant_of_runs(&fitted.fit_runs, experiment, parameters, fitted)?;
        let readings = experiment.plates.len() + experiment.shear.len();
        if readings > 0 && !model.kind.has_soil_laws() {
            return Err(format!(
                "kind = \"{}\" predicts no plates and rings: leave plates and shear out of the experiment",
                model.kind.name()
            ));
        }
        bevameter.ask(&mut fit);
        if !transients.fitted.is_empty() && !model.kind.has_transients() {
            return Err(format!(
                "[likelihood] histories = true, but kind = \"{}\" has a steady state alone: use quasi_static, wong_reece or scm",
                model.kind.name()
            ));
        }
        transients.ask_fitted(&mut fit);
        let mut holdout = match fitted.holdout_runs.as_slice() {
            [] => None,
            runs => Some(variant_of_runs(runs, experiment, parameters, fitted)?),
        };
        if let Some(holdout) = &mut holdout {
            transients.ask_holdout(holdout);
        }
        Ok(Variants { fit, holdout })
    }
}

/// Returns the variant of some runs.
fn variant_of_runs(
    runs: &[usize],
    experiment: &Experiment,
    parameters: &Parameters,
    fitted: &Fitted,
) -> Result<ModelVariant, String> {
    let free = parameters.free.iter();
    let of_model = || free.clone().filter(|p| !p.name.starts_with(NOISE_PREFIX));
    let names = of_model().map(|p| p.name.clone()).collect();
    let runs = runs.iter().map(|&i| &experiment.runs[i]);
    let variant = ModelVariant::new(experiment, &parameters.model, &parameters.effects, names, runs);
    let mut variant = variant.map_err(|e| e.to_string())?;
    if parameters.model.external.is_some() {
        variant.probe = of_model().map(|p| p.marginal.quantile(0.5)).collect();
    }
    let mut sensitive = fitted.likelihood.sensitive().iter();
    variant.stiffness_sensitivity = sensitive.any(|error| error.derivative == BY_STIFFNESS);
    Ok(variant)
}
