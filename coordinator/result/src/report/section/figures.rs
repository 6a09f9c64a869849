//! The figures of the source paper: places that a script draws in, and what stands there without one.

use maud::{Markup, html};

use crate::figure::{ChannelHistory, ErrorDensity, JointPosterior, Mark, SearchConvergence, StudyFigures};
use crate::words::number;

/// Every figure that has data.
pub(in crate::report) fn figures(figures: &StudyFigures) -> Markup {
    html! {
        @if !(figures.searches.is_empty() && figures.stages.is_empty()) {
            h3 { "Convergence" }
            div.charts {
                @for (i, search) in figures.searches.iter().enumerate() { (place("search", i, "", &search_words(search))) }
                @if !figures.stages.is_empty() {
                    (place("stages", 0, "Highest, median and 90 % of the log-likelihoods at the end of each stage.", &html! {
                        p { "The table of the sampler lists the stages." }
                    }))
                }
                @if figures.populations.is_some() {
                    (place("populations", 0, "The population moves from the prior to the posterior.", &html! {
                        p { "The scatter of the populations needs a script to be drawn; the store has every population." }
                    }))
                }
            }
        }
        @if !figures.posteriors.is_empty() {
            h3 { "Posterior densities" }
            div.charts { @for (i, pair) in figures.posteriors.iter().enumerate() { (place("posterior", i, "", &pair_table(pair))) } }
            p.note {
                "Gaussian kernel with the draws' own covariance (Scott's rule), reflected at the bounds of the prior; regions of highest density. "
                "Maximum likelihood: the draw of the highest likelihood, whatever its prior density."
            }
        }
        @if let Some(histories) = &figures.histories {
            h3 { "Time histories" }
            @for (i, history) in histories.iter().enumerate() { (place("history", i, "", &history_words(history))) }
        }
        @if !figures.errors.is_empty() {
            h3 { "Prediction errors" }
            div.charts.small { @for (i, error) in figures.errors.iter().enumerate() { (place("error", i, "", &error_table(error))) } }
            p.note {
                "Prediction error over the posterior on the fitted runs: Gaussian kernel with the width that is optimal for a normal density, reflected at 0. "
                "The width depends on the noise sd that the likelihood was given."
            }
        }
    }
}

/// A place for a picture; `instead` stands there where no script runs.
fn place(name: &str, index: usize, caption: &str, instead: &Markup) -> Markup {
    html! {
        figure data-figure=(name) data-index=(index) {
            noscript { (instead) }
            @if !caption.is_empty() { figcaption { (caption) } }
        }
    }
}

fn search_words(search: &SearchConvergence) -> Markup {
    let best = |at: Option<f64>| number::or_none(at, |v| number::significant(v, 5));
    html! {
        @if let (Some(first), Some(last)) = (search.history.first(), search.history.last()) {
            p {
                (search.algorithm.name()) ": best log-posterior " (best(first.best)) " after " (first.evaluations) " evaluations, "
                (best(last.best)) " after " (last.evaluations) "."
            }
        }
    }
}

fn pair_table(pair: &JointPosterior) -> Markup {
    let value = |v: Option<f64>| number::or_none(v, |v| number::significant(v, 4));
    html! {
        table {
            thead { tr { th.text { "" } @for p in &pair.parameters { th { (p.name) br; "[" (p.unit) "]" } } } }
            tbody {
                @for mark in &pair.marks { tr { td.text { (mark.label) } td { (value(mark.at.x)) } td { (value(mark.at.y)) } } }
            }
        }
        p { "rank correlation of the draws " (number::fixed(pair.rank_correlation, 2)) }
        @for line in &pair.lines { p { (line.label) } }
    }
}

fn history_words(history: &ChannelHistory) -> Markup {
    html! {
        p {
            "Run " (history.run) ", " (history.channel.words()) ": "
            @match &history.measured {
                Some(measured) => { (number::count(measured.t_s.len(), "measured value")) }
                None => { "no recording" }
            }
            " and what the model gives at "
            @for (i, model) in history.model.iter().enumerate() { @if i > 0 { ", " } (model.label) } "."
        }
    }
}

fn error_table(error: &ErrorDensity) -> Markup {
    let row =
        |mark: &Mark<f64>| html! { tr { td.text { (mark.label) } td { (number::significant(mark.at, 3)) } } };
    html! {
        table {
            thead { tr { th.text { "error of " (error.channel.words()) } th { (error.unit) } } }
            tbody { @for mark in &error.marks { (row(mark)) } }
        }
    }
}
