//! Diagnostics as text for a terminal.

use std::fmt::Write;

use crate::diagnostics::calibration::Diagnostics;
use crate::diagnostics::channels::{ChannelDiagnostics, CoverageCount};
use crate::diagnostics::data_channel::shown;
use crate::diagnostics::directions::{DirectionDiagnostics, WORST_KNOWN};
use crate::diagnostics::rejections::RejectionDiagnostics;
use crate::diagnostics::residuals::{ResidualDiagnostics, largest};
use crate::diagnostics::sampler::SamplerDiagnostics;
use crate::diagnostics::trends::TrendDiagnostics;
use crate::words::number;
use crate::words::probability::probability;

/// The full text report.
pub fn diagnostics(diagnostics: &Diagnostics) -> String {
    let mut parts = Vec::new();
    parts.extend(diagnostics.sampler.as_ref().map(sampler));
    parts.push(channels(&diagnostics.channels));
    if !diagnostics.residuals.is_empty() {
        parts.push(residuals(&diagnostics.residuals));
    }
    if !diagnostics.trends.is_empty() {
        parts.push(trends(&diagnostics.trends));
    }
    parts.push(parameters(diagnostics));
    if !diagnostics.directions.is_empty() {
        parts.push(directions(&diagnostics.directions));
    }
    parts.push(rejections(&diagnostics.rejections));
    parts.push(findings(diagnostics));
    parts.push(flags(diagnostics));
    parts.retain(|part| !part.is_empty());
    parts.join("\n")
}

/// The findings, a line each.
pub(crate) fn findings(diagnostics: &Diagnostics) -> String {
    let lines = diagnostics.findings.iter().map(|words| format!("{words}\n"));
    lines.collect()
}

/// The flags, a line each.
pub(crate) fn flags(diagnostics: &Diagnostics) -> String {
    let lines = diagnostics.flags.iter();
    lines
        .map(|flag| format!("flag {}: {}\n", flag.kind, flag.text))
        .collect()
}

fn cell(value: Option<f64>) -> String {
    value.map_or("-".into(), number::four_digits)
}

fn short(value: Option<f64>) -> String {
    value.map_or("-".into(), |x| number::significant(x, 2))
}

fn p_cell(value: Option<f64>) -> String {
    value.map_or("-".into(), probability)
}

fn sampler(sampler: &SamplerDiagnostics) -> String {
    let mut text = match sampler.equilibrated {
        Some(true) => "equilibrium was reached in every stage".to_owned(),
        Some(false) => "equilibrium was not reached".to_owned(),
        None => "whether equilibrium was reached is not known".to_owned(),
    };
    let _ = writeln!(
        text,
        "; {} draws, {} of them different; effective sample size {} at the last stage",
        sampler.draws,
        sampler.distinct_draws,
        sampler
            .effective_sample_size
            .map_or("-".into(), |ess| format!("{ess:.0}"))
    );
    let _ = writeln!(
        text,
        "{:>5} {:>10} {:>6} {:>10} {:>8} {:>11} {:>8} {:>11}",
        "stage", "exponent", "steps", "acceptance", "drift z", "correlation", "ess", "evaluations"
    );
    for s in &sampler.stages {
        let _ = writeln!(
            text,
            "{:>5} {:>10.3e} {:>6} {:>10.2} {:>8.2} {:>11.2} {:>8.0} {:>11}{}",
            s.stage,
            s.tempering_exponent,
            s.steps,
            s.acceptance,
            s.drift_z,
            s.correlation,
            s.ess,
            s.evaluations,
            if s.equilibrated {
                ""
            } else {
                "  not in equilibrium"
            }
        );
    }
    text
}

fn channels(channels: &[ChannelDiagnostics]) -> String {
    let mut text = format!(
        "{:<14} {:<4} {:>5} {:>10} {:>12} {:>11} {:>10} {:>10} {:>8} {:>9}  {:<26} holdout\n",
        "channel",
        "unit",
        "data",
        "error sd",
        "prior allows",
        "information",
        "parameters",
        "chi-square",
        "expected",
        "p",
        "inside 90 %: fit"
    );
    let count = |c: &Option<CoverageCount>| {
        c.map_or("-".into(), |c| {
            format!(
                "{} of {} ({} to {})",
                c.inside, c.of, c.expected_from, c.expected_to
            )
        })
    };
    for c in channels {
        let square = c.chi_square.as_ref();
        let (scale, unit) = shown(&c.channel);
        let _ = writeln!(
            text,
            "{:<14} {:<4} {:>5} {:>10} {:>12} {:>11} {:>10} {:>10} {:>8} {:>9}  {:<26} {}",
            c.channel,
            unit,
            c.data,
            cell(c.error_sd.map(|sd| scale * sd)),
            cell(c.prior_predictive_sd.map(|sd| scale * sd)),
            short(c.information),
            short(c.effective_parameters),
            cell(square.map(|s| s.chi_square)),
            cell(square.map(|s| s.degrees_of_freedom)),
            p_cell(square.and_then(|s| s.p)),
            count(&c.coverage90_fit),
            count(&c.coverage90_holdout)
        );
    }
    text
}

