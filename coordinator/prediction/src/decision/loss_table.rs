//! The loss of each option at each draw, with errors.

use job::{Decision, PlannedRun, QUANTITIES, QuantityValues, position_of};

use super::scenario::Scenarios;
use crate::balance::climb;
use crate::draw::{DrawnRun, Draws, ERRORS, WeightedDraw};
use crate::ensemble::Simulated;
use crate::error::PredictionError;
use crate::prediction::rig_radius_m;
use crate::quantity_value::quantity_values;
use crate::spread::{mean, probability, variance};

/// Number of the errors of all options. They are the same for each, so that what options have in common cancels in their differences.
pub(super) const OPTION_ERRORS: usize = 0;
/// Largest share of the weight of the draws at which a loss may have no value.
const MAX_LEFT_OUT: f64 = 0.5;

/// Losses of the options at the draws at which all options have one.
#[derive(Debug, Default)]
pub(super) struct LossTable {
    /// The draws.
    pub(super) draws: Vec<WeightedDraw>,
    /// Their weights, with the sum 1.
    pub(super) weights: Vec<f64>,
    /// For each draw and option: the loss with each error.
    pub(super) losses: Vec<Vec<Vec<f64>>>,
    /// For each draw and option: the mean loss over the errors.
    pub(super) means: Vec<Vec<f64>>,
    /// For each option: the loss at the most probable parameters, without errors.
    pub(super) at_mode: Vec<f64>,
    /// For each option and constraint: the probability that it holds.
    pub(super) holds: Vec<Vec<f64>>,
    /// For each option: the probability that the wheel is stuck.
    pub(super) stuck: Vec<Option<f64>>,
    /// For each option: the mean slip where the wheel is not stuck.
    pub(super) slip: Vec<Option<f64>>,
    /// Number of draws at which an option has no loss.
    pub(super) left_out: usize,
    /// Their share of the weight of all draws.
    pub(super) left_out_share: f64,
}

/// A mean with its standard error.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Expected {
    pub(super) mean: f64,
    pub(super) se: f64,
}

/// The runs of an option at all draws.
struct OptionRuns<'a> {
    planned: Vec<&'a PlannedRun>,
    radius_m: f64,
    drawn: Vec<Vec<Option<DrawnRun>>>,
}

impl OptionRuns<'_> {
    /// Returns the quantities of the option's run, from the channels of each of its planned runs.
    fn values(&self, channels: impl Fn(usize) -> Option<[f64; 4]>) -> Option<QuantityValues> {
        let first = self.planned.first()?;
        if self.planned.len() == 1 {
            return Some(quantity_values(first, self.radius_m, channels(0)?, false));
        }
        let points = self.planned.iter().enumerate();
        let points = points.filter_map(|(i, planned)| Some((planned.run.slip, channels(i)?)));
        let along_n = first.weight_n * libm::sin(first.slope_deg.to_radians());
        let found = climb(&points.collect::<Vec<_>>(), along_n)?;
        let planned = first.at_slip(found.slip);
        Some(quantity_values(
            &planned,
            self.radius_m,
            found.channels,
            found.is_stuck,
        ))
    }
}

