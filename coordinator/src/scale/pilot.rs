//! Pilots: their settings, and the list of present ones.

use std::collections::BTreeSet;
use std::path::PathBuf;

/// The settings of every pilot.
#[derive(Debug, Clone, PartialEq)]
pub struct PilotSettings {
    /// Name of the jobs, or of the deployment.
    pub name: String,
    /// The URL of the service for workers.
    pub coordinator: String,
    pub worker: String,
    /// The number of simulation threads.
    pub threads: u32,
    /// The time without work after which a pilot ends `[s]`.
    pub max_idle_s: f64,
    /// The file with the token of the service.
    pub token_file: Option<PathBuf>,
    /// The certificate of the service's authority.
    pub ca_certificate: Option<PathBuf>,
    /// Further options for the program of the engine.
    pub options: Vec<String>,
}

impl PilotSettings {
    /// Returns the environment of a pilot: names and values, as the program `worker` and `pilot.sh` read them.
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
    /// The pilots that wait for a machine.
    pub pending: Vec<String>,
    /// The pilots that run, or are about to.
    pub running: Vec<String>,
}

impl Pilots {
    /// Returns the number of pilots.
    pub fn count(&self) -> u32 {
        u32::try_from(self.pending.len() + self.running.len()).unwrap_or(u32::MAX)
    }

    /// Returns the names of all pilots.
    pub(super) fn names(&self) -> BTreeSet<String> {
        self.pending.iter().chain(&self.running).cloned().collect()
    }
}
