//! The error ledger.

use maud::{Markup, html};
use shared::channel::Channel;
use shared::experiment::RunUse;

use crate::study::Study;
use crate::table::ledger::{LedgerLine, LedgerRow};
use crate::words::data_channel::{ShownUnit, title};
use crate::words::number;

/// The errors of each calibration, by which an added effect is judged; nothing where there is but one.
pub(in crate::report) fn ledger(study: &Study) -> Option<Markup> {
    let lines = study.ledger_lines();
    let measured = |channel: &Channel| {
        let mut rows = lines.iter().flat_map(|line| &line.rows);
        rows.any(|row| row.errors.channel(*channel).is_some())
    };
    let channels: Vec<Channel> = Channel::ALL.into_iter().filter(measured).collect();
    (lines.len() > 1).then(|| {
        html! {
            h3 { "Error ledger" }
            div.scroll { table {
                thead { tr {
                    th.text { "model" } th.text { "runs" }
                    @for channel in &channels { th { (title(*channel)) } }
                    th { "all" br; "[noise sds]" } th { "inside" br; "90 %" } th { "log-evidence" }
                } }
                tbody {
                    @for line in &lines {
                        @for (i, row) in line.rows.iter().enumerate() {
                            tr.first[i == 0] { (cells(line, row, i == 0, &channels)) }
                        }
                    }
                }
            } }
            p.note {
                "Root mean square errors of the posterior-mean prediction. A real effect also lowers them on held-out runs. "
                "Noise sds, equal for all lines: " (study.fixed_sigmas().words()) ". "
                "Worse: more than 5 % above the line before. Log evidences are comparable only on the same measurements."
            }
        }
    })
}

fn cells(line: &LedgerLine, row: &LedgerRow, first: bool, channels: &[Channel]) -> Markup {
    let calibration = line.calibration;
    html! {
        td.text { @if first { (line.model) } }
        td.text { (match row.usage { RunUse::Fit => "fit", RunUse::Holdout => "held out" }) }
        @for channel in channels {
            td {
                @match row.errors.channel(*channel) {
                    Some(error) => {
                        @if row.worse.contains(channel) { span.alarm { "worse " } }
                        (number::significant(error.rmse * ShownUnit::of(*channel).factor, 3))
                    },
                    None => (number::NONE),
                }
            }
        }
        td { (number::or_none(row.errors.all.rmse_fixed_sigma, |s| number::significant(s, 3))) }
        td { (number::or_none(row.coverage.as_ref(), |c| format!("{} of {}", c.inside, c.of))) }
        td {
            @if first {
                @match (calibration.row.log_evidence, calibration.row.log_evidence_se) {
                    (Some(z), Some(se)) => (number::with_spread(z, se)),
                    (Some(z), None) => (format!("{z:.2} (normal approximation)")),
                    _ => (number::NONE),
                }
            }
        }
    }
}
