//! Predictions of conditions of one's own as text.

use std::fmt::Write;

use prediction::Prediction;
use prediction::prediction::{PredictedClimb, PredictedQuantity, PredictedRun};
use result::number;

use super::column::{cell, labelled};
use super::table::Table;

/// Quantities of the table; the other ones are in the CSV and the JSON.
const SHOWN: [(&str, &str, f64); 7] = [
    ("drawbar_pull_n", "pull N", 1.0),
    ("torque_n_m", "torque N m", 1.0),
    ("sinkage_m", "sinkage mm", 1e3),
    ("traction_coefficient", "traction", 1.0),
    ("tractive_efficiency", "efficiency", 1.0),
    ("balanced_slope_deg", "slope deg", 1.0),
    ("energy_j_m", "energy J/m", 1.0),
];

/// Tabulates the planned runs: for each quantity the mean with its interval of a new measurement by all models, then probabilities,
/// slopes, and what lies beyond the fitted range.
pub fn prediction(prediction: &Prediction) -> String {
    let mut text = head(prediction);
    for (name, title, factor) in SHOWN {
        let rows: Vec<Row<'_>> = prediction
            .runs
            .iter()
            .filter_map(|run| {
                let quantity = run.quantities.iter().find(|quantity| quantity.name == name)?;
                Some(Row { run, quantity })
            })
            .collect();
        if rows.is_empty() {
            continue;
        }
        let shown = move |x: f64| number::significant(x * factor, 3);
        let pair = move |ends: Option<[f64; 2]>| {
            cell(ends, |[low, high]| format!("{} to {}", shown(low), shown(high)))
        };
        let table = Table::<&Row<'_>>::new()
            .left(12, "run", |row| row.run.run.clone())
            .left(8, "wheel", |row| row.run.wheel.clone())
            .right(6, "slip", |row| number::significant(row.run.slip, 2))
            .right(7, "load N", |row| number::significant(row.run.wheel_load_n, 3))
            .right(10, title, move |row| shown(row.quantity.models_mean))
            .right(18, "parameters", move |row| pair(Some(row.quantity.parameters)))
            .right(18, "all models", move |row| pair(Some(row.quantity.models)))
            .right(18, "measurement", move |row| {
                pair(row.quantity.models_measurement)
            })
            .right(18, "corrected", move |row| {
                pair(row.quantity.corrected_measurement)
            })
            .remark(|row| beyond_mark(&row.run.beyond));
        let _ = write!(text, "\n{}", table.text(&rows));
    }
    text += &statements(prediction);
    for climb in &prediction.climbs {
        text += &labelled("climb:", &climb_words(climb));
    }
    text += &limits(prediction);
    text
}

struct Row<'a> {
    run: &'a PredictedRun,
    quantity: &'a PredictedQuantity,
}

fn head(prediction: &Prediction) -> String {
    let mut text = format!(
        "calibration {}, {} draws of each model; 90 % intervals\n",
        prediction.calibration, prediction.draws
    );
    if prediction.models.len() > 1 {
        for model in &prediction.models {
            let weight = match model.weight {
                weight if weight < 0.001 => "< 0.001".to_owned(),
                weight => format!("{weight:.3}"),
            };
            let _ = writeln!(
                text,
                "  weight {weight:<8} calibration {} {}",
                model.calibration, model.name
            );
        }
    }
    text
}

fn statements(prediction: &Prediction) -> String {
    let mut text = String::new();
    let p = |p: Option<f64>| cell(p, |p| format!("{p:.3}"));
    for run in prediction.runs.iter().filter(|run| !run.statements.is_empty()) {
        for statement in &run.statements {
            let _ = write!(
                text,
                "\nP({}) in {} = {} (parameters {}, all models {})",
                statement.statement,
                run.run,
                p(statement.measurement),
                p(statement.parameters),
                p(statement.models)
            );
        }
    }
    if text.is_empty() { text } else { text + "\n" }
}

