//! Inputs and versions, enough to reproduce the result.

use inference::evolution::EvolutionSettings;
use job::AlgorithmSettings;
use maud::{Markup, html};
use shared::experiment::RunUse;

use crate::finished_calibration::FinishedCalibration;
use crate::table::error_model::error_model;
use crate::words::number;

/// One line under the title: model, data, sampler.
pub(in crate::report) fn subtitle(calibration: &FinishedCalibration) -> String {
    let spec = &calibration.spec;
    let held = spec.experiment.runs.len() - spec.fit_runs.len();
    format!(
        "Model {} \u{b7} {}, {} \u{b7} {}, seed {}",
        spec.model_words(),
        number::count(spec.fit_runs.len(), "fitted run"),
        number::count(held, "holdout run"),
        spec.algorithm.words(),
        spec.algorithm.seed()
    )
}

/// Versions, settings and the job's own text.
pub(in crate::report) fn provenance(calibration: &FinishedCalibration) -> Markup {
    let spec = &calibration.spec;
    let held = spec
        .experiment
        .runs
        .iter()
        .filter(|r| r.usage == RunUse::Holdout)
        .count();
    html! {
        dl {
            dt { "calibration" } dd { (calibration.experiment) }
            dt { "model" } dd { (spec.model_words()) ", version " (calibration.row.model_version.as_deref().unwrap_or("unknown")) }
            dt { "data" }
            dd {
                (number::count(spec.fit_runs.len(), "fitted run")) " with "
                (number::count(spec.wheel_data(), "measurement")) ", " (number::count(held, "holdout run"))
            }
            @let (plates, rings) = (spec.bevameter.plates.len(), spec.bevameter.rings.len());
            @if plates + rings > 0 {
                dt { "bevameter" } dd { (number::count(plates, "plate reading")) ", " (number::count(rings, "ring reading")) }
            }
            @for words in error_model(calibration) {
                dt { "errors" } dd { (words) }
            }
            dt { "algorithm" }
            dd {
                (spec.algorithm.words())
                @match spec.algorithm {
                    AlgorithmSettings::Sample(s) => {
                        @if s.algorithm == inference::Algorithm::Tmcmc { ", " (s.moves[0]) " to " (s.moves[1]) " moves per stage" }
                    }
                    AlgorithmSettings::Fit(s) => {
                        ", " (number::count(s.starts, "start")) ", differences of at least " (number::as_written(s.difference_step)) " prior widths"
                    }
                    AlgorithmSettings::Evolve(EvolutionSettings::Ga(_)) | AlgorithmSettings::Discover { .. } => {}
                    AlgorithmSettings::Evolve(EvolutionSettings::CmaEs(s)) => {
                        ", " (s.first_population(spec.parameters.len())) " individuals and at most " (number::count(s.restarts, "restart")) " with twice as many each"
                    }
                }
            }
            dt { "seed" } dd { (spec.algorithm.seed()) }
            dt { "program" } dd { "Grouser " (env!("CARGO_PKG_VERSION")) }
        }
        p.note { "The result is a function of job, seed and model version alone: the same three give the same numbers, bit for bit." }
        details { summary { "Text of the job" } pre { (calibration.row.job.toml) } }
        @for effect in &spec.fit_variant.effects {
            details { summary { "Effect " (effect.name) } pre { (effect.text) } }
        }
    }
}
