//! A study with everything that is finished of it: what summary, report and figures are made from.

use shared::api::CalibrationState;

use super::Outcome;
use super::flags::Flag;
use super::point_estimate::PointEstimate;
use super::summary::{CalibrationSummary, Summary};
use crate::service::ServiceError;
use crate::store::{CalibrationRow, Reader};

/// The best of a thousand draws lies some nats below the mode, and more in many dimensions; this is beyond chance.
const MISSED_NATS: f64 = 15.0;

/// The finished calibrations of a study, oldest first. There is at least one.
#[derive(Debug)]
pub struct Study {
    /// Where the study stands: finished, or the state of its first calibration that is not.
    pub state: CalibrationState,
    /// The first: the job as it was submitted.
    pub lead: Outcome,
    /// Those beside it: the point estimates that the job asks for.
    pub beside: Vec<Outcome>,
}

impl Study {
    /// Loads what is finished of the study of a finished calibration.
    ///
    /// # Errors
    /// As those of [`Outcome::load`].
    pub async fn load(reader: &Reader, row: &CalibrationRow) -> Result<Study, ServiceError> {
        let rows = reader.study(row.study).await?;
        let unfinished = rows.iter().find(|r| r.state != CalibrationState::Finished);
        let mut finished = rows.iter().filter(|r| r.state == CalibrationState::Finished);
        // Without any, the calibration that was asked for says why there is nothing to show.
        let lead = Outcome::load(reader, finished.next().unwrap_or(row)).await?;
        let mut beside = Vec::new();
        for row in finished {
            beside.push(Outcome::load(reader, row).await?);
        }
        Ok(Study {
            state: unfinished.map_or(CalibrationState::Finished, |r| r.state),
            lead,
            beside,
        })
    }

    /// Every finished calibration, oldest first.
    pub fn outcomes(&self) -> impl Iterator<Item = &Outcome> {
        std::iter::once(&self.lead).chain(&self.beside)
    }

    /// The error ledger: the calibrations that have a posterior.
    pub fn calibrations(&self) -> Vec<CalibrationSummary> {
        self.outcomes().filter_map(Outcome::calibration_summary).collect()
    }

    /// What fits and searches found.
    pub fn point_estimates(&self) -> Vec<PointEstimate> {
        self.outcomes().filter_map(Outcome::point_estimate).collect()
    }

    /// What deserves attention; of a calibration beside the first, under the name of its algorithm.
    pub fn flags(&self) -> Vec<Flag> {
        let of = |outcome: &Outcome| outcome.diagnostics(&outcome.comparison()).flags;
        let mut flags = self.missed_modes();
        flags.extend(of(&self.lead));
        for outcome in &self.beside {
            let name = outcome.spec.method.name();
            flags.extend(of(outcome).into_iter().map(|flag| Flag {
                text: format!("{name}: {}", flag.text),
                ..flag
            }));
        }
        flags
    }

    /// A calibration whose best parameters are far less probable than what another one of the study found has missed them.
    pub(super) fn missed_modes(&self) -> Vec<Flag> {
        let best = |outcome: &Outcome| match &outcome.estimate {
            Some(estimate) => Some(estimate.log_likelihood + estimate.log_prior),
            None => {
                let sample = outcome.most_probable()?;
                Some(sample.log_likelihood? + sample.log_prior)
            }
        };
        let found: Vec<(&str, f64)> = self
            .outcomes()
            .filter_map(|outcome| Some((outcome.spec.method.name(), best(outcome)?)))
            .collect();
        let Some(&(winner, highest)) = found.iter().max_by(|a, b| a.1.total_cmp(&b.1)) else {
            return Vec::new();
        };
        found
            .iter()
            .filter(|(_, log_posterior)| highest - log_posterior > MISSED_NATS)
            .map(|(name, log_posterior)| {
                let text = format!(
                    "{name} has missed what {winner} found, parameters whose log-posterior is {:.0} nats higher: its result is not the answer",
                    highest - log_posterior
                );
                Flag::plain("not_equilibrated", text)
            })
            .collect()
    }

    /// `summary.json`.
    pub fn summary(&self) -> Summary {
        let lead = &self.lead;
        Summary {
            experiment: lead.experiment.clone(),
            seed: lead.spec.method.seed(),
            model_version: lead.row.model_version.clone().unwrap_or_default(),
            model_kind: lead.spec.model.kind.name().to_owned(),
            status: self.state.name().to_owned(),
            calibrations: self.calibrations(),
            point_estimates: self.point_estimates(),
            flags: self.flags(),
            discovery: None,
        }
    }
}

#[cfg(test)]
impl From<Outcome> for Study {
    fn from(lead: Outcome) -> Self {
        Study {
            state: lead.row.state,
            lead,
            beside: Vec::new(),
        }
    }
}

#[cfg(test)]
mod tests {
    use crate::result::report::fixture;

    #[test]
    fn a_sample_stands_in_the_ledger_and_a_search_beside_it() {
        let summary = fixture::study().summary();
        let algorithms: Vec<&str> = summary.calibrations.iter().map(|c| &*c.algorithm).collect();
        assert_eq!(algorithms, ["tmcmc"]);
        let estimates: Vec<&str> = summary.point_estimates.iter().map(|e| &*e.algorithm).collect();
        assert_eq!(estimates, ["ga"]);
        let of_search = summary.flags.iter().filter(|f| f.text.starts_with("ga: "));
        assert!(of_search.count() > 0, "{:?}", summary.flags);
    }

    #[test]
    fn what_another_calibration_found_is_held_against_those_that_missed_it() {
        let mut study = fixture::study();
        let missed = |study: &super::Study| {
            let flags = study.flags();
            let found = flags.iter().filter(|f| f.text.contains("has missed what"));
            found.map(|f| f.text.clone()).collect::<Vec<String>>()
        };
        assert_eq!(missed(&study), Vec::<String>::new());
        if let Some(estimate) = &mut study.beside[0].estimate {
            estimate.log_likelihood += 100.0;
        }
        let texts = missed(&study);
        assert!(
            texts.len() == 1 && texts[0].starts_with("tmcmc has missed what ga found"),
            "{texts:?}"
        );
        assert_eq!(
            study.flags()[0].text,
            texts[0],
            "it stands before what it casts doubt on"
        );
    }
}
