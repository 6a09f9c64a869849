//! The models that a job compares, as text.

use std::fmt::Write;

use shared::channel::Channel;

use super::column::cell;
use result::model_comparison::LeftOutBy;
use result::study::Study;
use result::words::data_channel::{ShownUnit, short_name};
use result::words::probability::probability;

/// The models with their evidence, probability and errors on data left out; nothing of a job with one.
pub(super) fn models(study: &Study) -> String {
    let Some(comparison) = study.model_comparison() else {
        return String::new();
    };
    let is_known = |channel: &Channel| {
        let mut tables = comparison
            .models
            .iter()
            .filter_map(|model| model.left_out.as_ref());
        tables.any(|table| table.channel(*channel).is_some())
    };
    let channels: Vec<Channel> = Channel::ALL.into_iter().filter(is_known).collect();
    let width = comparison
        .models
        .iter()
        .map(|m| m.name.chars().count())
        .fold(16, usize::max);
    let mut text = format!(
        "{:<width$} {:>12} {:>8} {:>8}",
        "model", "ln evidence", "P", "chi2 p"
    );
    for &channel in &channels {
        let unit = ShownUnit::of(channel);
        let _ = write!(text, " {:>10}", format!("{} {}", short_name(channel), unit.name));
    }
    let _ = writeln!(text, " {:>7}", "x noise");
    for model in &comparison.models {
        let _ = write!(
            text,
            "{:<width$} {:>12} {:>8} {:>8}",
            model.name,
            cell(model.log_evidence, |log| format!("{log:.2}")),
            probability(model.probability),
            cell(model.chi_square_p, probability)
        );
        let error = |channel: Channel| model.left_out.as_ref()?.channel(channel);
        for &channel in &channels {
            let rmse = cell(error(channel), |e| {
                format!("{:.2}", e.rmse * ShownUnit::of(channel).factor)
            });
            let _ = write!(text, " {rmse:>10}");
        }
        let sds = model
            .left_out
            .as_ref()
            .and_then(|errors| errors.all.rmse_fixed_sigma);
        let _ = writeln!(text, " {:>7}", cell(sds, |sds| format!("{sds:.2}")));
    }
    let of = comparison.models.first().map(|model| model.left_out_by);
    let _ = writeln!(
        text,
        "P from equal prior odds; errors of {}",
        match of {
            Some(LeftOutBy::Holdout) => "held-out runs",
            _ => "each condition when the others are fitted",
        }
    );
    text + "\n"
}