/// Returns the sentence on the slip on a slope.
pub(super) fn climb_words(climb: &PredictedClimb) -> String {
    let slope = number::significant(climb.slope_deg, 3);
    let load = number::significant(climb.wheel_load_n, 3);
    let probability = match climb.probability {
        p if p > 0.9995 => "P > 0.999".to_owned(),
        p => format!("P = {p:.3}"),
    };
    let at = climb.slip.zip(climb.slip_interval).map(|(slip, [low, high])| {
        let [slip, low, high] = [slip, low, high].map(|x| format!("{x:.3}"));
        format!(" at slip {slip} ({low} to {high})")
    });
    let energy = climb
        .energy_j_m
        .zip(climb.energy_interval)
        .map(|(energy, [low, high])| {
            let [energy, low, high] = [energy, low, high].map(|x| number::significant(x, 3));
            format!(", with {energy} J for a metre ({low} to {high})")
        });
    format!(
        "wheel {} with {load} N on level ground pulls its weight along {slope} deg with {probability}{}{}",
        climb.wheel,
        at.unwrap_or_default(),
        energy.unwrap_or_default()
    )
}

/// Returns the remark on a row that lies beyond the range of the fitted runs.
pub(super) fn beyond_mark(beyond: &[String]) -> &'static str {
    if beyond.is_empty() { "" } else { " *" }
}

/// Returns a line for each phrase of what lies beyond the range of the fitted runs, with the names that it is said of.
pub(super) fn beyond_lines<'a>(named: impl Iterator<Item = (&'a String, &'a Vec<String>)>) -> String {
    let mut beyond: Vec<(&str, Vec<&str>)> = Vec::new();
    for (name, phrases) in named {
        for phrase in phrases {
            match beyond.iter_mut().find(|(known, _)| known == phrase) {
                Some((_, names)) => names.push(name),
                None => beyond.push((phrase.as_str(), vec![name.as_str()])),
            }
        }
    }
    let line = |(phrase, names): (&str, Vec<&str>)| {
        let names = match names.as_slice() {
            [first, .., last] if names.len() > 3 => format!("{first} to {last}"),
            names => names.join(", "),
        };
        labelled("beyond:", &format!("{phrase} ({names})"))
    };
    beyond.into_iter().map(line).collect()
}

fn limits(prediction: &Prediction) -> String {
    let mut text = beyond_lines(prediction.runs.iter().map(|run| (&run.run, &run.beyond)));
    for run in &prediction.runs {
        if let Some(refused) = &run.refused {
            text += &labelled("refused:", &format!("{} at {}", run.run, refused.words()));
        }
    }
    for note in &prediction.notes {
        text += &labelled("note:", note);
    }
    text
}

/// The titles of the CSV.
const TITLES: &str = "run,wheel,slip,wheel_load_n,sled_speed_m_s,slip_angle_deg,pass,gravity_m_s2,slope_deg,beyond,quantity,unit,mean,\
    parameters_q05,parameters_q95,models_mean,models_q05,models_q95,measurement_mean,measurement_q05,measurement_q95,corrected,corrected_q05,\
    corrected_q95\n";

/// Returns a row for each run and quantity as CSV; a statement is a quantity whose means are its probabilities.
///
/// `measurement_mean` is the probability that a new measurement makes a statement true, and empty of other quantities.
pub fn prediction_csv(prediction: &Prediction) -> String {
    let mut text = TITLES.to_owned();
    let quoted = |words: &str| format!("\"{}\"", words.replace('"', "\"\""));
    let number = |x: Option<f64>| x.map(|x| x.to_string()).unwrap_or_default();
    let ends =
        |ends: Option<[f64; 2]>| format!("{},{}", number(ends.map(|e| e[0])), number(ends.map(|e| e[1])));
    for run in &prediction.runs {
        let start = format!(
            "{},{},{},{},{},{},{},{},{},{}",
            quoted(&run.run),
            quoted(&run.wheel),
            run.slip,
            run.wheel_load_n,
            run.sled_speed_m_s,
            run.slip_angle_deg,
            run.pass,
            run.gravity_m_s2,
            run.slope_deg,
            quoted(&run.beyond.join("; "))
        );
        for quantity in &run.quantities {
            let _ = writeln!(
                text,
                "{start},{},{},{},{},{},{},,{},{},{}",
                quantity.name,
                quantity.unit,
                quantity.mean,
                ends(Some(quantity.parameters)),
                quantity.models_mean,
                ends(Some(quantity.models)),
                ends(quantity.models_measurement),
                number(quantity.corrected),
                ends(quantity.corrected_measurement)
            );
        }
        for statement in &run.statements {
            let _ = writeln!(
                text,
                "{start},{},1,{},,,{},,,{},,,,,",
                quoted(&statement.statement),
                number(statement.parameters),
                number(statement.models),
                number(statement.measurement)
            );
        }
    }
    text
}
