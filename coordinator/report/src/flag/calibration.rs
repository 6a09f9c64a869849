//! All flags of one calibration.

use job::{SetCondition, confounded_orders};
use shared::parameters::behind;

use super::finding::findings_that_alarm;
use super::plates::plates_conflict;
use super::worker::{disputed, given_up, not_deterministic, quarantined};
use result::diagnostics::calibration::Diagnostics;
use result::diagnostics::trends::TrendVariable;
use result::finished_calibration::FinishedCalibration;
use result::flag::{Flag, FlagKind};
use result::parameter_summary::ParameterSummary;
use result::point_estimate::fitted;
use result::table::predictive::discrepancy_posterior;
use result::table::refusal::Refusal;
use result::words::number;
use result::words::rejection::rejection_counts;

/// Ratio of posterior to prior standard deviation, in the sampler's coordinate, above which the data are called uninformative.
const NO_CONTRACTION: f64 = 0.95;
/// Maximum number of refused runs that are named.
const SHOWN_REFUSED: usize = 3;
/// Share of rejected parameter vectors above which the prior is questioned.
const MANY_REJECTED: f64 = 0.5;

/// Returns all flags. Those that cast doubt on the others come first.
pub(crate) fn flags(calibration: &FinishedCalibration, diagnostics: &Diagnostics) -> Vec<Flag> {
    let mut flags: Vec<Flag> = disputed(calibration)
        .into_iter()
        .chain(quarantined(calibration))
        .chain(not_deterministic(calibration))
        .chain(unbalanced(calibration))
        .collect();
    flags.extend(findings_that_alarm(diagnostics));
    flags.extend(plates_conflict(calibration));
    flags.extend(confounded(calibration));
    let mut flag = |kind: FlagKind, text: String| flags.push(Flag::plain(kind, text));
    for ((name, parameter), found) in calibration
        .parameter_summaries()
        .iter()
        .zip(&diagnostics.parameters)
    {
        if parameter.at_bound {
            flag(FlagKind::Bound, bound_text(name, parameter));
        }
        if let Some(contraction) = found.contraction.filter(|c| *c < 1.0 - NO_CONTRACTION) {
            let left = 100.0 * (1.0 - contraction);
            let text = format!(
                "the data say nothing about {name}: {left:.0} % of its prior standard deviation remains"
            );
            flag(FlagKind::NoInformation, text);
        }
    }
    if let Some(estimate) = calibration.mode()
        && estimate.stop.is_early()
    {
        let (what, rough) = match (&estimate.sd, calibration.approximated()) {
            (_, Some(_)) => ("fit", ", and the normal approximation is not about the mode"),
            (Some(_), None) => ("fit", ", and the standard deviations are approximate"),
            (None, None) => ("search", ""),
        };
        let text = format!(
            "the {what} used its budget before it converged: a better point may be near{rough}; allow more {}",
            calibration.spec.algorithm.budget_key()
        );
        flag(FlagKind::NotEquilibrated, text);
    }
    if let Some(estimate) = calibration.estimate() {
        if calibration.spec.algorithm.has_posterior() {
            let text = "the density about the fit is not that of a normal distribution along every parameter, so there is no normal approximation: no posterior, no ledger, no search; let tmcmc sample";
            flag(FlagKind::NotEquilibrated, text.into());
        }
        for p in fitted(estimate, &calibration.spec.parameters) {
            let (name, prior_sd) = (&p.free.name, p.free.marginal.sd());
            if p.at_bound {
                let text = format!(
                    "{name} lies at a bound of its prior, {}{}: the data favour a value that the prior excludes, or an effect is missing",
                    number::significant(p.value, 4),
                    behind(&p.free.unit)
                );
                flag(FlagKind::Bound, text);
            } else if estimate.sd.is_some() && p.sd.is_none_or(|sd| sd > NO_CONTRACTION * prior_sd) {
                let sd = p.sd.map_or("unbounded".into(), |sd| format!("{sd:.3e}"));
                let text = format!(
                    "the data say nothing about {name}: its standard deviation is {sd} after the fit and {prior_sd:.3e} before"
                );
                flag(FlagKind::NoInformation, text);
            }
        }
    }
    for (channel, levels) in discrepancy_posterior(calibration) {
        if let Some((m, probability)) = levels.last().filter(|(_, p)| *p > 0.5) {
            let text = format!(
                "the largest allowed discrepancy of {}, {m:.0} noise sds, has probability {probability:.2}: the model error is larger still, or the declared noise sd is too small",
                channel.words()
            );
            flag(FlagKind::Bound, text);
        }
    }
    let (evaluations, rejected) = (
        calibration.row.evaluations.unwrap_or(0),
        calibration.row.rejected.unwrap_or(0),
    );
    if rejected as f64 > MANY_REJECTED * evaluations as f64 {
        let mut text = format!(
            "the model rejected {rejected} of {evaluations} parameter vectors because {}: much of the prior lies outside its validity",
            number::list(&rejection_counts(&calibration.rejections))
        );
        if let Some(words) = diagnostics.rejections.words() {
            text.push_str("; ");
            text.push_str(&words);
        }
        flag(FlagKind::Rejections, text);
    }
    flags.extend(given_up(calibration));
    let mut flag = |kind: FlagKind, text: String| flags.push(Flag::plain(kind, text));
    if let Some(text) = refused_holdout(calibration) {
        flag(FlagKind::Rejections, text);
    }
    flags
}

