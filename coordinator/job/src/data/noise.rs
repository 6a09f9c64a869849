//! The noise standard deviation of each measurement: stated, pooled from repeats, or inferred.

use shared::channel::Channel;
use shared::experiment::{Experiment, NoiseSd, RunUse, ScatterSd, TestRun};
use shared::parameters::{NOISE_PREFIX, noise_parameter};
use statistics::{Datum, Distribution, ErrorSd, Marginal};

use super::error::{DataError, MIN_FREEDOM};
use super::level::SAME_LOAD;
use super::shared_sd::SharedSd;
use crate::table::prior_entry::FreeParameter;

/// Default prior scale of an unknown noise sd: the typical run-to-run scatter of single-wheel rigs, 2 N, 0.2 N m, 1 mm, 2 N.
const USUAL_SD: [f64; 4] = [2.0, 0.2, 0.001, 2.0];

/// Adds a half-normal prior for every unknown noise sd and sd of shared errors that the job does not mention, and moves all noise
/// parameters behind the model's.
pub(crate) fn add_unknown_sds(
    experiment: &Experiment,
    shared: &[SharedSd],
    parameters: &mut Vec<FreeParameter>,
) {
    let mut add = |name: String, unit: &str, scale: f64| {
        if parameters.iter().any(|p| p.name == name) {
            return;
        }
        let marginal = Marginal::new(Distribution::HalfNormal { scale }, None)
            .expect("the usual scales are positive and finite");
        parameters.push(FreeParameter {
            name,
            unit: unit.to_owned(),
            marginal,
        });
    };
    for sd in shared.iter().filter(|sd| sd.is_inferred()) {
        add(sd.name.clone(), sd.unit, sd.prior_scale);
    }
    for channel in Channel::ALL {
        let unknown = experiment.noise.sd[channel.index()] == Some(NoiseSd::Unknown);
        if unknown && needs_experiment_sd(experiment, channel) {
            add(
                noise_parameter(channel),
                channel.unit(),
                USUAL_SD[channel.index()],
            );
        }
    }
    // A stable sort keeps the order of the file within each part.
    parameters.sort_by_key(|p| p.name.starts_with(NOISE_PREFIX));
}

/// Refuses a prior for a noise sd that is not inferred.
pub(crate) fn check_names(
    experiment: &Experiment,
    shared: &[SharedSd],
    parameters: &[FreeParameter],
) -> Result<(), DataError> {
    let is_stated = |name: &str| parameters.iter().any(|p| p.name == name);
    for sd in shared.iter().filter(|sd| is_stated(&sd.name)) {
        let name = sd.name.clone();
        if sd.stated != ScatterSd::Unknown {
            let key = sd.key().to_owned();
            return Err(DataError::NotUnknown { name, key });
        }
        if !sd.is_needed {
            let nothing = "nothing that is fitted";
            return Err(DataError::NotNeeded { name, nothing });
        }
    }
    for channel in Channel::ALL {
        let name = noise_parameter(channel);
        if !is_stated(&name) {
            continue;
        }
        if experiment.noise.sd[channel.index()] != Some(NoiseSd::Unknown) {
            let key = channel.column().to_owned();
            return Err(DataError::NotUnknown { name, key });
        }
        if !needs_experiment_sd(experiment, channel) {
            let nothing = "no fit run";
            return Err(DataError::NotNeeded { name, nothing });
        }
    }
    Ok(())
}

/// Returns whether any fitted measurement of the channel has no stated standard deviation.
fn needs_experiment_sd(experiment: &Experiment, channel: Channel) -> bool {
    let c = channel.index();
    experiment
        .runs
        .iter()
        .any(|r| r.usage == RunUse::Fit && r.measured[c].is_some() && r.sd[c].is_none())
}

