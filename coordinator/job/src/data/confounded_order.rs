//! Conditions that follow the order of the runs, so that their effects are confounded with a drift.

use shared::experiment::{Experiment, TestRun};

/// Difference of values, as a share of their range, up to which they are one level `[1]`.
const SAME_LEVEL: f64 = 0.02;
/// Absolute rank correlation beyond which at most one pair of runs in ten separates an effect from a drift.
const CONFOUNDED: f64 = 0.8;

/// A condition of the rig that may follow the order of the runs.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum SetCondition {
    /// Slip.
    Slip,
    /// Wheel load.
    WheelLoad,
    /// Sled speed.
    SledSpeed,
}

/// A condition that follows the order of the fitted runs.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ConfoundedOrder {
    /// The condition.
    pub condition: SetCondition,
    /// Rank correlation of order and condition, in [−1, 1].
    pub rank_correlation: f64,
}

impl SetCondition {
    /// Every condition, in the order of the messages.
    const ALL: [SetCondition; 3] = [
        SetCondition::Slip,
        SetCondition::WheelLoad,
        SetCondition::SledSpeed,
    ];

    /// Returns the name in sentences.
    pub fn words(self) -> &'static str {
        match self {
            SetCondition::Slip => "slip",
            SetCondition::WheelLoad => "wheel load",
            SetCondition::SledSpeed => "sled speed",
        }
    }

    /// Returns the variables of a law that change with the condition: itself, and those that follow from it. The shear displacement
    /// and the sliding velocity grow with the slip, depths with the load, velocities with the speed.
    pub fn law_variables(self) -> &'static [&'static str] {
        match self {
            SetCondition::Slip => &["slip", "j", "v_t"],
            SetCondition::WheelLoad => &["wheel_load", "z", "sinkage"],
            SetCondition::SledSpeed => &["sled_speed", "v_t", "v_n"],
        }
    }

    fn value(self, run: &TestRun) -> f64 {
        match self {
            SetCondition::Slip => run.slip,
            SetCondition::WheelLoad => run.wheel_load_n,
            SetCondition::SledSpeed => run.sled_speed_m_s,
        }
    }
}

impl ConfoundedOrder {
    /// Returns a sentence that states the consequence.
    pub fn words(self) -> String {
        let condition = self.condition.words();
        format!(
            "the runs were made in the order of their {condition} (rank correlation {:.2}): no effect that changes with {condition} can be told from a drift of soil or sensors but by their priors; repeat runs of several levels late and early in the series",
            self.rank_correlation
        )
    }
}

/// Returns the conditions that follow the stated order of the fitted runs; none if the experiment states no order.
///
/// # Equation
/// Goodman and Kruskal's gamma: the share of concordant pairs of runs minus the share of discordant pairs, among the pairs that
/// differ in order and condition. Pairs of one level are not counted, so two levels, one after the other, have gamma 1.
///
/// # Source
/// Goodman & Kruskal 1954, doi:10.1080/01621459.1954.10501231. Checked by
/// `tests::runs_in_the_order_of_a_condition_are_confounded_with_it`.
pub fn confounded_orders(experiment: &Experiment, fit_runs: &[usize]) -> Vec<ConfoundedOrder> {
    let runs = fit_runs.iter().map(|&i| &experiment.runs[i]);
    let runs: Vec<(i32, &TestRun)> = runs.filter_map(|run| Some((run.order?, run))).collect();
    confounded(&runs)
}

/// Returns the conditions that follow the rows of the fitted runs, by the measure of [`confounded_orders`]; none if a fitted run states
/// its order. The rows may be the order in which the runs were made.
pub fn conditions_in_row_order(experiment: &Experiment, fit_runs: &[usize]) -> Vec<ConfoundedOrder> {
    let runs = fit_runs.iter().map(|&i| &experiment.runs[i]);
    let runs: Vec<(i32, &TestRun)> = (1..).zip(runs).collect();
    match runs.iter().any(|(_, run)| run.order.is_some()) {
        true => Vec::new(),
        false => confounded(&runs),
    }
}

/// Returns the conditions that follow the numbers of the runs.
fn confounded(runs: &[(i32, &TestRun)]) -> Vec<ConfoundedOrder> {
    let confounded = |condition: SetCondition| {
        let values: Vec<(i32, f64)> = runs
            .iter()
            .map(|(order, run)| (*order, condition.value(run)))
            .collect();
        let rank_correlation = gamma(&values)?;
        (rank_correlation.abs() > CONFOUNDED).then_some(ConfoundedOrder {
            condition,
            rank_correlation,
        })
    };
    SetCondition::ALL.into_iter().filter_map(confounded).collect()
}

/// Returns gamma; `None` if no pair differs.
fn gamma(values: &[(i32, f64)]) -> Option<f64> {
    let least = values.iter().map(|v| v.1).fold(f64::INFINITY, f64::min);
    let greatest = values.iter().map(|v| v.1).fold(f64::NEG_INFINITY, f64::max);
    let gap = SAME_LEVEL * (greatest - least);
    let (mut concordant, mut discordant) = (0_u64, 0_u64);
    for (i, first) in values.iter().enumerate() {
        for second in &values[..i] {
            let change = second.1 - first.1;
            if second.0 == first.0 || change.abs() <= gap {
                continue;
            }
            match (second.0 > first.0) == (change > 0.0) {
                true => concordant += 1,
                false => discordant += 1,
            }
        }
    }
    let pairs = concordant + discordant;
    (pairs > 0).then(|| (concordant as f64 - discordant as f64) / pairs as f64)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn runs_in_the_order_of_a_condition_are_confounded_with_it() {
        let gamma_of = |values: &[f64]| gamma(&(1..).zip(values.iter().copied()).collect::<Vec<_>>());
        assert_eq!(gamma_of(&[0.1, 0.1, 0.4, 0.4]), Some(1.0));
        assert_eq!(gamma_of(&[150.0, 150.1, 60.0, 59.9]), Some(-1.0));
        assert_eq!(gamma_of(&[0.1, 0.4, 0.4, 0.1]), Some(0.0));
        assert_eq!(gamma_of(&[0.1, 0.1]), None);
        // Nine of twelve pairs grow, three fall.
        assert_eq!(gamma_of(&[0.1, 0.2, 0.3, 0.1, 0.2, 0.3]), Some(6.0 / 12.0));
    }
}
