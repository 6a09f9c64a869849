//! What the result says, in plain words made from its numbers.

use inference::diagnostics::mean_and_sd;
use job::repeat_scatter;
use maud::{Markup, html};
use shared::channel::Channel;
use shared::experiment::{RunUse, WheelGeometry};
use shared::model::ModelKind;
use shared::parameters::noise_parameter;

use super::estimate::reason;
use crate::finished_calibration::FinishedCalibration;
use crate::flag::model_limit::model_limits;
use crate::flag::unsettled_run::unsettled;
use crate::report::quantity::Quantity;
use crate::study::Study;
use crate::table::comparison::Comparison;
use crate::table::coverage::Coverage;
use crate::table::errors::ErrorTable;
use crate::words::number;

/// Flags first, then the verdict, then what a reader must know of the model.
pub(in crate::report) fn verdict(study: &Study, comparison: &Comparison) -> Markup {
    let outcome = &study.lead;
    let flags = study.flags();
    html! {
        @if !flags.is_empty() {
            div.flags role="note" {
                h2 { "Needs attention" }
                ul { @for flag in &flags { li { span.kind { (flag.kind.replace('_', " ")) } ": " (flag.text) } } }
            }
        }
        p.verdict {
            @for sentence in sentences(outcome, comparison) { (sentence) " " }
            @if flags.is_empty() { "No flag was raised." }
        }
        ul.notes { @for note in notes(outcome) { li { (note) } } }
    }
}

fn sentences(outcome: &FinishedCalibration, comparison: &Comparison) -> Vec<String> {
    let mut text = vec![match &outcome.estimate {
        Some(estimate) => format!(
            "A {} found the most probable parameters in {}; it stopped because {}. It says nothing of what else the data allow.",
            if estimate.sd.is_some() { "fit" } else { "search" },
            number::count(outcome.row.evaluations.unwrap_or(0) as usize, "evaluation"),
            reason(estimate.stop)
        ),
        None => equilibrium(outcome),
    }];
    text.push(match &comparison.fit {
        Some(fit) => format!(
            "On the {} the calibrated model is off by {} (root mean square).",
            few(runs(outcome, RunUse::Fit), "fitted run"),
            misses(fit)
        ),
        None => "The model has no prediction for any fitted run: it refused every final draw.".into(),
    });
    text.extend(holdout(outcome, comparison));
    text.extend(coverage(comparison));
    text.extend(inferred_noise(outcome));
    text
}

fn equilibrium(outcome: &FinishedCalibration) -> String {
    let stages = number::count(outcome.stages.len(), "stage");
    let unsettled: Vec<String> = outcome
        .stages
        .iter()
        .filter(|s| !s.equilibrated)
        .map(|s| s.stage.to_string())
        .collect();
    match outcome.row.equilibrated {
        Some(true) => format!(
            "The sampler reached equilibrium in each of its {stages}, so its draws can be read as the posterior."
        ),
        Some(false) if unsettled.is_empty() => {
            "The sampler did not reach equilibrium: no number below can be trusted.".into()
        }
        Some(false) if unsettled.len() == outcome.stages.len() => {
            format!(
                "The sampler did not reach equilibrium in any of its {stages}: no number below can be trusted."
            )
        }
        Some(false) => format!(
            "The sampler did not reach equilibrium in {} of its {stages} ({}): no number below can be trusted.",
            unsettled.len(),
            number::list(&unsettled)
        ),
        None => "Whether the sampler reached equilibrium is not known.".into(),
    }
}

/// `2.8 N in drawbar pull and 9.0 mm in sinkage`.
fn misses(table: &ErrorTable) -> String {
    let miss = |c: Channel| {
        Some(format!(
            "{} in {}",
            Quantity::of(c).words(table.channel(c)?.rmse),
            c.words()
        ))
    };
    number::list(&Channel::ALL.into_iter().filter_map(miss).collect::<Vec<_>>())
}

fn holdout(outcome: &FinishedCalibration, comparison: &Comparison) -> Vec<String> {
    let held = runs(outcome, RunUse::Holdout);
    if held == 0 {
        let text = "No run was held out, so nothing here shows how well the model predicts conditions that it was not fitted to.";
        return vec![text.into()];
    }
    let Some(model) = &comparison.holdout else {
        return vec![format!(
            "There is no prediction for the {}.",
            few(held, "holdout run")
        )];
    };
    let mut text = vec![format!(
        "On the {}, which the fit never saw, by {}.",
        few(held, "holdout run"),
        misses(model)
    )];
    // Like with like: the model on the rows where interpolation has a value.
    let rows = comparison
        .rows
        .iter()
        .filter(|r| r.usage == "holdout" && r.interpolated.is_some());
    text.push(match (&comparison.baseline_holdout, ErrorTable::of_model(rows)) {
        (Some(baseline), Some(model)) => format!(
            "Interpolating the fitted measurements in slip, without any physics, is off by {} where it has a value; there the model {}.",
            misses(baseline),
            against(&model, baseline)
        ),
        _ => "Interpolating the fitted measurements in slip, without any physics, would have to extrapolate there.".into(),
    });
    text
}

