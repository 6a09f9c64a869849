//! The variables along which an experiment can show a dependence, and their ranges.
//!
//! Only fitted runs count: a law outside the library must not depend on holdout runs.

use std::collections::BTreeMap;
use std::f64::consts::FRAC_PI_2;

use formula::Variable;
use shared::channel::Channel;
use shared::experiment::{Experiment, RunUse, TestRun, rim_speed_m_s};

/// Knots of a curve.
pub(crate) const KNOTS: usize = 5;
/// Minimum number of levels of slip: with two it is confounded with what else differs between them.
const SLIP_LEVELS: usize = 3;
/// Minimum number of levels of wheel load and sled speed: two show a change, though not its form. Without them a variable of the contact
/// that goes with load or speed would take the credit.
const LEVELS: usize = 2;
/// Speeds that differ by less than this share are one level `[1]`: the accuracy of rigs is some per cent.
const SPEED_TOLERANCE: f64 = 0.1;
/// Loads whose neighbours differ by less than this share are one level `[1]`: measured loads scatter.
const LOAD_TOLERANCE: f64 = 0.15;
/// Slips that differ by less than this share of their range, or by less than 0.01, are one level `[1]`.
const SLIP_TOLERANCE: f64 = 0.02;
/// Lower end of the range of a speed or displacement that varies along the contact, as a share of its maximum `[1]`.
const REACH: f64 = 1.0 / 30.0;
/// Smallest speed `[m/s]` and displacement `[m]` of a range.
const MIN_LENGTH: f64 = 1e-5;
/// Sinkage over the radius of the wheel, where none is measured `[1]`.
const USUAL_SINKAGE: f64 = 0.1;

/// The variable that a law depends on.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) enum DependsOn {
    /// Sinkage of a node.
    Z,
    /// Speed into the soil.
    Vn,
    /// Slip speed.
    Vt,
    /// Shear displacement.
    J,
    /// Position in the contact.
    Position,
    /// Slip.
    Slip,
    /// Sled speed.
    SledSpeed,
    /// Wheel load.
    WheelLoad,
    /// Sinkage of the wheel; for channels.
    Sinkage,
}

impl DependsOn {
    /// The variables on which a factor on a stress may depend.
    pub(crate) const OF_STRESSES: [DependsOn; 8] = [
        DependsOn::Z,
        DependsOn::Vn,
        DependsOn::Vt,
        DependsOn::J,
        DependsOn::Position,
        DependsOn::Slip,
        DependsOn::SledSpeed,
        DependsOn::WheelLoad,
    ];

    /// The variables on which an addition to a channel may depend.
    pub(crate) const OF_CHANNELS: [DependsOn; 4] = [
        DependsOn::Slip,
        DependsOn::SledSpeed,
        DependsOn::WheelLoad,
        DependsOn::Sinkage,
    ];

    /// Returns the variable of formulas.
    pub(crate) fn variable(self) -> Variable {
        match self {
            DependsOn::Z => Variable::Z,
            DependsOn::Vn => Variable::Vn,
            DependsOn::Vt => Variable::Vt,
            DependsOn::J => Variable::J,
            DependsOn::Position => Variable::Position,
            DependsOn::Slip => Variable::Slip,
            DependsOn::SledSpeed => Variable::SledSpeed,
            DependsOn::WheelLoad => Variable::WheelLoad,
            DependsOn::Sinkage => Variable::Sinkage,
        }
    }

    /// Returns the name in formulas and results.
    pub(crate) fn name(self) -> &'static str {
        self.variable().name()
    }

    /// Returns the name in sentences, without an article.
    pub(crate) fn words(self) -> &'static str {
        match self {
            DependsOn::Z => "depth",
            DependsOn::Vn => "speed into the soil",
            DependsOn::Vt => "slip speed",
            DependsOn::J => "shear displacement",
            DependsOn::Position => "place in the contact",
            DependsOn::Slip => "slip",
            DependsOn::SledSpeed => "sled speed",
            DependsOn::WheelLoad => "wheel load",
            DependsOn::Sinkage => "wheel sinkage",
        }
    }

    /// Returns whether its range is logarithmic.
    fn is_logarithmic(self) -> bool {
        matches!(
            self,
            DependsOn::SledSpeed | DependsOn::Vt | DependsOn::Vn | DependsOn::J
        )
    }
}

/// The range of a variable in an experiment, in its SI unit, rounded to four digits.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct VariableRange {
    /// Lower end; positive if logarithmic.
    pub(crate) lowest: f64,
    /// Upper end.
    pub(crate) highest: f64,
    /// Whether its points are equidistant in the logarithm.
    pub(crate) is_logarithmic: bool,
}

impl VariableRange {
    /// Makes the range of a variable; `None` if it is empty.
    fn new(variable: DependsOn, lowest: f64, highest: f64) -> Option<VariableRange> {
        let range = VariableRange {
            lowest: rounded(lowest, 4),
            highest: rounded(highest, 4),
            is_logarithmic: variable.is_logarithmic(),
        };
        let is_wide = range.highest > range.lowest && range.highest.is_finite();
        (is_wide && (range.lowest > 0.0 || !range.is_logarithmic)).then_some(range)
    }

