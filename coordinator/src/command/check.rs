//! `coordinator check`: validates a job and estimates its cost.

use std::sync::Arc;

use super::job_on_disk;
use super::output::say;
use crate::config::CheckArguments;
use crate::embedded::LocalModels;
use crate::pilot::{JobCost, job_cost};
use job::{Spec, confounded_orders};
use report::{model_limits, terminal};
use result::words::number;
use search::untried::additions;

/// Longest duration of a pilot `[s]`.
const PILOT_S: f64 = 30.0;

pub(super) async fn check(config: &CheckArguments) -> anyhow::Result<()> {
    let job = job_on_disk::read(&config.file, &[])?;
    let allowed = Arc::new(LocalModels::new(&config.models.allow_model).map_err(anyhow::Error::msg)?);
    let models: Vec<Spec> = std::iter::once(job.spec.clone())
        .chain(job.alternatives)
        .collect();
    let mut text = String::new();
    for (number, spec) in models.iter().enumerate() {
        if models.len() > 1 {
            text += &format!(
                "{}model {} of {}\n",
                ["\n", ""][usize::from(number == 0)],
                number + 1,
                models.len()
            );
        }
        text += &terminal::specification(spec);
        for note in model_limits(spec) {
            text += &format!("note: {note}\n");
        }
    }
    if !job.spec.fit_variant.conditions.is_empty() {
        for line in additions(&job.job, &job.experiment, job.spec.model.is_smooth())? {
            text += &format!("note: {line}\n");
        }
    }
    for order in confounded_orders(&job.spec.experiment, &job.spec.fit_runs) {
        text += &format!("warning: {}\n", order.words());
    }
    text += &terminal::rig(&job.spec);
    say(&text)?;
    let several = models.len() > 1;
    let mut core_s = 0.0;
    for spec in models {
        let kind = spec.model.kind.name();
        if spec.model.external.is_some() && config.models.allow_model.is_empty() {
            say(&format!(
                "\n{kind}: the model is not ours; --allow-model lets a pilot run it, to estimate evaluations and hours\n"
            ))?;
            continue;
        }
        let (text, own_s) = cost(spec, Arc::clone(&allowed)).await?;
        core_s += own_s;
        let heading = if several {
            format!("\n{kind}:")
        } else {
            String::new()
        };
        say(&(heading + &text))?;
    }
    if several {
        let hours = core_s / 3600.0;
        say(&format!("\nall models: {hours:.3} expected core hours\n"))?;
    }
    Ok(())
}

/// Estimates the cost of a calibration. Returns it in words, and in seconds of a core.
async fn cost(spec: Spec, models: Arc<LocalModels>) -> anyhow::Result<(String, f64)> {
    let point_estimates = spec.point_estimates.clone();
    let cost = tokio::task::spawn_blocking(move || job_cost(spec, &models, PILOT_S)).await??;
    let JobCost { cores, core_s, .. } = cost;
    let mut text = format!("\n{}\n", cost.pilot);
    text += &format!(
        "expected evaluations   {:>12.0}   (one evaluation: {})\n",
        cost.evaluations,
        number::count(cost.runs, "run")
    );
    text += &format!("expected simulations   {:>12.0}\n", cost.simulations());
    text += &format!("expected core hours    {:>12.3}\n", core_s / 3600.0);
    text += &format!(
        "on {cores} cores            {:>12.3} h = {:.0} s\n",
        core_s / 3600.0 / cores as f64,
        core_s / cores as f64
    );
    for algorithm in point_estimates {
        // The budget is the estimate, because the number of evaluations until convergence is unknown.
        let budget = algorithm.max_evaluations().unwrap_or_default() as f64;
        text += &format!(
            "point estimate {}: at most {:.3} core hours\n",
            algorithm.words(),
            budget * cost.seconds_per_evaluation() / 3600.0
        );
    }
    if cost.rejected_share > 0.0 {
        text += &format!(
            "the model rejected {:.0} % of the pilot's parameter vectors\n",
            100.0 * cost.rejected_share
        );
    }
    Ok((text, core_s))
}
