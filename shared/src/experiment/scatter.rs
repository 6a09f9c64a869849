//! Relative scatter: of the soil from run to run, of bevameter tests and readings.

use super::check::{RawScatter, ValueError};

/// A source of relative scatter.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Scatter {
    /// The soil's stiffness, from run to run of a wheel.
    Run,
    /// The soil's stiffness, from preparation to preparation.
    Preparation,
    /// The soil's shear strength, from preparation to preparation.
    PreparationStrength,
    /// The pressure under a plate, from test to test.
    PlateTest,
    /// The pressure under a plate, from reading to reading.
    PlateReading,
    /// The shear stress under a ring, from test to test.
    RingTest,
    /// The shear stress under a ring, from reading to reading.
    RingReading,
}

/// A relative standard deviation.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum ScatterSd {
    /// The scatter is stated as a number.
    Known(f64),
    /// A parameter of the calibration: `noise.` and the key.
    Unknown,
}

impl Scatter {
    /// Every kind, in the order of [`Scatter::index`].
    pub const ALL: [Scatter; 7] = [
        Scatter::Run,
        Scatter::Preparation,
        Scatter::PreparationStrength,
        Scatter::PlateTest,
        Scatter::PlateReading,
        Scatter::RingTest,
        Scatter::RingReading,
    ];

    /// Returns the position in [`Scatter::ALL`].
    pub fn index(self) -> usize {
        self as usize
    }

    /// Returns the key under `[noise]`, and in the parameter's name.
    pub fn key(self) -> &'static str {
        match self {
            Scatter::Run => "run_scatter",
            Scatter::Preparation => "preparation_scatter",
            Scatter::PreparationStrength => "preparation_strength_scatter",
            Scatter::PlateTest => "plate_scatter",
            Scatter::PlateReading => "plate_noise",
            Scatter::RingTest => "ring_scatter",
            Scatter::RingReading => "ring_noise",
        }
    }

    /// Returns the value if the experiment states none. The scatter of preparations is inferred: an experiment that names
    /// preparations expects them to differ, and without the column `prepared` it has no effect.
    pub fn usual(self) -> ScatterSd {
        match self {
            Scatter::Run => ScatterSd::Known(0.0),
            Scatter::Preparation | Scatter::PreparationStrength => ScatterSd::Unknown,
            Scatter::PlateTest => ScatterSd::Known(0.10),
            Scatter::PlateReading | Scatter::RingReading => ScatterSd::Known(0.03),
            Scatter::RingTest => ScatterSd::Known(0.05),
        }
    }

    /// Returns the scale of the half-normal prior of an unknown scatter if the job states none: for tests and readings
    /// twice the usual value, for the soil's stiffness 0.2 and for its strength 0.05 (one degree of friction changes it
    /// by 0.04).
    pub fn prior_scale(self) -> f64 {
        match self {
            Scatter::Run | Scatter::Preparation | Scatter::PlateTest => 0.2,
            Scatter::PreparationStrength => 0.05,
            Scatter::PlateReading | Scatter::RingReading => 0.06,
            Scatter::RingTest => 0.1,
        }
    }

    /// Reads a value; readings have noise, tests may have no scatter.
    pub(super) fn read(self, raw: Option<RawScatter>) -> Result<ScatterSd, ValueError> {
        let key = self.key();
        let rule = |message: String| Err(ValueError::Rule(message));
        match raw {
            None => Ok(self.usual()),
            Some(RawScatter::Word(word)) if word == "unknown" => Ok(ScatterSd::Unknown),
            Some(RawScatter::Word(word)) => {
                rule(format!("{key} = \"{word}\" must be a number or \"unknown\""))
            }
            Some(RawScatter::Number(x)) => {
                let reading = matches!(self, Scatter::PlateReading | Scatter::RingReading);
                match (0.0..=1.0).contains(&x) && (x > 0.0 || !reading) {
                    true => Ok(ScatterSd::Known(x)),
                    false if reading => rule(format!("{key} {x} must be > 0 and <= 1: it is relative")),
                    false => rule(format!("{key} {x} must lie in [0, 1]: it is relative")),
                }
            }
        }
    }
}
