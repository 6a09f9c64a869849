//! Questions about values that do not fit other values: measurements against load and wheel, noise against measurements, rig radius
//! against wheel radius, data against parameters.

use shared::channel::Channel;
use shared::experiment::{Experiment, NoiseSd, TestRun};
use shared::limit::{self, number};
use shared::parameters::noise_parameter;

use super::question::{DATA_FEW, Question};
use crate::Spec;

/// The bounds of the largest pull, in shares of the load.
const PULL: [f64; 2] = [1e-3, 2.0];
/// The bounds of the torque, in shares of load times radius.
const TORQUE: [f64; 2] = [1e-4, 3.0];
/// Sinkage beyond which the axle is near the ground, in shares of the radius.
const SINKAGE: f64 = 0.9;
/// The bounds of the rig's radius, in shares of the wheel's: it is the radius of the rim or of the tips of the grousers.
const RIG_RADIUS: [f64; 2] = [0.7, 1.5];
/// The bounds of a noise sd, in shares of the largest measurement: the lower is beyond any sensor, the upper makes data useless.
const NOISE: [f64; 2] = [1e-6, 10.0];

pub(super) fn questions(spec: &Spec) -> Vec<Question> {
    let experiment = &spec.experiment;
    let mut questions = Vec::new();
    let load_and_arm = |run: &TestRun| run.wheel_load_n * experiment.wheels[&run.wheel].radius_m;
    questions.extend(relative_size(
        experiment,
        Channel::DrawbarPull,
        PULL,
        "wheel loads",
        |run| run.wheel_load_n,
    ));
    questions.extend(relative_size(
        experiment,
        Channel::Torque,
        TORQUE,
        "load times radius",
        load_and_arm,
    ));
    questions.extend(sinkage(experiment));
    questions.extend(rig_radius(experiment));
    for channel in Channel::ALL {
        questions.extend(noise(experiment, channel));
    }
    let (data, free) = (spec.likelihood.data().len(), spec.parameters.len());
    if data < free {
        let words =
            format!("{data} fitted measurements for {free} free parameters: the priors decide the rest");
        questions.push(Question::new(DATA_FEW, words));
    }
    questions
}

/// Returns the question about the largest absolute value of a channel, relative to its scale.
fn relative_size(
    experiment: &Experiment,
    channel: Channel,
    [lower, upper]: [f64; 2],
    scale_words: &str,
    scale: impl Fn(&TestRun) -> f64,
) -> Option<Question> {
    // A load that is odd itself is no scale for other values.
    let has_odd_load = |run: &TestRun| limit::find("wheel_load_n")?.unusual(run.wheel_load_n);
    let judged = experiment.runs.iter().filter(|run| has_odd_load(run).is_none());
    let sizes = judged.filter_map(|run| {
        let value = run.measured[channel.index()]?;
        Some((run, value, value.abs() / scale(run)))
    });
    let (run, value, size) = sizes.max_by(|a, b| a.2.total_cmp(&b.2))?;
    let (what, units) = match size {
        size if size > upper => (
            "is",
            match channel {
                Channel::Torque => "N mm or N cm",
                _ => "another unit",
            },
        ),
        // All readings of a channel may be zero, as for a free-rolling wheel.
        size if size < lower && size > 0.0 => (
            "is the largest, and only",
            match channel {
                Channel::Torque => "kN m",
                _ => "kN",
            },
        ),
        _ => return None,
    };
    let words = format!(
        "{} {} {} of run {} {what} {} {scale_words}: was it typed in {units}?",
        channel.column(),
        number(value),
        channel.unit(),
        run.name,
        number(size)
    );
    Some(Question::new(channel.column(), words))
}

/// Returns the question about a wheel that has sunk nearly completely.
fn sinkage(experiment: &Experiment) -> Option<Question> {
    let sizes = experiment.runs.iter().filter_map(|run| {
        let sinkage_m = run.measured[Channel::Sinkage.index()]?;
        Some((
            run,
            sinkage_m,
            sinkage_m.abs() / experiment.wheels[&run.wheel].radius_m,
        ))
    });
    let (run, sinkage_m, size) = sizes.max_by(|a, b| a.2.total_cmp(&b.2))?;
    let words = format!(
        "sinkage_m {} m of run {} is {} radii of its wheel: was it typed in mm or cm?",
        number(sinkage_m),
        run.name,
        number(size)
    );
    (size > SINKAGE).then(|| Question::new(Channel::Sinkage.column(), words))
}

/// Returns the question about a rig radius that differs from the radius of its wheel.
fn rig_radius(experiment: &Experiment) -> Option<Question> {
    let [lower, upper] = RIG_RADIUS;
    experiment.wheels.iter().find_map(|(name, wheel)| {
        let ratio = wheel.rig_radius_m / wheel.radius_m;
        let words = format!(
            "rig_radius_m {} m of wheel {name} is {} times its radius_m {} m: was it a diameter, or typed in another unit?",
            number(wheel.rig_radius_m),
            number(ratio),
            number(wheel.radius_m)
        );
        (!(lower..=upper).contains(&ratio)).then(|| Question::new("rig_radius_m", words))
    })
}

/// Returns the question about a noise sd, compared with the largest measurement of its channel.
fn noise(experiment: &Experiment, channel: Channel) -> Option<Question> {
    let Some(NoiseSd::Known(sd)) = experiment.noise.sd[channel.index()] else {
        return None;
    };
    let values = experiment
        .runs
        .iter()
        .filter_map(|run| run.measured[channel.index()]);
    let largest = values.map(f64::abs).reduce(f64::max)?;
    let ratio = sd / largest;
    let [lower, upper] = NOISE;
    let words = format!(
        "[noise] {} {} {} is {} times the largest measurement: was it typed in another unit?",
        channel.column(),
        number(sd),
        channel.unit(),
        number(ratio)
    );
    (largest > 0.0 && !(lower..=upper).contains(&ratio))
        .then(|| Question::new(noise_parameter(channel), words))
}
