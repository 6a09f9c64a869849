//! Provenance of a calibration: the inputs and versions to reproduce it, and its results in sentences.

mod sentences;

use inference::evolution::EvolutionSettings;
use job::AlgorithmSettings;
use shared::api::NamedText;

use result::finished_calibration::FinishedCalibration;
use result::table::error_model::error_model;
use result::words::number;

/// The provenance of a calibration.
#[derive(Debug, Clone, PartialEq, Eq, serde::Serialize, serde::Deserialize, utoipa::ToSchema)]
pub struct Provenance {
    /// Name of the calibration.
    pub name: String,
    /// Results in sentences.
    pub sentences: Vec<String>,
    /// Notes on limits of the model and departures from the source paper.
    pub notes: Vec<String>,
    /// The model in words.
    pub model: String,
    /// Version of the equations, and of the effects.
    pub model_version: Option<String>,
    /// The measurements in words.
    pub data: String,
    /// The assumed errors, one sentence each.
    pub errors: Vec<String>,
    /// The algorithm with its settings, in words.
    pub algorithm: String,
    /// Seed of the algorithm.
    pub seed: u64,
    /// The program that computed these words.
    pub program: String,
    /// Text of the job.
    pub job: String,
    /// The effects of the model, with the texts of their files.
    pub effects: Vec<NamedText>,
}

/// Describes how a calibration was computed.
pub fn provenance(calibration: &FinishedCalibration) -> Provenance {
    let spec = &calibration.spec;
    Provenance {
        name: calibration.experiment.clone(),
        sentences: sentences::sentences(calibration, calibration.comparison()),
        notes: sentences::notes(calibration),
        model: spec.model_words(),
        model_version: calibration.row.model_version.clone(),
        data: data(calibration),
        errors: error_model(calibration),
        algorithm: algorithm(calibration),
        seed: spec.algorithm.seed(),
        program: format!("Grouser {}", env!("CARGO_PKG_VERSION")),
        job: calibration.row.job.toml.clone(),
        effects: spec
            .fit_variant
            .effects
            .iter()
            .map(|effect| NamedText {
                name: effect.name.clone(),
                text: effect.text.clone(),
            })
            .collect(),
    }
}

fn data(calibration: &FinishedCalibration) -> String {
    let spec = &calibration.spec;
    let held = spec.experiment.runs.len() - spec.fit_runs.len();
    let mut words = format!(
        "{} with {}, {}",
        number::count(spec.fit_runs.len(), "fitted run"),
        number::count(spec.wheel_data(), "measurement"),
        number::count(held, "holdout run")
    );
    if spec
        .experiment
        .campaign
        .as_ref()
        .is_some_and(|campaign| campaign.digitised)
    {
        words += "; digitised";
    }
    let (plates, rings) = (spec.bevameter.plates.len(), spec.bevameter.rings.len());
    if plates + rings > 0 {
        words += &format!(
            "; of a bevameter {}, {}",
            number::count(plates, "plate reading"),
            number::count(rings, "ring reading")
        );
    }
    let points = spec.transients.points();
    if points > 0 {
        words += &format!(
            "; {} before the steady state, of {}",
            number::count(points, "sinkage"),
            number::count(spec.transients.fitted.len(), "recording")
        );
    }
    words
}

fn algorithm(calibration: &FinishedCalibration) -> String {
    let spec = &calibration.spec;
    let settings = match spec.algorithm {
        AlgorithmSettings::Sample(s) if s.algorithm == inference::Algorithm::Tmcmc && !s.is_emulated() => {
            format!(", {} to {} moves per stage", s.moves[0], s.moves[1])
        }
        AlgorithmSettings::Fit(s) => format!(
            ", {}, differences of at least {} prior widths",
            number::count(s.starts, "start"),
            number::as_written(s.difference_step)
        ),
        AlgorithmSettings::Evolve(EvolutionSettings::CmaEs(s)) => format!(
            ", {} individuals and at most {} with twice as many each",
            s.first_population(spec.parameters.len()),
            number::count(s.restarts, "restart")
        ),
        AlgorithmSettings::Sample(_)
        | AlgorithmSettings::Evolve(EvolutionSettings::Ga(_))
        | AlgorithmSettings::Discover { .. } => String::new(),
    };
    spec.algorithm.words() + &settings
}

#[cfg(test)]
mod tests {
    use std::sync::Arc;

    use super::*;
    use crate::fixture;

    #[test]
    fn a_fit_claims_no_distribution() {
        let provenance = provenance(&fixture::fit());
        let text = provenance.sentences.join(" ");
        assert!(text.contains("no step improves the posterior"), "{text}");
        assert!(
            provenance
                .algorithm
                .starts_with("lm with at most 200 evaluations")
        );
        for words in [
            "posterior mean",
            "predictive intervals contain",
            "equilibrium",
            "log-evidence",
        ] {
            assert!(!text.contains(words), "{words} in {text}");
        }
    }

    #[test]
    fn a_campaign_stands_in_the_notes_and_digitised_data_are_called_so() {
        let mut calibration = fixture::calibration();
        assert!(!provenance(&calibration).data.contains("digitised"));
        Arc::make_mut(&mut calibration.spec.experiment).campaign = Some(fixture::campaign());
        let provenance = provenance(&calibration);
        assert!(provenance.data.ends_with("; digitised"), "{}", provenance.data);
        assert_eq!(provenance.notes[3], "Doubt: few rows.");
        assert!(provenance.notes[0].starts_with("Measurements: Wheels in <i>sand</i>, "));
    }

    #[test]
    fn a_search_that_was_cut_short_says_so() {
        let provenance = provenance(&fixture::search());
        assert!(provenance.sentences[0].contains("its last generation was reached"));
        assert!(
            provenance
                .algorithm
                .starts_with("ga with at most 200 generations of 100")
        );
    }

    #[test]
    fn without_holdout_the_sentences_say_what_that_means() {
        let is_said = |calibration: FinishedCalibration| {
            let sentences = provenance(&calibration).sentences;
            sentences.iter().any(|s| s.starts_with("No run was held out"))
        };
        assert!(is_said(fixture::without_holdout()) && !is_said(fixture::calibration()));
    }

    #[test]
    fn the_limits_of_the_model_are_stated() {
        let notes = provenance(&fixture::calibration()).notes.join(" ");
        assert!(notes.contains("no grousers are declared"), "{notes}");
    }
}
