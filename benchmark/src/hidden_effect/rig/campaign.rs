//! A campaign on a rig with a flaw, without a missing effect.

use shared::file::FileSet;
use statistics::rng::Stream;

use super::super::study::case::{MAX_REJECTED, NOISE, blank, run, spec};
use super::super::study::design::{Plan, PlannedRun, experiment};
use super::super::study::noise::{RunValues, add_noise, noise_sds};
use super::flaw::Flaw;
use crate::error::StudyError;

/// The first random stream of truths and noise.
const STAGE: u64 = (1 << 47) + 1;
const PLAN: Plan = Plan::Full;

/// A campaign on a rig with a flaw.
#[derive(Debug, Clone)]
pub struct RigCampaign {
    flaw: Flaw,
    /// The runs, with order and preparation.
    rows: Vec<PlannedRun>,
    measured: Vec<RunValues>,
    sds: RunValues,
}

impl RigCampaign {
    /// Draws a truth from the priors, and measures it on the rig.
    pub fn new(flaw: Flaw, seed: u64, number: u64) -> Result<Self, StudyError> {
        let mut rows = PLAN.rows();
        rows.retain(|row| !row.is_holdout);
        let preparations = preparations(&rows);
        let disturbances = flaw.disturbances(&preparations, seed, number);
        for (row, disturbance) in rows.iter_mut().zip(&disturbances) {
            (row.order, row.prepared) = (Some(disturbance.order), Some(disturbance.prepared));
        }
        let parameters = spec(&PLAN.job(), &blank(&rows))?;
        let place = |name: &str| {
            let place = parameters.parameters.iter().position(|p| p.name == name);
            place.ok_or(format!("the job has no {name}"))
        };
        let (stiffness, angle) = (place("log10_p_ref")?, place("friction_angle_deg")?);
        let prior = parameters.prior();
        for rejected in 0..MAX_REJECTED {
            let truth = prior.sample(&mut Stream::new(seed, STAGE, number, rejected));
            let mut values = Vec::new();
            for (row, disturbance) in rows.iter().zip(&disturbances) {
                let mut theta = truth.clone();
                theta[stiffness] += disturbance.stiffness.log10();
                theta[angle] += disturbance.angle_deg;
                let alone = PlannedRun {
                    order: None,
                    prepared: None,
                    ..row.clone()
                };
                values.extend(run(&PLAN.job(), &[alone], &theta)?.into_iter().flatten());
            }
            if values.len() < rows.len() {
                continue;
            }
            let sds = noise_sds(NOISE, values.iter());
            for (disturbance, measured) in disturbances.iter().zip(&mut values) {
                measured[0] += disturbance.pull_sds * sds[0];
            }
            let noise = sds.map(|sd| flaw.noise() * sd);
            add_noise(&mut values, noise, &mut Stream::new(seed, STAGE + 1, number, 0));
            return Ok(Self {
                flaw,
                rows,
                measured: values,
                sds,
            });
        }
        Err(format!("the model rejected {MAX_REJECTED} draws of the prior in a row").into())
    }

    pub fn job(&self) -> FileSet {
        PLAN.job()
    }

    /// Returns the files of the experiment; with `is_stated`, the runs have the column that states the flaw.
    pub fn experiment(&self, is_stated: bool) -> FileSet {
        let column = self.flaw.column().filter(|_| is_stated);
        let mut rows = self.rows.clone();
        for row in &mut rows {
            row.order = row.order.filter(|_| column == Some("order"));
            row.prepared = row.prepared.filter(|_| column == Some("prepared"));
        }
        experiment(&rows, &self.measured, self.sds)
    }
}

/// Returns the preparation of each run, from 1, with a separate preparation for each load and rim speed.
fn preparations(rows: &[PlannedRun]) -> Vec<usize> {
    let mut prepared: Vec<(f64, i64)> = Vec::new();
    let preparation = |row: &PlannedRun| {
        // The rim speed is rounded to a micrometre per second.
        let rim = (1e6 * row.sled_speed_m_s / (1.0 - row.slip)).round() as i64;
        let condition = (row.wheel_load_n, rim);
        let place = prepared.iter().position(|other| *other == condition);
        1 + place.unwrap_or_else(|| {
            prepared.push(condition);
            prepared.len() - 1
        })
    };
    rows.iter().map(preparation).collect()
}
