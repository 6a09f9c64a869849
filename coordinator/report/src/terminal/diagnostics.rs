//! The diagnostics of a calibration as text.

use std::fmt::Write;

use record::StageRow;

use super::column::{at_bound_words, cell, width};
use super::table::Table;
use result::diagnostics::calibration::Diagnostics;
use result::diagnostics::channels::{ChannelDiagnostics, CoverageCount};
use result::diagnostics::directions::{DirectionDiagnostics, WORST_KNOWN};
use result::diagnostics::emulator::{EmulatorDiagnostics, EmulatorRoundRow};
use result::diagnostics::parameters::ParameterDiagnostics;
use result::diagnostics::rejections::RejectionDiagnostics;
use result::diagnostics::residuals::{ResidualDiagnostics, largest};
use result::diagnostics::sampler::SamplerDiagnostics;
use result::diagnostics::trends::TrendDiagnostics;
use result::words::data_channel::ShownUnit;
use result::words::number;
use result::words::probability::probability;

/// Returns all diagnostics.
pub fn diagnostics(diagnostics: &Diagnostics) -> String {
    let mut parts = Vec::new();
    parts.extend(diagnostics.sampler.as_ref().map(sampler));
    parts.extend(diagnostics.emulator.as_ref().map(emulator));
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

/// Returns the findings that no flag repeats, one line each.
pub(crate) fn findings(diagnostics: &Diagnostics) -> String {
    let is_flag = |words: &&String| diagnostics.flags.iter().any(|flag| flag.text.ends_with(*words));
    let lines = diagnostics.findings.iter().filter(|words| !is_flag(words));
    lines.map(|words| format!("{words}\n")).collect()
}

/// Returns the flags, one line each.
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
    let table = Table::<&StageRow>::new()
        .right(5, "stage", |s| s.stage)
        .right(10, "exponent", |s| format!("{:.3e}", s.tempering_exponent))
        .right(6, "steps", |s| s.steps)
        .right(10, "acceptance", |s| format!("{:.2}", s.acceptance))
        .right(8, "drift z", |s| format!("{:.2}", s.drift_z))
        .right(11, "correlation", |s| format!("{:.2}", s.correlation))
        .right(8, "ess", |s| format!("{:.0}", s.ess))
        .right(11, "evaluations", |s| s.evaluations)
        .remark(|s| {
            if s.equilibrated {
                ""
            } else {
                "  not in equilibrium"
            }
        });
    text + &table.text(&sampler.stages)
}

fn emulator(emulator: &EmulatorDiagnostics) -> String {
    let nats = |value: Option<f64>| cell(value, |value| format!("{value:.3}"));
    let mut table = Table::<&EmulatorRoundRow>::new()
        .right(10, "exponent", |r| format!("{:.3e}", r.tempering_exponent))
        .right(11, "evaluations", |r| r.evaluations)
        .right(8, "rejected", |r| r.rejected)
        .right(10, "mean error", move |r| nats(r.mean_error))
        .right(8, "error sd", move |r| nats(r.error_sd));
    let first = emulator.rounds.first();
    for channel in first
        .into_iter()
        .flat_map(|round| round.channel_errors.keys().cloned())
    {
        let name = channel.clone();
        table = table.right(name.len().max(8), &name, move |r| {
            cell(r.channel_errors.get(&channel).copied(), |e| format!("{e:.3}"))
        });
    }
    let table = table
        .right(8, "training", |r| r.training_points)
        .remark(|r| if r.agreed { "" } else { "  refined" });
    let weights = match (emulator.effective_draws, emulator.max_share) {
        (Some(ess), Some(share)) => format!(
            "{} weigh as {ess:.0}; the heaviest has {:.1} % of the weight\n",
            number::count(emulator.final_draws, "final draw"),
            100.0 * share
        ),
        _ => "the emulator was given up, and the model itself was sampled\n".to_owned(),
    };
    "emulator: error of the tempered log-likelihood in nats, errors of the outputs in error sds\n".to_owned()
        + &table.text(&emulator.rounds)
        + &weights
}

