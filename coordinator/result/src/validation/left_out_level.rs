//! The levels of a factor in an experiment, each with the runs to leave out.

use std::collections::BTreeMap;

use job::{Spec, levels_of};
use shared::experiment::TestRun;

use super::factor::Factor;

/// The fitted runs at one level of a factor.
#[derive(Debug, Clone, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct LeftOutLevel {
    /// The level: `slip -0.20`, `wheel smooth`.
    pub name: String,
    /// Smallest value \[1, N, m/s, deg\]; null for the factor wheel.
    pub from: Option<f64>,
    /// Largest value.
    pub to: Option<f64>,
    /// Runs of the level.
    pub runs: Vec<String>,
}

impl LeftOutLevel {
    /// Returns the levels of the fitted runs in ascending order, wheels by name. Values closer than 2 % of their range are one level, as
    /// in the cross-validation of a search.
    ///
    /// # Errors
    /// Returns a sentence if there are fewer than two levels.
    pub fn all(spec: &Spec, factor: Factor) -> Result<Vec<Self>, String> {
        let runs: Vec<&TestRun> = spec.fit_runs.iter().map(|&i| &spec.experiment.runs[i]).collect();
        let values: Option<Vec<f64>> = runs.iter().map(|run| factor.value(run)).collect();
        let levels: Vec<Self> = match values {
            None => by_wheel(&runs),
            Some(values) => by_value(factor, &runs, &values),
        };
        match levels.as_slice() {
            [] => Err("there is no fitted run".into()),
            [one] => Err(format!(
                "all {} fitted runs are at {}: nothing is left to predict it from",
                runs.len(),
                one.name
            )),
            _ => Ok(levels),
        }
    }
}

fn by_wheel(runs: &[&TestRun]) -> Vec<LeftOutLevel> {
    let mut wheels: BTreeMap<&str, Vec<String>> = BTreeMap::new();
    for run in runs {
        wheels.entry(&run.wheel).or_default().push(run.name.clone());
    }
    let level = |(wheel, runs): (&str, Vec<String>)| LeftOutLevel {
        name: format!("wheel {wheel}"),
        from: None,
        to: None,
        runs,
    };
    wheels.into_iter().map(level).collect()
}

fn by_value(factor: Factor, runs: &[&TestRun], values: &[f64]) -> Vec<LeftOutLevel> {
    let mut levels: BTreeMap<usize, Vec<(f64, String)>> = BTreeMap::new();
    for ((level, &value), run) in levels_of(values).into_iter().zip(values).zip(runs) {
        levels.entry(level).or_default().push((value, run.name.clone()));
    }
    let level = |members: Vec<(f64, String)>| {
        let from = members
            .iter()
            .map(|(value, _)| *value)
            .fold(f64::INFINITY, f64::min);
        let to = members
            .iter()
            .map(|(value, _)| *value)
            .fold(f64::NEG_INFINITY, f64::max);
        LeftOutLevel {
            name: factor.words(from, to),
            from: Some(from),
            to: Some(to),
            runs: members.into_iter().map(|(_, run)| run).collect(),
        }
    };
    levels.into_values().map(level).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::fixture;

    #[test]
    fn the_levels_are_those_of_the_fitted_runs() {
        let spec = fixture::calibration().spec;
        let slips = LeftOutLevel::all(&spec, Factor::Slip).unwrap();
        let names: Vec<(&str, usize)> = slips.iter().map(|l| (l.name.as_str(), l.runs.len())).collect();
        assert_eq!(names, [("slip -0.20", 1), ("slip 0.20", 1), ("slip 0.50", 1)]);
        assert_eq!((slips[0].from, slips[2].to), (Some(-0.2), Some(0.5)));
        assert_eq!(slips[2].runs, ["d"]);
        for (factor, level) in [
            (Factor::Wheel, "wheel a"),
            (Factor::Load, "load 25.0 N"),
            (Factor::Angle, "slip angle 0.0 deg"),
        ] {
            let reason = format!("all 3 fitted runs are at {level}: nothing is left to predict it from");
            assert_eq!(LeftOutLevel::all(&spec, factor).unwrap_err(), reason);
        }
        assert_eq!(LeftOutLevel::all(&spec, Factor::Speed).unwrap().len(), 3);
    }
}
