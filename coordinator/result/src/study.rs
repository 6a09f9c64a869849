//! A study with everything that is finished of it: what summary, report and figures are made from.

use shared::api::CalibrationState;

use super::FinishedCalibration;
use super::discovery::{DiscoverySummary, Round};
use super::flags::Flag;
use super::point_estimate::PointEstimate;
use super::summary::{CalibrationSummary, Summary};

/// The best of a thousand draws lies some nats below the mode, and more in many dimensions; this is beyond chance.
const MISSED_NATS: f64 = 15.0;

/// The finished calibrations of a study, oldest first. There is at least one.
#[derive(Debug)]
pub struct Study {
    /// Where the study stands: finished where it takes no further step, or the state of its first calibration that is not.
    pub state: CalibrationState,
    /// The first: the job as it was submitted.
    pub lead: FinishedCalibration,
    /// Those of the same model and measurements beside it: the point estimates that the job asks for.
    pub beside: Vec<FinishedCalibration>,
    /// Those of other models or measurements: extended by effects, or by runs.
    pub extensions: Vec<FinishedCalibration>,
    /// The searches for missing effects.
    pub rounds: Vec<Round>,
}

impl Study {
    /// Every finished calibration of the submitted model and measurements, oldest first.
    pub fn outcomes(&self) -> impl Iterator<Item = &FinishedCalibration> {
        std::iter::once(&self.lead).chain(&self.beside)
    }

    /// The error ledger: the calibrations that have a posterior.
    pub fn calibrations(&self) -> Vec<CalibrationSummary> {
        self.all()
            .filter_map(FinishedCalibration::calibration_summary)
            .collect()
    }

    /// What fits and searches found.
    pub fn point_estimates(&self) -> Vec<PointEstimate> {
        self.all()
            .filter_map(FinishedCalibration::point_estimate)
            .collect()
    }

    /// Every finished calibration: the submitted one, those beside it, then the extensions.
    pub fn all(&self) -> impl Iterator<Item = &FinishedCalibration> {
        self.outcomes().chain(&self.extensions)
    }

    /// The lines of the error ledger: the calibrations that have a posterior.
    pub fn ledger(&self) -> impl Iterator<Item = &FinishedCalibration> {
        self.all().filter(|outcome| outcome.estimate.is_none())
    }

    /// Effects that the first calibration did not have, of the line of the ledger with the most evidence on the newest data.
    fn added(&self) -> Vec<String> {
        let had = self.lead.effects();
        let newest = self.ledger().map(|o| o.row.experiment).max();
        let of_newest = self.ledger().filter(|o| Some(o.row.experiment) == newest);
        let evidence = |o: &FinishedCalibration| o.row.log_evidence.unwrap_or(f64::NEG_INFINITY);
        let best = of_newest.reduce(|a, b| if evidence(b) > evidence(a) { b } else { a });
        best.map(FinishedCalibration::effects)
            .unwrap_or_default()
            .into_iter()
            .filter(|effect| !had.contains(effect))
            .collect()
    }

    /// What deserves attention; of a calibration beside the first, under the name of its algorithm, of an extension under its
    /// own.
    pub fn flags(&self) -> Vec<Flag> {
        let of = |outcome: &FinishedCalibration| outcome.diagnostics(&outcome.comparison()).flags;
        let mut flags = self.missed_modes();
        flags.extend(of(&self.lead));
        let beside = self.beside.iter().map(|o| (o.spec.method.name(), o));
        let extensions = self.extensions.iter().map(|o| (o.experiment.as_str(), o));
        for (name, outcome) in beside.chain(extensions) {
            flags.extend(of(outcome).into_iter().map(|flag| Flag {
                text: format!("{name}: {}", flag.text),
                ..flag
            }));
        }
        flags
    }

    /// A calibration whose best parameters are far less probable than what another one of the study found has missed them.
    pub(super) fn missed_modes(&self) -> Vec<Flag> {
        let best = |outcome: &FinishedCalibration| match &outcome.estimate {
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
            discovery: DiscoverySummary::of(&self.rounds, self.added()),
        }
    }
}

#[cfg(test)]
impl From<FinishedCalibration> for Study {
    fn from(lead: FinishedCalibration) -> Self {
        Study {
            state: lead.row.state,
            lead,
            beside: Vec::new(),
            extensions: Vec::new(),
            rounds: Vec::new(),
        }
    }
}

#[cfg(test)]
mod tests {
    use crate::report::fixture;

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
