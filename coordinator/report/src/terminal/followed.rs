//! A campaign that is followed, as text.

use std::collections::BTreeSet;
use std::fmt::Write;

use prediction::follow::Followed;
use result::number;

/// Number of contradicting runs that speak against the model rather than against a rig.
const SEVERAL: usize = 3;

/// Returns what further runs changed: contradictions first, then verdict and next run, then models and parameters.
///
/// # Arguments
/// - `seconds`: the time that the answer took.
pub fn followed(followed: &Followed, seconds: f64) -> String {
    let mut text = String::new();
    let count = followed.runs.len();
    let last = followed.runs.last().map_or("", String::as_str);
    // Writing to a text cannot fail.
    let _ = writeln!(text, "{count} further runs, the last {last} ({seconds:.1} s)");
    let far: Vec<_> = followed
        .expectations
        .iter()
        .filter(|expected| expected.contradicts)
        .collect();
    for expected in &far {
        let _ = writeln!(
            text,
            "CONTRADICTS: run {}: {} {} was expected near {} (probability {:.0e})",
            expected.run,
            expected.channel,
            number::significant(expected.measured, 4),
            number::significant(expected.expected, 4),
            expected.probability
        );
    }
    let runs: BTreeSet<&str> = far.iter().map(|expected| expected.run.as_str()).collect();
    if runs.len() >= SEVERAL {
        let _ = writeln!(
            text,
            "{} runs contradict the model: it misses something that they show",
            runs.len()
        );
    } else if !runs.is_empty() {
        let _ = writeln!(
            text,
            "look at sensor, preparation, and the wheel on its shaft; where the run is right, the model is wrong there"
        );
    }
    let _ = writeln!(text, "verdict: {}", followed.verdict);
    if let Some(run) = followed.next_runs.first() {
        let settles = run.settles.map_or_else(String::new, |settles| {
            format!("; it settles the matter with a probability of {settles:.2}")
        });
        let _ = writeln!(
            text,
            "next run: slip {:.2}, {:.1} N, {:.4} m/s distinguishes {} ({:.2} nats){settles}",
            run.slip,
            run.wheel_load_n,
            run.sled_speed_m_s,
            run.separates.join(", "),
            run.information_nats
        );
    }
    if let Some(stop) = &followed.stop {
        let _ = writeln!(text, "stop: {stop}");
    }
    for model in &followed.models {
        let weight = model
            .weight
            .map_or_else(|| "?".to_owned(), |weight| format!("{weight:.3}"));
        let ess = model
            .ess
            .map_or_else(String::new, |ess| format!(", {ess:.0} effective draws"));
        let _ = writeln!(
            text,
            "model {}: {}: weight {:.3} -> {weight} ({}{ess})",
            model.calibration, model.name, model.weight_before, model.method
        );
    }
    for parameter in &followed.parameters {
        let shown = |x: f64| number::significant(x, 4);
        let _ = writeln!(
            text,
            "  {} {} ± {} {} (90 % {} to {})",
            parameter.name,
            shown(parameter.mean),
            number::significant(parameter.sd, 2),
            parameter.unit,
            shown(parameter.interval[0]),
            shown(parameter.interval[1])
        );
    }
    text
}
