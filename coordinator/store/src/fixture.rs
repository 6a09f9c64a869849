//! A store with one calibration, for tests.

use std::collections::BTreeMap;

use record::{Membership, Role};
use shared::file::FileSet;
use tempfile::TempDir;

use super::{NewCalibrationRow, NewStudy, Store};

/// A store in a folder of its own, and the number of its calibration.
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
