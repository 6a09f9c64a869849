//! The results of the searches for a missing effect.

use std::path::Path;

use maud::{Markup, html};
use record::{Discovery, JudgedEffect, Outside};

use crate::discovery::{DiscoveryRound, arguments, numerical_noise};
use crate::report::chart;
use crate::study::Study;
use crate::words::number;

/// Each search; nothing where the study has none.
pub(in crate::report) fn discovery(study: &Study) -> Option<Markup> {
    (!study.rounds.is_empty()).then(|| {
        html! {
            @for round in &study.rounds { (search(study, round)) }
        }
    })
}

/// The result of a search.
fn search(study: &Study, round: &DiscoveryRound) -> Markup {
    let record = &round.record;
    let of = study
        .calibrations()
        .find(|calibration| calibration.row.id == round.calibration);
    html! {
        h3 { "Search of " (of.map_or("the model", |calibration| calibration.experiment.as_str())) }
        p.verdict { (record.text) }
        (explanations(record))
        @if let Some(said) = numerical_noise(record) { p.note { (said) "." } }
        @if let Some(outside) = &record.outside { (law(outside)) }
        @if !record.drop.is_empty() { p { "No longer improves the evidence: " (number::list(&record.drop)) "." } }
        @if !record.cannot_exclude.is_empty() {
            p { "Not detectable with these data at the usual strength: " (number::list(&record.cannot_exclude)) "." }
        }
        @if !record.refused.is_empty() {
            p { "Rejected by the model at every strength: " (number::list(&record.refused)) "." }
        }
        @if !record.not_tried.is_empty() { (not_tried(record)) }
        @if !(record.next_runs.is_empty() && record.other_tests.is_empty()) { (next(record)) }
        @if let Some(arguments) = arguments(record, Path::new("")) {
            p { "To add it: " code { "coordinator extend " (round.calibration) " " (arguments) } }
        }
        p.note { (number::count(record.evaluations as usize, "evaluation")) "." }
    }
}

fn not_tried(record: &Discovery) -> Markup {
    html! {
        p { "Weighed with assumed values, because the experiment does not state what they need. An effect of this list is never named: " }
        ul {
            @for effect in &record.not_tried {
                li { code { (effect.name) } ": " (effect.why) ". Needs " (effect.needs) "." }
            }
        }
    }
}

/// Explanations outside the fold.
const SHOWN: usize = 10;

fn explanations(record: &Discovery) -> Markup {
    let (shown, others) = record.effects.split_at(SHOWN.min(record.effects.len()));
    html! {
        (table(shown))
        p.note { "The data cannot distinguish explanations of one class. Bayes factors are relative to the searched model." }
        (sets(record))
        @if !others.is_empty() {
            details { summary { (number::count(others.len(), "less probable explanation")) } (table(others)) }
        }
    }
}

fn table(effects: &[JudgedEffect]) -> Markup {
    html! {
        div.scroll { table {
            thead { tr {
                th.text { "explanation" } th { "ln Bayes" br; "factor" } th { "probability" } th { "class" }
                th.text { "95 % set" } th { "strength" br; "[prior sds]" } th.text { "prior of its strength" }
            } }
            tbody {
                @for effect in effects {
                    tr {
                        td.text { (effect.name) }
                        td { (number::fixed(effect.log_bayes_factor, 2)) }
                        td { (number::fixed(effect.probability, 4)) }
                        td { (effect.class) }
                        td.text { @if effect.in_credible_set { "in" } }
                        td { (number::or_none(effect.prior_sds, |sds| number::fixed(sds, 1))) }
                        td.text { (effect.strength_prior.as_deref().unwrap_or_default()) }
                    }
                }
            }
        } }
    }
}

/// The models that were compared, from which the probabilities follow.
fn sets(record: &Discovery) -> Markup {
    html! {
        @if !record.sets.is_empty() {
            details {
                summary { "The sets behind these probabilities" }
                div.scroll { table {
                    thead { tr {
                        th.text { "set" } th { "ln Bayes" br; "factor" } th { "prior" } th { "probability" }
                        th { "prediction of" br; "left-out levels [nats]" }
                    } }
                    tbody {
                        @for set in record.sets.iter().take(SHOWN) {
                            tr {
                                td.text { (set.members.join(" + ")) }
                                td { (number::fixed(set.log_bayes_factor, 2)) }
                                td { (number::fixed(set.prior, 4)) }
                                td { (number::fixed(set.probability, 4)) }
                                td { (number::or_none(set.predictive, |nats| number::fixed(nats, 1))) }
                            }
                        }
                    }
                } }
                p.note {
                    "A set's probability is proportional to its prior times the exponential of ln Bayes factor / "
                    (number::significant(record.misfit, 3))
                    ", the chi-square of the best explanation over its degrees of freedom (1 where it fits). These Bayes factors "
                    "have widened priors of the strengths; an effect's probability is the sum over the sets that it leads."
                }
            }
        }
    }
}

fn law(outside: &Outside) -> Markup {
    let by = outside.depends_on.replace('_', " ");
    let what = outside.acts_on.replace('_', " ");
    html! {
        p {
            "Not in the library: " (what) " depends on " (by) " (" (outside.form) ", ln Bayes factor "
            (number::fixed(outside.log_bayes_factor, 2)) ")."
        }
        @if outside.curve.len() > 1 {
            figure {
                (chart::curve(&outside.curve, &by, &format!("correction of {what}")))
                figcaption { "The factor (on a channel: the addition) against the variable, in SI units." }
            }
        }
        details { summary { "Effect file" } pre { (outside.effect_file) } }
    }
}

fn next(record: &Discovery) -> Markup {
    html! {
        p { "Informative tests:" }
        ul {
            @for (place, run) in record.next_runs.iter().enumerate() {
                li {
                    (if place == 0 { "a run" } else { "and then a run" }) " at slip " (number::significant(run.slip, 2)) ", " (number::significant(run.wheel_load_n, 3)) "\u{a0}N, "
                    (number::significant(run.sled_speed_m_s, 3)) "\u{a0}m/s distinguishes " (number::list(&run.separates)) " ("
                    (if place == 0 { "tells " } else { "adds " }) (number::significant(run.information_nats, 2)) "\u{a0}nats)"
                }
            }
            @for test in &record.other_tests { li { (test) } }
        }
    }
}
