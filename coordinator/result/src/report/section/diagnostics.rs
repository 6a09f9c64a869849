//! Whether the data can tell, where the model misses them, and what the prior has to say.

use maud::{Markup, html};

use crate::diagnostics::calibration::Diagnostics;
use crate::diagnostics::channels::ChannelDiagnostics;
use crate::diagnostics::data_channel::shown;
use crate::diagnostics::directions::WORST_KNOWN;
use crate::diagnostics::residuals::{ResidualDiagnostics, largest};
use crate::diagnostics::trends::TrendDiagnostics;
use crate::words::number;
use crate::words::probability::probability;

/// Findings, then the tables that they come from.
pub(in crate::report) fn diagnostics(diagnostics: &Diagnostics) -> Markup {
    html! {
        ul.findings { @for words in &diagnostics.findings { li { (words) "." } } }
        h3 { "Channels" }
        div.scroll { (channels(diagnostics)) }
        p.note {
            "Error sd: noise, and what it shares with other rows. Prior allows: standard deviation of the prediction over draws from the prior. "
            "Information: the latter over the former; below 1 a row says less than the prior did. Parameters spent: sum of the leverages. "
            "Chi-square: squares of the residuals over the errors' variances; none where the noise was inferred from them. "
            "How many rows lie in their intervals stands under the errors by channel."
        }
        (residuals(&diagnostics.residuals))
        (trends(&diagnostics.trends))
        h3 { "What the data did to the prior" }
        div.scroll { (parameters(diagnostics)) }
        p.note {
            "Contraction: 1 less the standard deviation after the fit over that before; 0: the data say nothing. "
            "Prior against data: probability of a posterior so far out, were the prior right (Evans and Moshonov's check); a dash: the data say too little."
        }
        div.scroll { (directions(diagnostics)) }
        p.note {
            "Directions in standard deviations of the prior. Along the first the data say least: its parameters can stand in for each other."
        }
    }
}

fn or_dash(value: Option<f64>, digits: i32) -> String {
    value.map_or(number::NONE.into(), |x| number::significant(x, digits))
}

fn p_cell(value: Option<f64>) -> String {
    value.map_or(number::NONE.into(), probability)
}

fn channels(diagnostics: &Diagnostics) -> Markup {
    let silent = |c: &ChannelDiagnostics| c.silence.is_some();
    html! {
        table {
            thead { tr {
                th.text { "channel" } th.text { "unit" } th { "rows" } th { "error sd" } th { "prior" br; "allows" } th { "information" }
                th { "parameters" br; "spent" } th { "chi-square" } th { "expected" } th { "p" }
            } }
            tbody {
                @for c in &diagnostics.channels {
                    @let square = c.chi_square.as_ref();
                    @let (scale, unit) = shown(&c.channel);
                    tr {
                        td.text { (c.channel.replace('_', " ")) } td.text { (unit) } td { (c.data) }
                        td { (or_dash(c.error_sd.map(|sd| scale * sd), 3)) } td { (or_dash(c.prior_predictive_sd.map(|sd| scale * sd), 3)) }
                        td { span.alarm[silent(c)] { (or_dash(c.information, 2)) } }
                        td { (or_dash(c.effective_parameters, 2)) }
                        td { (or_dash(square.map(|s| s.chi_square), 3)) } td { (or_dash(square.map(|s| s.degrees_of_freedom), 3)) }
                        td { (p_cell(square.and_then(|s| s.p))) }
                    }
                }
                @if let Some(all) = &diagnostics.chi_square {
                    tr.first {
                        td.text { "all together" } td {} td { (all.data) } td {} td {} td {} td {}
                        td { (number::significant(all.chi_square, 3)) } td { (number::significant(all.degrees_of_freedom, 3)) }
                        td { (p_cell(all.p)) }
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
                tbody { @for r in &largest { @let (scale, unit) = shown(&r.channel); tr {
                    td.text { (r.run) } td.text { (r.channel.replace('_', " ")) }
                    td { (number::to_spread(scale * r.residual, scale * r.error_sd)) } td { (number::to_spread(scale * r.error_sd, scale * r.error_sd)) } td.text { (unit) }
                    td { (number::fixed(r.leverage, 2)) }
                    td { (or_dash(r.studentised, 2)) } td { (p_cell(r.p)) }
                } } }
            } }
            p.note {
                "Leverage: the share of the error's variance that the fit takes up. Studentised: the residual over what is left of its standard deviation. "
                "p: probability of one so large by itself; the smallest of " (number::count(all.len(), "residual")) " is usually about " (number::significant(1.0 / all.len() as f64, 1)) "."
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
                tbody { @for (i, t) in all.iter().enumerate() { @let (scale, unit) = shown(&t.channel); tr.first[i == 0 || all[i - 1].channel != t.channel] {
                    td.text { (t.channel.replace('_', " ")) } td.text { (t.against.name().replace('_', " ")) }
                    td { (number::with_spread(scale * t.change, scale * t.change_sd)) } td.text { (unit) }
                    td { (number::fixed(t.share_left, 2)) } td { (probability(t.p)) }
                } } }
            } }
            p.note {
                "Change: by how much the measurements rise beyond the model from the least to the largest value of the condition (constant: lie above it), "
                "had the fit not bent towards them, \u{b1} its standard deviation where there is no trend. "
                "Share left: how much of such a pattern the parameters cannot imitate; what they imitate fully is not listed."
            }
        }
    }
}

fn parameters(diagnostics: &Diagnostics) -> Markup {
    html! {
        table {
            thead { tr { th.text { "parameter" } th { "contraction" } th { "p, prior" br; "against data" } th.text { "" } } }
            tbody {
                @for p in &diagnostics.parameters {
                    tr {
                        td.text { (p.name) }
                        td { (p.contraction.map_or(number::NONE.into(), |c| number::fixed(c, 2))) }
                        td { (p_cell(p.conflict_p)) }
                        td.text { @if p.at_bound { span.alarm { "AT BOUND" } } }
                    }
                }
                @if let Some(all) = &diagnostics.conflict {
                    tr.first { td.text { "all together" } td {} td { (p_cell(all.p)) } td {} }
                }
            }
        }
    }
}

fn directions(diagnostics: &Diagnostics) -> Markup {
    html! {
        @if !diagnostics.directions.is_empty() {
            table {
                thead { tr { th { "share of the prior's" br; "spread that is left" } th.text { "worst-known directions" } } }
                tbody { @for d in diagnostics.directions.iter().take(WORST_KNOWN) { tr {
                    td { (number::significant(d.sd_ratio, 2)) } td.text { (d.words()) }
                } } }
            }
        }
    }
}