impl LossTable {
    /// Computes the losses.
    pub(super) fn new(
        simulated: &Simulated,
        draws: &Draws<'_>,
        decision: &Decision,
        scenarios: &Scenarios,
    ) -> Result<LossTable, PredictionError> {
        let options = scenarios.options.iter();
        let options: Vec<OptionRuns<'_>> = options
            .map(|runs| OptionRuns {
                planned: runs.iter().map(|&run| &simulated.runs[run]).collect(),
                radius_m: runs
                    .first()
                    .map_or(1.0, |&run| rig_radius_m(simulated, &simulated.runs[run])),
                drawn: runs.iter().map(|&run| draws.of_run(run, OPTION_ERRORS)).collect(),
            })
            .collect();
        let nothing = [f64::NAN; QUANTITIES.len()];
        let loss = |option: usize, values: &QuantityValues| decision.options[option].loss.value(values);
        let mut table = LossTable::default();
        // For each kept draw and option, the quantities with each error.
        let mut kept: Vec<Vec<Vec<QuantityValues>>> = Vec::new();
        for (i, draw) in draws.all.iter().enumerate() {
            let of_option = |option: &OptionRuns<'_>| {
                (0..ERRORS)
                    .map(|error| match option.planned.is_empty() {
                        true => Some(nothing),
                        false => option.values(|run| Some(option.drawn[run][i].as_ref()?.measured(error))),
                    })
                    .collect::<Option<Vec<QuantityValues>>>()
            };
            let values: Option<Vec<Vec<QuantityValues>>> = options.iter().map(of_option).collect();
            let losses = values.as_ref().map(|values| {
                let of_option = |(option, values): (usize, &Vec<QuantityValues>)| -> Vec<f64> {
                    values.iter().map(|values| loss(option, values)).collect()
                };
                values.iter().enumerate().map(of_option).collect::<Vec<_>>()
            });
            match (values, losses) {
                (Some(values), Some(losses)) if losses.iter().flatten().all(|loss| loss.is_finite()) => {
                    let mean = |losses: &Vec<f64>| losses.iter().sum::<f64>() / losses.len() as f64;
                    table.means.push(losses.iter().map(mean).collect());
                    table.losses.push(losses);
                    table.draws.push(*draw);
                    kept.push(values);
                }
                _ => table.left_out += 1,
            }
        }
        let total: f64 = table.draws.iter().map(|draw| draw.weight).sum();
        table.left_out_share = left_out_share(&draws.all, &table.draws)?;
        table.weights = table.draws.iter().map(|draw| draw.weight / total).collect();
        let at_mode = options.iter().zip(&scenarios.options).enumerate();
        table.at_mode = at_mode
            .map(|(number, (option, runs))| {
                let values = match runs.is_empty() {
                    true => Some(nothing),
                    false => option.values(|run| {
                        let channels = draws.at_mode(runs[run]);
                        channels[0].is_finite().then_some(channels)
                    }),
                };
                values.map_or(f64::NAN, |values| loss(number, &values))
            })
            .collect();
        table.judge(decision, scenarios, &kept);
        Ok(table)
    }

    /// Computes the probabilities of constraints and of being stuck.
    fn judge(&mut self, decision: &Decision, scenarios: &Scenarios, kept: &[Vec<Vec<QuantityValues>>]) {
        let [at_slip, at_stuck] =
            ["slip", "stuck"].map(|name| position_of(name).expect("a quantity of the list"));
        for (option, runs) in scenarios.options.iter().enumerate() {
            let values = || {
                let weighted = kept.iter().zip(&self.weights);
                weighted.flat_map(move |(options, &weight)| options[option].iter().map(move |v| (v, weight)))
            };
            let holds = decision.constraints.iter().map(|constraint| {
                let holds = values().map(|(v, weight)| (constraint.statement.holds(v) == Some(true), weight));
                probability(holds).unwrap_or(0.0)
            });
            let holds: Vec<f64> = holds.collect();
            let stuck = probability(values().map(|(v, weight)| (v[at_stuck] > 0.5, weight)));
            let slips: Vec<(f64, f64)> = values()
                .filter(|(v, _)| v[at_stuck] < 0.5)
                .map(|(v, weight)| (v[at_slip], weight))
                .collect();
            self.holds.push(holds);
            self.stuck.push(stuck.filter(|_| runs.len() > 1));
            self.slip.push(mean(&slips).filter(|_| !runs.is_empty()));
        }
    }

    /// Returns the losses of an option with their weights.
    pub(super) fn losses_of(&self, option: usize) -> Vec<(f64, f64)> {
        let weighted = self.losses.iter().zip(&self.weights);
        weighted
            .flat_map(|(options, &weight)| options[option].iter().map(move |&loss| (loss, weight)))
            .collect()
    }

    /// Returns the expected loss of an option.
    pub(super) fn expected(&self, option: usize) -> Expected {
        self.expectation(|row| row[option])
    }

    /// Returns the expected difference of the losses of two options.
    pub(super) fn difference(&self, option: usize, other: usize) -> Expected {
        self.expectation(|row| row[option] - row[other])
    }

    /// Returns the mean over the draws of a value of their mean losses, with its standard error for independent draws.
    pub(super) fn expectation(&self, value: impl Fn(&[f64]) -> f64) -> Expected {
        let rows = self.means.iter().zip(&self.weights);
        let values: Vec<(f64, f64)> = rows.map(|(row, &weight)| (value(row), weight)).collect();
        let squares: f64 = self.weights.iter().map(|weight| weight * weight).sum();
        Expected {
            mean: mean(&values).unwrap_or(f64::NAN),
            se: (variance(&values).unwrap_or(0.0) * squares).sqrt(),
        }
    }

    /// Returns the least expected loss of some options; `None` without options.
    pub(super) fn least(&self, options: &[usize]) -> Option<f64> {
        let expected = options.iter().map(|&option| self.expected(option).mean);
        expected.reduce(f64::min)
    }

    /// Returns by how much the expected loss would fall if the draw were known; `None` without options.
    pub(super) fn perfect_information(&self, options: &[usize]) -> Option<f64> {
        let least = self.least(options)?;
        let known = self.expectation(|row| {
            let losses = options.iter().map(|&option| row[option]);
            losses.fold(f64::INFINITY, f64::min)
        });
        Some((least - known.mean).max(0.0))
    }
}

