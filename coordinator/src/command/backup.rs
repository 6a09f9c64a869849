//! `coordinator backup`: a copy of a store.

use anyhow::bail;

use super::output::say;
use crate::config::BackupArguments;
use store::{IdPage, Reader, is_server, name_of};

pub(super) async fn backup(config: &BackupArguments) -> anyhow::Result<()> {
    if is_server(&config.store.store) {
        bail!(
            "--store {}: a server has backups of its own (pg_dump); coordinator copy-store copies a store from it to a file",
            name_of(&config.store.store)
        );
    }
    let reader = Reader::open(&config.store.store).await?;
    let bytes = reader.back_up(&config.file).await?;
    let copy = Reader::open(&config.file.display().to_string()).await?;
    let (studies, calibrations) = (copy.studies().await?, copy.calibrations(IdPage::ALL).await?);
    Ok(say(&format!(
        "{}: {:.1} MB, studies: {}, calibrations: {}\n",
        config.file.display(),
        bytes as f64 / 1e6,
        studies.len(),
        calibrations.len(),
    ))?)
}
