//! Units and their dimensions.

/// Powers of kilogram, metre, second and degree, each counted in halves: a square root stays a dimension.
///
/// A degree is a dimension, so that `sin` of a degree is noticed; a radian has no dimension.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Unit {
    halves: [i16; 4],
}

/// The largest power that is tracked, in halves.
const MAX_HALVES: i16 = 64;

/// The highest power that a text may state.
const HIGHEST: i16 = 9;

/// A unit that is not known.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error("unknown unit \"{word}\"{}; SI units without prefixes are {}, with / and spaces and ^ up to {HIGHEST}",
    within.as_ref().map_or_else(String::new, |text| format!(" in \"{text}\"")), KNOWN.map(|(name, _)| name).join(", "))]
pub struct UnitError {
    /// The unknown word.
    pub word: String,
    /// The whole text, if it contains more than that word.
    pub within: Option<String>,
}

const KNOWN: [(&str, [i16; 4]); 11] = [
    ("1", [0, 0, 0, 0]),
    ("kg", [1, 0, 0, 0]),
    ("m", [0, 1, 0, 0]),
    ("s", [0, 0, 1, 0]),
    ("deg", [0, 0, 0, 1]),
    ("rad", [0, 0, 0, 0]),
    ("N", [1, 1, -2, 0]),
    ("Pa", [1, -1, -2, 0]),
    ("J", [1, 2, -2, 0]),
    ("W", [1, 2, -3, 0]),
    ("Hz", [0, 0, -1, 0]),
];

impl Unit {
    /// A number without unit.
    pub const ONE: Unit = Unit { halves: [0; 4] };

    /// The unit degree.
    pub(crate) const DEGREE: Unit = Unit { halves: [0, 0, 0, 2] };

    /// Parses a unit: names of SI units, `^` with a whole power, products by spaces, quotients by `/` (which applies to
    /// the next name alone): `N s/m`, `1/m`, `kg/m^3`.
    ///
    /// # Errors
    /// [`UnitError`] names the unknown word and the known units.
    pub fn parse(text: &str) -> Result<Unit, UnitError> {
        let unknown = |word: &str| UnitError {
            word: word.to_owned(),
            within: (word != text).then(|| text.to_owned()),
        };
        let mut unit = Unit::ONE;
        let mut any = false;
        for product in text.split_whitespace() {
            for (place, factor) in product.split('/').enumerate() {
                let (name, power) = factor.split_once('^').unwrap_or((factor, "1"));
                let entry = KNOWN.iter().find(|(symbol, _)| *symbol == name);
                let (_, dimension) = entry.ok_or_else(|| unknown(factor))?;
                let power: i16 = power.parse().map_err(|_| unknown(factor))?;
                if power.unsigned_abs() > HIGHEST.unsigned_abs() {
                    return Err(unknown(factor));
                }
                let power = if place == 0 { power } else { -power };
                let halves = dimension.map(|d| 2 * d * power);
                unit = unit.times(Unit { halves }).ok_or_else(|| unknown(factor))?;
                any = true;
            }
        }
        if any { Ok(unit) } else { Err(unknown(text)) }
    }

    /// Returns the unit of a product; `None` if its powers are too large.
    pub(crate) fn times(self, other: Unit) -> Option<Unit> {
        self.combine(other, |a, b| a + b)
    }

    /// Returns the unit of a quotient.
    pub(crate) fn over(self, other: Unit) -> Option<Unit> {
        self.combine(other, |a, b| a - b)
    }

    fn combine(self, other: Unit, with: fn(i16, i16) -> i16) -> Option<Unit> {
        let mut halves = self.halves;
        for (mine, theirs) in halves.iter_mut().zip(other.halves) {
            *mine = with(*mine, theirs);
        }
        Unit { halves }.within_reach()
    }

    /// Returns the unit of a power; `None` if it is no whole number of halves.
    pub(crate) fn to_the(self, power: f64) -> Option<Unit> {
        let mut halves = [0; 4];
        for (new, old) in halves.iter_mut().zip(self.halves) {
            let exact = f64::from(old) * power;
            if (libm::rint(exact) - exact).abs() > 0.0 || exact.abs() > f64::from(MAX_HALVES) {
                return None;
            }
            *new = exact as i16;
        }
        Some(Unit { halves })
    }

    fn within_reach(self) -> Option<Unit> {
        self.halves.iter().all(|h| h.abs() <= MAX_HALVES).then_some(self)
    }
}

impl core::fmt::Display for Unit {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        if let Some((name, _)) = KNOWN
            .iter()
            .find(|(name, d)| *name != "rad" && d.map(|d| 2 * d) == self.halves)
        {
            return f.write_str(name);
        }
        let mut first = true;
        for (name, half) in ["kg", "m", "s", "deg"].into_iter().zip(self.halves) {
            if half == 0 {
                continue;
            }
            let gap = if first { "" } else { " " };
            first = false;
            match half {
                2 => write!(f, "{gap}{name}")?,
                _ if half % 2 == 0 => write!(f, "{gap}{name}^{}", half / 2)?,
                _ => write!(f, "{gap}{name}^({half}/2)")?,
            }
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn units_are_read_and_written() {
        for (text, shown) in [
            ("1", "1"),
            ("m", "m"),
            ("Pa", "Pa"),
            ("N/m^2", "Pa"),
            ("N m", "J"),
            ("1/m", "m^-1"),
            ("kg/m^3", "kg m^-3"),
            ("N s/m", "kg s^-1"),
            ("rad", "1"),
            ("deg", "deg"),
        ] {
            assert_eq!(Unit::parse(text).unwrap().to_string(), shown, "{text}");
        }
    }

    #[test]
    fn unknown_units_are_named() {
        for text in ["mm", "", "N/", "m^x", "m^400", "m^-32768", "lb"] {
            let error = Unit::parse(text).unwrap_err().to_string();
            assert!(
                error.starts_with("unknown unit") && error.contains("Pa"),
                "{error}"
            );
        }
    }

    #[test]
    fn powers_that_are_no_dimension_are_none() {
        let metre = Unit::parse("m").unwrap();
        assert_eq!(metre.to_the(0.5).unwrap().to_string(), "m^(1/2)");
        assert!(metre.to_the(0.3).is_none() && metre.to_the(1e9).is_none());
    }
}
