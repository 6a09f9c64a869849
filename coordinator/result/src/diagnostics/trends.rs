//! Whether what the fit leaves follows a condition of the runs.

use inference::diagnostics::{PredictedDraw, TrendTest};
use shared::channel::Channel;
use shared::experiment::TestRun;

use crate::finished_calibration::FinishedCalibration;
use crate::table::level::levels;

/// What residuals are held against.
#[derive(Debug, Clone, Copy, PartialEq, Eq, serde::Serialize, serde::Deserialize, utoipa::ToSchema)]
#[serde(rename_all = "snake_case")]
pub enum Against {
    /// The same everywhere.
    Constant,
    /// Slip.
    Slip,
    /// Wheel load.
    WheelLoad,
    /// Sled speed.
    SledSpeed,
    /// The product of slip and sled speed.
    SlipXSledSpeed,
}

impl Against {
    const ALL: [Against; 5] = [
        Against::Constant,
        Against::Slip,
        Against::WheelLoad,
        Against::SledSpeed,
        Against::SlipXSledSpeed,
    ];

    /// Name in tables: `slip_x_sled_speed`.
    pub fn name(self) -> &'static str {
        match self {
            Against::Constant => "constant",
            Against::Slip => "slip",
            Against::WheelLoad => "wheel_load",
            Against::SledSpeed => "sled_speed",
            Against::SlipXSledSpeed => "slip_x_sled_speed",
        }
    }

    fn value(self, run: &TestRun) -> f64 {
        match self {
            Against::Constant => 1.0,
            Against::Slip => run.slip,
            Against::WheelLoad => run.wheel_load_n,
            Against::SledSpeed => run.sled_speed_m_s,
            Against::SlipXSledSpeed => run.slip * run.sled_speed_m_s,
        }
    }

    /// Whether these runs vary it on enough levels: two, of slip three.
    fn is_varied(self, runs: &[&TestRun]) -> bool {
        let count = |of: Against| levels(runs.iter().map(|run| of.value(run))).len();
        match self {
            Against::Constant => true,
            Against::Slip => count(Against::Slip) >= 3,
            Against::WheelLoad | Against::SledSpeed => count(self) >= 2,
            Against::SlipXSledSpeed => Against::Slip.is_varied(runs) && Against::SledSpeed.is_varied(runs),
        }
    }

    /// Its values at these runs about their mean, in units of their range; of the constant, 1.
    fn regressor(self, runs: &[&TestRun]) -> Vec<f64> {
        let values: Vec<f64> = runs.iter().map(|run| self.value(run)).collect();
        if self == Against::Constant {
            return values;
        }
        let mean = values.iter().sum::<f64>() / values.len() as f64;
        let least = values.iter().copied().fold(f64::INFINITY, f64::min);
        let largest = values.iter().copied().fold(f64::NEG_INFINITY, f64::max);
        values.iter().map(|v| (v - mean) / (largest - least)).collect()
    }
}

/// The residuals of a channel against a condition.
#[derive(Debug, Clone, PartialEq, serde::Serialize, serde::Deserialize, utoipa::ToSchema)]
pub struct TrendDiagnostics {
    /// Channel without unit.
    pub channel: String,
    /// The condition.
    pub against: Against,
    /// Unit of the next two.
    pub unit: String,
    /// By how much the measurements rise beyond the model from the condition's least to its largest value, or lie above it in
    /// all, had the fit not bent towards them.
    pub change: f64,
    /// Standard deviation of the change where there is no trend.
    pub change_sd: f64,
    /// Share of the condition's pattern that the fit cannot take up.
    pub share_left: f64,
    /// Two-sided probability of so large a change, before correction for the number of tests.
    pub p: f64,
}

/// Every channel against every condition that its fitted runs vary and that the fit does not take up; empty of a fit.
pub(crate) fn trends(outcome: &FinishedCalibration, posterior: &[PredictedDraw]) -> Vec<TrendDiagnostics> {
    let spec = &outcome.spec;
    // These values were scored while sampling.
    let Ok(Some(test)) = TrendTest::new(&spec.likelihood, &spec.prior(), posterior) else {
        return Vec::new();
    };
    let data = spec.likelihood.data();
    let mut found = Vec::new();
    for channel in Channel::ALL {
        let own: Vec<usize> = (0..data.len())
            .filter(|&i| data[i].channel == channel.index())
            .collect();
        let runs: Vec<&TestRun> = own
            .iter()
            .map(|&i| &spec.experiment.runs[spec.fit_runs[data[i].run]])
            .collect();
        for against in Against::ALL {
            if own.is_empty() || !against.is_varied(&runs) {
                continue;
            }
            let mut regressor = vec![0.0; data.len()];
            for (&i, value) in own.iter().zip(against.regressor(&runs)) {
                regressor[i] = value;
            }
            found.extend(test.against(&regressor).map(|trend| TrendDiagnostics {
                channel: channel.name().into(),
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

    /// Runs with these slips, loads and speeds.
    fn runs(conditions: &[[f64; 3]]) -> Vec<TestRun> {
        let first = fixture::outcome().spec.experiment.runs[0].clone();
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
        let all = Against::ALL.into_iter().filter(|a| a.is_varied(&runs));
        all.map(Against::name).collect()
    }

    #[test]
    fn a_condition_is_judged_only_where_it_was_varied() {
        let two_slips = [[0.1, 60.0, 0.01], [0.4, 60.2, 0.02], [0.4, 90.0, 0.02]];
        assert_eq!(varied(&two_slips), ["constant", "wheel_load", "sled_speed"]);
        let one_speed = [[0.1, 60.0, 0.01], [0.2, 60.0, 0.01], [0.4, 60.0, 0.01]];
        assert_eq!(varied(&one_speed), ["constant", "slip"]);
        let all = [[0.1, 60.0, 0.01], [0.2, 60.0, 0.02], [0.4, 70.0, 0.01]];
        assert_eq!(varied(&all).len(), 5);
    }

    #[test]
    fn a_regressor_has_the_mean_zero_and_the_range_one() {
        let runs = runs(&[[0.1, 60.0, 0.01], [0.2, 60.0, 0.02], [0.6, 70.0, 0.01]]);
        let runs: Vec<&TestRun> = runs.iter().collect();
        let slip = Against::Slip.regressor(&runs);
        for (found, expected) in slip.iter().zip([-0.4, -0.2, 0.6]) {
            assert!((found - expected).abs() < 1e-12, "{slip:?}");
        }
        assert_eq!(Against::Constant.regressor(&runs), [1.0; 3]);
    }

    #[test]
    fn a_fit_has_no_trends() {
        assert_eq!(trends(&fixture::fit(), &[]), []);
    }
}
