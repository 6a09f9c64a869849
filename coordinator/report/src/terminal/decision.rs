//! A decision as text: losses of the options, the best one, what decides, what one more run is worth.

use std::fmt::Write;

use prediction::DecisionAnswer;
use prediction::decision::{OptionLoss, RunValue};
use result::number;

use super::column::{cell, labelled};
use super::prediction::{beyond_lines, beyond_mark};
use super::table::Table;

/// Number of further runs that are listed.
const LISTED: usize = 3;

/// Tabulates the options, then says what is best, why, and whether one more run pays.
pub fn decision(answer: &DecisionAnswer) -> String {
    let options = answer.options.iter();
    let width = options
        .map(|option| option.name.chars().count())
        .fold(10, usize::max);
    let short = |x: f64| number::significant(x, 4);
    let table = Table::<&OptionLoss>::new()
        .left(width, "option", |option| option.name.clone())
        .right(12, "loss", move |option| short(option.expected_loss))
        .right(9, "+-", |option| number::significant(option.expected_loss_se, 2))
        .right(21, "90 % of one run", move |option| {
            let [low, high] = option.interval.map(short);
            format!("{low} to {high}")
        })
        .right(12, "at the mode", move |option| cell(option.loss_at_mode, short))
        .right(6, "slip", |option| cell(option.slip, |slip| format!("{slip:.2}")))
        .right(6, "stuck", |option| cell(option.stuck, |p| format!("{p:.2}")))
        .remark(|option| beyond_mark(&option.beyond))
        .apart(0, "", broken);
    let mut text = format!(
        "calibration {}, {} draws of each model\n\n{}\n",
        answer.calibration,
        answer.draws,
        table.text(&answer.options)
    );
    text += &labelled("best:", &best(answer));
    if let Some(by) = &answer.decided_by {
        let share = |x: f64| format!("{:.0} %", 100.0 * x);
        let each: Vec<String> = by
            .each
            .iter()
            .enumerate()
            .map(|(i, each)| match i {
                0 => format!(
                    ". Alone, {} explains {} of the mean difference",
                    each.parameter,
                    share(each.share)
                ),
                _ => format!(", {} {}", each.parameter, share(each.share)),
            })
            .collect();
        text += &labelled(
            "decided:",
            &format!(
                "the difference of one run has an sd of {}: {} of its variance is the model, {} the parameters, {} errors{}",
                short(by.sd),
                share(by.model),
                share(by.parameters),
                share(by.noise),
                each.concat()
            ),
        );
    }
    if let Some(perfect) = answer.perfect_information {
        let cost = answer
            .run_cost
            .map(|cost| format!("; a run costs {}", short(cost)));
        let words = format!(
            "knowing parameters and model would lower the expected loss by {}{}",
            number::significant(perfect, 3),
            cost.unwrap_or_default()
        );
        text += &labelled("worth:", &words);
    }
    for run in answer.runs.iter().take(LISTED) {
        text += &labelled("run:", &run_words(run));
    }
    text += &beyond_lines(answer.options.iter().map(|option| (&option.name, &option.beyond)));
    for note in &answer.notes {
        text += &labelled("note:", note);
    }
    text
}

/// Names the constraints that an option breaks.
fn broken(option: &OptionLoss) -> String {
    let broken = option.constraints.iter().filter(|c| c.probability < c.needed);
    let words: Vec<String> = broken
        .map(|c| format!("P({}) = {:.2} < {}", c.statement, c.probability, c.needed))
        .collect();
    words.join("; ")
}

fn best(answer: &DecisionAnswer) -> String {
    let Some(best) = &answer.best else {
        return "none: no option keeps all constraints".into();
    };
    let mut words = best.clone();
    if let Some((second, margin)) = answer.second.as_ref().zip(answer.margin) {
        let _ = write!(
            words,
            ", by {} +- {} before {second}",
            number::significant(margin, 3),
            number::significant(answer.margin_se.unwrap_or(0.0), 2)
        );
    }
    if let Some(probability) = answer.probability_best {
        let _ = write!(words, "; the best with P = {probability:.2}");
    }
    if let Some(mode) = answer.best_at_mode.as_ref().filter(|mode| *mode != best) {
        let _ = write!(words, "; the most probable parameters alone would choose {mode}");
    }
    words
}

fn run_words(run: &RunValue) -> String {
    let worth = match run.is_worth_its_cost {
        Some(true) => ", more than it costs",
        Some(false) => ", less than it costs",
        None => "",
    };
    format!(
        "{}: wheel {}, slip {}, {} N, {} m/s is worth {} +- {}{worth}",
        run.run,
        run.wheel,
        number::significant(run.slip, 2),
        number::significant(run.wheel_load_n, 3),
        number::significant(run.sled_speed_m_s, 2),
        number::significant(run.value, 3),
        number::significant(run.value_se, 2)
    )
}
