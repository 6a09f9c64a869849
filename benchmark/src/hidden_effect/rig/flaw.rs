//! Flaws of a rig whose model is right.

use statistics::rng::Stream;

/// The random stream of orders and preparations.
const STAGE: u64 = 1 << 47;
/// Change of the stiffness over the series, up and down from its middle.
const STIFFNESS_DRIFT: f64 = 0.10;
/// Shift of the pull over the series, up and down from its middle, in noise sds.
const PULL_DRIFT_SDS: f64 = 1.2;
/// Relative sd of the stiffness from one preparation to the next.
const PREPARED_STIFFNESS: f64 = 0.10;
/// Sd of the friction angle from one preparation to the next.
const PREPARED_ANGLE_DEG: f64 = 1.0;
/// The ratio of the noise to the declared noise.
const UNDERSTATED: f64 = 1.5;

/// A flaw of a rig whose model is right.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Flaw {
    /// The soil stiffens by 20 % over the series and the zero of the pull moves by 2.4 noise sds, with the runs made in order of slip.
    SortedDrift,
    /// The same drifts, with the runs made in random order.
    RandomDrift,
    /// Four preparations of the soil, one for each load and speed, which differ in stiffness and friction.
    Preparations,
    /// The noise is larger than declared.
    Understated,
}

/// The effect of a flaw on one run.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Disturbance {
    /// Factor of the soil's stiffness.
    pub stiffness: f64,
    pub angle_deg: f64,
    /// The shift of the pull in noise sds.
    pub pull_sds: f64,
    /// The place in time, from 1.
    pub order: usize,
    /// The number of the soil preparation.
    pub prepared: usize,
}

impl Flaw {
    pub const DRIFTS: [Flaw; 2] = [Flaw::SortedDrift, Flaw::RandomDrift];

    pub fn name(self) -> &'static str {
        match self {
            Flaw::SortedDrift => "drift, runs sorted by slip",
            Flaw::RandomDrift => "drift, runs in random order",
            Flaw::Preparations => "preparations",
            Flaw::Understated => "understated noise",
        }
    }

    /// Returns the column of the runs that states the flaw.
    pub fn column(self) -> Option<&'static str> {
        match self {
            Flaw::SortedDrift | Flaw::RandomDrift => Some("order"),
            Flaw::Preparations => Some("prepared"),
            Flaw::Understated => None,
        }
    }

    /// For each search of a campaign, whether the experiment states the column.
    pub fn statements(self) -> &'static [bool] {
        match self.column() {
            Some(_) => &[true, false],
            None => &[false],
        }
    }

    /// Returns the ratio of the noise to the declared noise.
    pub fn noise(self) -> f64 {
        if self == Flaw::Understated {
            UNDERSTATED
        } else {
            1.0
        }
    }

    /// Returns the effect of the flaw on each run.
    ///
    /// # Arguments
    /// - `preparations`: the preparation of each run, with a separate one for each load and speed.
    pub fn disturbances(self, preparations: &[usize], seed: u64, number: u64) -> Vec<Disturbance> {
        let count = preparations.len();
        let mut order: Vec<usize> = (0..count).collect();
        if self == Flaw::RandomDrift {
            let mut stream = Stream::new(seed, STAGE, number, 0);
            for place in (1..count).rev() {
                order.swap(place, stream.below(place + 1));
            }
        }
        let disturbance = |run: usize| {
            let mut disturbed = Disturbance {
                stiffness: 1.0,
                angle_deg: 0.0,
                pull_sds: 0.0,
                order: 1 + order[run],
                prepared: 1,
            };
            match self {
                Flaw::SortedDrift | Flaw::RandomDrift => {
                    let from_middle = 2.0 * order[run] as f64 / (count - 1) as f64 - 1.0;
                    disturbed.stiffness = 1.0 + STIFFNESS_DRIFT * from_middle;
                    disturbed.pull_sds = PULL_DRIFT_SDS * from_middle;
                }
                Flaw::Preparations => {
                    disturbed.prepared = preparations[run];
                    let attempt = 1 + disturbed.prepared as u64;
                    let z = Stream::new(seed, STAGE, number, attempt).normals(2);
                    disturbed.stiffness = 1.0 + PREPARED_STIFFNESS * z[0];
                    disturbed.angle_deg = PREPARED_ANGLE_DEG * z[1];
                }
                Flaw::Understated => {}
            }
            disturbed
        };
        (0..count).map(disturbance).collect()
    }
}
