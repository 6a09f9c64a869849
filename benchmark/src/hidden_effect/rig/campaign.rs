//! A campaign on a rig with a flaw, in which nothing is missing from the model.

use shared::file::FileSet;
use statistics::rng::Stream;

use super::super::study::case::{NOISE, blank, run, spec};
use super::super::study::design::{CHANNELS, Plan, PlannedRun, experiment};
use super::super::study::error::StudyError;
use super::flaw::Flaw;

/// Random streams of truths and noise.
const STAGE: u64 = (1 << 47) + 1;
/// Most draws of the prior in a row that the model rejects.
const MAX_REFUSED: u64 = 1000;
const PLAN: Plan = Plan::Full;

/// A campaign on a rig with a flaw.
#[derive(Debug, Clone)]
pub struct RigCampaign {
    flaw: Flaw,
    /// With order and preparation.
    rows: Vec<PlannedRun>,
    measured: Vec<[f64; CHANNELS]>,
    sds: [f64; CHANNELS],
}

impl RigCampaign {
    /// Draws a truth from the priors, and measures it on the rig.
    pub fn new(flaw: Flaw, seed: u64, number: u64) -> Result<Self, StudyError> {
        let mut rows = PLAN.rows();
        rows.retain(|row| !row.is_holdout);
        let preparations = preparations(&rows);
        let disturbances = flaw.disturbances(&preparations, seed, number);
        for (row, own) in rows.iter_mut().zip(&disturbances) {
            (row.order, row.prepared) = (Some(own.order), Some(own.prepared));
        }
        let parameters = spec(&PLAN.job(), &blank(&rows))?;
        let place = |name: &str| {
            let place = parameters.parameters.iter().position(|p| p.name == name);
            place.ok_or(format!("the job has no {name}"))
        };
        let (stiffness, angle) = (place("log10_p_ref")?, place("friction_angle_deg")?);
        let prior = parameters.prior();
        for refused in 0..MAX_REFUSED {
            let truth = prior.sample(&mut Stream::new(seed, STAGE, number, refused));
            let mut values = Vec::new();
            for (row, own) in rows.iter().zip(&disturbances) {
                let mut theta = truth.clone();
                theta[stiffness] += own.stiffness.log10();
                theta[angle] += own.angle_deg;
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
            let sds: [f64; CHANNELS] = std::array::from_fn(|channel| {
                let squares: f64 = values.iter().map(|v| v[channel] * v[channel]).sum();
                NOISE * (squares / rows.len() as f64).sqrt()
            });
            let mut noise = Stream::new(seed, STAGE + 1, number, 0)
                .normals(CHANNELS * rows.len())
                .into_iter();
            for (own, measured) in disturbances.iter().zip(&mut values) {
                measured[0] += own.pull_sds * sds[0];
                for (x, sd) in measured.iter_mut().zip(sds) {
                    *x += flaw.noise() * sd * noise.next().unwrap_or(0.0);
                }
            }
            return Ok(Self {
                flaw,
                rows,
                measured: values,
                sds,
            });
        }
        Err(format!("the model rejected {MAX_REFUSED} draws of the prior in a row").into())
    }

    pub fn job(&self) -> FileSet {
        PLAN.job()
    }

    /// The files that the search gets.
    ///
    /// # Arguments
    /// - `is_stated`: with the column that states the flaw.
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

/// The preparation of each run, from 1, if each load and rim speed has its own.
fn preparations(rows: &[PlannedRun]) -> Vec<usize> {
    let mut known: Vec<(f64, i64)> = Vec::new();
    let of_row = |row: &PlannedRun| {
        // The rim speed to a micrometre per second.
        let rim = (1e6 * row.sled_speed_m_s / (1.0 - row.slip)).round() as i64;
        let own = (row.wheel_load_n, rim);
        let place = known.iter().position(|other| *other == own);
        1 + place.unwrap_or_else(|| {
            known.push(own);
            known.len() - 1
        })
    };
    rows.iter().map(of_row).collect()
}
