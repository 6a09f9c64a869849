//! Units of measured quantities, as factors to SI, in the spellings of users.

use std::f64::consts::{PI, TAU};

/// A measured quantity.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Quantity {
    Ratio,
    Angle,
    AngularSpeed,
    Length,
    Time,
    Speed,
    Force,
    Torque,
}

impl Quantity {
    /// Returns the name with its article, for sentences.
    pub(crate) fn words(self) -> &'static str {
        match self {
            Quantity::Ratio => "a ratio",
            Quantity::Angle => "an angle",
            Quantity::AngularSpeed => "a rotational speed",
            Quantity::Length => "a length",
            Quantity::Time => "a time",
            Quantity::Speed => "a speed",
            Quantity::Force => "a force",
            Quantity::Torque => "a torque",
        }
    }

    /// Returns the SI unit in formulas.
    pub(crate) fn si(self) -> &'static str {
        ["1", "rad", "1/s", "m", "s", "m/s", "N", "N m"][self as usize]
    }

    /// Returns the units that the quantity can be given in, the usual ones first.
    pub(crate) fn units(self) -> impl Iterator<Item = &'static str> {
        UNITS
            .iter()
            .filter(move |unit| unit.quantity == self)
            .map(|unit| unit.name)
    }
}

/// A unit.
#[derive(Debug, PartialEq)]
pub(crate) struct Unit {
    pub(crate) quantity: Quantity,
    pub(crate) name: &'static str,
    /// One unit in SI units.
    pub(crate) si: f64,
    /// Other spellings.
    words: &'static [&'static str],
}

