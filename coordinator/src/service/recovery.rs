//! Recovery of unfinished calibrations when the coordinator starts.

use std::collections::BTreeMap;
use std::sync::Arc;

use super::background::in_background;
use super::error::ServiceError;
use super::stored_calibration::{calibration_row, experiment_files, spec_of};
use farm::calibration::{Calibration, CalibrationIdentity, VerificationRule};
use farm::dispatch::{Dispatcher, Rewinds};
use store::{Reader, Store};

/// Resumes the calibrations that are not over. Returns those that cannot be resumed, with the reasons. Nothing is written about these,
/// because another version may resume them, or a backup may have an intact row.
pub(super) async fn recover(
    store: &Store,
    dispatcher: &Dispatcher,
    rule: &VerificationRule,
) -> Result<BTreeMap<i64, String>, ServiceError> {
    let mut left_alone = BTreeMap::new();
    let reader = store.reader();
    for id in reader.unfinished().await? {
        match take_up(&reader, dispatcher, id, rule).await {
            Ok(()) => {}
            Err(ServiceError::Stopped(stopped)) => return Err(stopped.into()),
            // A calibration that cannot be resumed must not stop the others.
            Err(error) => {
                tracing::error!(id, reason = %error, "not resumed");
                left_alone.insert(id, error.to_string());
            }
        }
    }
    Ok(left_alone)
}

/// Replays the calibrations that are rewound, until the farm ends.
pub(super) async fn rewind(
    store: Store,
    dispatcher: Dispatcher,
    mut rewinds: Rewinds,
    rule: VerificationRule,
) {
    while let Some((id, fact)) = rewinds.recv().await {
        if store.writer().durable(fact).await.is_err() {
            return;
        }
        let replayed = take_up(&store.reader(), &dispatcher, id, &rule).await;
        if let Err(error) = replayed {
            tracing::error!(id, reason = %error, "not replayed");
            // The farm may have ended.
            let _ = dispatcher.rewind_failed(id, error.to_string());
        }
    }
}

/// Replays a calibration and gives it to the farm.
async fn take_up(
    reader: &Reader,
    dispatcher: &Dispatcher,
    id: i64,
    rule: &VerificationRule,
) -> Result<(), ServiceError> {
    let row = calibration_row(reader, id).await?;
    let spec = Arc::new(spec_of(reader, &row).await?);
    let stored = reader.stored(id, spec.algorithm.is_told_values()).await?;
    let key = reader.seal_key(id).await?;
    let evaluations = stored.evaluations.len();
    let identity = CalibrationIdentity {
        id,
        name: row.name.clone(),
        study: row.study,
        experiment: row.experiment,
    };
    let experiment = experiment_files(reader, row.experiment).await?;
    let rule = rule.clone();
    let (calibration, facts) = in_background(move || {
        let calibration = Calibration::from_files(identity, spec, &row.job, &experiment)?;
        let mut calibration = calibration.verified(&rule, key);
        let facts = calibration.replay(stored)?;
        Ok::<_, ServiceError>((calibration, facts))
    })
    .await?;
    tracing::info!(
        id,
        name = calibration.identity.name,
        evaluations,
        state = calibration.state.name(),
        "resumed"
    );
    Ok(dispatcher.add(calibration, key, facts).await?)
}
