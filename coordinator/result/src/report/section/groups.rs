//! Errors by level of a condition.

use maud::{Markup, html};
use shared::channel::Channel;

use crate::table::comparison::Comparison;
use crate::table::group::{ErrorGroup, GroupError};
use crate::table::row::measured_channels;
use crate::words::number;

/// A mean beyond so many of its sampling errors is highlighted.
const NOTABLE: f64 = 3.0;

/// The table, folded; nothing where every condition has one level.
pub(in crate::report) fn groups(comparison: &Comparison) -> Markup {
    let channels = measured_channels(&comparison.rows);
    let groups = &comparison.groups;
    html! {
        @if !groups.is_empty() {
            details {
                summary { "Errors by slip, load, speed and wheel" }
                div.scroll { table {
                    thead { tr {
                        th.text { "rows" } th.text { "at" }
                        @for channel in &channels { th { (channel.words()) br; "noise sds" } }
                    } }
                    tbody {
                        @for (i, group) in groups.iter().enumerate() {
                            tr.first[i == 0 || groups[i - 1].by != group.by || groups[i - 1].usage != group.usage] {
                                td.text { (group.usage.name()) } td.text { (group.words()) }
                                @for channel in &channels { td { (cell(group, *channel)) } }
                            }
                        }
                    }
                } }
                p.note {
                    "Root mean square of measured minus predicted in units of the noise sd, (its mean), and the number of rows. A mean above 0: the model predicts too little. "
                    "Means of more than three sampling errors are highlighted."
                }
            }
        }
    }
}

fn cell(group: &ErrorGroup, channel: Channel) -> Markup {
    let error = group.channels.get(channel.name());
    let notable = |e: &GroupError| e.mean_sigma.abs() * (e.runs as f64).sqrt() > NOTABLE;
    html! {
        @match error {
            Some(error) => { span.alarm[notable(error)] { (error.words()) } }
            None => { (number::NONE) }
        }
    }
}
