//! Rejections by region of the prior.

use maud::{Markup, html};

use crate::diagnostics::rejections::{PriorBin, RejectionDiagnostics};
use crate::words::number;

/// A row for each parameter, a cell for each fifth of its prior.
pub(in crate::report) fn rejections(rejections: &RejectionDiagnostics) -> Markup {
    let RejectionDiagnostics {
        prior_draws,
        prior_refused,
        ..
    } = rejections;
    html! {
        @for (message, n) in &rejections.faults {
            p { (number::count(*n as usize, "lease")) " failed and " (if *n == 1 { "was" } else { "were" }) " retried: " (message) "." }
        }
        @if *prior_refused == 0 {
            p { "The model accepted every draw from the prior (" (prior_draws) ")." }
        } @else {
            p {
                @match rejections.words() {
                    Some(words) => { (words) "." }
                    None => { "The model rejected " (prior_refused) " of " (prior_draws) " draws from the prior, nowhere more often than by chance." }
                }
            }
            div.scroll { table {
                thead { tr {
                    th.text { "parameter" } th.text { "unit" }
                    @for part in ["lowest fifth", "second", "middle", "fourth", "highest fifth"] { th.text { (part) } }
                } }
                tbody { @for p in &rejections.parameters { tr {
                    td.text { (p.name) } td.text { (p.unit) }
                    @for bin in &p.bins { td.text { (cell(bin)) } }
                } } }
            } }
            p.note {
                "Rejected of drawn in five equally probable parts of each prior, with the bounds of the part. "
                "A rejection depends on the parameters alone; a failed lease is the fault of a machine and was retried."
            }
        }
    }
}

fn cell(bin: &PriorBin) -> Markup {
    let refused: u64 = bin.refused.values().sum();
    let reasons: Vec<String> = bin
        .refused
        .iter()
        .map(|(kind, n)| format!("{kind} {n}"))
        .collect();
    let end = |x: Option<f64>| x.map(|x| number::significant(x, 3));
    html! {
        b { (refused) } " of " (bin.draws)
        @if !reasons.is_empty() { br; (reasons.join(", ")) }
        @if bin.faults > 0 { br; (number::count(bin.faults as usize, "lease")) " failed" }
        br; span.note {
            @match (end(bin.from), end(bin.to)) {
                (Some(from), Some(to)) => { (from) " to " (to) }
                (None, Some(to)) => { "below " (to) }
                (Some(from), None) => { "above " (from) }
                (None, None) => {}
            }
        }
    }
}
