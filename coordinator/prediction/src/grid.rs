//! Predictions over a grid of conditions: what the page and a report interpolate while sliders move.

use std::collections::BTreeMap;

use job::{ConditionDefaults, PlannedCondition, PlannedRun};
use result::{Refusal, Study};
use serde::{Deserialize, Serialize};
use shared::experiment::{Experiment, RunUse, TestRun, rim_speed_m_s};
use utoipa::ToSchema;

use crate::ensemble::{Answers, Ensemble, Question};
use crate::error::PredictionError;
use crate::prediction::{PredictedQuantity, PredictedRun, predict};

/// Draws of each model: enough for a curve that follows sliders.
const DRAWS: usize = 40;
/// Number of slips, loads and speeds.
const SLIPS: usize = 11;
const LEVELS: usize = 3;
/// The largest slip; at 1, a wheel turns on the spot.
const MAX_SLIP: f64 = 0.95;
/// How far the grid reaches beyond the fitted slips, and beyond the fitted loads and speeds as a ratio.
const BEYOND_SLIP: f64 = 0.2;
const BEYOND: f64 = 1.3;
/// Speeds that differ by a smaller share are one level.
const ONE_LEVEL: f64 = 0.02;
/// Significant digits of the values.
const DIGITS: usize = 6;

/// Predictions of a calibration over a grid of slips, loads and speeds, on level ground and in straight travel.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, ToSchema)]
pub struct PredictionGrid {
    /// Id of the calibration.
    pub calibration: i64,
    /// Number of draws of each model.
    pub draws: usize,
    /// Whether the rig held the speed of the rim, so that the speeds are those of the rim; else those of travel.
    pub holds_rim: bool,
    /// What the fitted runs span.
    pub fitted: ConditionRanges,
    /// What the grid spans.
    pub reach: ConditionRanges,
    /// Slips, closer where curves bend.
    pub slips: Vec<f64>,
    /// Loads `[N]`.
    pub wheel_loads_n: Vec<f64>,
    /// Speeds of the rim or of travel `[m/s]`.
    pub speeds_m_s: Vec<f64>,
    /// The predicted quantities.
    pub quantities: Vec<GridQuantity>,
    /// A grid for each wheel of the fitted runs; empty for a model that rolls over terrain or is not ours, whose grid would take hours.
    pub wheels: Vec<WheelGrid>,
}

/// Least and greatest slip, load and speed.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, ToSchema)]
pub struct ConditionRanges {
    /// Slip.
    pub slip: [f64; 2],
    /// Load `[N]`.
    pub wheel_load_n: [f64; 2],
    /// Speed of the rim or of travel `[m/s]`.
    pub speed_m_s: [f64; 2],
}

/// A quantity of a grid.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, ToSchema)]
pub struct GridQuantity {
    /// Name with the unit at its end.
    pub name: String,
    /// Unit.
    pub unit: String,
    /// Whether its intervals are those of a new measurement; else those of the parameters alone, because the noise is unknown.
    pub is_measurement: bool,
}

/// The predictions of a wheel.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, ToSchema)]
pub struct WheelGrid {
    /// Name of the wheel.
    pub wheel: String,
    /// The points by slip, then by load, then by speed.
    pub points: Vec<GridPoint>,
}

/// The predictions at a point of a grid.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, ToSchema)]
pub struct GridPoint {
    /// The draws at which the model refuses the point; null if it refuses none.
    pub refused: Option<Refusal>,
    /// Mean and ends of the 90 % interval of each quantity over all models, to six significant digits; null where nothing is predicted.
    pub values: Vec<Option<[f64; 3]>>,
}

/// Predicts a calibration over the grid that its fitted runs span.
///
/// # Arguments
/// - `simulate`: answers a question.
///
/// # Errors
/// [`PredictionError::Request`] if no run is fitted; else those of [`Ensemble::new`] and [`Ensemble::simulate`].
/// Checked by the farm test `prediction::the_grid_has_the_predictions_of_its_points`.
pub fn prediction_grid(
    study: Study,
    id: i64,
    simulate: impl Fn(Question) -> Result<Answers, String>,
) -> Result<PredictionGrid, PredictionError> {
    let ensemble = Ensemble::new(study, id, BTreeMap::new())?;
    let mut grid = empty(id, &ensemble.asked().spec.experiment)?;
    if !ensemble.is_fast() {
        return Ok(grid);
    }
    let wheels = fitted(&ensemble.asked().spec.experiment).map(|run| run.wheel.clone());
    let mut wheels: Vec<String> = wheels.collect();
    wheels.sort();
    wheels.dedup();
    let defaults = ConditionDefaults::new(&ensemble.asked().spec.experiment, ensemble.wheels());
    let runs = wheels.iter().flat_map(|wheel| grid.conditions(wheel));
    let runs: Result<Vec<PlannedRun>, String> = runs
        .enumerate()
        .map(|(i, condition)| defaults.run(&condition, &format!("p{}", i + 1), None))
        .collect();
    let simulated = ensemble.simulate(runs.map_err(PredictionError::Request)?, Some(DRAWS), simulate)?;
    let predicted = predict(&simulated, &[]);
    grid.draws = predicted.draws;
    grid.quantities = quantities(&predicted.runs);
    let points = predicted.runs.len() / wheels.len().max(1);
    let of_wheel = wheels.into_iter().zip(predicted.runs.chunks(points.max(1)));
    grid.wheels = of_wheel
        .map(|(wheel, runs)| WheelGrid {
            wheel,
            points: runs.iter().map(|run| point(run, &grid.quantities)).collect(),
        })
        .collect();
    Ok(grid)
}

