//! Trends: tests whether the residuals follow a condition of the runs.

use inference::diagnostics::{PredictedDraw, TrendTest};
use shared::channel::Channel;
use shared::experiment::TestRun;

use crate::finished_calibration::FinishedCalibration;
use crate::table::level::levels;

/// The condition that residuals are tested against.
#[derive(Debug, Clone, Copy, PartialEq, Eq, serde::Serialize, serde::Deserialize, utoipa::ToSchema)]
#[serde(rename_all = "snake_case")]
pub enum TrendVariable {
    /// A constant: the same error in all runs.
    Constant,
    /// Slip.
    Slip,
    /// Wheel load.
    WheelLoad,
    /// Sled speed.
    SledSpeed,
    /// The product of slip and sled speed.
    SlipXSledSpeed,
    /// The position of the run in the order of measurement.
    Order,
}

impl TrendVariable {
    const ALL: [TrendVariable; 6] = [
        TrendVariable::Constant,
        TrendVariable::Slip,
        TrendVariable::WheelLoad,
        TrendVariable::SledSpeed,
        TrendVariable::SlipXSledSpeed,
        TrendVariable::Order,
    ];

    /// Returns the name in tables: `slip_x_sled_speed`.
    pub fn name(self) -> &'static str {
        match self {
            TrendVariable::Constant => "constant",
            TrendVariable::Slip => "slip",
            TrendVariable::WheelLoad => "wheel_load",
            TrendVariable::SledSpeed => "sled_speed",
            TrendVariable::SlipXSledSpeed => "slip_x_sled_speed",
            TrendVariable::Order => "order",
        }
    }

    fn value(self, run: &TestRun) -> f64 {
        match self {
            TrendVariable::Constant => 1.0,
            TrendVariable::Slip => run.slip,
            TrendVariable::WheelLoad => run.wheel_load_n,
            TrendVariable::SledSpeed => run.sled_speed_m_s,
            TrendVariable::SlipXSledSpeed => run.slip * run.sled_speed_m_s,
            TrendVariable::Order => run.order.map_or(0.0, f64::from),
        }
    }

    /// Returns whether the runs have enough levels of the condition: two, or three for slip and order.
    fn is_varied(self, runs: &[&TestRun]) -> bool {
        let count = |variable: TrendVariable| levels(runs.iter().map(|run| variable.value(run))).len();
        match self {
            TrendVariable::Constant => true,
            TrendVariable::Slip | TrendVariable::Order => count(self) >= 3,
            TrendVariable::WheelLoad | TrendVariable::SledSpeed => count(self) >= 2,
            TrendVariable::SlipXSledSpeed => {
                TrendVariable::Slip.is_varied(runs) && TrendVariable::SledSpeed.is_varied(runs)
            }
        }
    }

    /// Returns the condition of each run minus its mean, divided by its range; the constant is 1 for each run.
    fn regressor(self, runs: &[&TestRun]) -> Vec<f64> {
        let values: Vec<f64> = runs.iter().map(|run| self.value(run)).collect();
        if self == TrendVariable::Constant {
            return values;
        }
        let mean = values.iter().sum::<f64>() / values.len() as f64;
        let min = values.iter().copied().fold(f64::INFINITY, f64::min);
        let max = values.iter().copied().fold(f64::NEG_INFINITY, f64::max);
        values.iter().map(|v| (v - mean) / (max - min)).collect()
    }
}

/// The trend of a channel's residuals with a condition.
#[derive(Debug, Clone, PartialEq, serde::Serialize, serde::Deserialize, utoipa::ToSchema)]
pub struct TrendDiagnostics {
    /// Channel, by its name without unit.
    #[schema(value_type = String)]
    pub channel: Channel,
    /// Condition against which the residuals are tested.
    pub against: TrendVariable,
    /// Unit of the change and its standard deviation.
    pub unit: String,
    /// Change of measured minus predicted from the smallest to the largest value of the condition, or its mean for the constant. It is
    /// the change before the fit absorbs a part.
    pub change: f64,
    /// Standard deviation of the change if there is no trend.
    pub change_sd: f64,
    /// Share of the condition's pattern that the fit cannot absorb.
    pub share_left: f64,
    /// Two-sided probability of a change at least this large, before correction for the number of tests.
    pub p: f64,
}