const fn unit(quantity: Quantity, name: &'static str, si: f64, words: &'static [&'static str]) -> Unit {
    Unit {
        quantity,
        name,
        si,
        words,
    }
}

/// Standard gravity `[m/s²]`, which defines kilogram-force and pound-force (3rd CGPM 1901; NIST SP 811 B.8).
const G: f64 = 9.806_65;
/// International pound `[kg]` (NIST SP 811 B.8).
const LB: f64 = 0.453_592_37;
const INCH: f64 = 0.0254;
const FOOT: f64 = 0.3048;

/// All units. Spaces, dots, asterisks and brackets in a spelling are ignored; capitals are not.
const UNITS: [Unit; 56] = [
    unit(Quantity::Ratio, "1", 1.0, &["-", "–", "—", "ratio", "none"]),
    unit(Quantity::Ratio, "%", 0.01, &["percent", "Prozent", "pct", "v.H."]),
    unit(Quantity::Ratio, "permille", 0.001, &["‰", "Promille"]),
    unit(
        Quantity::Angle,
        "deg",
        PI / 180.0,
        &["°", "degree", "degrees", "Grad"],
    ),
    unit(Quantity::Angle, "rad", 1.0, &["radian", "radians"]),
    unit(
        Quantity::Angle,
        "rev",
        TAU,
        &["U", "turn", "turns", "Umdrehung", "Umdrehungen", "Umdr", "revs"],
    ),
    unit(
        Quantity::AngularSpeed,
        "rpm",
        TAU / 60.0,
        &[
            "1/min", "U/min", "Umdr/min", "r/min", "rev/min", "min^-1", "min-1", "min⁻¹", "RPM",
        ],
    ),
    unit(Quantity::AngularSpeed, "rad/s", 1.0, &[]),
    unit(Quantity::AngularSpeed, "rev/s", TAU, &["U/s", "rps", "r/s"]),
    unit(Quantity::AngularSpeed, "deg/s", PI / 180.0, &["°/s", "Grad/s"]),
    unit(Quantity::Length, "m", 1.0, &["metre", "meter", "Meter"]),
    unit(Quantity::Length, "mm", 1e-3, &["Millimeter"]),
    unit(Quantity::Length, "cm", 1e-2, &["Zentimeter"]),
    unit(Quantity::Length, "um", 1e-6, &["µm", "μm"]),
    unit(Quantity::Length, "km", 1e3, &[]),
    unit(Quantity::Length, "in", INCH, &["inch", "inches", "\"", "Zoll"]),
    unit(Quantity::Length, "ft", FOOT, &["foot", "feet"]),
    unit(Quantity::Time, "s", 1.0, &["sec", "Sek", "Sekunden", "seconds"]),
    unit(Quantity::Time, "ms", 1e-3, &[]),
    unit(Quantity::Time, "us", 1e-6, &["µs", "μs"]),
    unit(Quantity::Time, "min", 60.0, &[]),
    unit(Quantity::Time, "h", 3600.0, &["hours", "Std"]),
    unit(Quantity::Speed, "m/s", 1.0, &["ms^-1", "mps"]),
    unit(Quantity::Speed, "mm/s", 1e-3, &["mms^-1"]),
    unit(Quantity::Speed, "cm/s", 1e-2, &["cms^-1"]),
    unit(Quantity::Speed, "m/min", 1.0 / 60.0, &[]),
    unit(Quantity::Speed, "mm/min", 1e-3 / 60.0, &[]),
    unit(Quantity::Speed, "cm/min", 1e-2 / 60.0, &[]),
    unit(Quantity::Speed, "m/h", 1.0 / 3600.0, &[]),
    unit(Quantity::Speed, "km/h", 1.0 / 3.6, &["kmh", "kph"]),
    unit(Quantity::Speed, "in/s", INCH, &["ips"]),
    unit(Quantity::Speed, "ft/s", FOOT, &["fps"]),
    unit(Quantity::Force, "N", 1.0, &["Newton", "newton"]),
    unit(Quantity::Force, "kN", 1e3, &[]),
    unit(Quantity::Force, "mN", 1e-3, &[]),
    unit(Quantity::Force, "daN", 10.0, &[]),
    unit(Quantity::Force, "MN", 1e6, &[]),
    unit(Quantity::Force, "kgf", G, &["kp", "kg-f", "kg_f"]),
    unit(Quantity::Force, "gf", 1e-3 * G, &["p", "pond"]),
    unit(Quantity::Force, "lbf", LB * G, &["lb_f", "lb-f"]),
    unit(Quantity::Force, "ozf", LB * G / 16.0, &[]),
    unit(Quantity::Torque, "N m", 1.0, &["Newtonmeter"]),
    unit(Quantity::Torque, "N cm", 1e-2, &[]),
    unit(Quantity::Torque, "N mm", 1e-3, &[]),
    unit(Quantity::Torque, "kN m", 1e3, &[]),
    unit(Quantity::Torque, "mN m", 1e-3, &[]),
    unit(Quantity::Torque, "kgf m", G, &["kp m"]),
    unit(Quantity::Torque, "kgf cm", 1e-2 * G, &["kp cm"]),
    unit(Quantity::Torque, "gf cm", 1e-5 * G, &[]),
    unit(
        Quantity::Torque,
        "lbf in",
        LB * G * INCH,
        &["in lbf", "lb in", "in lb", "in-lb", "in-lbf", "lbf-in"],
    ),
    unit(
        Quantity::Torque,
        "lbf ft",
        LB * G * FOOT,
        &["ft lbf", "lb ft", "ft lb", "ft-lb", "ft-lbf", "lbf-ft"],
    ),
    unit(
        Quantity::Torque,
        "ozf in",
        LB * G * INCH / 16.0,
        &["oz in", "in oz", "oz-in"],
    ),
    unit(Quantity::AngularSpeed, "deg/min", PI / 180.0 / 60.0, &["°/min"]),
    unit(Quantity::AngularSpeed, "rad/min", 1.0 / 60.0, &[]),
    unit(Quantity::AngularSpeed, "mrad/s", 1e-3, &[]),
    unit(Quantity::Angle, "mrad", 1e-3, &[]),
];

/// Masses and other words that users write in place of a unit, and the replacement to propose.
const NOT_UNITS: [(&str, &str); 10] = [
    (
        "kg",
        "kg is a mass; for the force that a scale shows in kilograms write kgf, else give the force in N",
    ),
    (
        "g",
        "g is a mass; for the force that a scale shows in grams write gf, else give the force in N",
    ),
    ("t", "t is a mass; give the force in kN"),
    ("lb", "lb is a mass; for a force write lbf"),
    ("lbs", "lbs is a mass; for a force write lbf"),
    ("1/s", "1/s can mean rad/s or rev/s: write one of these"),
    ("s^-1", "s^-1 can mean rad/s or rev/s: write one of these"),
    ("Hz", "Hz can mean rad/s or rev/s: write one of these"),
    ("gon", "gon is not known; give angles in deg or rad"),
    ("digit", "a raw reading has no unit; give the calibrated quantity"),
];

/// Returns the significant characters of a unit's name.
fn plain_chars(text: &str) -> impl Iterator<Item = char> + '_ {
    text.chars()
        .filter(|c| !c.is_whitespace() && !"·⋅*.[]()".contains(*c))
}

