//! Errors of the rig: those that a search judges beside the effects, and their record.
//!
//! Offsets of sessions, tarings and operators are part of the likelihood. Two more are suspected where the experiment states such a
//! column: wear, by which a channel drifts from one session to the next, and a guide that carries a part of the load, so that the forces
//! of a run are too large or too small together while its sinkage is right.

use std::collections::BTreeMap;

use discovery::{JudgedError, SharedErrorSource, SuspectedError, SuspectedShift};
use job::{SharedError, Spec};
use record::{JudgedRigError, RigOffset};
use shared::channel::Channel;
use shared::experiment::{RigColumn, RigError, RigQuantity, TestRun};
use shared::parameters::NOISE_PREFIX;
use statistics::ErrorSd;

/// Name of the error of a guide that carries a part of the load.
const GUIDE: &str = "guide_friction";
/// Scale of the prior of that part: friction of a linear guide `[1]`.
const GUIDE_SCALE: f64 = 0.05;
/// Change from one session to the next over the offset of a session, as scales of their priors.
const WEAR_SHARE: f64 = 0.5;

/// An error that a search suspects, with its name and the unit of its sd.
pub(super) struct NamedSuspect {
    name: String,
    unit: &'static str,
    pub(super) error: SuspectedError,
    /// The id of each group.
    ids: Vec<String>,
}

/// Returns the errors that are suspected beyond those of the likelihood; none if no fitted run states a session, taring or operator.
pub(super) fn suspects(spec: &Spec) -> Vec<NamedSuspect> {
    let has_ids = |column: RigColumn| fitted(spec).any(|run| column.id(run).is_some());
    if !RigColumn::ALL.into_iter().any(has_ids) {
        return Vec::new();
    }
    let wear = Channel::ALL.into_iter().filter_map(|channel| wear(spec, channel));
    wear.chain(guide(spec)).collect()
}

fn fitted(spec: &Spec) -> impl Iterator<Item = &TestRun> {
    spec.fit_runs.iter().map(|&run| &spec.experiment.runs[run])
}

/// Returns the drift of a channel from session to session; `None` without the order of three sessions that measure it. Runs without a
/// session do not count.
fn wear(spec: &Spec, channel: Channel) -> Option<NamedSuspect> {
    let offset = RigError {
        column: RigColumn::Session,
        quantity: RigQuantity::Offset(channel),
    };
    // The place of each session in time: the mean place of its runs.
    let mut places: BTreeMap<&str, (f64, f64)> = BTreeMap::new();
    for run in fitted(spec).filter(|run| run.measured[channel.index()].is_some()) {
        let Some(session) = run.session.as_deref() else {
            continue;
        };
        let (sum, count) = places.entry(session).or_default();
        *sum += f64::from(run.order?);
        *count += 1.0;
    }
    let mut sessions: Vec<(&str, f64)> = places
        .into_iter()
        .map(|(id, (sum, count))| (id, sum / count))
        .collect();
    sessions.sort_by(|a, b| a.1.total_cmp(&b.1));
    let rank: BTreeMap<&str, usize> = sessions.iter().enumerate().map(|(k, (id, _))| (*id, k)).collect();
    let data = spec.likelihood.data().iter().enumerate();
    let of_channel: Vec<(usize, usize)> = data
        .filter(|(_, datum)| datum.channel == channel.index())
        .filter_map(|(place, datum)| {
            let run = &spec.experiment.runs[spec.fit_runs[datum.run]];
            Some((place, *rank.get(run.session.as_deref()?)?))
        })
        .collect();
    let since = |from: usize| -> Vec<usize> {
        let later = of_channel.iter().filter(|(_, rank)| *rank >= from);
        later.map(|(place, _)| *place).collect()
    };
    if sessions.len() < 3 || of_channel.is_empty() {
        return None;
    }
    Some(NamedSuspect {
        name: format!("wear_{}", channel.column()),
        unit: channel.unit(),
        error: SuspectedError {
            groups: (1..sessions.len()).map(since).collect(),
            shift: SuspectedShift::Offset,
            prior_scale: WEAR_SHARE * offset.prior_scale(),
        },
        ids: sessions[1..].iter().map(|(id, _)| (*id).to_owned()).collect(),
    })
}

/// Returns the error of a guide that carries a part of the load; `None` if no run measures two forces.
fn guide(spec: &Spec) -> Option<NamedSuspect> {
    let forces = [Channel::DrawbarPull, Channel::Torque, Channel::LateralForce].map(Channel::index);
    let mut groups = vec![Vec::new(); spec.fit_runs.len()];
    for (place, datum) in spec.likelihood.data().iter().enumerate() {
        if forces.contains(&datum.channel) {
            groups[datum.run].push(place);
        }
    }
    let runs = groups.into_iter().zip(fitted(spec));
    let (groups, ids): (Vec<Vec<usize>>, Vec<String>) = runs
        .filter(|(data, _)| data.len() > 1)
        .map(|(data, run)| (data, run.name.clone()))
        .unzip();
    (!groups.is_empty()).then(|| NamedSuspect {
        name: GUIDE.to_owned(),
        unit: "1",
        error: SuspectedError {
            groups,
            shift: SuspectedShift::Factor,
            prior_scale: GUIDE_SCALE,
        },
        ids,
    })
}

/// Returns the record of the errors that runs share, by falling probability.
pub(super) fn rig_errors(spec: &Spec, judged: &[JudgedError]) -> Vec<JudgedRigError> {
    let suspects = suspects(spec);
    let named = |error: &JudgedError| {
        let (name, unit, ids) = match error.source {
            SharedErrorSource::Suspected(k) => {
                let suspect = suspects.get(k)?;
                (suspect.name.clone(), suspect.unit, suspect.ids.clone())
            }
            SharedErrorSource::Parameter(k) => {
                let inferred = ErrorSd::Inferred { parameter: k };
                let shared = spec.shared_errors.iter().find(|shared| shared.sd == inferred)?;
                let groups = error.groups.iter();
                let ids = groups.map(|group| id(spec, shared, group.data.first().copied()));
                let name = spec.parameters.get(k)?.name.as_str();
                let name = name.strip_prefix(NOISE_PREFIX).unwrap_or(name);
                let unit = shared.rig?.unit();
                (name.to_owned(), unit, ids.collect())
            }
        };
        let offset = |(group, id): (&discovery::GroupError, String)| RigOffset {
            id,
            mean: group.mean,
            sd: group.sd,
        };
        Some(JudgedRigError {
            name,
            unit: unit.to_owned(),
            log_bayes_factor: error.log_bayes_factor,
            probability: error.probability,
            sd: error.sd,
            offsets: error.groups.iter().zip(ids).map(offset).collect(),
        })
    };
    let mut errors: Vec<JudgedRigError> = judged.iter().filter_map(named).collect();
    errors.sort_by(|a, b| b.probability.total_cmp(&a.probability));
    errors
}

/// Returns the id that the runs of a group share, or the name of a run without one.
fn id(spec: &Spec, shared: &SharedError, datum: Option<usize>) -> String {
    let Some(datum) = datum.and_then(|place| spec.likelihood.data().get(place)) else {
        return String::new();
    };
    let run = &spec.experiment.runs[spec.fit_runs[datum.run]];
    let stated = shared.rig.and_then(|error| error.column.id(run));
    stated.unwrap_or(&run.name).to_owned()
}