    /// Returns points from the lower to the upper end, 2 or more.
    pub(crate) fn points(&self, count: usize) -> Vec<f64> {
        let share = |i: usize| i as f64 / (count - 1) as f64;
        let between = |share: f64| match self.is_logarithmic {
            true => self.lowest * libm::pow(self.highest / self.lowest, share),
            false => self.lowest + (self.highest - self.lowest) * share,
        };
        (0..count).map(|i| between(share(i))).collect()
    }

    /// Returns the knots of a curve.
    pub(crate) fn knots(&self) -> Vec<f64> {
        self.points(KNOTS)
    }

    /// Returns the greatest magnitude.
    pub(crate) fn greatest(&self) -> f64 {
        self.highest.max(-self.lowest)
    }
}

/// Rounds a number to significant digits, as in files.
pub(super) fn rounded(x: f64, digits: usize) -> f64 {
    let decimals = digits - 1;
    format!("{x:.decimals$e}").parse().unwrap_or(x)
}

/// Returns the variables along which the fitted runs can show a dependence, with their ranges.
///
/// Slip needs three designed levels, sled speed and wheel load two. The sled speed needs them of sled and rim: where a rig keeps one of
/// these speeds and sets the slip by the other, slip and speed are confounded. Variables within the contact are always used.
/// Checked by `tests::levels_decide_what_can_be_used`.
pub(crate) fn ranges(experiment: &Experiment) -> BTreeMap<DependsOn, VariableRange> {
    let runs: Vec<&TestRun> = experiment
        .runs
        .iter()
        .filter(|r| r.usage == RunUse::Fit)
        .collect();
    let all = |value: fn(&TestRun) -> f64| -> Vec<f64> { runs.iter().map(|&run| value(run)).collect() };
    let radius = |run: &TestRun| experiment.wheels[&run.wheel].radius_m;
    let sinkages: Vec<f64> = measured(&runs, Channel::Sinkage).collect();
    let deepest = match greatest(sinkages.iter().copied()) {
        deepest if deepest > 0.0 => deepest,
        _ => USUAL_SINKAGE * greatest(runs.iter().map(|run| radius(run))),
    };
    // From the axle to the front entry of the deepest contact.
    let angle = |run: &TestRun| libm::acos((1.0 - deepest / radius(run)).max(-1.0));
    let rim = |run: &TestRun| rim_speed_m_s(run.slip, run.sled_speed_m_s);
    let slide = |run: &TestRun| (rim(run) - run.sled_speed_m_s).abs();
    let slowest = least(runs.iter().map(|run| slide(run)));
    let fastest = greatest(runs.iter().map(|run| slide(run)));
    let turning = || runs.iter().filter(|run| rim(run) > 0.0);
    let into_soil = greatest(turning().map(|run| rim(run) * libm::sin(angle(run).min(FRAC_PI_2))));
    let slid = greatest(turning().map(|run| slide(run) / rim(run) * radius(run) * angle(run)));
    let from_reach = |max: f64| ((REACH * max).max(MIN_LENGTH), max.max(MIN_LENGTH / REACH));
    let of_designed = |variable: DependsOn| -> Option<(f64, f64)> {
        let (values, levels, needed) = match variable {
            DependsOn::Slip => (all(|r| r.slip), slip_levels(all(|r| r.slip)), SLIP_LEVELS),
            DependsOn::WheelLoad => (
                all(|r| r.wheel_load_n),
                load_levels(all(|r| r.wheel_load_n)),
                LEVELS,
            ),
            _ => {
                let sled = all(|r| r.sled_speed_m_s);
                let rims = turning().map(|run| rim(run)).collect();
                (sled.clone(), speed_levels(sled).min(speed_levels(rims)), LEVELS)
            }
        };
        (levels >= needed).then(|| (least(values.iter().copied()), greatest(values.into_iter())))
    };
    let ends = |variable: DependsOn| match variable {
        DependsOn::Z => Some((0.0, 1.2 * deepest)),
        DependsOn::Vn => Some(from_reach(into_soil)),
        DependsOn::Vt => {
            let lowest = (0.3 * slowest).max(MIN_LENGTH);
            Some((lowest, (1.5 * fastest).max(lowest / REACH)))
        }
        DependsOn::J => Some(from_reach(slid)),
        DependsOn::Position => Some((0.0, 1.0)),
        DependsOn::Slip | DependsOn::SledSpeed | DependsOn::WheelLoad => of_designed(variable),
        DependsOn::Sinkage => Some((
            least(sinkages.iter().copied()),
            greatest(sinkages.iter().copied()),
        )),
    };
    let variables = DependsOn::OF_STRESSES.into_iter().chain([DependsOn::Sinkage]);
    variables
        .filter(|_| !runs.is_empty())
        .filter_map(|variable| {
            let (lowest, highest) = ends(variable)?;
            Some((variable, VariableRange::new(variable, lowest, highest)?))
        })
        .collect()
}

