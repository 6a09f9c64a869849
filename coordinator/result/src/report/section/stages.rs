//! The sampler: evidence, counts, and its stages from the prior to the posterior.

use maud::{Markup, html};
use record::StageRow;

use crate::diagnostics::VerificationDiagnostics;
use crate::finished_calibration::FinishedCalibration;
use crate::report::chart::{self, Marker, glyph};
use crate::words::number;

/// Evidence, pictures and table.
pub(in crate::report) fn stages(calibration: &FinishedCalibration) -> Markup {
    let row = &calibration.row;
    let evidence = match (row.log_evidence, row.log_evidence_se) {
        (Some(z), Some(se)) => number::with_spread(z, se),
        (Some(z), None) => number::significant(z, 4),
        _ => number::NONE.into(),
    };
    html! {
        dl {
            dt { "log-evidence" } dd { (evidence) " (natural logarithm; \u{b1} is its standard error within this run)" }
            (cost(calibration))
        }
        @if !calibration.stages.is_empty() {
            div.legend {
                span { (glyph(Some(Marker::Sound))) "equilibrated" }
                span { (glyph(Some(Marker::Alarming))) "not equilibrated" }
            }
            div.charts {
                figure { (chart::exponent(&calibration.stages)) figcaption { "Power of the likelihood: near 0 is the prior, 1 the posterior." } }
                figure {
                    (chart::drift(&calibration.stages))
                    figcaption { "Mean change of the log-likelihood during a stage's moves. Within the shaded band a stage may end; beyond the dashed lines it is not in equilibrium." }
                }
            }
            div.scroll { (table(&calibration.stages)) }
            p.note {
                "Correlation: rank correlation of the log-likelihoods before and after the moves; above 0.3 the particles still depend on where they started. "
                "ESS: effective number of particles after weighting. Stage 0, the draws from the prior, has no moves."
            }
        }
    }
}

/// Evaluations, rejections and time.
pub(super) fn cost(calibration: &FinishedCalibration) -> Markup {
    let row = &calibration.row;
    let refused = row.rejected.unwrap_or(0);
    let kinds: Vec<String> = calibration
        .rejections
        .iter()
        .map(|(kind, n)| format!("{kind} {n}"))
        .collect();
    html! {
        dt { "evaluations" } dd { (number::or_none(row.evaluations, |n| n.to_string())) }
        @if let Some(metamodel) = &calibration.subchains {
            dt { "metamodel" }
            dd {
                (number::count(metamodel.moves as usize, "move")) " of quasi_static in " (number::count(metamodel.subchains as usize, "subchain")) ", " (metamodel.moved)
                " of which moved and were evaluated"
            }
        }
        dt { "rejected by the model" }
        dd {
            (refused)
            @if let Some(n) = row.evaluations.filter(|n| *n > 0) { " (" (number::significant(100.0 * refused as f64 / n as f64, 2)) " %)" }
            @if !kinds.is_empty() { ": " (kinds.join(", ")) }
        }
        dt { "verified" } dd { (VerificationDiagnostics::from(&calibration.verified).words()) }
        dt { "wall time" } dd { (number::duration(row.busy_ms as f64 / 1000.0)) }
    }
}

fn table(stages: &[StageRow]) -> Markup {
    html! {
        table {
            thead { tr {
                th { "stage" } th { "tempering" br; "exponent" } th { "steps per" br; "particle" } th { "acceptance" } th { "drift z" }
                th { "correlation" } th { "ESS" } th { "share of" br; "log-evidence" } th { "evaluations" } th.text { "equilibrated" }
            } }
            tbody {
                @for s in stages {
                    tr {
                        td { (s.stage) }
                        td { (number::significant(s.tempering_exponent, 3)) }
                        td { (s.steps) }
                        td { (number::fixed(s.acceptance, 2)) }
                        td { (number::significant(s.drift_z, 2)) }
                        td { (number::fixed(s.correlation, 2)) }
                        td { (number::fixed(s.ess, 0)) }
                        td { (number::fixed(s.log_evidence_increment, 2)) }
                        td { (s.evaluations) }
                        td.text { @if s.equilibrated { "yes" } @else { span.alarm { "no" } } }
                    }
                }
            }
        }
    }
}
