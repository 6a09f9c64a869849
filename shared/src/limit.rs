//! The limits of quantities: their possible and their usual values. A value outside was probably typed in another unit.
//!
//! Bounds are wide: wheels from a pebble's to a mining truck's, soils from regolith to clay, gravity from an asteroid's to a
//! centrifuge's. They do not describe a soil; they distinguish a number in kN from one in N.

/// The bounds of a quantity.
#[derive(Debug)]
pub struct Limit {
    /// Name of a column, a key or a parameter.
    pub name: &'static str,
    unit: &'static str,
    /// The physical limits: no rig has a value outside.
    possible: [f64; 2],
    /// The usual range: a value outside is questioned.
    usual: [f64; 2],
    /// Units that are often typed instead, with their size in the unit of the quantity.
    mistaken: &'static [(&'static str, f64)],
}

const LENGTHS: &[(&str, f64)] = &[("mm", 1e-3), ("cm", 1e-2), ("in", 0.0254)];
const ANGLES: &[(&str, f64)] = &[("rad", 180.0 / std::f64::consts::PI)];
const WEIGHTS: &[(&str, f64)] = &[("kN", 1e3), ("g", 9.81e-3), ("kg", 9.81)];
const SPEEDS: &[(&str, f64)] = &[("mm/s", 1e-3), ("cm/s", 1e-2), ("km/s", 1e3)];
const DENSITIES: &[(&str, f64)] = &[("g/cm^3", 1e3)];
const PRESSURES: &[(&str, f64)] = &[("MPa", 1e6), ("kPa", 1e3)];

const fn limit(
    name: &'static str,
    unit: &'static str,
    possible: [f64; 2],
    usual: [f64; 2],
    mistaken: &'static [(&'static str, f64)],
) -> Limit {
    Limit {
        name,
        unit,
        possible,
        usual,
        mistaken,
    }
}

const ANY: f64 = f64::INFINITY;

/// Every quantity that has limits.
pub const LIMITS: [Limit; 27] = [
    limit("wheel_load_n", "N", [0.0, 1e7], [1.0, 2e4], WEIGHTS),
    limit("sled_speed_m_s", "m/s", [0.0, 1e3], [1e-4, 2.0], SPEEDS),
    limit("slip", "1", [-1.0, 1.0], [-1.0, 1.0], &[("per cent", 1e-2)]),
    limit("radius_m", "m", [0.0, 10.0], [0.01, 1.0], LENGTHS),
    limit("width_m", "m", [0.0, 10.0], [0.003, 1.0], LENGTHS),
    limit("rig_radius_m", "m", [0.0, 10.0], [0.01, 1.0], LENGTHS),
    limit("wheel_radius_m", "m", [0.0, 100.0], [0.01, 1.0], LENGTHS),
    limit("grouser_height_m", "m", [0.0, 1.0], [0.0, 0.1], LENGTHS),
    limit("grouser_thickness_m", "m", [0.0, 1.0], [0.0, 0.1], LENGTHS),
    limit("grouser_width_m", "m", [0.0, 10.0], [1e-3, 1.0], LENGTHS),
    limit("grouser_angle_deg", "deg", [-89.0, 89.0], [-60.0, 60.0], &[]),
    limit("grouser_chevron_deg", "deg", [-89.0, 89.0], [-60.0, 60.0], &[]),
    limit("grouser_bow_m", "m", [-1.0, 1.0], [-0.1, 0.1], LENGTHS),
    limit(
        "gravity_m_s2",
        "m/s^2",
        [0.0, 3e3],
        [0.1, 30.0],
        &[("cm/s^2", 1e-2)],
    ),
    limit("bin_length_m", "m", [0.0, 1e4], [0.1, 100.0], LENGTHS),
    limit("density_kg_m3", "kg/m^3", [0.0, 2.5e4], [200.0, 5e3], DENSITIES),
    limit("repose_angle_deg", "deg", [0.0, 90.0], [10.0, 60.0], ANGLES),
    limit("plate_radius_m", "m", [0.0, 1.0], [0.005, 0.5], LENGTHS),
    limit("pressure_pa", "Pa", [-1e9, 1e9], [-1e4, 1e7], PRESSURES),
    limit("friction_angle_deg", "deg", [0.0, 89.0], [8.0, 60.0], ANGLES),
    limit("cohesion_pa", "Pa", [0.0, ANY], [0.0, 1e5], &[]),
    limit("log10_p_ref", "log10 Pa", [-3.0, 12.0], [1.0, 7.0], &[]),
    limit("n", "1", [0.01, 10.0], [0.1, 3.0], &[]),
    limit(
        "shear_velocity_m_s",
        "m/s",
        [0.0, ANY],
        [0.0, 1.0],
        &[("mm/s", 1e-3)],
    ),
    limit("dem_spacing_m", "m", [0.0, 1.0], [2e-4, 0.05], LENGTHS),
    limit("travel_step_m", "m", [0.0, 1.0], [1e-7, 0.02], LENGTHS),
    limit("steady_travel_m", "m", [0.0, 1e4], [0.01, 100.0], LENGTHS),
];

