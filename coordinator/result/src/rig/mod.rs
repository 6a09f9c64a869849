//! What the rig did: offsets of sessions, tarings and operators that repeats of a condition show, without a contact model.
//!
//! # Layout
//! - this file: [`RepeatOffsets`], the answer for a quantity, and the analysis of an experiment.
//! - `repeated_quantity`: what is compared: a channel or the wheel load. `compared_runs`: the runs, with their conditions and ids.
//! - `confounding`: why the data cannot tell, in a sentence.

mod compared_runs;
mod confounding;
mod repeated_quantity;

pub use confounding::RigWords;
pub use repeated_quantity::RepeatedQuantity;

use inference::diagnostics::{GroupOffset, GroupOffsets, group_offsets};
use shared::experiment::{Experiment, RigColumn};

use compared_runs::ComparedRuns;
use confounding::sentence;

/// What repeats tell about offsets of the sessions, tarings or operators in one quantity.
#[derive(Debug, Clone, PartialEq, serde::Serialize, serde::Deserialize, utoipa::ToSchema)]
pub struct RepeatOffsets {
    /// The wheel; null if the wheels share ids and are analysed together, as for the wheel load.
    pub wheel: Option<String>,
    /// Channel without unit, or `wheel_load`.
    #[schema(value_type = String)]
    pub quantity: RepeatedQuantity,
    /// SI unit of offsets and standard deviations.
    pub unit: String,
    /// Column of runs.csv: `session`, `zero` or `operator`.
    #[schema(value_type = String)]
    pub column: RigColumn,
    /// Number of fitted runs that state an id and the quantity.
    pub runs: usize,
    /// Natural logarithm of the Bayes factor of offsets against none; null if the data cannot tell.
    pub log_bayes_factor: Option<f64>,
    /// Probability of offsets, from even prior odds; null if the data cannot tell.
    pub probability: Option<f64>,
    /// Standard deviation of the offsets, if there are any: posterior mean.
    pub offset_sd: Option<f64>,
    /// Standard deviation of repeats of a condition beside the offsets: posterior mean.
    pub repeat_sd: Option<f64>,
    /// Standard deviation of repeats of a condition without offsets: posterior mean.
    pub repeat_sd_without: Option<f64>,
    /// Offsets by id, in the order of the runs; without the ids that share no condition with another.
    pub offsets: Vec<RepeatOffset>,
    /// Reason why the data cannot tell; null if they can.
    pub confounded: Option<String>,
}

/// The offset of a session, a taring or an operator.
#[derive(Debug, Clone, PartialEq, serde::Serialize, serde::Deserialize, utoipa::ToSchema)]
pub struct RepeatOffset {
    /// The id in runs.csv.
    pub id: String,
    /// Posterior mean, from the mean of the ids that common conditions link it to.
    pub mean: f64,
    /// Posterior standard deviation.
    pub sd: f64,
    /// Number of its runs.
    pub runs: usize,
}

/// Returns what the fitted runs tell about offsets; `None` if no run states a session, a taring or an operator.
///
/// A column whose ids group the runs as those of an earlier column do is left out, and so are a wheel with one id and a quantity whose
/// repeats are equal, as nominal loads are.
pub fn repeat_offsets(experiment: &Experiment, fit_runs: &[usize]) -> Option<Vec<RepeatOffsets>> {
    let states = |column: &RigColumn| fit_runs.iter().any(|&i| column.id(&experiment.runs[i]).is_some());
    let stated: Vec<RigColumn> = RigColumn::ALL.into_iter().filter(states).collect();
    if stated.is_empty() {
        return None;
    }
    let mut found = Vec::new();
    for column in stated {
        for quantity in RepeatedQuantity::ALL {
            let parts = ComparedRuns::parts(experiment, fit_runs, quantity, column);
            found.extend(parts.iter().filter_map(|part| part.offsets(quantity, column)));
        }
    }
    // The wheels first, so that a reader finds one wheel's quantities together.
    found.sort_by(|a, b| (a.column, &a.wheel).cmp(&(b.column, &b.wheel)));
    Some(found)
}

