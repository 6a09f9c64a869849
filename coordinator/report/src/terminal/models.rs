//! The comparison of a job's models as text.

use std::fmt::Write;

use shared::channel::Channel;

use super::column::cell;
use super::table::{Table, channel_title};
use result::model_comparison::{ComparedModel, LeftOutBy};
use result::study::Study;
use result::words::data_channel::ShownUnit;
use result::words::probability::probability;

/// Maximum number of models in a brief table.
const BRIEF: usize = 3;

/// Tabulates the compared models with their evidence, probability and errors on left-out data; empty for a job with one model.
pub(super) fn models(study: &Study) -> String {
    let Some(comparison) = study.model_comparison() else {
        return String::new();
    };
    let mut text = table(&comparison.models, false);
    let left_out_by = comparison.models.first().map(|model| model.left_out_by);
    let _ = writeln!(
        text,
        "P from equal prior odds; errors of {}",
        match left_out_by {
            Some(LeftOutBy::Holdout) => "held-out runs",
            _ => "each condition when the others are fitted",
        }
    );
    text + "\n"
}

/// Tabulates the most probable of the compared models; empty for a job with one model.
pub(super) fn brief_models(study: &Study) -> String {
    study.model_comparison().map_or_else(String::new, |comparison| {
        let mut models = comparison.models;
        models.sort_by(|a, b| b.probability.total_cmp(&a.probability));
        models.truncate(BRIEF);
        table(&models, true)
    })
}

/// Tabulates models. A brief table fits 80 columns, without the p of chi-square, which the story says.
fn table(models: &[ComparedModel], is_brief: bool) -> String {
    let is_known = |channel: &Channel| {
        let mut tables = models.iter().filter_map(|model| model.left_out.as_ref());
        tables.any(|table| table.channel(*channel).is_some())
    };
    let channels: Vec<Channel> = Channel::ALL.into_iter().filter(is_known).collect();
    let width = models.iter().map(|m| m.name.chars().count()).fold(16, usize::max);
    let mut table = Table::<&ComparedModel>::new()
        .left(width, "model", |model| &model.name)
        .right(12, "ln evidence", |model| {
            cell(model.log_evidence, |log| format!("{log:.2}"))
        })
        .right(8, "P", |model| probability(model.probability));
    if !is_brief {
        table = table.right(8, "chi2 p", |model| cell(model.chi_square_p, probability));
    }
    for channel in channels {
        table = table.right(10, &channel_title(channel), move |model| {
            let error = model.left_out.as_ref().and_then(|errors| errors.channel(channel));
            cell(error, |e| {
                format!("{:.2}", e.rmse * ShownUnit::new(channel).factor)
            })
        });
    }
    let table = table.right(7, "x noise", |model| {
        let sds = model
            .left_out
            .as_ref()
            .and_then(|errors| errors.all.rmse_fixed_sigma);
        cell(sds, |sds| format!("{sds:.2}"))
    });
    table.text(models)
}
