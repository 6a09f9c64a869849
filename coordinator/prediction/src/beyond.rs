//! What lies outside the range of the fitted runs.

use job::PlannedRun;
use shared::experiment::{Experiment, RunUse, TestRun, rim_speed_m_s};

/// Relative distance from the end of a range that counts as inside it.
const CLOSE: f64 = 1e-6;

/// Returns a phrase for each condition of a planned run that lies outside the range of the fitted runs; empty for a run within it.
///
/// A speed is outside if neither that of travel nor that of the rim is in its range, because a rig holds one of them.
/// Checked by `tests::each_condition_outside_the_fitted_range_is_named`.
pub fn beyond(experiment: &Experiment, planned: &PlannedRun) -> Vec<String> {
    let fitted: Vec<&TestRun> = experiment
        .runs
        .iter()
        .filter(|run| run.usage == RunUse::Fit)
        .collect();
    let run = &planned.run;
    let outside = |value: &dyn Fn(&TestRun) -> f64| {
        let values = || fitted.iter().map(|run| value(run));
        let low = values().fold(f64::INFINITY, f64::min);
        let high = values().fold(f64::NEG_INFINITY, f64::max);
        let (here, close) = (value(run), CLOSE * low.abs().max(high.abs()));
        let is_outside = here < low - close || here > high + close;
        is_outside.then_some([low, high])
    };
    let mut phrases = Vec::new();
    let mut add = |name: &str, unit: &str, range: Option<[f64; 2]>| {
        let Some(ends) = range else { return };
        let [low, high] = ends.map(|x| result::number::significant(x, 3));
        phrases.push(match low == high {
            true => format!("{name} other than the fitted {low}{unit}"),
            false => format!("{name} outside the fitted {low} to {high}{unit}"),
        });
    };
    add("slip", "", outside(&|run| run.slip));
    add("load", " N", outside(&|run| run.wheel_load_n));
    let rim = outside(&|run| rim_speed_m_s(run.slip, run.sled_speed_m_s));
    add(
        "sled speed",
        " m/s",
        outside(&|run| run.sled_speed_m_s).filter(|_| rim.is_some()),
    );
    add("slip angle", " deg", outside(&|run| run.slip_angle_deg));
    add("pass", "", outside(&|run| f64::from(run.pass)));
    if !fitted.iter().any(|fitted| fitted.wheel == run.wheel) {
        phrases.push(format!("wheel {} without a fitted run", run.wheel));
    }
    let rig = experiment.rig.gravity_m_s2;
    if (planned.gravity_m_s2 - rig).abs() > CLOSE * rig {
        phrases.push(format!("gravity other than the fitted {rig} m/s^2"));
    }
    phrases
}

#[cfg(test)]
mod tests {
    use shared::file::FileSet;

    use super::*;
    use crate::quantity_value::tests::planned;

    #[test]
    fn each_condition_outside_the_fitted_range_is_named() {
        let toml = "runs = \"runs.csv\"\n[wheel.w]\nradius_m = 0.1\nwidth_m = 0.05\n[soil.s]\n[noise]\ndrawbar_pull_n = 1.0\n";
        let runs = "run,wheel,soil,slip,wheel_load_n,sled_speed_m_s,drawbar_pull_n,use\n1,w,s,0.1,60,0.02,1,fit\n2,w,s,0.5,120,0.02,1,fit\n3,w,s,0.9,999,0.02,1,holdout\n";
        let files = FileSet {
            toml: toml.into(),
            files: [("runs.csv".to_owned(), runs.to_owned())].into(),
        };
        let experiment = Experiment::parse("experiment.toml", &files).unwrap();
        assert_eq!(beyond(&experiment, &planned(0.5, 0.0)), Vec::<String>::new());
        let mut far = planned(0.6, 0.0);
        far.gravity_m_s2 = 1.62;
        far.run.wheel = "v".into();
        far.run.wheel_load_n = 130.0;
        assert_eq!(
            beyond(&experiment, &far),
            [
                "slip outside the fitted 0.100 to 0.500",
                "load outside the fitted 60.0 to 120 N",
                "wheel v without a fitted run",
                "gravity other than the fitted 9.81 m/s^2",
            ]
        );
    }
}
