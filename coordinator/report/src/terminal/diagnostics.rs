//! Diagnostics as text for a terminal.

use std::fmt::Write;

use super::column::{cell, width};
use result::diagnostics::calibration::Diagnostics;
use result::diagnostics::channels::{ChannelDiagnostics, CoverageCount};
use result::diagnostics::directions::{DirectionDiagnostics, WORST_KNOWN};
use result::diagnostics::rejections::RejectionDiagnostics;
use result::diagnostics::residuals::{ResidualDiagnostics, largest};
use result::diagnostics::sampler::SamplerDiagnostics;
use result::diagnostics::trends::TrendDiagnostics;
use result::words::data_channel::ShownUnit;
use result::words::number;
use result::words::probability::probability;

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
    parts.push(format!("{}\n", diagnostics.verification.words()));
    parts.push(findings(diagnostics));
    parts.push(flags(diagnostics));
    parts.retain(|part| !part.is_empty());
    parts.join("\n")
}

/// The findings that no flag repeats, a line each.
pub(crate) fn findings(diagnostics: &Diagnostics) -> String {
    let is_flag = |words: &&String| diagnostics.flags.iter().any(|flag| flag.text.ends_with(*words));
    let lines = diagnostics.findings.iter().filter(|words| !is_flag(words));
    lines.map(|words| format!("{words}\n")).collect()
}

/// The flags, a line each.
pub(crate) fn flags(diagnostics: &Diagnostics) -> String {
    let lines = diagnostics.flags.iter();
    lines
        .map(|flag| format!("flag {}: {}\n", flag.kind.name(), flag.text))
        .collect()
}

fn sampler(sampler: &SamplerDiagnostics) -> String {
    let mut text = match sampler.equilibrated {
        Some(true) => "every stage reached equilibrium".to_owned(),
        Some(false) => "the sampler did not reach equilibrium".to_owned(),
        None => "whether the sampler reached equilibrium is unknown".to_owned(),
    };
    let _ = writeln!(
        text,
        "; {}, {} of them distinct; effective sample size {} at the last stage",
        number::count(sampler.draws, "draw"),
        sampler.distinct_draws,
        cell(sampler.effective_sample_size, |ess| format!("{ess:.0}"))
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
        "prior spread",
        "information",
        "parameters",
        "chi-square",
        "expected",
        "p",
        "inside 90 %: fit"
    );
    let count = |c: &Option<CoverageCount>| {
        cell(*c, |c| {
            format!(
                "{} of {} ({} to {})",
                c.inside, c.of, c.expected_from, c.expected_to
            )
        })
    };
    for c in channels {
        let square = c.chi_square.as_ref();
        let unit = c.channel.shown();
        let _ = writeln!(
            text,
            "{:<14} {:<4} {:>5} {:>10} {:>12} {:>11} {:>10} {:>10} {:>8} {:>9}  {:<26} {}",
            c.channel.name(),
            unit.name,
            c.data,
            cell(c.error_sd.map(|sd| unit.factor * sd), number::four_digits),
            cell(
                c.prior_predictive_sd.map(|sd| unit.factor * sd),
                number::four_digits
            ),
            cell(c.information, |x| number::significant(x, 2)),
            cell(c.effective_parameters, |x| number::significant(x, 2)),
            cell(square.map(|s| s.chi_square), number::four_digits),
            cell(square.map(|s| s.degrees_of_freedom), number::four_digits),
            cell(square.and_then(|s| s.p), probability),
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
        let unit = r.channel.shown();
        let _ = writeln!(
            text,
            "{:<28} {:<14} {:<4} {:>10} {:>10} {:>9.2} {:>12} {:>9}",
            r.run,
            r.channel.name(),
            unit.name,
            number::four_digits(unit.factor * r.residual),
            number::four_digits(unit.factor * r.error_sd),
            r.leverage,
            cell(r.studentised, |x| number::significant(x, 2)),
            cell(r.p, probability)
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
        let unit = ShownUnit::of(t.channel);
        let _ = writeln!(
            text,
            "{:<14} {:<18} {:<4} {:>10} {:>10} {:>10.2} {:>9}",
            t.channel.name(),
            t.against.name(),
            unit.name,
            number::four_digits(unit.factor * t.change),
            number::four_digits(unit.factor * t.change_sd),
            t.share_left,
            probability(t.p)
        );
    }
    text
}

fn parameters(diagnostics: &Diagnostics) -> String {
    let width = width(diagnostics.parameters.iter().map(|p| &p.name));
    let mut text = format!(
        "{:<width$} {:>11} {:>23}\n",
        "parameter", "contraction", "p of prior conflict"
    );
    for p in &diagnostics.parameters {
        let _ = writeln!(
            text,
            "{:<width$} {:>11} {:>23}{}",
            p.name,
            cell(p.contraction, |c| number::fixed(c, 2)),
            cell(p.conflict_p, probability),
            if p.at_bound { "  AT BOUND" } else { "" }
        );
    }
    if let Some(all) = &diagnostics.conflict {
        let distance = format!(
            "all together: squared distance {} for {}",
            number::significant(all.statistic, 3),
            number::count(all.degrees_of_freedom, "direction")
        );
        let _ = writeln!(text, "{distance}, p {}", cell(all.p, probability));
    }
    text
}

fn directions(all: &[DirectionDiagnostics]) -> String {
    let mut text = format!("{:<24} direction, in prior sds\n", "share of prior sd");
    let line =
        |d: &DirectionDiagnostics| format!("{:<24} {}\n", number::significant(d.sd_ratio, 2), d.words());
    text.extend(all.iter().take(WORST_KNOWN).map(line));
    if all.len() > WORST_KNOWN {
        text.push_str("...\n");
        text.extend(all.last().map(line));
    }
    text
}

/// Rejections in each fifth of each prior; empty where nothing was rejected and nothing failed.
fn rejections(rejections: &RejectionDiagnostics) -> String {
    let mut text = String::new();
    for (message, count) in &rejections.faults {
        let _ = writeln!(
            text,
            "{} failed and {} retried: {message}",
            number::count(*count as usize, "lease"),
            if *count == 1 { "was" } else { "were" }
        );
    }
    let faults = rejections
        .parameters
        .iter()
        .flat_map(|p| &p.bins)
        .any(|b| b.faults > 0);
    if rejections.prior_refused == 0 && !faults {
        return text;
    }
    let width = width(rejections.parameters.iter().map(|p| &p.name));
    let _ = writeln!(
        text,
        "rejected (of drawn) in each fifth of the prior, {} of {} draws in all",
        rejections.prior_refused, rejections.prior_draws
    );
    for p in &rejections.parameters {
        let cells = p.bins.iter().map(|b| {
            let faults = if b.faults > 0 {
                format!(", {}", number::count(b.faults as usize, "fault"))
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