/// The fitted runs of an experiment.
fn fitted(experiment: &Experiment) -> impl Iterator<Item = &TestRun> {
    experiment.runs.iter().filter(|run| run.usage == RunUse::Fit)
}

/// Returns the axes of the grid of an experiment, without predictions.
fn empty(calibration: i64, experiment: &Experiment) -> Result<PredictionGrid, PredictionError> {
    let span = |value: &dyn Fn(&TestRun) -> f64| {
        let ends = fitted(experiment).map(value);
        ends.fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], x| {
            [low.min(x), high.max(x)]
        })
    };
    if fitted(experiment).next().is_none() {
        let message = "no wheel run is fitted: nothing tells what a wheel would do";
        return Err(PredictionError::Request(message.into()));
    }
    let rim = |run: &TestRun| rim_speed_m_s(run.slip, run.sled_speed_m_s);
    let sled = |run: &TestRun| run.sled_speed_m_s;
    let levels = |value: &dyn Fn(&TestRun) -> f64| levels(fitted(experiment).map(value).collect());
    let holds_rim = levels(&rim) < levels(&sled);
    let fitted = ConditionRanges {
        slip: span(&|run| run.slip),
        wheel_load_n: span(&|run| run.wheel_load_n),
        speed_m_s: if holds_rim { span(&rim) } else { span(&sled) },
    };
    let wider = |[low, high]: [f64; 2]| [low / BEYOND, high * BEYOND];
    let [slowest, fastest] = fitted.speed_m_s;
    let has_speeds = fastest > slowest * (1.0 + ONE_LEVEL);
    let reach = ConditionRanges {
        slip: [
            fitted.slip[0].min(0.0),
            (fitted.slip[1] + BEYOND_SLIP).min(MAX_SLIP),
        ],
        wheel_load_n: wider(fitted.wheel_load_n),
        speed_m_s: if has_speeds {
            wider(fitted.speed_m_s)
        } else {
            fitted.speed_m_s
        },
    };
    let share = |i: usize| libm::pow(i as f64 / (SLIPS - 1) as f64, 1.5);
    Ok(PredictionGrid {
        calibration,
        draws: 0,
        holds_rim,
        slips: (0..SLIPS)
            .map(|i| reach.slip[0] + (reach.slip[1] - reach.slip[0]) * share(i))
            .collect(),
        wheel_loads_n: even(reach.wheel_load_n),
        speeds_m_s: even(reach.speed_m_s),
        fitted,
        reach,
        quantities: Vec::new(),
        wheels: Vec::new(),
    })
}

/// Counts the levels among values.
fn levels(mut values: Vec<f64>) -> usize {
    values.sort_by(f64::total_cmp);
    let steps = values
        .windows(2)
        .filter(|pair| pair[1] > pair[0] * (1.0 + ONE_LEVEL));
    1 + steps.count()
}

/// Returns both ends with their geometric mean between them; a range of one level has one value.
fn even([low, high]: [f64; 2]) -> Vec<f64> {
    if high <= low * (1.0 + ONE_LEVEL) {
        return vec![low];
    }
    let step = |i: usize| i as f64 / (LEVELS - 1) as f64;
    (0..LEVELS)
        .map(|i| low * libm::pow(high / low, step(i)))
        .collect()
}

impl PredictionGrid {
    /// Returns the conditions of a wheel by slip, then by load, then by speed.
    fn conditions(&self, wheel: &str) -> Vec<PlannedCondition> {
        let mut conditions = Vec::new();
        for &slip in &self.slips {
            for &load in &self.wheel_loads_n {
                for &speed in &self.speeds_m_s {
                    conditions.push(PlannedCondition {
                        wheel: Some(wheel.to_owned()),
                        slip: Some(slip),
                        wheel_load_n: Some(load),
                        sled_speed_m_s: Some(self.sled_speed_m_s(slip, speed)),
                        ..PlannedCondition::default()
                    });
                }
            }
        }
        conditions
    }