/// Returns the share of the weight of the draws that are not kept.
///
/// # Errors
/// [`PredictionError::Request`] if it exceeds [`MAX_LEFT_OUT`]. Checked by `tests::draws_that_are_left_out_count_by_their_weight`.
fn left_out_share(all: &[WeightedDraw], kept: &[WeightedDraw]) -> Result<f64, PredictionError> {
    let weight = |draws: &[WeightedDraw]| draws.iter().map(|draw| draw.weight).sum::<f64>();
    let share = match kept.len() == all.len() {
        true => 0.0,
        false => 1.0 - weight(kept) / weight(all),
    };
    if share <= MAX_LEFT_OUT && !kept.is_empty() {
        return Ok(share);
    }
    Err(PredictionError::Request(format!(
        "a loss has no value at draws with {:.1} % of the weight, which must be at most {:.0} %: the model refuses a run there, or the \
         formula uses what an option without a condition does not have",
        100.0 * share,
        100.0 * MAX_LEFT_OUT
    )))
}

#[cfg(test)]
pub(super) mod tests {
    use super::*;

    /// Returns a table of mean losses without errors, each row a draw of equal weight.
    pub(crate) fn table(means: &[[f64; 2]]) -> LossTable {
        let count = means.len();
        LossTable {
            draws: (0..count)
                .map(|draw| WeightedDraw {
                    model: 0,
                    draw,
                    weight: 1.0 / count as f64,
                })
                .collect(),
            weights: vec![1.0 / count as f64; count],
            losses: means
                .iter()
                .map(|row| row.iter().map(|&loss| vec![loss; ERRORS]).collect())
                .collect(),
            means: means.iter().map(|row| row.to_vec()).collect(),
            ..LossTable::default()
        }
    }

    #[test]
    fn draws_that_are_left_out_count_by_their_weight() {
        let draw = |model: usize, draw: usize, weight: f64| WeightedDraw { model, draw, weight };
        // The second model has half of the draws and a hundredth of the weight.
        let all = [
            draw(0, 0, 0.495),
            draw(0, 1, 0.495),
            draw(1, 0, 0.005),
            draw(1, 1, 0.005),
        ];
        assert!(left_out_share(&all, &all).unwrap().abs() < 1e-15);
        assert!((left_out_share(&all, &all[..2]).unwrap() - 0.01).abs() < 1e-12);
        let error = left_out_share(&all, &all[2..]).unwrap_err().to_string();
        assert!(
            error.contains("with 99.0 % of the weight, which must be at most 50 %"),
            "{error}"
        );
        assert!(left_out_share(&all, &[]).is_err());
    }

    #[test]
    fn perfect_information_is_worth_what_the_right_choice_at_each_draw_saves() {
        let table = table(&[[0.0, 1.0], [4.0, 1.0]]);
        assert!((table.expected(0).mean - 2.0).abs() < 1e-12);
        assert!((table.difference(0, 1).mean - 1.0).abs() < 1e-12);
        // Option 1 costs 1; with knowledge, option 0 is taken at half of the draws at the cost of 0.
        assert!((table.perfect_information(&[0, 1]).unwrap() - 0.5).abs() < 1e-12);
        assert_eq!(table.perfect_information(&[1]), Some(0.0));
        assert_eq!(table.perfect_information(&[]), None);
    }
}
