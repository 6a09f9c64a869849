//! Holdout groups: whether the conditions of a holdout run are levels of the fitted runs, lie between them, or beyond.

use shared::experiment::TestRun;

use super::conditions::Axis;

/// The place of a holdout run among the conditions of the fitted runs. What a prediction rests on differs: a fitted neighbour, levels on both
/// sides, or the model alone.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, serde::Serialize, serde::Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum HoldoutGroup {
    /// Each condition of the run is a level of the fitted runs.
    InLevels,
    /// A condition lies between levels of the fitted runs, and none beyond them.
    BetweenLevels,
    /// A condition lies outside of the range of the fitted runs, or no fitted run has the wheel or the soil.
    Beyond,
    /// The recording of the run shows that it was not steady, so no steady model can be right or wrong about its averages.
    NotSteady,
}

impl HoldoutGroup {
    /// The groups in the order of tables.
    pub const ALL: [HoldoutGroup; 4] = [
        HoldoutGroup::InLevels,
        HoldoutGroup::BetweenLevels,
        HoldoutGroup::Beyond,
        HoldoutGroup::NotSteady,
    ];

    /// Returns the name in tables.
    pub fn words(self) -> &'static str {
        match self {
            HoldoutGroup::InLevels => "in levels",
            HoldoutGroup::BetweenLevels => "between levels",
            HoldoutGroup::Beyond => "beyond",
            HoldoutGroup::NotSteady => "not steady",
        }
    }
}

/// The conditions of the fitted runs, among which holdout runs have their places.
///
/// A level is a value that a fitted run has within the accuracy of a rig, as [`job::repeats`] states it: slip to 0.02, slip angle to 0.5
/// degrees, load to 15 %, speed to 5 %. So a load that the rig does not hold is in the level of the fitted load that it repeats. The speed is
/// that of sled or rim, whichever was set. Each condition counts by itself: a run at a fitted slip and a fitted angle is in levels although no
/// fitted run has both. Checked by `tests::a_condition_outside_of_the_fitted_ones_decides`.
pub(super) struct FittedConditions<'a> {
    axes: [Axis; 4],
    runs: Vec<&'a TestRun>,
}

impl<'a> FittedConditions<'a> {
    pub(super) fn new(runs: Vec<&'a TestRun>) -> Self {
        FittedConditions {
            axes: Axis::distinguishing(&runs),
            runs,
        }
    }

    /// Returns the group of a holdout run.
    pub(super) fn group(&self, run: &TestRun) -> HoldoutGroup {
        if run.history.as_ref().is_some_and(|history| !history.is_steady()) {
            return HoldoutGroup::NotSteady;
        }
        let is_fitted = |name: fn(&TestRun) -> &str| self.runs.iter().any(|other| name(other) == name(run));
        if !is_fitted(|run| &run.wheel) || !is_fitted(|run| &run.soil) {
            return HoldoutGroup::Beyond;
        }
        let of_axis = |axis: &Axis| {
            let is_level = self.runs.iter().any(|other| axis.is_same(other, run));
            self.place(is_level, |run| axis.value(run), run)
        };
        let is_pass = self.runs.iter().any(|other| other.pass == run.pass);
        let of_pass = self.place(is_pass, |run| f64::from(run.pass), run);
        self.axes.iter().map(of_axis).fold(of_pass, HoldoutGroup::max)
    }

    fn place(&self, is_level: bool, value: impl Fn(&TestRun) -> f64, run: &TestRun) -> HoldoutGroup {
        let is_below = |other: &&TestRun| value(other) < value(run);
        match (
            is_level,
            self.runs.iter().any(is_below),
            self.runs.iter().all(is_below),
        ) {
            (true, ..) => HoldoutGroup::InLevels,
            (false, true, false) => HoldoutGroup::BetweenLevels,
            (false, ..) => HoldoutGroup::Beyond,
        }
    }
}

#[cfg(test)]
mod tests {
    use shared::experiment::Experiment;
    use shared::file::FileSet;

    use super::*;
    use crate::fixture;

