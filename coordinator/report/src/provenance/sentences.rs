//! Sentences of the provenance: the results of a calibration, and notes on its limits.

use inference::diagnostics::mean_and_sd;
use job::repeat_scatter;
use shared::channel::Channel;
use shared::experiment::{RunUse, WheelGeometry};
use shared::parameters::noise_parameter;

use crate::flag::model_limit::model_limits;
use crate::flag::unsettled_run::unsettled;
use crate::story::wrong::size;
use inference::point_estimate::StopReason;
use result::finished_calibration::FinishedCalibration;
use result::table::comparison::Comparison;
use result::table::coverage::Coverage;
use result::table::errors::ErrorTable;
use result::table::interpolation::InterpolatedOver;
use result::table::refusal::Refusal;
use result::table::row::{ComparisonRow, rows_of};
use result::words::campaign::CampaignWords;
use result::words::data_channel::ShownUnit;
use result::words::number;

/// Describes how the calibration ended, and its errors.
pub(super) fn sentences(calibration: &FinishedCalibration, comparison: &Comparison) -> Vec<String> {
    let mut text = vec![match calibration.estimate() {
        Some(estimate) => format!(
            "A {} found the most probable parameters in {}; it stopped because {}. It does not show which other parameters the data allow.",
            if estimate.sd.is_some() { "fit" } else { "search" },
            number::count(calibration.row.evaluations.unwrap_or(0) as usize, "evaluation"),
            reason(estimate.stop)
        ),
        None => match calibration.approximated() {
            Some(mode) => format!(
                "A fit found the most probable parameters in {}; it stopped because {}. Draws, intervals and evidence below are those of a normal approximation about them: exact where the posterior is normal in the normal scores of the parameters.",
                number::count(calibration.row.evaluations.unwrap_or(0) as usize, "evaluation"),
                reason(mode.stop)
            ),
            None => equilibrium(calibration),
        },
    }];
    text.push(match &comparison.fit {
        Some(fit) => format!(
            "On the {} the calibrated model has a root mean square error of {}.",
            few(runs(calibration, RunUse::Fit), "fitted run"),
            misses(fit)
        ),
        None => "The model has no prediction for any fitted run: it rejected every final draw.".into(),
    });
    text.extend(holdout(calibration, comparison));
    text.extend(coverage(comparison));
    text.extend(inferred_noise(calibration));
    text
}

fn equilibrium(calibration: &FinishedCalibration) -> String {
    let stages = number::count(calibration.stages().len(), "stage");
    let unsettled: Vec<String> = calibration
        .stages()
        .iter()
        .filter(|s| !s.equilibrated)
        .map(|s| s.stage.to_string())
        .collect();
    match calibration.row.equilibrated {
        Some(true) => format!(
            "The sampler reached equilibrium in each of its {stages}, so its draws represent the posterior."
        ),
        Some(false) if unsettled.is_empty() => {
            "The sampler did not reach equilibrium: no number below can be trusted.".into()
        }
        Some(false) if unsettled.len() == calibration.stages().len() => {
            format!(
                "The sampler did not reach equilibrium in any of its {stages}: no number below can be trusted."
            )
        }
        Some(false) => format!(
            "The sampler did not reach equilibrium in {} of its {stages} ({}): no number below can be trusted.",
            unsettled.len(),
            number::list(&unsettled)
        ),
        None => "Whether the sampler reached equilibrium is unknown.".into(),
    }
}

/// Says why a fit stopped.
fn reason(stop: StopReason) -> &'static str {
    match stop {
        StopReason::Decrease => "no step improves the posterior any more",
        StopReason::Step => {
            "no tried step improved the posterior: the numerical noise of the model hides smaller improvements"
        }
        StopReason::Budget => "its budget of evaluations was used; a better point may be near",
        StopReason::Stagnation => "many generations brought no improvement",
        StopReason::Generations => "its last generation was reached; a better point may be near",
    }
}

