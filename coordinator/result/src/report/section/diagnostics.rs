//! Diagnostics: findings and the tables behind them.

use maud::{Markup, html};

use crate::diagnostics::calibration::Diagnostics;
use crate::diagnostics::channels::ChannelDiagnostics;
use crate::diagnostics::directions::WORST_KNOWN;
use crate::diagnostics::residuals::{ResidualDiagnostics, largest};
use crate::diagnostics::trends::TrendDiagnostics;
use crate::words::data_channel::ShownUnit;
use crate::words::number;
use crate::words::probability::probability;

/// Findings, then the tables behind them.
pub(in crate::report) fn diagnostics(diagnostics: &Diagnostics) -> Markup {
    html! {
        ul.findings { @for words in &diagnostics.findings { li { (words) "." } } }
        h3 { "Channels" }
        div.scroll { (channels(diagnostics)) }
        p.note {
            "Error sd: noise, discrepancy and shared errors together, so it can exceed the declared noise. Prior spread: standard deviation of the prediction over draws from the prior. "
            "Information: the latter over the former; below 1 a row is less informative than the prior. Parameters spent: sum of the leverages. "
            "Chi-square: squares of the residuals over the errors' variances; none where the noise was inferred from them. "
            "The coverage of the intervals stands under the errors by channel."
        }
        (residuals(&diagnostics.residuals))
        (trends(&diagnostics.trends))
        h3 { "Parameters against their priors" }
        div.scroll { (parameters(diagnostics)) }
        p.note {
            "Contraction: 1 minus the standard deviation after the fit over that before; 0: the data are uninformative. "
            "Prior conflict: probability of a posterior so far out if the prior is right (Evans and Moshonov's check); a dash: the data are uninformative."
        }
        div.scroll { (directions(diagnostics)) }
        p.note {
            "Directions in standard deviations of the prior. The data determine the first least: its parameters can compensate for each other."
        }
    }
}

fn channels(diagnostics: &Diagnostics) -> Markup {
    let silent = |c: &ChannelDiagnostics| c.silence.is_some();
    html! {
        table {
            thead { tr {
                th.text { "channel" } th.text { "unit" } th { "rows" } th { "error sd" } th { "prior" br; "spread" } th { "information" }
                th { "parameters" br; "spent" } th { "chi-square" } th { "expected" } th { "p" }
            } }
            tbody {
                @for c in &diagnostics.channels {
                    @let square = c.chi_square.as_ref();
                    @let unit = c.channel.shown();
                    tr {
                        td.text { (c.channel.words()) } td.text { (unit.name) } td { (c.data) }
                        td { (number::or_none(c.error_sd.map(|sd| unit.factor * sd), |x| number::significant(x, 3))) } td { (number::or_none(c.prior_predictive_sd.map(|sd| unit.factor * sd), |x| number::significant(x, 3))) }
                        td { span.alarm[silent(c)] { (number::or_none(c.information, |x| number::significant(x, 2))) } }
                        td { (number::or_none(c.effective_parameters, |x| number::significant(x, 2))) }
                        td { (number::or_none(square.map(|s| s.chi_square), |x| number::significant(x, 3))) } td { (number::or_none(square.map(|s| s.degrees_of_freedom), |x| number::significant(x, 3))) }
                        td { (number::or_none(square.and_then(|s| s.p), probability)) }
                    }
                }
                @if let Some(all) = &diagnostics.chi_square {
                    tr.first {
                        td.text { "all together" } td {} td { (all.data) } td {} td {} td {} td {}
                        td { (number::significant(all.chi_square, 3)) } td { (number::significant(all.degrees_of_freedom, 3)) }
                        td { (number::or_none(all.p, probability)) }
                    }
                }
            }
        }
    }
}

fn residuals(all: &[ResidualDiagnostics]) -> Markup {
    let largest = largest(all);
    html! {
        @if !largest.is_empty() {
            h3 { "Largest residuals" }
            div.scroll { table {
                thead { tr {
                    th.text { "run" } th.text { "channel" } th { "residual" } th { "error sd" } th.text { "unit" } th { "leverage" }
                    th { "studentised" } th { "p" }
                } }
                tbody { @for r in &largest { @let unit = r.channel.shown(); tr {
                    td.text { (r.run) } td.text { (r.channel.words()) }
                    td { (number::to_spread(unit.factor * r.residual, unit.factor * r.error_sd)) } td { (number::to_spread(unit.factor * r.error_sd, unit.factor * r.error_sd)) } td.text { (unit.name) }
                    td { (number::fixed(r.leverage, 2)) }
                    td { (number::or_none(r.studentised, |x| number::significant(x, 2))) } td { (number::or_none(r.p, probability)) }
                } } }
            } }
            p.note {
                "Leverage: the share of the error's variance that the fit absorbs. Studentised: the residual over its remaining standard deviation. "
                "p: probability of a single residual so large; the smallest of " (number::count(all.len(), "residual")) " is usually about " (number::significant(1.0 / all.len() as f64, 1)) "."
            }
        }
    }
}

fn trends(all: &[TrendDiagnostics]) -> Markup {
    html! {
        @if !all.is_empty() {
            h3 { "Trends of the residuals" }
            div.scroll { table {
                thead { tr {
                    th.text { "channel" } th.text { "against" } th { "change" } th.text { "unit" } th { "share left" } th { "p" }
                } }
                tbody { @for (i, t) in all.iter().enumerate() { @let unit = ShownUnit::of(t.channel); tr.first[i == 0 || all[i - 1].channel != t.channel] {
                    td.text { (t.channel.words()) } td.text { (t.against.name().replace('_', " ")) }
                    td { (number::with_spread(unit.factor * t.change, unit.factor * t.change_sd)) } td.text { (unit.name) }
                    td { (number::fixed(t.share_left, 2)) } td { (probability(t.p)) }
                } } }
            } }
            p.note {
                "Change: by how much the measurements rise above the model from the least to the largest value of the condition (constant: lie above it), "
                "before the fit compensates, \u{b1} its standard deviation where there is no trend. "
                "Share left: how much of such a pattern the parameters cannot reproduce; patterns that they reproduce fully are not listed."
            }
        }
    }
}

fn parameters(diagnostics: &Diagnostics) -> Markup {
    html! {
        table {
            thead { tr { th.text { "parameter" } th { "contraction" } th { "p, prior" br; "conflict" } th.text { "" } } }
            tbody {
                @for p in &diagnostics.parameters {
                    tr {
                        td.text { (p.name) }
                        td { (number::or_none(p.contraction, |c| number::fixed(c, 2))) }
                        td { (number::or_none(p.conflict_p, probability)) }
                        td.text { @if p.at_bound { span.alarm { "AT BOUND" } } }
                    }
                }
                @if let Some(all) = &diagnostics.conflict {
                    tr.first { td.text { "all together" } td {} td { (number::or_none(all.p, probability)) } td {} }
                }
            }
        }
    }
}

fn directions(diagnostics: &Diagnostics) -> Markup {
    html! {
        @if !diagnostics.directions.is_empty() {
            table {
                thead { tr { th { "remaining share of" br; "the prior sd" } th.text { "worst-known directions" } } }
                tbody { @for d in diagnostics.directions.iter().take(WORST_KNOWN) { tr {
                    td { (number::significant(d.sd_ratio, 2)) } td.text { (d.words()) }
                } } }
            }
        }
    }
}
