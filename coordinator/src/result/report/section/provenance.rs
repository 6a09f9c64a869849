//! Where the result comes from, enough to make it again.

use maud::{Markup, html};
use shared::experiment::RunUse;

use crate::result::Outcome;
use crate::result::report::number;
use crate::result::summary::algorithm_name;

/// One line under the title: model, data, sampler.
pub(in crate::result::report) fn subtitle(outcome: &Outcome) -> String {
    let spec = &outcome.spec;
    let held = spec.experiment.runs.len() - spec.fit_runs.len();
    format!(
        "Model {} \u{b7} {}, {} \u{b7} {} with {} particles, seed {}",
        spec.model.kind.name(),
        number::count(spec.fit_runs.len(), "fitted run"),
        number::count(held, "holdout run"),
        algorithm_name(spec.sampler.algorithm),
        spec.sampler.particles,
        spec.sampler.seed
    )
}

/// Versions, settings and the job's own text.
pub(in crate::result::report) fn provenance(outcome: &Outcome) -> Markup {
    let spec = &outcome.spec;
    let [least, most] = spec.sampler.moves;
    let held = spec
        .experiment
        .runs
        .iter()
        .filter(|r| r.usage == RunUse::Holdout)
        .count();
    html! {
        dl {
            dt { "calibration" } dd { (outcome.experiment) }
            dt { "model" } dd { (spec.model.kind.name()) ", version " (outcome.row.model_version.as_deref().unwrap_or("unknown")) }
            dt { "data" }
            dd {
                (number::count(spec.fit_runs.len(), "fitted run")) " with "
                (number::count(spec.likelihood.data().len(), "measurement")) ", " (number::count(held, "holdout run"))
            }
            dt { "algorithm" }
            dd {
                (algorithm_name(spec.sampler.algorithm)) ", " (spec.sampler.particles) " particles"
                @if spec.sampler.algorithm == inference::Algorithm::Tmcmc { ", " (least) " to " (most) " moves per stage" }
            }
            dt { "seed" } dd { (spec.sampler.seed) }
            dt { "program" } dd { "Grouser " (env!("CARGO_PKG_VERSION")) }
        }
        p.note { "The posterior is a function of job, seed and model version alone: the same three give the same draws, bit for bit." }
        details { summary { "Text of the job" } pre { (outcome.row.toml) } }
    }
}
