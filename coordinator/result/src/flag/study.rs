//! Flags of a study: those of its calibrations, and calibrations that missed a mode.

use super::kind::Flag;
use crate::finished_calibration::FinishedCalibration;
use crate::study::Study;

/// The best of a thousand draws lies some nats below the mode, and more in many dimensions; this is beyond chance.
const MISSED_NATS: f64 = 15.0;

impl Study {
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
    pub(crate) fn missed_modes(&self) -> Vec<Flag> {
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
}

#[cfg(test)]
mod tests {
    use crate::fixture;

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
