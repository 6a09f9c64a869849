//! The likelihood of the fitted measurements: their noise, and the errors that they have in common.

use shared::experiment::Experiment;
use statistics::{CommonError, CommonErrorSize, Datum, Discrepancy, Likelihood};

use super::bevameter_readings::BevameterReadings;
use super::error::DataError;
use super::noise;
use super::shared_error::SharedError;
use super::shared_sd::scatter_sd;
use super::transient_readings::TransientReadings;
use crate::table::likelihood_settings::LikelihoodSettings;
use crate::table::prior_entry::FreeParameter;

/// Returns the likelihood of the fitted measurements: their noise, and the errors that they have in common.
pub(crate) fn likelihood(
    experiment: &Experiment,
    fit_runs: &[usize],
    (bevameter, transients): (&BevameterReadings, &TransientReadings),
    parameters: &[FreeParameter],
    shared: &[SharedError],
    settings: LikelihoodSettings,
) -> Result<Likelihood, DataError> {
    let mut data = noise::data(experiment, fit_runs, parameters)?;
    let mut common = Vec::new();
    let members = |data: &[Datum], is_one: &dyn Fn(&Datum) -> bool| -> Vec<usize> {
        (0..data.len()).filter(|&i| is_one(&data[i])).collect()
    };
    for shared in shared {
        let errors = shared.errors(&data);
        common.extend(errors.into_iter().map(|error| (error.data, error.size)));
    }
    if settings.has_discrepancy() {
        for condition in noise::conditions(experiment, fit_runs) {
            for (channel, discrepancy) in settings.discrepancies.iter().enumerate() {
                if *discrepancy != Discrepancy::None {
                    let affected = members(&data, &|d| d.channel == channel && condition.contains(&d.run));
                    common.push((affected, CommonErrorSize::Discrepancy { group: channel }));
                }
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
    let mut common: Vec<CommonError> = common
        .into_iter()
        .filter(|(data, _)| !data.is_empty())
        .map(|(data, size)| CommonError { data, size })
        .collect();
    transients.append(parameters, &mut data, &mut common)?;
    Ok(Likelihood::with_common(
        data,
        settings.law,
        common,
        settings.discrepancies.to_vec(),
    )?)
}