/// Returns the measurements of a channel.
pub(super) fn measured(runs: &[&TestRun], channel: Channel) -> impl Iterator<Item = f64> {
    runs.iter().filter_map(move |run| run.measured[channel.index()])
}

fn least(values: impl Iterator<Item = f64>) -> f64 {
    values.fold(f64::INFINITY, f64::min)
}

fn greatest(values: impl Iterator<Item = f64>) -> f64 {
    values.fold(f64::NEG_INFINITY, f64::max)
}

fn slip_levels(slips: Vec<f64>) -> usize {
    let range = greatest(slips.iter().copied()) - least(slips.iter().copied());
    let apart = (SLIP_TOLERANCE * range).max(0.01);
    levels(slips, |first, _, slip| slip - first > apart)
}

fn speed_levels(speeds: Vec<f64>) -> usize {
    levels(speeds, |first, _, speed| speed > first * (1.0 + SPEED_TOLERANCE))
}

/// Counts levels of loads: a chain of neighbouring loads, however long it is, counts as scatter around one or two designed loads.
fn load_levels(loads: Vec<f64>) -> usize {
    levels(loads, |_, before, load| load > before * (1.0 + LOAD_TOLERANCE))
}

/// Counts levels. `is_next` decides, from the first and the last value of a level, whether the next value begins another.
fn levels(mut values: Vec<f64>, is_next: impl Fn(f64, f64, f64) -> bool) -> usize {
    values.sort_by(f64::total_cmp);
    let mut values = values.into_iter();
    let Some(mut first) = values.next() else {
        return 0;
    };
    let (mut before, mut count) = (first, 1);
    for value in values {
        if is_next(first, before, value) {
            (first, count) = (value, count + 1);
        }
        before = value;
    }
    count
}

#[cfg(test)]
mod tests {
    use std::path::Path;

    use super::*;

    /// The ranges of an experiment of the repository.
    fn of(folder: &str) -> BTreeMap<DependsOn, VariableRange> {
        let file = Path::new("../..").join(folder).join("experiment.toml");
        let files = Experiment::read_files(&file).unwrap();
        ranges(&Experiment::parse("experiment.toml", &files).unwrap())
    }

    #[test]
    fn levels_decide_what_can_be_used() {
        use DependsOn::{J, Position, Sinkage, SledSpeed, Slip, Vn, Vt, WheelLoad, Z};
        // four slips, two loads, three speeds of the rim
        let designed: Vec<DependsOn> = of("tests/data/shear-mobilisation").into_keys().collect();
        assert_eq!(
            designed,
            [Z, Vn, Vt, J, Position, Slip, SledSpeed, WheelLoad, Sinkage]
        );
        // five slips by five speeds of the rim, one speed of the sled, one load that scatters by 13 %
        let sand: Vec<DependsOn> = of("examples/cmu-sand").into_keys().collect();
        assert_eq!(sand, [Z, Vn, Vt, J, Position, Slip, Sinkage]);
        assert!(!sand.contains(&WheelLoad));
    }

    #[test]
    fn neighbours_within_tolerance_are_one_level() {
        assert_eq!(slip_levels(vec![0.2, 0.201, 0.6, 0.603, -0.2]), 3);
        assert!(slip_levels((0..100).map(|i| f64::from(i) / 100.0).collect()) >= 33);
        assert_eq!(speed_levels(vec![0.01, 0.0101, 0.0103]), 1);
        assert_eq!(speed_levels(vec![0.003, 0.005, 0.1]), 3);
        assert_eq!(load_levels(vec![50.0, 60.0, 68.0, 102.0]), 3);
        assert_eq!(load_levels(vec![50.0, 60.0, 71.0, 102.0]), 4);
        assert_eq!(load_levels(vec![18.0, 20.0, 22.0, 24.0, 27.0]), 1);
        assert_eq!(levels(Vec::new(), |_, _, _| true), 0);
    }

    #[test]
    fn ranges_cover_the_fitted_runs_alone() {
        let ranges = of("tests/data/shear-mobilisation");
        let slip = ranges[&DependsOn::Slip];
        // held out: slips up to 0.7, loads up to 150 N
        assert_eq!(
            (slip.lowest, slip.highest, slip.is_logarithmic),
            (0.05, 0.6, false)
        );
        let speed = ranges[&DependsOn::SledSpeed];
        assert_eq!(
            (speed.lowest, speed.highest, speed.is_logarithmic),
            (0.004, 0.076, true)
        );
        // |rim - sled| = 0.05 * 10 mm/s at least, 0.6 * 80 mm/s at most
        let slide = ranges[&DependsOn::Vt];
        assert_eq!((slide.lowest, slide.highest), (0.00015, 0.072));
        let knots = speed.knots();
        assert!((knots[2] - f64::sqrt(0.004 * 0.076)).abs() < 1e-12, "{knots:?}");
        assert!((knots[4] - 0.076).abs() < 1e-12);
    }
}
