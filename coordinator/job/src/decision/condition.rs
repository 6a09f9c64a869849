//! A condition that was not measured, as users write it, and the run that it stands for.

use std::collections::BTreeMap;

use schemars::JsonSchema;
use serde::Deserialize;
use shared::experiment::{Experiment, RunUse, TestRun, WheelGeometry};
use shared::file::unknown_word;

/// A condition as written: a row of a plan, or the condition of an option. What is not stated follows from the fitted runs.
#[derive(Debug, Clone, Default, PartialEq, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct PlannedCondition {
    /// Name of the run.
    pub run: Option<String>,
    /// Name of the wheel; may be omitted if the fitted runs have only one.
    pub wheel: Option<String>,
    /// Slip.
    #[schemars(range(min = -1), extend("exclusiveMaximum" = 1))]
    pub slip: Option<f64>,
    /// Load of the wheel on level ground `[N]`; by default, the median of the fitted runs.
    #[schemars(extend("exclusiveMinimum" = 0))]
    pub wheel_load_n: Option<f64>,
    /// Speed of travel `[m/s]`; by default, the median of the fitted runs.
    #[schemars(extend("exclusiveMinimum" = 0))]
    pub sled_speed_m_s: Option<f64>,
    /// From wheel heading to travel `[deg]`; 0 if it is not stated.
    #[schemars(range(min = -90, max = 90))]
    pub slip_angle_deg: Option<f64>,
    /// Number of the pass; 1 if it is not stated.
    #[schemars(range(min = 1))]
    pub pass: Option<u32>,
    /// Acceleration of gravity `[m/s^2]`; by default, that of the rig.
    #[schemars(extend("exclusiveMinimum" = 0))]
    pub gravity_m_s2: Option<f64>,
    /// Inclination of the ground along the travel, positive uphill `[deg]`; 0 if it is not stated.
    #[schemars(range(min = -60, max = 60))]
    pub slope_deg: Option<f64>,
}

/// A run that was not measured.
#[derive(Debug, Clone, PartialEq)]
pub struct PlannedRun {
    /// The run, held out and without measurements. Its load is the one normal to the ground.
    pub run: TestRun,
    /// Load of the wheel on level ground `[N]`.
    pub weight_n: f64,
    /// Acceleration of gravity `[m/s^2]`.
    pub gravity_m_s2: f64,
    /// Inclination of the ground along the travel, positive uphill `[deg]`.
    pub slope_deg: f64,
}

impl PlannedRun {
    /// Returns the same run with another slip.
    pub fn at_slip(&self, slip: f64) -> PlannedRun {
        let mut planned = self.clone();
        planned.run.slip = slip;
        planned
    }
}

/// What a plan may leave out, from the fitted runs of an experiment.
#[derive(Debug)]
pub struct ConditionDefaults<'a> {
    experiment: &'a Experiment,
    wheels: &'a BTreeMap<String, WheelGeometry>,
    fitted: Vec<&'a TestRun>,
}

/// A number of a condition: its name, value, unit and bounds.
fn within(
    name: &str,
    value: f64,
    unit: &str,
    is_valid: impl Fn(f64) -> bool,
    bound: &str,
) -> Result<(), String> {
    match value.is_finite() && is_valid(value) {
        true => Ok(()),
        false => Err(format!("{name} {value}{unit} must {bound}{unit}")),
    }
}

impl<'a> ConditionDefaults<'a> {
    /// Takes the defaults from the fitted runs.
    ///
    /// # Arguments
    /// - `wheels`: the wheels that a condition may name.
    pub fn new(experiment: &'a Experiment, wheels: &'a BTreeMap<String, WheelGeometry>) -> Self {
        let fitted = experiment.runs.iter().filter(|run| run.usage == RunUse::Fit);
        ConditionDefaults {
            experiment,
            wheels,
            fitted: fitted.collect(),
        }
    }

    /// Returns the median of a condition over the fitted runs; of an even number, the lower one, which a run had.
    fn median(&self, value: impl Fn(&TestRun) -> f64) -> Option<f64> {
        let mut values: Vec<f64> = self.fitted.iter().map(|run| value(run)).collect();
        values.sort_by(f64::total_cmp);
        values.get(values.len().saturating_sub(1) / 2).copied()
    }

    fn wheel(&self, stated: Option<&String>) -> Result<String, String> {
        match stated {
            Some(name) if self.wheels.contains_key(name) => Ok(name.clone()),
            Some(name) => Err(unknown_word(
                "wheel",
                name,
                self.wheels.keys().map(String::as_str),
            )),
            None => {
                let used = self.experiment.wheel_names();
                match used.iter().next() {
                    Some(only) if used.len() == 1 => Ok((*only).to_owned()),
                    _ => {
                        let names: Vec<&str> = used.into_iter().collect();
                        Err(format!(
                            "wheel is not stated; the fitted runs have {}",
                            names.join(", ")
                        ))
                    }
                }
            }
        }
    }

