//! Questions about unusual values: numbers outside the usual range of their quantity, slip angles that look like radians, and
//! radii that contradict the wheel.

use shared::experiment::{Experiment, TestRun};
use shared::limit::{self, Limit};
use shared::parameters::{WHEEL_RADIUS, behind};

use super::question::{Question, SLIP_ANGLE};
use crate::Spec;
use crate::table::prior_entry::FreeParameter;

/// Probability of the central interval of a prior that is compared with the usual range.
const CENTRAL: f64 = 0.9;
/// Probability of the central interval of the prior of a wheel's radius that is compared with the wheel.
const CENTRAL_OF_RADIUS: f64 = 0.998;
/// Relative difference up to which a radius counts as the wheel's.
const RADIUS_TOLERANCE: f64 = 0.02;

/// Returns one question for each quantity, with its first odd value and the number of its other odd values.
pub(super) fn questions(spec: &Spec) -> Vec<Question> {
    let mut questions = Vec::new();
    for limit in &limit::LIMITS {
        let mut odd = values(spec, limit)
            .into_iter()
            .filter_map(|(place, value)| Some((place, limit.unusual(value)?)));
        let Some((place, why)) = odd.next() else {
            continue;
        };
        let others = match odd.count() {
            0 => String::new(),
            1 => " (and 1 other)".into(),
            more => format!(" (and {more} others)"),
        };
        let words = format!("{} of {place}{others}: {why}", limit.name);
        questions.push(Question::new(limit.name, words));
    }
    let model = spec.model.fixed.iter();
    for (name, &value) in model {
        let limit = limit::find(base(name));
        if let Some((limit, why)) = limit.and_then(|limit| Some((limit, limit.unusual(value)?))) {
            questions.push(Question::new(limit.name, format!("{name}, fixed: {why}")));
        }
    }
    questions.extend(spec.parameters.iter().filter_map(prior_question));
    let has_posterior = |p: &&FreeParameter| {
        let joint = spec.joint_prior.as_ref();
        joint.is_some_and(|joint| joint.parameters.contains(&p.name))
    };
    // Nobody types a posterior, so its values raise no question.
    let typed = spec.parameters.iter().filter(|p| !has_posterior(p));
    questions.extend(typed.filter_map(|p| radius_prior_question(spec, p)));
    let fixed = spec.model.fixed.iter();
    questions.extend(fixed.filter_map(|(name, &value)| fixed_radius_question(spec, name, value)));
    questions.extend(slip_angle(&spec.experiment));
    questions
}

/// Returns the question about a prior of a wheel's radius whose 99.8 % interval excludes the wheel's radius.
fn radius_prior_question(spec: &Spec, parameter: &FreeParameter) -> Option<Question> {
    let end = 0.5 * (1.0 - CENTRAL_OF_RADIUS);
    let [low, high] = [end, 1.0 - end].map(|p| parameter.marginal.quantile(p));
    let (wheel, radius_m) = elsewhere(spec, &parameter.name, [low, high])?;
    let words = format!(
        "the prior of {} has 99.8 % of its probability from {} to {} m, and wheel {wheel} has radius_m = {}",
        parameter.name,
        limit::number(low),
        limit::number(high),
        limit::number(radius_m)
    );
    Some(Question::new(WHEEL_RADIUS, words))
}

/// Returns the question about a fixed wheel's radius that differs from the wheel's.
fn fixed_radius_question(spec: &Spec, name: &str, value: f64) -> Option<Question> {
    let (wheel, radius_m) = elsewhere(spec, name, [value, value])?;
    let [value, radius_m] = [value, radius_m].map(limit::number);
    let words = format!("{name}, fixed: {value} m, and wheel {wheel} has radius_m = {radius_m}");
    Some(Question::new(WHEEL_RADIUS, words))
}