/// Returns the fitted measurements with their standard deviations.
pub(crate) fn data(
    experiment: &Experiment,
    fit_runs: &[usize],
    parameters: &[FreeParameter],
) -> Result<Vec<Datum>, DataError> {
    let mut data = Vec::new();
    for channel in Channel::ALL {
        let c = channel.index();
        let mut pooled = None;
        for (position, &run_index) in fit_runs.iter().enumerate() {
            let run = &experiment.runs[run_index];
            let Some(value) = run.measured[c] else { continue };
            let sd = match (run.sd[c], experiment.noise.sd[c]) {
                (Some(sd), _) | (None, Some(NoiseSd::Known(sd))) => ErrorSd::Known(sd),
                (None, Some(NoiseSd::Replicates)) => match pooled {
                    Some(sd) => ErrorSd::Known(sd),
                    None => {
                        let sd = pooled_sd(experiment, fit_runs, channel)?;
                        pooled = Some(sd);
                        ErrorSd::Known(sd)
                    }
                },
                (None, Some(NoiseSd::Unknown)) => {
                    let name = noise_parameter(channel);
                    let parameter = parameters.iter().position(|p| p.name == name);
                    ErrorSd::Inferred {
                        parameter: parameter.ok_or(DataError::NoPrior(name))?,
                    }
                }
                (None, None) => {
                    return Err(DataError::NoNoise {
                        column: channel.column(),
                        run: run.name.clone(),
                        unit: channel.unit(),
                    });
                }
            };
            data.push(Datum {
                run: position,
                channel: c,
                value,
                sd,
            });
        }
    }
    Ok(data)
}

/// Returns the scatter of fitted repeats with its degrees of freedom; `None` with fewer than three.
pub fn repeat_scatter(experiment: &Experiment, fit_runs: &[usize], channel: Channel) -> Option<(f64, usize)> {
    let (sd, freedom) = pooled(experiment, fit_runs, channel);
    (freedom >= MIN_FREEDOM).then_some((sd, freedom))
}

fn pooled_sd(experiment: &Experiment, fit_runs: &[usize], channel: Channel) -> Result<f64, DataError> {
    let column = channel.column();
    match pooled(experiment, fit_runs, channel) {
        (_, freedom) if freedom < MIN_FREEDOM => Err(DataError::FewRepeats { column, freedom }),
        (sd, _) if sd > 0.0 => Ok(sd),
        _ => Err(DataError::EqualRepeats(column)),
    }
}

/// Returns `sqrt(sum (y - mean of its repeats)^2 / freedom)` over the groups of repeated conditions, with
/// freedom = values - groups; not a number if freedom is 0.
fn pooled(experiment: &Experiment, fit_runs: &[usize], channel: Channel) -> (f64, usize) {
    let c = channel.index();
    let mut groups: Vec<(&TestRun, Vec<f64>)> = Vec::new();
    for &i in fit_runs {
        let run = &experiment.runs[i];
        let Some(value) = run.measured[c] else { continue };
        match groups.iter_mut().find(|(first, _)| repeats(first, run)) {
            Some((_, values)) => values.push(value),
            None => groups.push((run, vec![value])),
        }
    }
    let count: usize = groups.iter().map(|(_, values)| values.len()).sum();
    let freedom = count - groups.len();
    let sum: f64 = groups
        .iter()
        .map(|(_, values)| {
            let mean = values.iter().sum::<f64>() / values.len() as f64;
            values.iter().map(|v| (v - mean) * (v - mean)).sum::<f64>()
        })
        .sum();
    ((sum / freedom as f64).sqrt(), freedom)
}

/// Returns the fitted runs by condition, as positions among them; a run joins the first condition that it repeats.
pub fn conditions(experiment: &Experiment, fit_runs: &[usize]) -> Vec<Vec<usize>> {
    let mut conditions: Vec<(&TestRun, Vec<usize>)> = Vec::new();
    for (position, &i) in fit_runs.iter().enumerate() {
        let run = &experiment.runs[i];
        match conditions.iter_mut().find(|(first, _)| repeats(first, run)) {
            Some((_, positions)) => positions.push(position),
            None => conditions.push((run, vec![position])),
        }
    }
    conditions.into_iter().map(|(_, positions)| positions).collect()
}

/// Returns whether two runs repeat one condition, within the accuracy of a rig: slip to 0.02, slip angle to 0.5 degrees, load to 15 %, speed
/// to 5 %.
pub fn repeats(a: &TestRun, b: &TestRun) -> bool {
    repeats_but_for_load(a, b) && is_close(a.wheel_load_n, b.wheel_load_n, SAME_LOAD)
}

/// Returns whether two runs repeat all that the rig sets but the load, within the same accuracy.
pub fn repeats_but_for_load(a: &TestRun, b: &TestRun) -> bool {
    a.wheel == b.wheel
        && a.soil == b.soil
        && a.pass == b.pass
        && (a.slip - b.slip).abs() <= 0.02
        && (a.slip_angle_deg - b.slip_angle_deg).abs() <= 0.5
        && is_close(a.sled_speed_m_s, b.sled_speed_m_s, 0.05)
}

/// Returns whether two values differ by at most a share of the larger one.
fn is_close(x: f64, y: f64, share: f64) -> bool {
    (x - y).abs() <= share * x.abs().max(y.abs())
}