fn channels(channels: &[ChannelDiagnostics]) -> String {
    let count = |c: &Option<CoverageCount>| {
        cell(*c, |c| {
            format!(
                "{} of {} ({} to {})",
                c.inside, c.of, c.expected_from, c.expected_to
            )
        })
    };
    let two_digits = |x: f64| number::significant(x, 2);
    let shown = |c: &ChannelDiagnostics, sd: Option<f64>| {
        cell(sd, |sd| number::four_digits(c.channel.shown().factor * sd))
    };
    Table::<&ChannelDiagnostics>::new()
        .left(14, "channel", |c| c.channel.name())
        .left(4, "unit", |c| c.channel.shown().name)
        .right(5, "data", |c| c.data)
        .right(10, "error sd", |c| shown(c, c.error_sd))
        .right(12, "prior spread", |c| shown(c, c.prior_predictive_sd))
        .right(11, "information", |c| cell(c.information, two_digits))
        .right(10, "parameters", |c| cell(c.effective_parameters, two_digits))
        .right(10, "chi-square", |c| {
            cell(c.chi_square.as_ref(), |s| number::four_digits(s.chi_square))
        })
        .right(8, "expected", |c| {
            cell(c.chi_square.as_ref(), |s| {
                number::four_digits(s.degrees_of_freedom)
            })
        })
        .right(9, "p", |c| {
            cell(c.chi_square.as_ref().and_then(|s| s.p), probability)
        })
        .apart(26, "inside 90 %: fit", |c| count(&c.coverage90_fit))
        .left(0, "holdout", |c| count(&c.coverage90_holdout))
        .text(channels)
}

fn residuals(all: &[ResidualDiagnostics]) -> String {
    let shown = |r: &ResidualDiagnostics, x: f64| number::four_digits(r.channel.shown().factor * x);
    Table::<&ResidualDiagnostics>::new()
        .left(28, "largest residuals: run", |r| &r.run)
        .left(14, "channel", |r| r.channel.name())
        .left(4, "unit", |r| r.channel.shown().name)
        .right(10, "residual", |r| shown(r, r.residual))
        .right(10, "error sd", |r| shown(r, r.error_sd))
        .right(9, "leverage", |r| format!("{:.2}", r.leverage))
        .right(12, "studentised", |r| {
            cell(r.studentised, |x| number::significant(x, 2))
        })
        .right(9, "p", |r| cell(r.p, probability))
        .text(largest(all))
}

fn trends(all: &[TrendDiagnostics]) -> String {
    let shown = |t: &TrendDiagnostics, x: f64| number::four_digits(ShownUnit::new(t.channel).factor * x);
    Table::<&TrendDiagnostics>::new()
        .left(14, "trend of", |t| t.channel.name())
        .left(18, "against", |t| t.against.name())
        .left(4, "unit", |t| ShownUnit::new(t.channel).name)
        .right(10, "change", |t| shown(t, t.change))
        .right(10, "sd", |t| shown(t, t.change_sd))
        .right(10, "share left", |t| format!("{:.2}", t.share_left))
        .right(9, "p", |t| probability(t.p))
        .text(all)
}

fn parameters(diagnostics: &Diagnostics) -> String {
    let width = width(diagnostics.parameters.iter().map(|p| &p.name));
    let mut text = Table::<&ParameterDiagnostics>::new()
        .left(width, "parameter", |p| &p.name)
        .right(11, "contraction", |p| {
            cell(p.contraction, |c| number::fixed(c, 2))
        })
        .right(23, "p of prior conflict", |p| cell(p.conflict_p, probability))
        .remark(|p| at_bound_words(p.at_bound))
        .text(&diagnostics.parameters);
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
    let table = Table::<&DirectionDiagnostics>::new()
        .left(24, "share of prior sd", |d| number::significant(d.sd_ratio, 2))
        .left(0, "direction, in prior sds", DirectionDiagnostics::words);
    let mut text = table.text(all.iter().take(WORST_KNOWN));
    if all.len() > WORST_KNOWN {
        text.push_str("...\n");
        text.extend(all.last().map(|last| table.line(last)));
    }
    text
}

/// Tabulates the rejections in each fifth of each prior; empty if nothing was rejected and nothing failed.
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
