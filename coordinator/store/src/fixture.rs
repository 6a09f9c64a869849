//! A store with one calibration, for tests.

use std::collections::BTreeMap;

use inference::StageRecord;
use record::{EvaluationRow, Fact, Fingerprint, Kept, Membership, Role};
use shared::file::FileSet;
use tempfile::TempDir;

use super::{NewCalibrationRow, NewStudy, Store};

/// Makes a store in a folder of its own. Returns the store and the number of its calibration.
pub(super) async fn store() -> (TempDir, Store, i64) {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("grouser.db").display().to_string();
    let store = Store::open(&file, 0).await.unwrap();
    let files = || FileSet {
        toml: String::new(),
        files: BTreeMap::new(),
    };
    let experiment = store.writer().add_experiment(files(), 0).await.unwrap();
    let row = NewCalibrationRow {
        membership: Membership::submitted(Role::Sample),
        name: "sand".into(),
        job: files(),
    };
    let new = NewStudy {
        experiment,
        calibrations: vec![row],
        webhook: None,
        now_ms: 0,
    };
    let ids = store.writer().add_study(new).await.unwrap();
    (folder, store, ids.calibrations[0])
}

/// Makes the row of an evaluation that a worker has computed.
pub(super) fn row(evaluation: u64, worker: &str, fingerprint: i64) -> EvaluationRow {
    EvaluationRow {
        evaluation,
        theta: vec![1.0],
        log_likelihood: None,
        kept: Kept::Scored,
        fingerprint: Fingerprint(fingerprint),
        worker: worker.into(),
    }
}

/// Makes the facts of a dispute between two workers about evaluation 3.
pub(super) fn dispute(calibration: i64, first: &str, second: &str) -> Vec<Fact> {
    let evaluated = Fact::Evaluated {
        calibration,
        row: row(3, first, 1),
    };
    let duplicate = Fact::Duplicate {
        calibration,
        evaluation: 3,
        fingerprint: Fingerprint(2),
        worker: second.into(),
    };
    vec![evaluated, duplicate]
}

/// Makes the first stage of a sampler, without particles.
pub(super) fn stage() -> StageRecord {
    StageRecord {
        stage: 1,
        tempering_exponent: 1.0,
        acceptance: 0.5,
        drift_z: -0.0,
        weight_drift_z: 0.0,
        correlation: 0.25,
        steps: 3,
        log_evidence_increment: -1.5,
        weight_cov: 0.75,
        ess: 12.5,
        scale: 1.0,
        evaluations: 20,
        equilibrated: true,
        population: Vec::new(),
    }
}
