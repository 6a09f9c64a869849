//! Reads the decision of a job, or of a file that has nothing else.

use serde::Deserialize;
use shared::file::{FileError, parse_toml};

use crate::decision::{Decision, RawDecision};
use crate::job::Job;

/// A file with a decision alone, and wheels that the experiment does not have.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct DecisionFile {
    decision: RawDecision,
    #[serde(default)]
    wheel: toml::Table,
}

/// Reads the decision of a file: a job with a table `[decision]`, or a file with that table alone and wheels that the experiment does
/// not have. Returns the wheels as a file of their own.
///
/// # Errors
/// [`FileError`] names the line or the table.
/// Checked by `tests::a_decision_stands_in_a_job_or_alone`.
pub fn read_decision(name: &str, toml: &str) -> Result<(Decision, String), FileError> {
    let table: toml::Table = parse_toml(name, toml)?;
    if ["model", "models", "priors"]
        .iter()
        .any(|key| table.contains_key(*key))
    {
        let decision = Job::parse(name, toml)?.decision;
        let missing = || FileError::whole(name, "the job has no table [decision]");
        return Ok((decision.ok_or_else(missing)?, String::new()));
    }
    let file: DecisionFile = parse_toml(name, toml)?;
    let decision = file.decision.decision();
    let decision = decision.map_err(|e| FileError::whole(name, format!("[decision] {e}")))?;
    let wheels = toml::Table::from_iter([("wheel".to_owned(), toml::Value::Table(file.wheel))]);
    Ok((decision, wheels.to_string()))
}

#[cfg(test)]
mod tests {
    use super::*;

    const DECISION: &str = "[decision]\nloss = \"energy_j_m\"\nrun_cost = 2\n\
        [[decision.options]]\nname = \"climb\"\ncondition = { slope_deg = 10 }\n\
        [[decision.options]]\nname = \"stay\"\nloss = \"40\"\n\
        [[decision.constraints]]\nstatement = \"net_pull_n >= 0\"\nprobability = 0.9\n";

    #[test]
    fn a_decision_stands_in_a_job_or_alone() {
        let wheel = "[wheel.wide]\nradius_m = 0.1\nwidth_m = 0.2\n";
        let (decision, wheels) = read_decision("decision.toml", &format!("{DECISION}{wheel}")).unwrap();
        assert_eq!(decision.options.len(), 2);
        assert!(decision.options[1].condition.is_none());
        assert!(
            shared::experiment::read_wheels("decision.toml", &wheels)
                .unwrap()
                .contains_key("wide")
        );
        let job = format!("[model]\nkind = \"quasi_static\"\n{DECISION}");
        let (in_job, wheels) = read_decision("job.toml", &job).unwrap();
        assert_eq!((in_job.constraints.len(), wheels.as_str()), (1, ""));
        let without = read_decision("job.toml", "[model]\nkind = \"quasi_static\"\n").unwrap_err();
        assert_eq!(without.to_string(), "job.toml: the job has no table [decision]");
    }

    #[test]
    fn a_mistake_names_its_option_or_constraint() {
        let refused = |old: &str, new: &str| {
            let text = DECISION.replace(old, new);
            read_decision("decision.toml", &text).unwrap_err().to_string()
        };
        for (old, new, reason) in [
            (
                "\"stay\"",
                "\"climb\"",
                "[decision] option \"climb\" appears twice",
            ),
            (
                "loss = \"energy_j_m\"\n",
                "",
                "[decision] option \"climb\" has no loss",
            ),
            (
                "\"energy_j_m\"",
                "\"energy\"",
                "[decision] loss of option \"climb\": character 1: ",
            ),
            ("= 0.9", "= 1.9", "probability 1.9 must lie in [0, 1]"),
            (
                "run_cost = 2",
                "run_cost = -2",
                "[decision] run_cost -2 must be >= 0",
            ),
            ("slope_deg", "slop_deg", "nearest known is \"slope_deg\""),
        ] {
            let error = refused(old, new);
            assert!(error.contains(reason), "{error}");
        }
    }
}