/// Returns the limits of a quantity by its name.
pub fn find(name: &str) -> Option<&'static Limit> {
    LIMITS.iter().find(|limit| limit.name == name)
}

/// Returns the message about a value that no rig has: `125 m must be at most 10 m: was it typed in mm (0.125 m)?`.
pub fn impossible(name: &str, value: f64) -> Option<String> {
    let limit = find(name)?;
    let outside = limit.outside(limit.possible, value)?;
    Some(format!("{outside}{}", limit.question(value)))
}

impl Limit {
    /// Returns the message about an unusual value: `0.06 N must be at least 1 N …`; `None` for a usual one.
    pub fn unusual(&self, value: f64) -> Option<String> {
        let [min, max] = self.usual;
        let side = match value {
            value if value < min => format!("below {}", self.amount(min)),
            value if value > max => format!("above {}", self.amount(max)),
            _ => return None,
        };
        let (amount, question) = (self.amount(value), self.question(value));
        Some(format!("{amount} is {side}{question}"))
    }

    /// Returns whether any value between two is usual.
    pub fn is_usual_within(&self, low: f64, high: f64) -> bool {
        let [min, max] = self.usual;
        low <= max && high >= min
    }

    fn outside(&self, [min, max]: [f64; 2], value: f64) -> Option<String> {
        let bound = match value {
            value if value < min => format!("at least {}", self.amount(min)),
            value if value > max => format!("at most {}", self.amount(max)),
            _ => return None,
        };
        Some(format!("{} must be {bound}", self.amount(value)))
    }

    fn amount(&self, value: f64) -> String {
        match self.unit {
            "1" => number(value),
            unit => format!("{} {unit}", number(value)),
        }
    }

    /// Asks whether another unit was typed: the units in which the value is usual.
    fn question(&self, value: f64) -> String {
        let [min, max] = self.usual;
        let typed: Vec<String> = self
            .mistaken
            .iter()
            .filter(|(_, size)| (min..=max).contains(&(value * size)))
            .map(|(unit, size)| format!("{unit} ({})", self.amount(value * size)))
            .collect();
        match typed.is_empty() {
            true => String::new(),
            false => format!(": was it typed in {}?", typed.join(" or ")),
        }
    }
}

/// Formats a number with at most six digits, without an exponent if that is short.
pub fn number(value: f64) -> String {
    let rounded: f64 = format!("{value:.5e}").parse().unwrap_or(value);
    match rounded.abs() {
        0.0 => "0".into(),
        size if (1e-6..1e7).contains(&size) => format!("{rounded}"),
        _ => format!("{rounded:e}"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::case_table::cases;

    #[test]
    fn a_value_in_another_unit_is_asked_about_in_it() {
        let split = |text: &'static str| {
            let (name, value) = text.split_once(' ').unwrap();
            (name, value.parse::<f64>().unwrap())
        };
        for (value, question) in cases(
            r#"
            wheel_load_n 0.06 => 0.06 N is below 1 N: was it typed in kN (60 N)?
            wheel_load_n 60000 => 60000 N is above 20000 N: was it typed in g (588.6 N)?
            sled_speed_m_s 9.5 => 9.5 m/s is above 2 m/s: was it typed in mm/s (0.0095 m/s) or cm/s (0.095 m/s)?
            friction_angle_deg 0.52 => 0.52 deg is below 8 deg: was it typed in rad (29.7938 deg)?
            cohesion_pa 2e10 => 2e10 Pa is above 100000 Pa"#,
        ) {
            let (name, value) = split(value);
            assert_eq!(find(name).unwrap().unusual(value).unwrap(), question);
        }
        assert_eq!(find("wheel_load_n").unwrap().unusual(60.0), None);
        for (value, question) in cases(
            r#"
            radius_m 125 => 125 m must be at most 10 m: was it typed in mm (0.125 m)?
            dem_spacing_m 1e300 => 1e300 m must be at most 1 m"#,
        ) {
            let (name, value) = split(value);
            assert_eq!(impossible(name, value).unwrap(), question);
        }
        assert_eq!(impossible("nobody_knows_it", 1e300), None);
    }

    #[test]
    fn usual_values_are_possible() {
        for (place, limit) in LIMITS.iter().enumerate() {
            let ([min, max], [low, high]) = (limit.possible, limit.usual);
            assert!(min <= low && low < high && high <= max, "{}", limit.name);
            assert!(LIMITS[..place].iter().all(|other| other.name != limit.name));
        }
    }
}