    #[test]
    fn a_condition_outside_of_the_fitted_ones_decides() {
        use HoldoutGroup::{BetweenLevels, Beyond, InLevels};
        let spec = fixture::calibration().spec;
        let run = |slip: f64, slip_angle_deg: f64, wheel_load_n: f64| TestRun {
            slip,
            slip_angle_deg,
            wheel_load_n,
            sled_speed_m_s: 0.01,
            ..spec.experiment.runs[0].clone()
        };
        let fitted = [
            run(0.0, 0.0, 24.0),
            run(0.5, 0.0, 21.0),
            run(0.2, 30.0, 26.5),
            run(0.9, 60.0, 60.0),
        ];
        let conditions = FittedConditions::new(fitted.iter().collect());
        let group = |run: TestRun| conditions.group(&run);
        // Slip 0.5 and 30 degrees are fitted, though not together; the load scatters.
        assert_eq!(group(run(0.51, 30.4, 19.0)), InLevels);
        assert_eq!(group(run(0.35, 30.0, 24.0)), BetweenLevels);
        assert_eq!(group(run(0.5, 45.0, 24.0)), BetweenLevels);
        assert_eq!(group(run(0.5, 30.0, 40.0)), BetweenLevels);
        assert_eq!(group(run(-0.1, 30.0, 24.0)), Beyond);
        assert_eq!(group(run(0.35, 90.0, 24.0)), Beyond);
        assert_eq!(group(run(0.5, 30.0, 14.0)), Beyond);
        let further = |change: &dyn Fn(&mut TestRun)| {
            let mut other = run(0.5, 30.0, 24.0);
            change(&mut other);
            group(other)
        };
        assert_eq!(further(&|_| ()), InLevels);
        assert_eq!(further(&|run| run.wheel = "another".into()), Beyond);
        assert_eq!(further(&|run| run.soil = "another".into()), Beyond);
        assert_eq!(further(&|run| run.sled_speed_m_s = 0.0103), InLevels);
        assert_eq!(further(&|run| run.sled_speed_m_s = 0.02), Beyond);
        assert_eq!(further(&|run| run.pass = 2), Beyond);
    }

    #[test]
    fn a_run_that_still_sinks_is_in_a_group_of_its_own() {
        let toml = "runs = \"runs.csv\"\n[wheel.w]\nradius_m = 0.1\nwidth_m = 0.05\n[soil.s]\n[noise]\nsinkage_m = 0.001\n\
                    [protocol]\nmeasured_transient_s = 25\nlowpass_hz = 0\n";
        let csv = "run,wheel,soil,slip,wheel_load_n,sled_speed_m_s,history\na,w,s,0.2,100,0.01,h.csv\nb,w,s,0.2,100,0.01,h.csv\n";
        let mut history = "run,t_s,sinkage_m\n".to_owned();
        for k in 1..=30 {
            history += &format!("a,{k},0.01\nb,{k},{}\n", 0.0002 * f64::from(k));
        }
        let files =
            [("runs.csv", csv), ("h.csv", &history)].map(|(name, text)| (name.to_owned(), text.to_owned()));
        let files = FileSet {
            toml: toml.to_owned(),
            files: files.into(),
        };
        let runs = Experiment::parse("experiment.toml", &files).unwrap().runs;
        let conditions = FittedConditions::new(vec![&runs[0]]);
        assert_eq!(conditions.group(&runs[0]), HoldoutGroup::InLevels);
        assert_eq!(conditions.group(&runs[1]), HoldoutGroup::NotSteady);
    }

    #[test]
    fn the_speed_is_the_one_that_was_set() {
        // The rim keeps 10 mm/s, so the sled is as slow as the slip makes it.
        let spec = fixture::calibration().spec;
        let run = |slip: f64| TestRun {
            slip,
            sled_speed_m_s: 0.01 * (1.0 - slip),
            ..spec.experiment.runs[0].clone()
        };
        let fitted = [run(0.1), run(0.3), run(0.6)];
        let conditions = FittedConditions::new(fitted.iter().collect());
        let faster = TestRun {
            sled_speed_m_s: 0.02 * (1.0 - 0.3),
            ..run(0.3)
        };
        assert_eq!(conditions.group(&run(0.3)), HoldoutGroup::InLevels);
        assert_eq!(conditions.group(&run(0.45)), HoldoutGroup::BetweenLevels);
        assert_eq!(conditions.group(&faster), HoldoutGroup::Beyond);
    }
}