impl ComparedRuns<'_> {
    fn offsets(&self, quantity: RepeatedQuantity, column: RigColumn) -> Option<RepeatOffsets> {
        let found = group_offsets(&self.values, &self.conditions, &self.groups);
        let estimate = |value: fn(&GroupOffsets) -> f64| found.as_ref().ok().map(value);
        let confounded = match found {
            Err(reason) => Some(sentence(self, column, reason)?),
            Ok(_) => None,
        };
        Some(RepeatOffsets {
            wheel: self.wheel.map(str::to_owned),
            quantity,
            unit: quantity.unit().to_owned(),
            column,
            runs: self.values.len(),
            log_bayes_factor: estimate(|found| found.log_bayes_factor),
            probability: estimate(|found| found.probability),
            offset_sd: estimate(|found| found.offset_sd),
            repeat_sd: estimate(|found| found.repeat_sd),
            repeat_sd_without: estimate(|found| found.repeat_sd_without),
            offsets: found
                .as_ref()
                .map_or_else(|_| Vec::new(), |found| self.by_id(&found.offsets)),
            confounded,
        })
    }

    fn by_id(&self, offsets: &[Option<GroupOffset>]) -> Vec<RepeatOffset> {
        let offset = |(group, offset): (usize, &Option<GroupOffset>)| {
            let GroupOffset { mean, sd } = (*offset)?;
            Some(RepeatOffset {
                id: self.ids[group].to_owned(),
                mean,
                sd,
                runs: self.groups.iter().filter(|&&g| g == group).count(),
            })
        };
        offsets.iter().enumerate().filter_map(offset).collect()
    }
}

#[cfg(test)]
mod tests {
    use shared::experiment::RunUse;
    use shared::file::FileSet;
    use statistics::rng::Stream;

    use super::*;

    const TOML: &str = "runs = \"runs.csv\"\n[wheel.a]\nradius_m = 0.1\nwidth_m = 0.05\n[wheel.b]\nradius_m = 0.1\nwidth_m = 0.05\n[soil.s]\n[noise]\nsinkage_m = 0.001\n";

    /// Returns what is found in four conditions of a wheel, each run once a day, with the ids of a day's taring and operator.
    fn found(wheels: &[&str], id: impl Fn(usize) -> String) -> Option<Vec<RepeatOffsets>> {
        let mut runs = String::new();
        let mut stream = Stream::new(5, 0, 0, 0);
        for (w, wheel) in wheels.iter().enumerate() {
            for day in 0..6 {
                let shift = [0.9, -0.7, 0.2, -0.8, 0.6, -0.2][day];
                for slip in [0.1, 0.2, 0.3, 0.4] {
                    let (load, sinkage) = stream.normal_pair();
                    let (load, sinkage) = (24.0 + shift + 0.3 * load, 0.01 * slip + 0.0002 * sinkage);
                    let run = 1 + runs.lines().count();
                    runs += &format!(
                        "{run},{wheel},s,{slip},{load},0.01,{sinkage},fit,{}\n",
                        id(w + 10 * day)
                    );
                }
            }
        }
        // A held-out run that would spoil every estimate is never read.
        offsets(&format!("{runs}last,a,s,0.1,24,0.01,0.15,holdout,{}\n", id(0)))
    }

    /// Returns what is found in these rows.
    fn offsets(rows: &str) -> Option<Vec<RepeatOffsets>> {
        let runs = format!(
            "run,wheel,soil,slip,wheel_load_n,sled_speed_m_s,sinkage_m,use,session,zero,operator\n{rows}"
        );
        let files = FileSet {
            toml: TOML.into(),
            files: [("runs.csv".into(), runs)].into(),
        };
        let experiment = Experiment::parse("experiment.toml", &files).unwrap();
        let is_fitted = |&i: &usize| experiment.runs[i].usage == RunUse::Fit;
        let fitted: Vec<usize> = (0..experiment.runs.len()).filter(is_fitted).collect();
        repeat_offsets(&experiment, &fitted)
    }