/// Tests each channel against each condition that its fitted runs vary and that the fit does not absorb; empty for a fit.
pub fn trends(calibration: &FinishedCalibration, posterior: &[PredictedDraw]) -> Vec<TrendDiagnostics> {
    let spec = &calibration.spec;
    // The sampler already evaluated the likelihood of these values, so an error cannot occur here.
    let Ok(Some(test)) = TrendTest::new(&spec.likelihood, &spec.prior(), posterior) else {
        return Vec::new();
    };
    let data = spec.likelihood.data();
    let mut found = Vec::new();
    for channel in Channel::ALL {
        let indices: Vec<usize> = (0..data.len())
            .filter(|&i| data[i].channel == channel.index())
            .collect();
        let runs: Vec<&TestRun> = indices
            .iter()
            .map(|&i| &spec.experiment.runs[spec.fit_runs[data[i].run]])
            .collect();
        for against in TrendVariable::ALL {
            if indices.is_empty() || !against.is_varied(&runs) {
                continue;
            }
            let mut regressor = vec![0.0; data.len()];
            for (&i, value) in indices.iter().zip(against.regressor(&runs)) {
                regressor[i] = value;
            }
            found.extend(test.against(&regressor).map(|trend| TrendDiagnostics {
                channel,
                against,
                unit: channel.unit().into(),
                change: trend.slope,
                change_sd: trend.sd,
                share_left: trend.share_left,
                p: trend.p,
            }));
        }
    }
    found
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::fixture;

    /// Returns runs with the given slips, loads and speeds.
    fn runs(conditions: &[[f64; 3]]) -> Vec<TestRun> {
        let first = fixture::calibration().spec.experiment.runs[0].clone();
        let run = |&[slip, wheel_load_n, sled_speed_m_s]: &[f64; 3]| TestRun {
            slip,
            wheel_load_n,
            sled_speed_m_s,
            ..first.clone()
        };
        conditions.iter().map(run).collect()
    }

    fn varied(conditions: &[[f64; 3]]) -> Vec<&'static str> {
        let runs = runs(conditions);
        let runs: Vec<&TestRun> = runs.iter().collect();
        let all = TrendVariable::ALL.into_iter().filter(|a| a.is_varied(&runs));
        all.map(TrendVariable::name).collect()
    }

    #[test]
    fn a_condition_is_judged_only_where_it_was_varied() {
        let two_slips = [[0.1, 60.0, 0.01], [0.4, 60.2, 0.02], [0.4, 90.0, 0.02]];
        assert_eq!(varied(&two_slips), ["constant", "wheel_load", "sled_speed"]);
        let one_speed = [[0.1, 60.0, 0.01], [0.2, 60.0, 0.01], [0.4, 60.0, 0.01]];
        assert_eq!(varied(&one_speed), ["constant", "slip"]);
        let all = [[0.1, 60.0, 0.01], [0.2, 60.0, 0.02], [0.4, 70.0, 0.01]];
        assert_eq!(varied(&all).len(), 5);
        let mut numbered = runs(&all);
        for (run, order) in numbered.iter_mut().zip([3, 1, 2]) {
            run.order = Some(order);
        }
        assert!(TrendVariable::Order.is_varied(&numbered.iter().collect::<Vec<_>>()));
    }

    #[test]
    fn a_regressor_has_the_mean_zero_and_the_range_one() {
        let runs = runs(&[[0.1, 60.0, 0.01], [0.2, 60.0, 0.02], [0.6, 70.0, 0.01]]);
        let runs: Vec<&TestRun> = runs.iter().collect();
        let slip = TrendVariable::Slip.regressor(&runs);
        for (found, expected) in slip.iter().zip([-0.4, -0.2, 0.6]) {
            assert!((found - expected).abs() < 1e-12, "{slip:?}");
        }
        assert_eq!(TrendVariable::Constant.regressor(&runs), [1.0; 3]);
    }

    #[test]
    fn a_fit_has_no_trends() {
        assert_eq!(trends(&fixture::fit(), &[]), []);
    }
}
