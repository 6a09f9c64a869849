//! The holdout measurements of an experiment, interpolated from the fitted ones.

use std::collections::{BTreeMap, BTreeSet};

use shared::channel::Channel;
use shared::experiment::{Experiment, RunUse};

use super::along_slip::along_slip;
use super::interpolated::{Interpolated, InterpolatedOver};
use super::surface::Surfaces;

/// The holdout measurements of an experiment, interpolated from the fitted ones.
#[derive(Debug, Clone, Default)]
pub struct Interpolations {
    values: BTreeMap<(usize, Channel), Interpolated>,
    missing: BTreeMap<(usize, Channel), String>,
}

impl Interpolations {
    /// Interpolates every holdout measurement of an experiment.
    pub fn new(experiment: &Experiment) -> Self {
        let mut values = BTreeMap::new();
        let mut missing = BTreeMap::new();
        let mut surfaces = Surfaces::new(experiment);
        let runs = experiment.runs.iter().enumerate();
        for (i, run) in runs.filter(|(_, run)| run.usage == RunUse::Holdout) {
            let is_measured = |channel: &Channel| run.measured[channel.index()].is_some();
            for channel in Channel::ALL.into_iter().filter(is_measured) {
                let in_slip = along_slip(experiment, run, channel).map(|value| Interpolated {
                    value,
                    over: InterpolatedOver::Slip,
                });
                match in_slip.map_or_else(|| surfaces.at(run, channel), Ok) {
                    Ok(found) => drop(values.insert((i, channel), found)),
                    Err(reason) => drop(missing.insert((i, channel), reason)),
                }
            }
        }
        Interpolations { values, missing }
    }

    /// Returns the interpolated value of a run and channel; `None` if it was fitted or cannot be interpolated.
    pub fn at(&self, run: usize, channel: Channel) -> Option<Interpolated> {
        self.values.get(&(run, channel)).copied()
    }

    /// Returns why the value of a run and channel cannot be interpolated; `None` if it can.
    pub fn missing_at(&self, run: usize, channel: Channel) -> Option<&str> {
        self.missing.get(&(run, channel)).map(String::as_str)
    }

    /// Returns the reasons why values are missing, each once.
    pub fn missing(&self) -> Vec<String> {
        let reasons: BTreeSet<&String> = self.missing.values().collect();
        reasons.into_iter().cloned().collect()
    }
}

#[cfg(test)]
mod tests {
    use shared::file::FileSet;

    use super::*;

    const TOML: &str = "runs = \"runs.csv\"\n[wheel.a]\nradius_m = 0.1\nwidth_m = 0.05\n[wheel.b]\nradius_m = 0.1\nwidth_m = 0.05\n[soil.sand]\n[noise]\nlateral_force_n = 1.0\n";

    /// Returns the experiment with the given rows of runs.
    fn parsed(rows: &str) -> Experiment {
        let titles = "run,wheel,soil,slip,wheel_load_n,sled_speed_m_s,slip_angle_deg,lateral_force_n,use";
        let files = FileSet {
            toml: TOML.into(),
            files: [("runs.csv".into(), format!("{titles}\n{rows}"))].into(),
        };
        Experiment::parse("experiment.toml", &files).unwrap()
    }

    fn force(slip: f64, angle: f64) -> f64 {
        10.0 * (1.0 + slip) * libm::sin(angle / 60.0)
    }

    /// Returns an experiment with two fitted repeats at each of several slips and angles, and the given holdout runs.
    fn experiment(held_out: &[&str]) -> Experiment {
        let mut runs = String::new();
        for (i, slip) in [-0.3, 0.0, 0.3, 0.6].into_iter().enumerate() {
            for angle in [0.0, 15.0, 30.0, 45.0, 60.0] {
                for repeat in 0..2 {
                    let (load, force) = (
                        100.0 + f64::from(repeat),
                        force(slip, angle) + 0.2 * f64::from(repeat) - 0.1,
                    );
                    runs += &format!("r{i}-{angle}-{repeat},a,sand,{slip},{load},0.01,{angle},{force},fit\n");
                }
            }
        }
        for (i, row) in held_out.iter().enumerate() {
            runs += &format!("h{i},{row},holdout\n");
        }
        parsed(&runs)
    }

