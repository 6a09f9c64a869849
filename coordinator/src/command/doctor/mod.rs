//! `coordinator doctor`: checks machine, store and service, and proposes remedies.
//!
//! # Layout
//! - `finding`: the result of a check.
//! - `machine`: program, processor, clock, file descriptors.
//! - `place`: the store, its disk, the listening address.
//! - `service`: a service, the token for it, its workers.

mod finding;
mod machine;
mod place;
mod service;

use anyhow::bail;

use super::output::say;
use crate::config::DoctorArguments;
use finding::Finding;

pub(super) async fn doctor(config: &DoctorArguments) -> anyhow::Result<()> {
    let mut findings = machine::findings();
    findings.extend(place::findings(&config.store.store, config.listen).await);
    if let Some(url) = &config.url {
        findings.extend(service::findings(url, &config.client).await);
    }
    let text: String = findings.iter().map(Finding::to_string).collect();
    say(&text)?;
    match findings.iter().filter(|finding| finding.is_failure()).count() {
        0 => Ok(()),
        failed => bail!("{failed} of {} checks failed", findings.len()),
    }
}
