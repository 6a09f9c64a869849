//! The rules of runs.csv: the valid values of its columns.

use crate::field::{Field, Kind};
use crate::unit::Quantity;

/// Checks a number for a column; the error is a message.
pub(crate) fn check_number(field: &Field, value: f64) -> Result<(), String> {
    let name = field.name.as_str();
    if !value.is_finite() {
        return Err(format!(
            "{name} is {value}: the formula divides by 0 or leaves its range"
        ));
    }
    let is_positive = matches!(name, "wheel_load_n" | "sled_speed_m_s") || name.ends_with("_sd");
    match (name, field.quantity()) {
        ("slip", _) if !(-1.0..1.0).contains(&value) => Err(format!(
            "slip {value} must lie in [-1, 1){}",
            if value.abs() <= 100.0 && value.abs() > 1.5 {
                ": is this in %? State `unit = \"%\"` in the map"
            } else {
                ""
            }
        )),
        ("slip_angle_deg", _) if value.abs() > 90.0 => {
            Err(format!("slip angle {value} deg must lie in [-90, 90] deg"))
        }
        (_, Some(quantity)) if is_positive && value <= 0.0 => Err(format!(
            "{} {value} {} must be > 0",
            field.words,
            if quantity == Quantity::Angle {
                "deg"
            } else {
                quantity.si()
            }
        )),
        _ => Ok(()),
    }
}

/// Returns the text of a column without unit as runs.csv has it, or a message.
pub(crate) fn check_text(field: &Field, text: &str) -> Result<String, String> {
    match field.kind {
        Kind::Whole(min) => match text.parse::<f64>() {
            Ok(value) if value.fract().abs() <= 0.0 && value >= min as f64 && value.abs() < 1e9 => {
                Ok(format!("{value:.0}"))
            }
            _ if min > 0 => Err(format!(
                "{} \"{text}\" must be a whole number of at least {min}",
                field.name
            )),
            _ => Err(format!("{} \"{text}\" must be a whole number", field.name)),
        },
        Kind::Use if text != "fit" && text != "holdout" => Err(format!(
            "use \"{text}\" must be fit or holdout; where it is another word, `words = {{ \"{text}\" = \"holdout\" }}` in the map says what it means"
        )),
        _ => Ok(text.to_owned()),
    }
}