fn residuals(all: &[ResidualDiagnostics]) -> String {
    let mut text = format!(
        "{:<28} {:<14} {:<4} {:>10} {:>10} {:>9} {:>12} {:>9}\n",
        "largest residuals: run", "channel", "unit", "residual", "error sd", "leverage", "studentised", "p"
    );
    for r in largest(all) {
        let (scale, unit) = shown(&r.channel);
        let _ = writeln!(
            text,
            "{:<28} {:<14} {:<4} {:>10} {:>10} {:>9.2} {:>12} {:>9}",
            r.run,
            r.channel,
            unit,
            number::four_digits(scale * r.residual),
            number::four_digits(scale * r.error_sd),
            r.leverage,
            short(r.studentised),
            p_cell(r.p)
        );
    }
    text
}

fn trends(all: &[TrendDiagnostics]) -> String {
    let mut text = format!(
        "{:<14} {:<18} {:<4} {:>10} {:>10} {:>10} {:>9}\n",
        "trend of", "against", "unit", "change", "sd", "share left", "p"
    );
    for t in all {
        let (scale, unit) = shown(&t.channel);
        let _ = writeln!(
            text,
            "{:<14} {:<18} {:<4} {:>10} {:>10} {:>10.2} {:>9}",
            t.channel,
            t.against.name(),
            unit,
            number::four_digits(scale * t.change),
            number::four_digits(scale * t.change_sd),
            t.share_left,
            probability(t.p)
        );
    }
    text
}

fn parameters(diagnostics: &Diagnostics) -> String {
    let width = diagnostics
        .parameters
        .iter()
        .map(|p| p.name.len())
        .fold(28, usize::max);
    let mut text = format!(
        "{:<width$} {:>11} {:>23}\n",
        "parameter", "contraction", "p of prior against data"
    );
    for p in &diagnostics.parameters {
        let _ = writeln!(
            text,
            "{:<width$} {:>11} {:>23}{}",
            p.name,
            p.contraction.map_or("-".into(), |c| number::fixed(c, 2)),
            p_cell(p.conflict_p),
            if p.at_bound { "  AT BOUND" } else { "" }
        );
    }
    if let Some(all) = &diagnostics.conflict {
        let distance = format!(
            "all together: squared distance {} for {} directions",
            number::significant(all.statistic, 3),
            all.degrees_of_freedom
        );
        let _ = writeln!(text, "{distance}, p {}", p_cell(all.p));
    }
    text
}

fn directions(all: &[DirectionDiagnostics]) -> String {
    let mut text = format!("{:<24} direction, in prior sds\n", "share of prior spread");
    let line =
        |d: &DirectionDiagnostics| format!("{:<24} {}\n", number::significant(d.sd_ratio, 2), d.words());
    text.extend(all.iter().take(WORST_KNOWN).map(line));
    if all.len() > WORST_KNOWN {
        text.push_str("...\n");
        text.extend(all.last().map(line));
    }
    text
}

/// What was refused in each fifth of each prior; nothing where nothing was refused and nothing failed.
fn rejections(rejections: &RejectionDiagnostics) -> String {
    let mut text = String::new();
    for (message, count) in &rejections.faults {
        let _ = writeln!(text, "{count} leases failed and were given out again: {message}");
    }
    let faults = rejections
        .parameters
        .iter()
        .flat_map(|p| &p.bins)
        .any(|b| b.faults > 0);
    if rejections.prior_refused == 0 && !faults {
        return text;
    }
    let width = rejections
        .parameters
        .iter()
        .map(|p| p.name.len())
        .fold(28, usize::max);
    let _ = writeln!(
        text,
        "refused (of drawn) in each fifth of the prior, {} of {} draws in all",
        rejections.prior_refused, rejections.prior_draws
    );
    for p in &rejections.parameters {
        let cells = p.bins.iter().map(|b| {
            let faults = if b.faults > 0 {
                format!(", {} faults", b.faults)
            } else {
                String::new()
            };
            let cell = format!("{} ({}){faults}", b.refused.values().sum::<u64>(), b.draws);
            let end =
                b.to.map_or(String::new(), |to| format!(" | {}", number::significant(to, 3)));
            format!("{cell:>12}{end}")
        });
        let _ = writeln!(text, "{:<width$}{}", p.name, cells.collect::<String>());
    }
    text
}