    /// Returns the run of a condition. A load on a slope presses with `wheel_load_n cos(slope)` on the ground.
    ///
    /// # Arguments
    /// - `name`: of the run if the condition has none. `slip`: where the condition states none.
    ///
    /// # Errors
    /// A sentence that names the quantity, its value, its unit and its bound.
    /// Checked by `tests::what_a_condition_leaves_out_follows_from_the_fitted_runs`.
    pub fn run(
        &self,
        stated: &PlannedCondition,
        name: &str,
        slip: Option<f64>,
    ) -> Result<PlannedRun, String> {
        let wheel = self.wheel(stated.wheel.as_ref())?;
        let none = || "the experiment has no fitted run".to_owned();
        let soil = &self.fitted.first().ok_or_else(none)?.soil;
        let slip = stated.slip.or(slip).ok_or("slip is not stated")?;
        within("slip", slip, "", |x| (-1.0..1.0).contains(&x), "lie in [-1, 1)")?;
        let median_load = self.median(|run| run.wheel_load_n);
        let weight_n = stated.wheel_load_n.or(median_load).ok_or_else(none)?;
        within("wheel_load_n", weight_n, " N", |x| x > 0.0, "be > 0")?;
        let median_speed = self.median(|run| run.sled_speed_m_s);
        let sled_speed_m_s = stated.sled_speed_m_s.or(median_speed).ok_or_else(none)?;
        within("sled_speed_m_s", sled_speed_m_s, " m/s", |x| x > 0.0, "be > 0")?;
        let slip_angle_deg = stated.slip_angle_deg.unwrap_or(0.0);
        within(
            "slip_angle_deg",
            slip_angle_deg,
            " deg",
            |x| x.abs() <= 90.0,
            "lie in [-90, 90]",
        )?;
        let pass = stated.pass.unwrap_or(1);
        if pass < 1 {
            return Err("pass 0 must be a whole number >= 1".into());
        }
        let gravity_m_s2 = stated.gravity_m_s2.unwrap_or(self.experiment.rig.gravity_m_s2);
        within("gravity_m_s2", gravity_m_s2, " m/s^2", |x| x > 0.0, "be > 0")?;
        let slope_deg = stated.slope_deg.unwrap_or(0.0);
        within(
            "slope_deg",
            slope_deg,
            " deg",
            |x| x.abs() <= MAX_SLOPE_DEG,
            "lie in [-60, 60]",
        )?;
        let run = TestRun {
            name: stated.run.clone().unwrap_or_else(|| name.to_owned()),
            wheel,
            soil: soil.clone(),
            slip,
            wheel_load_n: weight_n * libm::cos(slope_deg.to_radians()),
            sled_speed_m_s,
            slip_angle_deg,
            pass,
            order: None,
            prepared: None,
            session: None,
            zero: None,
            operator: None,
            measured: [None; 4],
            history: None,
            sd: [None; 4],
            usage: RunUse::Holdout,
        };
        Ok(PlannedRun {
            run,
            weight_n,
            gravity_m_s2,
            slope_deg,
        })
    }
}

/// Steepest slope: sand slides long before.
const MAX_SLOPE_DEG: f64 = 60.0;

#[cfg(test)]
mod tests {
    use shared::file::FileSet;

    use super::*;

    fn experiment(runs: &str) -> Experiment {
        let toml = "runs = \"runs.csv\"\n[wheel.a]\nradius_m = 0.1\nwidth_m = 0.05\n[wheel.b]\nradius_m = 0.1\nwidth_m = 0.1\n[soil.s]\n[noise]\ndrawbar_pull_n = 1.0\n";
        let header = "run,wheel,soil,slip,wheel_load_n,sled_speed_m_s,drawbar_pull_n,use\n";
        let files = FileSet {
            toml: toml.into(),
            files: [("runs.csv".to_owned(), format!("{header}{runs}"))].into(),
        };
        Experiment::parse("experiment.toml", &files).unwrap()
    }

    #[test]
    fn what_a_condition_leaves_out_follows_from_the_fitted_runs() {
        let experiment =
            experiment("1,a,s,0.2,60,0.01,1,fit\n2,a,s,0.2,120,0.03,1,fit\n3,a,s,0.2,999,9,1,holdout\n");
        let defaults = ConditionDefaults::new(&experiment, &experiment.wheels);
        let stated = PlannedCondition {
            slip: Some(0.3),
            slope_deg: Some(60.0),
            ..Default::default()
        };
        let planned = defaults.run(&stated, "p1", None).unwrap();
        assert_eq!(
            (planned.run.name.as_str(), planned.run.wheel.as_str()),
            ("p1", "a")
        );
        assert!((planned.weight_n - 60.0).abs() < 1e-12 && (planned.run.wheel_load_n - 30.0).abs() < 1e-9);
        let refused = |stated: PlannedCondition| defaults.run(&stated, "p1", None).unwrap_err();
        assert_eq!(refused(PlannedCondition::default()), "slip is not stated");
        let steep = PlannedCondition {
            slope_deg: Some(61.0),
            ..stated.clone()
        };
        assert_eq!(refused(steep), "slope_deg 61 deg must lie in [-60, 60] deg");
        let unknown = PlannedCondition {
            wheel: Some("c".into()),
            ..stated
        };
        assert!(refused(unknown).contains("unknown wheel \"c\""));
    }

    #[test]
    fn one_of_several_wheels_must_be_named() {
        let experiment = experiment("1,a,s,0.2,60,0.01,1,fit\n2,b,s,0.2,120,0.03,1,fit\n");
        let defaults = ConditionDefaults::new(&experiment, &experiment.wheels);
        let refused = defaults.run(&PlannedCondition::default(), "p1", Some(0.1));
        assert_eq!(
            refused.unwrap_err(),
            "wheel is not stated; the fitted runs have a, b"
        );
    }
}