/// How the model does against interpolation, channel by channel.
fn against(model: &ErrorTable, baseline: &ErrorTable) -> String {
    let mut groups: [(&str, Vec<String>); 3] = [
        ("does better in", vec![]),
        ("does about as well in", vec![]),
        ("does worse in", vec![]),
    ];
    for channel in Channel::ALL {
        let (Some(m), Some(b)) = (model.channel(channel), baseline.channel(channel)) else {
            continue;
        };
        let ratio = m.rmse / b.rmse;
        if !ratio.is_finite() || ratio <= 0.0 {
            continue;
        }
        // Each error is known to 1/sqrt(2n) of itself: their ratio differs from 1 beyond two standard errors or not.
        let clear = 2.0 / (m.runs as f64).sqrt();
        let times = |r: f64| {
            format!(
                "{} ({} times the error)",
                channel.words(),
                number::significant(r, 2)
            )
        };
        let group = if ratio.ln() < -clear {
            0
        } else if ratio.ln() > clear {
            2
        } else {
            1
        };
        groups[group].1.push(times(ratio));
    }
    let parts: Vec<String> = groups
        .iter()
        .filter(|g| !g.1.is_empty())
        .map(|(verb, who)| format!("{verb} {}", number::list(who)))
        .collect();
    if parts.is_empty() {
        "cannot be compared".into()
    } else {
        number::list(&parts)
    }
}

fn coverage(comparison: &Comparison) -> Option<String> {
    let parts: Vec<String> = [("fit", "fitted"), ("holdout", "holdout")]
        .into_iter()
        .filter_map(|(usage, word)| {
            let c = Coverage::count(comparison.rows.iter().filter(|r| r.usage == usage))?;
            let [low, high] = c.expected();
            Some(format!(
                "{} of {} {word} measurements ({low} to {high} expected)",
                c.inside, c.of
            ))
        })
        .collect();
    (!parts.is_empty()).then(|| {
        format!(
            "In their 90\u{a0}% predictive intervals lie {}.",
            number::list(&parts)
        )
    })
}

/// Where the noise was inferred from the misfit, a small error in units of it proves nothing.
fn inferred_noise(outcome: &FinishedCalibration) -> Option<String> {
    let noise = |channel: Channel| {
        let parameter = outcome
            .spec
            .parameters
            .iter()
            .position(|p| p.name == noise_parameter(channel))?;
        let (value, sd) = match &outcome.estimate {
            Some(estimate) => {
                let sd = estimate.sd.as_ref().and_then(|sd| sd[parameter]);
                (estimate.theta[parameter], sd.unwrap_or(0.0))
            }
            None => mean_and_sd(&outcome.draws(parameter))?,
        };
        let q = Quantity::of(channel);
        let shown = if sd > 0.0 {
            number::with_spread(value * q.scale, sd * q.scale)
        } else {
            number::significant(value * q.scale, 2)
        };
        let mut text = format!("{shown}\u{a0}{} for {}", q.unit, channel.words());
        if let Some((scatter, freedom)) =
            repeat_scatter(&outcome.spec.experiment, &outcome.spec.fit_runs, channel)
        {
            let se = scatter / (2.0 * freedom as f64).sqrt();
            let scatter = number::with_spread(scatter * q.scale, se * q.scale);
            text.push_str(&format!(
                ", where repeats of one condition scatter by {scatter}\u{a0}{}",
                q.unit
            ));
        }
        Some(text)
    };
    let inferred: Vec<String> = Channel::ALL.into_iter().filter_map(noise).collect();
    (!inferred.is_empty()).then(|| {
        format!(
            "The noise sd was inferred from these very misfits: {}. What exceeds the scatter of repeats is the model's own misfit, so {} for the model.",
            inferred.join("; "),
            if outcome.estimate.is_none() {
                "neither the width of the intervals nor an error of one noise sd speaks"
            } else {
                "an error of one noise sd does not speak"
            }
        )
    })
}

/// `24 fitted runs`, `one fitted run`.
fn few(n: usize, noun: &str) -> String {
    if n == 1 {
        format!("one {noun}")
    } else {
        number::count(n, noun)
    }
}

fn runs(outcome: &FinishedCalibration, usage: RunUse) -> usize {
    outcome
        .spec
        .experiment
        .runs
        .iter()
        .filter(|r| r.usage == usage)
        .count()
}

fn notes(outcome: &FinishedCalibration) -> Vec<String> {
    let mut notes = Vec::new();
    // where grousers are declared, the notes of the job name their wheels
    let quasi_static = outcome.spec.model.kind == ModelKind::QuasiStatic;
    if quasi_static
        && !outcome
            .spec
            .experiment
            .wheels
            .values()
            .any(WheelGeometry::has_grousers)
    {
        notes.push("Grousers are not modelled here: each wheel has its own wheel_radius_m.NAME.".to_owned());
    }
    notes.extend(
        model_limits(&outcome.spec)
            .into_iter()
            .map(|note| format!("{note}.")),
    );
    notes.extend(unsettled(outcome).map(|note| format!("{note}.")));
    notes.push("Likelihood: normalised Gaussian; the source paper's Eq. 13-15 lack 1/sigma.".into());
    notes
}