    #[test]
    fn an_angle_and_a_slip_that_were_not_fitted_are_interpolated() {
        let found = Interpolations::new(&experiment(&[
            "a,sand,0.15,100,0.01,22,1",
            "a,sand,0.3,100,0.01,75,1",
            "a,sand,0.2,100,0.01,30,1",
        ]));
        let at = |run: usize| found.at(40 + run, Channel::LateralForce).unwrap();
        for (run, slip, angle, over, within) in [
            (0, 0.15, 22.0, InterpolatedOver::Conditions, 0.15),
            (1, 0.3, 75.0, InterpolatedOver::Extrapolation, 2.0),
            (2, 0.2, 30.0, InterpolatedOver::Slip, 0.2),
        ] {
            let interpolated = at(run);
            assert_eq!(interpolated.over, over, "run {run}");
            assert!(
                (interpolated.value - force(slip, angle)).abs() < within,
                "run {run}: {}",
                interpolated.value
            );
        }
        assert!(found.missing().is_empty());
        assert_eq!(
            found.at(0, Channel::LateralForce),
            None,
            "a fitted run is measured"
        );
    }

    #[test]
    fn between_two_levels_it_is_a_line_however_the_load_scatters() {
        let mut runs = String::new();
        let force = |slip: f64, angle: f64| 10.0 * (1.0 + slip * slip) * angle / 60.0;
        for (i, slip) in [-0.7, -0.2, 0.0, 0.5, 0.9].into_iter().enumerate() {
            for (k, angle) in [0.0, 60.0].into_iter().enumerate() {
                // The load is lower at the larger angle, and all loads scatter within a fifth without a gap.
                let load = 25.0 - 1.1 * (i + 2 * k) as f64;
                let force = force(slip, angle);
                runs += &format!("r{i}-{k},a,sand,{slip},{load},0.01,{angle},{force},fit\n");
                runs += &format!("h{i}-{k},a,sand,{slip},{load},0.01,30,1,holdout\n");
            }
        }
        let experiment = parsed(&runs);
        let found = Interpolations::new(&experiment);
        for (i, run) in experiment
            .runs
            .iter()
            .enumerate()
            .filter(|(_, run)| run.usage == RunUse::Holdout)
        {
            let interpolated = found.at(i, Channel::LateralForce).unwrap();
            assert_eq!(interpolated.over, InterpolatedOver::Conditions);
            assert!(
                (interpolated.value - force(run.slip, 30.0)).abs() < 0.5,
                "{}: {}",
                run.slip,
                interpolated.value
            );
        }
    }

    #[test]
    fn loads_from_half_to_twice_are_a_condition_though_no_gap_parts_them() {
        let mut runs = String::new();
        for (i, load) in (0..12).map(|i| (i, 60.0 + 6.0 * f64::from(i))) {
            let (slip, angle) = (0.1 * f64::from(i % 3), 15.0 * f64::from(i % 2));
            runs += &format!("r{i},a,sand,{slip},{load},0.01,{angle},{},fit\n", 0.1 * load);
        }
        runs += "h,a,sand,0.1,93,0.01,8,1,holdout\n";
        let experiment = parsed(&runs);
        let interpolated = Interpolations::new(&experiment).at(12, Channel::LateralForce);
        assert!(
            (interpolated.unwrap().value - 9.3).abs() < 0.1,
            "{interpolated:?}"
        );
    }

    #[test]
    fn what_cannot_be_interpolated_says_why() {
        let found = Interpolations::new(&experiment(&[
            "a,sand,0.15,200,0.01,22,1",
            "b,sand,0.15,100,0.01,22,1",
            "a,sand,0.15,100,0.02,22,1",
        ]));
        assert_eq!(
            found.missing(),
            [
                "wheel a on soil sand was fitted at one load alone",
                "wheel a on soil sand was fitted at one sled speed alone",
                "wheel b on soil sand has no fitted lateral force",
            ]
        );
        let mut scattered = experiment(&["a,sand,0.15,200,0.01,22,1"]);
        let fitted = scattered.runs.iter_mut().filter(|run| run.usage == RunUse::Fit);
        for (i, run) in fitted.enumerate() {
            run.wheel_load_n = 100.0 + i as f64;
        }
        assert_eq!(
            Interpolations::new(&scattered).missing(),
            ["wheel a on soil sand was fitted at loads of 100 to 139 N alone"]
        );
        let mut few = experiment(&["a,sand,0.15,100,0.01,22,1"]);
        few.runs.retain(|run| {
            run.usage == RunUse::Holdout
                || (run.name.ends_with('0')
                    && run.slip_angle_deg <= 15.0
                    && run.slip <= 0.0
                    && (run.slip < 0.0 || run.slip_angle_deg > 1.0))
        });
        assert_eq!(
            Interpolations::new(&few).missing(),
            [
                "wheel a on soil sand has 3 fitted conditions of lateral force, and a Gaussian process over slip and slip angle needs 4"
            ]
        );
    }
}