/// Returns the first wheel, with its `radius_m`, that a parameter's radii do not fit: they differ from its rim and, if the model
/// rolls a smooth wheel in place of its grousers, beside their tips and what is between.
fn elsewhere<'a>(spec: &'a Spec, parameter: &str, [low, high]: [f64; 2]) -> Option<(&'a str, f64)> {
    let (name, stated_wheel) = match parameter.split_once('.') {
        Some((name, wheel)) => (name, Some(wheel)),
        None => (parameter, None),
    };
    if name != WHEEL_RADIUS {
        return None;
    }
    let mut wheels = spec.experiment.wheels.iter();
    let (wheel, geometry) = wheels.find(|(wheel, geometry)| {
        let rim = geometry.radius_m;
        let largest = match spec.model.is_smooth() {
            true => rim + geometry.grouser_height_m,
            false => rim,
        };
        let is_meant = stated_wheel.is_none_or(|stated| stated == wheel.as_str());
        is_meant && (high < rim * (1.0 - RADIUS_TOLERANCE) || low > largest * (1.0 + RADIUS_TOLERANCE))
    })?;
    Some((wheel, geometry.radius_m))
}

/// Returns the question about a prior with hardly any probability in the usual range.
fn prior_question(parameter: &FreeParameter) -> Option<Question> {
    let limit = limit::find(base(&parameter.name))?;
    let end = 0.5 * (1.0 - CENTRAL);
    let [low, high] = [end, 1.0 - end].map(|p| parameter.marginal.quantile(p));
    // Both ends on the same side: nothing between them is usual.
    let why = limit.unusual(low).filter(|_| !limit.is_usual_within(low, high))?;
    let words = format!(
        "the prior of {} has 90 % of its probability from {} to {}{}: {why}",
        parameter.name,
        limit::number(low),
        limit::number(high),
        behind(&parameter.unit)
    );
    Some(Question::new(limit.name, words))
}

/// Returns the question about slip angles that would all be at most right angles if they were in radians.
fn slip_angle(experiment: &Experiment) -> Option<Question> {
    let angles = experiment.runs.iter().map(|run| run.slip_angle_deg.abs());
    let largest = angles.reduce(f64::max)?;
    let words = format!(
        "the largest slip_angle_deg is {} deg: was it typed in rad ({} deg)?",
        limit::number(largest),
        limit::number(largest.to_degrees())
    );
    let in_radians = largest > 0.0 && largest <= std::f64::consts::FRAC_PI_2;
    in_radians.then(|| Question::new(SLIP_ANGLE, words))
}

/// Returns the name of a parameter without the name of its wheel.
fn base(name: &str) -> &str {
    name.split_once('.').map_or(name, |(base, _)| base)
}

/// Returns the values that the files state for a quantity, each with its place.
fn values(spec: &Spec, limit: &Limit) -> Vec<(String, f64)> {
    let experiment = &spec.experiment;
    let runs = |value: fn(&TestRun) -> f64| {
        let each = experiment.runs.iter();
        each.map(|run| (format!("run {}", run.name), value(run)))
            .collect()
    };
    let wheels = |value: fn(&shared::experiment::WheelGeometry) -> f64| {
        let each = experiment.wheels.iter();
        each.map(|(name, wheel)| (format!("wheel {name}"), value(wheel)))
            .collect()
    };
    let treads = |value: fn(&shared::experiment::Tread) -> Option<f64>| {
        let each = experiment.wheels.iter();
        each.filter_map(|(name, wheel)| Some((format!("wheel {name}"), value(wheel.tread.as_ref()?)?)))
            .collect()
    };
    let soils = |value: fn(&shared::experiment::SoilProperties) -> Option<f64>| {
        let each = experiment.soils.iter();
        each.filter_map(|(name, soil)| Some((format!("soil {name}"), value(soil)?)))
            .collect()
    };
    let spatial = |value: fn(&shared::model::SpatialSettings) -> f64| {
        let settings = spec.model.spatial.iter();
        settings.map(|s| ("[model]".to_owned(), value(s))).collect()
    };
    match limit.name {
        "wheel_load_n" => runs(|run| run.wheel_load_n),
        "sled_speed_m_s" => runs(|run| run.sled_speed_m_s),
        "radius_m" => wheels(|wheel| wheel.radius_m),
        "width_m" => wheels(|wheel| wheel.width_m),
        "rig_radius_m" => wheels(|wheel| wheel.rig_radius_m),
        "grouser_height_m" => wheels(|wheel| wheel.grouser_height_m),
        "grouser_thickness_m" => wheels(|wheel| wheel.grouser_thickness_m),
        "grouser_width_m" => treads(|tread| tread.width_m),
        "grouser_angle_deg" => treads(|tread| Some(tread.angle_deg)),
        "grouser_chevron_deg" => treads(|tread| Some(tread.chevron_deg)),
        "grouser_bow_m" => treads(|tread| Some(tread.bow_m)),
        "gravity_m_s2" => vec![("[rig]".into(), experiment.rig.gravity_m_s2)],
        "bin_length_m" => {
            let length = experiment.rig.bin_length_m.into_iter();
            length.map(|length| ("[rig]".into(), length)).collect()
        }
        "density_kg_m3" => soils(|soil| soil.density_kg_m3),
        "repose_angle_deg" => soils(|soil| soil.repose_angle_deg),
        "plate_radius_m" => {
            let each = experiment.plates.iter();
            each.map(|p| (format!("plate test {}", p.test), p.plate_radius_m))
                .collect()
        }
        "pressure_pa" => {
            let each = experiment.plates.iter();
            each.filter_map(|p| Some((format!("plate test {}", p.test), p.pressure_pa?)))
                .collect()
        }
        "dem_spacing_m" => spatial(|s| s.dem_spacing_m),
        "travel_step_m" => spatial(|s| s.travel_step_m),
        "steady_travel_m" => spatial(|s| s.steady_travel_m),
        // Slip is refused outside its range; the rest are parameters.
        _ => Vec::new(),
    }
}

