//! Recovery of unfinished calibrations when the coordinator starts.

use std::collections::BTreeMap;
use std::sync::Arc;

use super::error::ServiceError;
use super::stored_calibration::{calibration_row, experiment_files, spec_of};
use crate::calibration::{Calibration, CalibrationIdentity};
use crate::farm::dispatch::{Dispatcher, Stopped};
use crate::store::Store;

/// Takes up what is not over; returns what this version cannot take up, with the reason. Nothing is written
/// of those: another version may be able to.
pub(super) async fn recover(
    store: &Store,
    dispatcher: &Dispatcher,
) -> Result<BTreeMap<i64, String>, ServiceError> {
    let mut left_alone = BTreeMap::new();
    let reader = store.reader();
    for id in reader.unfinished().await? {
        let row = calibration_row(&reader, id).await?;
        // One calibration that this version cannot take up must not keep the others waiting.
        let spec = match spec_of(&reader, &row).await {
            Ok(spec) => Arc::new(spec),
            Err(error) => {
                left_alone.insert(id, error.to_string());
                continue;
            }
        };
        let stored = reader.stored(id, spec.algorithm.is_told_values()).await?;
        let evaluations = stored.evaluations.len();
        let identity = CalibrationIdentity {
            id,
            name: row.name.clone(),
            study: row.study,
            experiment: row.experiment,
        };
        let (job, experiment) = (row.job.clone(), experiment_files(&reader, row.experiment).await?);
        // Replaying is seconds of CPU for a long calibration: not on the async runtime.
        let replayed = tokio::task::spawn_blocking(move || {
            let mut calibration = Calibration::of(identity, spec, &job, &experiment)?;
            let facts = calibration.replay(stored).map_err(|e| e.to_string());
            Ok::<_, ServiceError>((calibration, facts))
        })
        .await
        .map_err(|_| Stopped)?;
        let (calibration, facts) = replayed?;
        let facts = match facts {
            Ok(facts) => facts,
            Err(reason) => {
                left_alone.insert(id, reason);
                continue;
            }
        };
        tracing::info!(
            id,
            name = row.name,
            evaluations,
            state = calibration.state.name(),
            "resumed"
        );
        let key = reader.seal_key(id).await?;
        dispatcher.add(calibration, key, facts).await?;
    }
    for (id, reason) in &left_alone {
        tracing::error!(id, reason, "not resumed: this version cannot read it");
    }
    Ok(left_alone)
}