/// Returns a flag for each condition that was set in the order of the runs.
fn confounded(calibration: &FinishedCalibration) -> impl Iterator<Item = Flag> {
    let confounded = confounded_orders(&calibration.spec.experiment, &calibration.spec.fit_runs);
    confounded.into_iter().map(|order| Flag {
        against: Some(match order.condition {
            SetCondition::Slip => TrendVariable::Slip,
            SetCondition::WheelLoad => TrendVariable::WheelLoad,
            SetCondition::SledSpeed => TrendVariable::SledSpeed,
        }),
        ..Flag::plain(FlagKind::Order, order.words())
    })
}

/// Returns a flag if the sampler did not reach equilibrium.
fn unbalanced(calibration: &FinishedCalibration) -> Option<Flag> {
    if calibration.row.equilibrated != Some(false) {
        return None;
    }
    let stages = calibration.stages().iter().filter(|s| !s.equilibrated);
    let stages: Vec<String> = stages.map(|s| s.stage.to_string()).collect();
    let doubt = "neither the draws nor the evidence can be trusted, nor any flag derived from them";
    let text = if stages.is_empty() {
        format!("the sampler did not reach equilibrium: {doubt}")
    } else {
        format!(
            "stage{} {} ended before the moves reached equilibrium: {doubt}; allow more moves or particles",
            if stages.len() == 1 { "" } else { "s" },
            number::list(&stages)
        )
    };
    Some(Flag::plain(FlagKind::NotEquilibrated, text))
}

/// Returns a sentence on the holdout runs that the model refuses; `None` if it refuses none.
fn refused_holdout(calibration: &FinishedCalibration) -> Option<String> {
    let spec = &calibration.spec;
    let refused: Vec<(&str, Refusal)> = spec
        .holdout_runs
        .iter()
        .filter_map(|&run| Some((spec.experiment.runs[run].name.as_str(), calibration.refusal(run)?)))
        .collect();
    let shown = refused.iter().take(SHOWN_REFUSED);
    let mut words: Vec<String> = shown
        .map(|(run, refusal)| format!("{run} at {}", refusal.words()))
        .collect();
    let more = refused.len().saturating_sub(SHOWN_REFUSED);
    if more > 0 {
        words.push(format!("{more} more"));
    }
    let whole = refused
        .iter()
        .filter(|(_, refusal)| refusal.is_at_half_or_more())
        .count();
    let rest = match (whole, spec.holdout_runs.len() - whole) {
        (0, _) => ", and its predictions there rest on the other draws".to_owned(),
        (_, 0) => ", and no held-out run is left to judge the model".to_owned(),
        (whole, rest) => format!(
            "; {whole} of them, refused at half of the draws or more, {} not judged, and errors and coverage are over the other {}",
            if whole == 1 { "is" } else { "are" },
            number::count(rest, "held-out run")
        ),
    };
    (!refused.is_empty()).then(|| {
        format!(
            "the model refuses {} of {}: {}; {} outside its validity{rest}",
            refused.len(),
            number::count(spec.holdout_runs.len(), "held-out run"),
            number::list(&words),
            if refused.len() == 1 { "it lies" } else { "they lie" },
        )
    })
}

fn bound_text(name: &str, p: &ParameterSummary) -> String {
    format!(
        "{name} lies at a bound of its prior (90 % of the posterior in {} to {}): the data favour a value that the prior excludes, or an effect is missing",
        number::to_spread(p.q05, p.sd),
        number::to_spread(p.q95, p.sd)
    )
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::diagnosis::diagnostics;
    use crate::fixture;

    #[test]
    fn a_fit_that_was_to_have_a_posterior_and_has_none_says_so() {
        let is_flagged = |draws: usize| {
            let mut fit = fixture::fit();
            fit.spec.algorithm = job::AlgorithmSettings::Fit(inference::lm::LmSettings {
                draws,
                ..Default::default()
            });
            let flags = diagnostics(&fit, fit.comparison()).flags;
            flags
                .iter()
                .any(|f| f.kind == FlagKind::NotEquilibrated && f.text.contains("tmcmc"))
        };
        assert!(is_flagged(1000));
        assert!(!is_flagged(0));
    }
}