/// Returns a unit's name reduced to its significant characters.
fn plain(text: &str) -> String {
    plain_chars(text).collect()
}

/// Returns the unit that a text names; `None` if it names none.
pub(crate) fn find(text: &str) -> Option<&'static Unit> {
    // Every title and every cell below the titles is tested, so nothing is allocated.
    let is_meant = |name: &str| plain_chars(name).eq(plain_chars(text));
    let is_named = |unit: &&Unit| is_meant(unit.name) || unit.words.iter().any(|word| is_meant(word));
    UNITS.iter().find(is_named)
}

/// Returns whether a text is a unit, or a word used in place of one.
pub(crate) fn is_like_a_unit(text: &str) -> bool {
    find(text).is_some() || NOT_UNITS.iter().any(|(word, _)| *word == plain(text))
}

/// Returns the unit of a quantity that a text names.
///
/// # Errors
/// A message if the text is no unit, or a unit of another quantity, with the nearest fix.
pub(crate) fn read(text: &str, quantity: Quantity) -> Result<&'static Unit, String> {
    let names: Vec<&str> = quantity.units().collect();
    let listed = names.join(", ");
    if let Some(unit) = find(text) {
        return if unit.quantity == quantity {
            Ok(unit)
        } else {
            Err(format!(
                "unit \"{text}\" is one of {}, and {} is expected: {listed}",
                unit.quantity
                    .words()
                    .trim_start_matches("a ")
                    .trim_start_matches("an "),
                quantity.words()
            ))
        };
    }
    if let Some((_, hint)) = NOT_UNITS.iter().find(|(word, _)| *word == plain(text)) {
        return Err(format!("unit \"{text}\" cannot be used: {hint}"));
    }
    let sought = plain(text).to_lowercase();
    let near = UNITS
        .iter()
        .filter(|unit| unit.quantity == quantity)
        .find(|unit| {
            let words = unit.words.iter().chain([&unit.name]);
            words.into_iter().any(|word| plain(word).to_lowercase() == sought)
        });
    Err(match near {
        Some(near) => format!("unknown unit \"{text}\"; did you mean \"{}\"", near.name),
        None => format!("unknown unit \"{text}\"; {} is in {listed}", quantity.words()),
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn people_write_a_unit_in_many_ways() {
        for (text, name) in [
            ("Ncm", "N cm"),
            ("N·cm", "N cm"),
            ("[N*m]", "N m"),
            ("U/min", "rpm"),
            ("min⁻¹", "rpm"),
            ("°", "deg"),
            ("kp", "kgf"),
            ("-", "1"),
            ("in-lb", "lbf in"),
        ] {
            assert_eq!(find(text).map(|unit| unit.name), Some(name), "{text}");
        }
    }

    #[test]
    fn factors_are_those_of_their_definitions() {
        for (name, si) in [
            ("kgf", 9.80665),
            ("lbf", 4.448_221_615_260_5),
            ("lbf in", 0.112_984_829_027_616_7),
            ("lbf ft", 1.355_817_948_331_400_4),
            ("rpm", 0.104_719_755_119_659_77),
            ("km/h", 0.277_777_777_777_777_8),
            ("N cm", 0.01),
        ] {
            let unit = find(name).unwrap();
            assert!((unit.si - si).abs() <= 1e-15 * si, "{name}: {}", unit.si);
        }
    }

    #[test]
    fn no_two_units_share_a_word() {
        let mut seen = std::collections::BTreeMap::new();
        for unit in &UNITS {
            for word in unit.words.iter().chain([&unit.name]) {
                let earlier = seen.insert(plain(word), unit.name);
                assert!(
                    earlier.is_none() || earlier == Some(unit.name),
                    "{word}: {earlier:?}, {}",
                    unit.name
                );
            }
        }
    }

    #[test]
    fn what_is_no_unit_of_the_quantity_is_refused_with_the_nearest() {
        let message = |text, quantity| read(text, quantity).unwrap_err();
        assert_eq!(
            message("KN", Quantity::Force),
            "unknown unit \"KN\"; did you mean \"kN\""
        );
        assert!(message("kg", Quantity::Force).contains("write kgf"));
        assert!(
            message("mm", Quantity::Force)
                .starts_with("unit \"mm\" is one of length, and a force is expected: N, kN")
        );
        assert!(message("Hz", Quantity::AngularSpeed).contains("rad/s or rev/s"));
        assert!(message("zoll", Quantity::Length).contains("did you mean \"in\""));
    }
}
