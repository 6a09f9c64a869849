//! Numbers outside the usual range of their quantity.

use shared::experiment::TestRun;
use shared::limit::{self, Limit};
use shared::parameters::{WHEEL_RADIUS, behind};

use super::question::Question;
use crate::Spec;
use crate::table::prior_entry::FreeParameter;

/// Probability of a prior within the values that are judged.
const CENTRAL: f64 = 0.9;
/// The same of a wheel's radius, which is known.
const OF_RADIUS: f64 = 0.998;
/// Relative distance at which a radius is still that of the wheel.
const ABOUT: f64 = 0.02;

/// Each quantity once, with the first of its values that is odd and the number of the others.
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
        let limit = limit::of(base(name));
        if let Some((limit, why)) = limit.and_then(|limit| Some((limit, limit.unusual(value)?))) {
            questions.push(Question::new(limit.name, format!("{name}, fixed: {why}")));
        }
    }
    questions.extend(spec.parameters.iter().filter_map(of_prior));
    questions.extend(spec.parameters.iter().filter_map(|p| of_radius(spec, p)));
    questions
}

/// A prior of a wheel's radius that lies elsewhere than the wheel: neither rim nor tips, nor what is between them, is where it has
/// 99.8 % of its probability.
fn of_radius(spec: &Spec, parameter: &FreeParameter) -> Option<Question> {
    let (name, own) = match parameter.name.split_once('.') {
        Some((name, wheel)) => (name, Some(wheel)),
        None => (parameter.name.as_str(), None),
    };
    if name != WHEEL_RADIUS {
        return None;
    }
    let end = 0.5 * (1.0 - OF_RADIUS);
    let [low, high] = [end, 1.0 - end].map(|p| parameter.marginal.quantile(p));
    let wheels = spec.experiment.wheels.iter();
    let mut elsewhere = wheels.filter(|(wheel, geometry)| {
        let (rim, tips) = (geometry.radius_m, geometry.radius_m + geometry.grouser_height_m);
        let is_meant = own.is_none_or(|own| own == wheel.as_str());
        is_meant && (high < rim * (1.0 - ABOUT) || low > tips * (1.0 + ABOUT))
    });
    let (wheel, geometry) = elsewhere.next()?;
    let words = format!(
        "the prior of {} has 99.8 % of its probability from {} to {} m, and wheel {wheel} has radius_m = {}",
        parameter.name,
        limit::number(low),
        limit::number(high),
        limit::number(geometry.radius_m)
    );
    Some(Question::new(WHEEL_RADIUS, words))
}

/// A prior of which hardly anything lies in the usual range.
fn of_prior(parameter: &FreeParameter) -> Option<Question> {
    let limit = limit::of(base(&parameter.name))?;
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

/// The name of a parameter without that of a wheel.
fn base(name: &str) -> &str {
    name.split_once('.').map_or(name, |(base, _)| base)
}

/// What the files say of a quantity: the place of each value, and the value.
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