    #[test]
    fn a_load_that_shifts_from_day_to_day_is_found_and_the_sinkage_is_not_blamed() {
        let found = found(&["a"], |number| format!("day {},,", number / 10)).unwrap();
        let [load, sinkage] = &found[..] else {
            panic!("{found:?}")
        };
        assert_eq!((load.quantity, load.runs), (RepeatedQuantity::WheelLoad, 24));
        assert!(
            load.probability > Some(0.99) && load.repeat_sd < Some(0.5),
            "{load:?}"
        );
        assert_eq!(load.offsets.len(), 6);
        assert!(
            load.offsets[0].mean > 0.5 && load.offsets[1].mean < -0.4,
            "{load:?}"
        );
        assert!(sinkage.probability < Some(0.5), "{sinkage:?}");
        assert!(sinkage.repeat_sd_without < Some(0.0005), "{sinkage:?}");
    }

    #[test]
    fn wheels_that_share_a_day_share_the_offset_of_their_load_alone() {
        let together = found(&["a", "b"], |number| format!("day {},,", number / 10)).unwrap();
        let wheels: Vec<_> = together
            .iter()
            .map(|part| (part.wheel.as_deref(), part.quantity.name(), part.runs))
            .collect();
        assert_eq!(
            wheels,
            [
                (None, "wheel_load", 48),
                (Some("a"), "sinkage", 24),
                (Some("b"), "sinkage", 24)
            ]
        );
        let apart = found(&["a", "b"], |number| format!("day {number},,")).unwrap();
        assert!(apart.iter().all(|part| part.wheel.is_some()) && apart.len() == 4);
    }

    #[test]
    fn ids_that_follow_a_condition_are_confounded_with_it() {
        let by_day = found(&["a"], |number| format!("day {},,", number / 10)).unwrap();
        assert!(by_day.iter().all(|part| part.confounded.is_none()));
        let run = |number: usize, slip: f64, session: &str| {
            format!("{number},a,s,{slip},24,0.01,0.0{number},fit,{session},,\n")
        };
        let rows = |sessions: [&str; 6]| -> String {
            let slips = [0.1, 0.1, 0.1, 0.3, 0.3, 0.3];
            (1..)
                .zip(slips)
                .zip(sessions)
                .map(|((n, slip), session)| run(n, slip, session))
                .collect()
        };
        let words = |sessions: [&str; 6]| {
            let found = offsets(&rows(sessions)).unwrap();
            found.iter().find_map(|part| {
                assert_eq!(part.probability.is_none(), part.confounded.is_some());
                (part.quantity == RepeatedQuantity::Sinkage).then(|| part.confounded.clone())
            })
        };
        assert_eq!(
            words(["A", "A", "A", "B", "B", "B"]).unwrap().unwrap(),
            "the sessions of wheel a follow the slip: an offset of a session cannot be told from an effect of the slip; repeat conditions of a session in another, for example conditions of A in B"
        );
        assert_eq!(
            words(["A", "B", "C", "D", "E", "F"]).unwrap().unwrap(),
            "the repeats of wheel a do not tell an offset of a session from the scatter of a run; repeat conditions in the same session"
        );
        assert_eq!(
            words(["A", "B", "", "", "A", "B"]).unwrap().unwrap(),
            "wheel a has fewer than three repeats of conditions: offsets of sessions cannot be told from effects of the conditions; repeat conditions, some in the same session and some in another"
        );
        assert_eq!(words(["A", "A", "B", "A", "B", "B"]).unwrap(), None);
    }

    #[test]
    fn a_column_counts_if_it_groups_the_runs_otherwise_than_an_earlier_one() {
        let columns = |id: fn(usize) -> String| {
            let found = found(&["a"], id)?;
            let mut columns: Vec<_> = found.iter().map(|part| part.column.name()).collect();
            columns.dedup();
            Some(columns)
        };
        let same = |number| format!("day {number},tare {number},Ada");
        assert_eq!(columns(same), Some(vec!["session"]));
        let other = |number| format!("day {number},tare {number},{}", number % 20);
        assert_eq!(columns(other), Some(vec!["session", "operator"]));
        assert_eq!(columns(|_| ",,Ada".to_owned()), Some(Vec::new()));
        assert_eq!(columns(|_| ",,".to_owned()), None);
    }
}
