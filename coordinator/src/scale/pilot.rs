//! Pilots: what each is told, and which there are.

use std::collections::BTreeSet;
use std::path::PathBuf;

/// What every pilot is told.
#[derive(Debug, Clone, PartialEq)]
pub struct PilotSettings {
    /// Name of the jobs, or of the deployment.
    pub name: String,
    /// URL of the service as workers reach it.
    pub coordinator: String,
    pub worker: String,
    /// Threads that simulate.
    pub threads: u32,
    /// It ends after so long without work `[s]`.
    pub max_idle_s: f64,
    /// File with the token of the service.
    pub token_file: Option<PathBuf>,
    /// Certificate of the service's authority.
    pub ca_certificate: Option<PathBuf>,
    /// Further options for the program of the engine.
    pub options: Vec<String>,
}

impl PilotSettings {
    /// The environment of a pilot: names and values, as the program `worker` and `pilot.sh` read them.
    pub(super) fn environment(&self) -> Vec<(&'static str, String)> {
        let mut variables = vec![
            ("GROUSER_COORDINATOR", self.coordinator.clone()),
            ("GROUSER_WORKER", self.worker.clone()),
            ("GROUSER_THREADS", self.threads.to_string()),
            ("GROUSER_MAX_IDLE", self.max_idle_s.to_string()),
        ];
        let files = [
            ("GROUSER_TOKEN_FILE", &self.token_file),
            ("GROUSER_CA_CERTIFICATE", &self.ca_certificate),
        ];
        let named = |(name, file): (_, &Option<PathBuf>)| Some((name, file.as_ref()?.display().to_string()));
        variables.extend(files.into_iter().filter_map(named));
        variables
    }
}

/// The pilots of an engine, by the names that it gives them.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct Pilots {
    /// Those that wait for a machine.
    pub pending: Vec<String>,
    /// Those that run, or are about to.
    pub running: Vec<String>,
}

impl Pilots {
    /// How many there are.
    pub fn count(&self) -> u32 {
        u32::try_from(self.pending.len() + self.running.len()).unwrap_or(u32::MAX)
    }

    /// The names of all.
    pub(super) fn names(&self) -> BTreeSet<String> {
        self.pending.iter().chain(&self.running).cloned().collect()
    }
}