/// Lists the errors by channel: `2.8 N in drawbar pull and 9.0 mm in sinkage`.
fn misses(table: &ErrorTable) -> String {
    let miss = |c: Channel| Some(format!("{} in {}", size(c, table.channel(c)?.rmse), c.words()));
    number::list(&Channel::ALL.into_iter().filter_map(miss).collect::<Vec<_>>())
}

fn holdout(calibration: &FinishedCalibration, comparison: &Comparison) -> Vec<String> {
    let held = runs(calibration, RunUse::Holdout);
    if held == 0 {
        let text = "No run was held out, so the prediction error in new conditions is unknown.";
        return vec![text.into()];
    }
    let Some(model) = &comparison.holdout else {
        return vec![format!(
            "There is no prediction for the {}.",
            few(held, "holdout run")
        )];
    };
    let refused = calibration.spec.holdout_runs.iter();
    let refused = refused.filter_map(|&run| calibration.refusal(run));
    let mut text = vec![match refused.filter(Refusal::is_at_half_or_more).count() {
        0 => format!(
            "On the {}, not used in the fit, it is {}.",
            few(held, "holdout run"),
            misses(model)
        ),
        refused => format!(
            "On {} of the {}, not used in the fit, it is {}; the model refuses the others at half of its final draws or more.",
            held - refused,
            few(held, "holdout run"),
            misses(model)
        ),
    }];
    // Compare both on the same rows: those where interpolation has a value.
    let both = || {
        rows_of(&comparison.rows, RunUse::Holdout)
            .filter(|r| r.predicted.is_some() && r.interpolated.is_some())
    };
    text.push(match (ErrorTable::of_baseline(both()), ErrorTable::of_model(both())) {
        (Some(baseline), Some(model)) => format!(
            "Interpolating the fitted measurements {}, without physics, has an error of {} where it applies{}; there the model {}.",
            over(both()),
            misses(&baseline),
            beyond(both()),
            against(&model, &baseline)
        ),
        _ => "Interpolating the fitted measurements, without physics, does not apply there.".into(),
    });
    text.extend(
        comparison
            .not_interpolated
            .iter()
            .map(|why| format!("Not interpolated: {why}.")),
    );
    text
}

/// Names the conditions that the rows are interpolated over.
fn over<'a>(mut rows: impl Iterator<Item = &'a ComparisonRow>) -> &'static str {
    match rows.all(|row| row.interpolated_over == Some(InterpolatedOver::Slip)) {
        true => "in slip",
        false => "over the conditions that vary",
    }
}

/// Counts extrapolated rows: ` (46 measurements between the fitted conditions, 2 beyond them)`; empty if there are none.
fn beyond<'a>(rows: impl Iterator<Item = &'a ComparisonRow>) -> String {
    let is_beyond = rows.map(|row| row.interpolated_over == Some(InterpolatedOver::Extrapolation));
    let is_beyond: Vec<bool> = is_beyond.collect();
    match is_beyond.iter().filter(|beyond| **beyond).count() {
        0 => String::new(),
        beyond => format!(
            " ({} between the fitted conditions, {beyond} beyond them)",
            number::count(is_beyond.len() - beyond, "measurement")
        ),
    }
}