#[cfg(test)]
mod tests {
    use shared::file::FileSet;

    use super::*;

    const EXPERIMENT: &str = "runs = \"runs.csv\"\n[wheel.w]\nradius_m = 0.125\nwidth_m = 0.112\ngrouser_count = 12\ngrouser_height_m = 0.02\ngrouser_thickness_m = 0.002\n[soil.s]\n[noise]\ndrawbar_pull_n = 1.0\n";
    const RUNS: &str =
        "run,wheel,soil,slip,wheel_load_n,sled_speed_m_s,drawbar_pull_n\na,w,s,0.2,100,0.008,30\n";

    /// Returns the questions on the radius of a wheel with its rim at 0.125 m and its tips at 0.145 m.
    fn asked(model: &str, radius: &str) -> Vec<String> {
        let priors = match model.contains("rft") {
            true => "",
            false => {
                "log10_p_ref = 4.5\nkappa = 0.0\nfriction_angle_deg = 30.0\nn = { normal = [1.1, 0.2], bounds = [0.8, 2.0] }\n"
            }
        };
        let job = FileSet {
            toml: format!("[model]\n{model}\n[priors]\n\"wheel_radius_m.w\" = {radius}\n{priors}"),
            files: Default::default(),
        };
        let experiment = FileSet {
            toml: EXPERIMENT.into(),
            files: [("runs.csv".to_owned(), RUNS.to_owned())].into(),
        };
        let spec = Spec::new("job.toml", &job, "experiment.toml", &experiment).unwrap();
        let about_radius = questions(&spec)
            .into_iter()
            .filter(|question| question.name == WHEEL_RADIUS);
        about_radius.map(|question| question.words).collect()
    }

    #[test]
    fn a_radius_may_be_that_of_the_tips_only_where_the_wheel_rolls_smooth() {
        let (smooth, rolled) = (
            "kind = \"quasi_static\"",
            "kind = \"quasi_static\"\ngrousers = \"rolled\"",
        );
        let tips = "{ uniform = [0.140, 0.145] }";
        let none: [&str; 0] = [];
        assert_eq!(asked(smooth, tips), none);
        for model in [rolled, "kind = \"scm\"", "kind = \"rft\""] {
            assert_eq!(
                asked(model, tips),
                [
                    "the prior of wheel_radius_m.w has 99.8 % of its probability from 0.140005 to 0.144995 m, and wheel w has radius_m = 0.125"
                ],
                "{model}"
            );
            assert_eq!(asked(model, "{ uniform = [0.120, 0.130] }"), none, "{model}");
        }
    }

    #[test]
    fn a_fixed_radius_of_another_wheel_is_asked_about() {
        let smooth = "kind = \"quasi_static\"";
        let none: [&str; 0] = [];
        assert_eq!(asked(smooth, "0.145"), none);
        for radius in ["0.25", "0.0625"] {
            assert_eq!(
                asked(smooth, radius),
                [format!(
                    "wheel_radius_m.w, fixed: {radius} m, and wheel w has radius_m = 0.125"
                )]
            );
        }
    }
}