    /// Returns the speed of travel at a speed that the rig holds: the inverse of [`rim_speed_m_s`] if that is the rim's.
    fn sled_speed_m_s(&self, slip: f64, speed_m_s: f64) -> f64 {
        match self.holds_rim {
            false => speed_m_s,
            true if slip < 0.0 => speed_m_s / (1.0 + slip),
            true => speed_m_s * (1.0 - slip),
        }
    }
}

/// Returns the quantities of predicted runs. Curves join the intervals, so they are of one kind at all points.
fn quantities(runs: &[PredictedRun]) -> Vec<GridQuantity> {
    let Some(first) = runs.iter().find(|run| !run.quantities.is_empty()) else {
        return Vec::new();
    };
    let of_name = |name: &str| {
        let mut all = runs.iter().flat_map(|run| &run.quantities);
        all.all(|quantity| quantity.name != name || quantity.models_measurement.is_some())
    };
    let quantity = |quantity: &PredictedQuantity| GridQuantity {
        name: quantity.name.clone(),
        unit: quantity.unit.clone(),
        is_measurement: of_name(&quantity.name),
    };
    first.quantities.iter().map(quantity).collect()
}

fn point(run: &PredictedRun, quantities: &[GridQuantity]) -> GridPoint {
    let value = |stated: &GridQuantity| {
        let found = run
            .quantities
            .iter()
            .find(|quantity| quantity.name == stated.name)?;
        let [low, high] = match stated.is_measurement {
            true => found.models_measurement?,
            false => found.models,
        };
        Some([found.models_mean, low, high].map(rounded))
    };
    GridPoint {
        refused: run.refused.clone(),
        values: quantities.iter().map(value).collect(),
    }
}

/// Rounds a value to [`DIGITS`] significant digits.
fn rounded(x: f64) -> f64 {
    let digits = DIGITS - 1;
    format!("{x:.digits$e}").parse().unwrap_or(x)
}

#[cfg(test)]
mod tests {
    use shared::file::FileSet;

    use super::*;

    fn experiment(runs: &str) -> Experiment {
        let toml = "runs = \"runs.csv\"\n[wheel.w]\nradius_m = 0.1\nwidth_m = 0.05\n[soil.s]\n[noise]\ndrawbar_pull_n = 1.0\n";
        let head = "run,wheel,soil,slip,wheel_load_n,sled_speed_m_s,drawbar_pull_n,use\n";
        let files = FileSet {
            toml: toml.into(),
            files: [("runs.csv".to_owned(), format!("{head}{runs}"))].into(),
        };
        Experiment::parse("experiment.toml", &files).unwrap()
    }

    #[test]
    fn the_grid_reaches_beyond_the_fitted_runs_and_holds_what_the_rig_held() {
        let rim =
            experiment("1,w,s,0.1,60,0.018,1,fit\n2,w,s,0.5,120,0.01,1,fit\n3,w,s,0.8,999,0.02,1,holdout\n");
        let grid = empty(7, &rim).unwrap();
        assert!(grid.holds_rim);
        let is_near = |range: [f64; 2], expected: [f64; 2]| {
            let mut pairs = range.iter().zip(expected);
            assert!(pairs.all(|(a, b)| (a - b).abs() < 1e-12), "{range:?}");
        };
        is_near(grid.fitted.slip, [0.1, 0.5]);
        is_near(grid.reach.slip, [0.0, 0.7]);
        is_near(grid.fitted.wheel_load_n, [60.0, 120.0]);
        assert!(grid.reach.wheel_load_n[0] < 60.0 && grid.reach.wheel_load_n[1] > 120.0);
        assert_eq!((grid.slips.len(), grid.wheel_loads_n.len()), (11, 3));
        // A speed that the rig held all the time has no slider.
        assert_eq!(grid.speeds_m_s.len(), 1);
        let conditions = grid.conditions("w");
        assert_eq!(conditions.len(), 33);
        let last = conditions.last().unwrap();
        assert!(
            (last.sled_speed_m_s.unwrap() - 0.02 * 0.3).abs() < 1e-9,
            "{last:?}"
        );
        let sled = experiment("1,w,s,0.1,60,0.02,1,fit\n2,w,s,0.5,120,0.02,1,fit\n");
        assert!(!empty(7, &sled).unwrap().holds_rim);
        let none = experiment("1,w,s,0.1,60,0.02,1,holdout\n");
        assert!(empty(7, &none).is_err());
    }

    #[test]
    fn values_have_six_significant_digits() {
        for (value, expected) in [
            (12.345_678_9, 12.3457_f64),
            (-0.001_234_567_8, -0.001_234_57),
            (0.0, 0.0),
        ] {
            assert_eq!(rounded(value).to_bits(), expected.to_bits());
        }
    }
}