/// Compares the model with interpolation, channel by channel.
fn against(model: &ErrorTable, baseline: &ErrorTable) -> String {
    let mut groups: [(&str, Vec<String>); 3] = [
        ("does better in", vec![]),
        ("differs by no more than chance in", vec![]),
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
        // Each error has the relative standard error 1/sqrt(2n). The ratio differs from 1 if it is more than two standard errors away.
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
    let parts: Vec<String> = [(RunUse::Fit, "fitted"), (RunUse::Holdout, "holdout")]
        .into_iter()
        .filter_map(|(usage, word)| {
            let c = Coverage::count(rows_of(&comparison.rows, usage))?;
            let [low, high] = c.expected();
            Some(format!(
                "{} of {} {word} measurements ({low} to {high} expected)",
                c.inside, c.total
            ))
        })
        .collect();
    (!parts.is_empty()).then(|| {
        format!(
            "The 90\u{a0}% predictive intervals contain {}.",
            number::list(&parts)
        )
    })
}

/// Returns a caution if the noise was inferred from the misfit, because a small error in noise standard deviations is then no evidence
/// for the model.
fn inferred_noise(calibration: &FinishedCalibration) -> Option<String> {
    let noise = |channel: Channel| {
        let parameter = calibration
            .spec
            .parameters
            .iter()
            .position(|p| p.name == noise_parameter(channel))?;
        let (value, sd) = match calibration.estimate() {
            Some(estimate) => {
                let sd = estimate.sd.as_ref().and_then(|sd| sd[parameter]);
                (estimate.theta[parameter], sd.unwrap_or(0.0))
            }
            None => mean_and_sd(&calibration.draws(parameter))?,
        };
        let unit = ShownUnit::new(channel);
        let shown = if sd > 0.0 {
            number::with_spread(value * unit.factor, sd * unit.factor)
        } else {
            number::significant(value * unit.factor, 2)
        };
        let mut text = format!("{shown}\u{a0}{} for {}", unit.name, channel.words());
        if let Some((scatter, freedom)) =
            repeat_scatter(&calibration.spec.experiment, &calibration.spec.fit_runs, channel)
        {
            let se = scatter / (2.0 * freedom as f64).sqrt();
            let scatter = number::with_spread(scatter * unit.factor, se * unit.factor);
            text.push_str(&format!(
                ", where repeats of one condition scatter by {scatter}\u{a0}{}",
                unit.name
            ));
        }
        Some(text)
    };
    let inferred: Vec<String> = Channel::ALL.into_iter().filter_map(noise).collect();
    (!inferred.is_empty()).then(|| {
        format!(
            "The noise sd was inferred from these misfits: {}. The part above the scatter of repeats is model error, so {} for the model.",
            inferred.join("; "),
            if calibration.estimate().is_none() {
                "neither the width of the intervals nor an error of one noise sd is evidence"
            } else {
                "an error of one noise sd is no evidence"
            }
        )
    })
}

/// Formats a count, with a word for one: `24 fitted runs`, `one fitted run`.
fn few(n: usize, noun: &str) -> String {
    if n == 1 {
        format!("one {noun}")
    } else {
        number::count(n, noun)
    }
}

fn runs(calibration: &FinishedCalibration, usage: RunUse) -> usize {
    calibration
        .spec
        .experiment
        .runs
        .iter()
        .filter(|r| r.usage == usage)
        .count()
}

/// Lists the limits of the model and the departures from the source paper.
pub(super) fn notes(calibration: &FinishedCalibration) -> Vec<String> {
    let mut notes = Vec::new();
    if let Some(campaign) = &calibration.spec.experiment.campaign {
        let words = CampaignWords::from(campaign);
        let note = |what: &str, text: &str| format!("{what}{}.", text.trim_end_matches('.'));
        notes.push(note("Measurements: ", &words.citation));
        notes.extend(words.digitised.iter().map(|text| note("They are ", text)));
        notes.extend(words.method.iter().map(|text| note("Method, ", text)));
        notes.extend(words.doubts.iter().map(|text| note("Doubt: ", text)));
    }
    let accepted = calibration.spec.accepted.join(", ");
    if !accepted.is_empty() {
        notes.push(format!("What looks odd was accepted as meant: {accepted}."));
    }
    // If grousers are declared, the limits of the model name their wheels.
    if calibration.spec.model.kind.is_smooth()
        && !calibration
            .spec
            .experiment
            .wheels
            .values()
            .any(WheelGeometry::has_grousers)
    {
        notes.push("The wheels are smooth rims: no grousers are declared.".to_owned());
    }
    notes.extend(
        model_limits(&calibration.spec)
            .into_iter()
            .map(|note| format!("{note}.")),
    );
    notes.extend(unsettled(calibration).map(|note| format!("{note}.")));
    notes
}
