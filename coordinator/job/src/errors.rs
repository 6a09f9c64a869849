//! The table `[likelihood]`, and the errors that measurements have in common.

use serde::Deserialize;
use shared::experiment::{Experiment, Scatter, ScatterSd};
use shared::file::unknown_word;
use shared::parameters::scatter_parameter;
use statistics::likelihood::{DISCREPANCY_LEVELS, GREATEST_DISCREPANCY, LEAST_DISCREPANCY};
use statistics::{CommonError, CommonErrorSize, Datum, Discrepancy, ErrorLaw, ErrorSd, Likelihood};

use super::bevameter::{BevameterReadings, PLATE};
use super::priors::FreeParameter;
use super::{Spec, noise};

/// Degrees of freedom of Student's t where a job says nothing.
const USUAL_FREEDOM: f64 = 5.0;

/// How measurements scatter around the model: what a job says of it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LikelihoodSettings {
    /// The law of the errors.
    pub law: ErrorLaw,
    /// How far off the model may be in a condition, in noise sds.
    pub discrepancy: Discrepancy,
}

impl LikelihoodSettings {
    /// What is unusual about it, a sentence each; none of independent normal errors.
    pub fn words(&self) -> Vec<String> {
        let mut words = Vec::new();
        if let ErrorLaw::StudentT { degrees_of_freedom } = self.law {
            words.push(format!(
                "errors are Student's t with {degrees_of_freedom} degrees of freedom, the noise sd its scale"
            ));
        }
        match self.discrepancy {
            Discrepancy::None => {}
            Discrepancy::Known(m) => words.push(format!(
                "the model may be off by {m} noise sds in each condition and channel, common to all repeats"
            )),
            Discrepancy::Unknown => words.push(format!(
                "the model may be off by m noise sds in each condition and channel, common to all repeats; m is marginalised over {DISCREPANCY_LEVELS} values from {LEAST_DISCREPANCY} to {GREATEST_DISCREPANCY}, uniform in log m: {}",
                levels(self.discrepancy)
            )),
        }
        words
    }
}

fn levels(discrepancy: Discrepancy) -> String {
    let levels = discrepancy.levels();
    let words: Vec<String> = levels.iter().map(|m| format!("{m:.2}")).collect();
    words.join(", ")
}

impl Spec {
    /// What tests and runs have in common, a sentence each.
    pub fn scatter_words(&self) -> Vec<String> {
        let sd = |scatter: Scatter| match self.experiment.noise.scatter(scatter) {
            ScatterSd::Known(sd) => format!("{sd}"),
            ScatterSd::Unknown => "unknown".to_owned(),
        };
        let mut words = Vec::new();
        if !self.likelihood.sensitive().is_empty() {
            words.push(format!(
                "the soil's stiffness scatters from run to run, relative sd {}; each condition is simulated twice for it",
                sd(Scatter::Run)
            ));
        }
        for (what, readings, tests) in [
            (
                "pressures under plates",
                Scatter::PlateReading,
                Scatter::PlateTest,
            ),
            (
                "shear stresses under rings",
                Scatter::RingReading,
                Scatter::RingTest,
            ),
        ] {
            if self.bevameter.scatters(readings) {
                words.push(format!(
                    "{what} scatter with the relative sd {} from test to test and {} within a test",
                    sd(tests),
                    sd(readings)
                ));
            }
        }
        words
    }
}

/// The table as written.
#[derive(Deserialize)]
#[serde(deny_unknown_fields, default)]
pub(super) struct RawLikelihood {
    kind: String,
    degrees_of_freedom: Option<f64>,
    discrepancy: toml::Value,
}

impl Default for RawLikelihood {
    fn default() -> Self {
        RawLikelihood {
            kind: "gaussian".into(),
            degrees_of_freedom: None,
            discrepancy: toml::Value::Float(0.0),
        }
    }
}

impl RawLikelihood {
    pub(super) fn settings(&self) -> Result<LikelihoodSettings, String> {
        let law = match (self.kind.as_str(), self.degrees_of_freedom) {
            ("gaussian", None) => ErrorLaw::Gaussian,
            ("gaussian", Some(_)) => return Err("degrees_of_freedom belongs to kind = \"student_t\"".into()),
            ("student_t", given) => {
                let degrees_of_freedom = given.unwrap_or(USUAL_FREEDOM);
                if !(degrees_of_freedom.is_finite() && degrees_of_freedom >= 1.0) {
                    return Err(format!(
                        "degrees_of_freedom = {degrees_of_freedom} must be a finite number >= 1"
                    ));
                }
                ErrorLaw::StudentT { degrees_of_freedom }
            }
            (other, _) => return Err(unknown_word("kind", other, ["gaussian", "student_t"])),
        };
        let value = &self.discrepancy;
        let number = shared::file::number(value);
        let discrepancy = match (number, value.as_str()) {
            (_, Some("unknown")) => Discrepancy::Unknown,
            (Some(m), _) if m.abs() == 0.0 => Discrepancy::None,
            (Some(m), _) if m.is_finite() && m > 0.0 => Discrepancy::Known(m),
            _ => {
                return Err(format!(
                    "discrepancy = {value} must be a number >= 0, in noise sds, or \"unknown\""
                ));
            }
        };
        Ok(LikelihoodSettings { law, discrepancy })
    }
}

/// The relative sd of something that scatters; `None` where it does not.
pub(super) fn scatter_sd(
    experiment: &Experiment,
    parameters: &[FreeParameter],
    scatter: Scatter,
) -> Result<Option<ErrorSd>, String> {
    match experiment.noise.scatter(scatter) {
        ScatterSd::Known(sd) => Ok((sd > 0.0).then_some(ErrorSd::Known(sd))),
        ScatterSd::Unknown => {
            let name = scatter_parameter(scatter);
            let parameter = parameters.iter().position(|p| p.name == name);
            let parameter = parameter.ok_or(format!("{name} has no prior"))?;
            Ok(Some(ErrorSd::Inferred { parameter }))
        }
    }
}

/// The likelihood of the fitted measurements: their noise, and what they have in common.
pub(super) fn likelihood(
    experiment: &Experiment,
    fit_runs: &[usize],
    bevameter: &BevameterReadings,
    parameters: &[FreeParameter],
    settings: LikelihoodSettings,
) -> Result<Likelihood, String> {
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
        data.extend(table.data(sd.ok_or("readings without noise")?));
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
        return Err("no fit run has a measured channel: there is nothing to fit".into());
    }
    let common = common
        .into_iter()
        .filter(|(data, _)| !data.is_empty())
        .map(|(data, size)| CommonError { data, size })
        .collect();
    Likelihood::with_common(data, settings.law, common, settings.discrepancy).map_err(|e| e.to_string())
}
