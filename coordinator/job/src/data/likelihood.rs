//! The likelihood of the fitted measurements: their noise, and the errors that they have in common.

use shared::experiment::{Experiment, Scatter, ScatterSd};
use shared::parameters::scatter_parameter;
use statistics::{CommonError, CommonErrorSize, Datum, Discrepancy, ErrorSd, Likelihood};

use super::bevameter_readings::{BevameterReadings, PLATE};
use super::error::DataError;
use super::noise;
use crate::table::likelihood_settings::LikelihoodSettings;
use crate::table::prior_entry::FreeParameter;

/// The relative sd of something that scatters; `None` where it does not.
fn scatter_sd(
    experiment: &Experiment,
    parameters: &[FreeParameter],
    scatter: Scatter,
) -> Result<Option<ErrorSd>, DataError> {
    match experiment.noise.scatter(scatter) {
        ScatterSd::Known(sd) => Ok((sd > 0.0).then_some(ErrorSd::Known(sd))),
        ScatterSd::Unknown => {
            let name = scatter_parameter(scatter);
            let parameter = parameters.iter().position(|p| p.name == name);
            let parameter = parameter.ok_or(DataError::NoPrior(name))?;
            Ok(Some(ErrorSd::Inferred { parameter }))
        }
    }
}

/// The likelihood of the fitted measurements: their noise, and what they have in common.
pub(crate) fn likelihood(
    experiment: &Experiment,
    fit_runs: &[usize],
    bevameter: &BevameterReadings,
    parameters: &[FreeParameter],
    settings: LikelihoodSettings,
) -> Result<Likelihood, DataError> {
    let mut data = noise::data(experiment, fit_runs, parameters)?;
    let mut common = Vec::new();
    let members = |data: &[Datum], is_one: &dyn Fn(&Datum) -> bool| -> Vec<usize> {
        (0..data.len()).filter(|&i| is_one(&data[i])).collect()
    };
    if let Some(sd) = scatter_sd(experiment, parameters, Scatter::Run)? {
        for run in 0..fit_runs.len() {
            let own = members(&data, &|d| d.run == run);
            common.push((own, CommonErrorSize::Sensitivity(sd)));
        }
    }
    if settings.discrepancy != Discrepancy::None {
        for condition in noise::conditions(experiment, fit_runs) {
            for channel in 0..PLATE {
                let own = members(&data, &|d| d.channel == channel && condition.contains(&d.run));
                common.push((own, CommonErrorSize::Discrepancy));
            }
        }
    }
    for table in bevameter.tables() {
        let sd = scatter_sd(experiment, parameters, table.between_readings)?;
        let first = data.len();
        data.extend(table.data(sd.ok_or(DataError::NoScatter)?));
        if let Some(sd) = scatter_sd(experiment, parameters, table.between_tests)? {
            for test in table.tests() {
                common.push((
                    test.iter().map(|i| first + i).collect(),
                    CommonErrorSize::Shift(sd),
                ));
            }
        }
    }
    if data.is_empty() {
        return Err(DataError::NothingToFit);
    }
    let common = common
        .into_iter()
        .filter(|(data, _)| !data.is_empty())
        .map(|(data, size)| CommonError { data, size })
        .collect();
    Ok(Likelihood::with_common(
        data,
        settings.law,
        common,
        settings.discrepancy,
    )?)
}
