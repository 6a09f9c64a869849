//! The slip at which a wheel climbs a slope: where its pull balances the weight along the ground.

use job::PlannedRun;

/// Runs of a plan that differ in their slip alone, by ascending slip.
#[derive(Debug, Clone, PartialEq)]
pub struct SlipCurve {
    /// Positions of the planned runs.
    pub runs: Vec<usize>,
}

/// Returns the number of the curve of each planned run: runs that differ in slip alone are of one curve.
pub fn curve_of_runs(runs: &[PlannedRun]) -> Vec<usize> {
    let mut first: Vec<&PlannedRun> = Vec::new();
    let mut numbers = Vec::with_capacity(runs.len());
    for planned in runs {
        let known = first.iter().position(|other| {
            let (a, b) = (&other.run, &planned.run);
            let numbers = |x: &PlannedRun| {
                [
                    x.weight_n,
                    x.run.sled_speed_m_s,
                    x.run.slip_angle_deg,
                    x.gravity_m_s2,
                    x.slope_deg,
                ]
                .map(f64::to_bits)
            };
            a.wheel == b.wheel && a.pass == b.pass && numbers(other) == numbers(planned)
        });
        numbers.push(known.unwrap_or(first.len()));
        if known.is_none() {
            first.push(planned);
        }
    }
    numbers
}

/// Returns the curves of a plan that have at least three slips.
pub fn slip_curves(runs: &[PlannedRun]) -> Vec<SlipCurve> {
    let numbers = curve_of_runs(runs);
    let count = numbers.iter().max().map_or(0, |last| last + 1);
    let curves = (0..count).map(|number| {
        let mut members: Vec<usize> = (0..runs.len()).filter(|&run| numbers[run] == number).collect();
        members.sort_by(|&a, &b| runs[a].run.slip.total_cmp(&runs[b].run.slip));
        members.dedup_by(|a, b| runs[*a].run.slip.total_cmp(&runs[*b].run.slip).is_eq());
        SlipCurve { runs: members }
    });
    curves.filter(|curve| curve.runs.len() >= 3).collect()
}

/// A wheel on a slope: the slip at which it climbs, with its channels there.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Climb {
    /// The least slip at which the pull balances the weight along the slope; the largest of the curve if none does.
    pub slip: f64,
    /// The channels at that slip.
    pub channels: [f64; 4],
    /// Whether no slip of the curve balances the slope.
    pub is_stuck: bool,
}

/// Finds where the pull of a curve first reaches the weight along the slope, linear between its slips.
///
/// At the least slip of the curve a pull beyond the weight counts as balanced there: the wheel would go on with less slip.
/// `None` of a curve without points. Checked by `tests::a_wheel_climbs_with_the_slip_at_which_its_pull_balances_the_slope`.
///
/// # Arguments
/// - `points`: slip and channels, by ascending slip. `along_n`: weight along the slope `[N]`.
pub fn climb(points: &[(f64, [f64; 4])], along_n: f64) -> Option<Climb> {
    let net = |point: &(f64, [f64; 4])| point.1[0] - along_n;
    let first = points.first()?;
    let at = |&(slip, channels): &(f64, [f64; 4]), is_stuck| Climb {
        slip,
        channels,
        is_stuck,
    };
    if net(first) >= 0.0 {
        return Some(at(first, false));
    }
    let reached = points.windows(2).find(|pair| net(&pair[1]) >= 0.0);
    let Some([below, above]) = reached else {
        return points.last().map(|last| at(last, true));
    };
    let share = net(below) / (net(below) - net(above));
    let between = |a: f64, b: f64| a + share * (b - a);
    Some(Climb {
        slip: between(below.0, above.0),
        channels: std::array::from_fn(|c| between(below.1[c], above.1[c])),
        is_stuck: false,
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::quantity_value::tests::planned;

    #[test]
    fn a_wheel_climbs_with_the_slip_at_which_its_pull_balances_the_slope() {
        let points = [
            (0.0, [-5.0, 0.0, 0.001, 0.0]),
            (0.2, [15.0, 2.0, 0.003, 0.0]),
            (0.4, [25.0, 4.0, 0.005, 0.0]),
        ];
        let found = climb(&points, 20.0).unwrap();
        assert!((found.slip - 0.3).abs() < 1e-12 && !found.is_stuck);
        assert!((found.channels[1] - 3.0).abs() < 1e-12 && (found.channels[0] - 20.0).abs() < 1e-12);
        let steep = climb(&points, 30.0).unwrap();
        assert!(steep.is_stuck && (steep.slip - 0.4).abs() < 1e-12);
        let downhill = climb(&points, -10.0).unwrap();
        assert!(!downhill.is_stuck && downhill.slip.abs() < 1e-12);
        assert_eq!(climb(&[], 1.0), None);
    }

    #[test]
    fn runs_that_differ_in_slip_alone_are_a_curve() {
        let runs = [
            planned(0.4, 0.0),
            planned(0.2, 0.0),
            planned(0.3, 0.0),
            planned(0.2, 5.0),
            planned(0.3, 5.0),
        ];
        assert_eq!(curve_of_runs(&runs), [0, 0, 0, 1, 1]);
        assert_eq!(slip_curves(&runs), [SlipCurve { runs: vec![1, 2, 0] }]);
    }
}
