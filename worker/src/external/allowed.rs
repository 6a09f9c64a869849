//! The external models that this worker may run.
//!
//! A job names a program by its file name, or a server by its URL; a program runs only if the operator allows it, from the
//! operator's folder. So a job from the network can neither start anything else nor pass arguments.

use std::collections::BTreeMap;
use std::os::unix::fs::MetadataExt;
use std::path::PathBuf;
use std::sync::{Mutex, MutexGuard, PoisonError};
use std::time::Duration;

use sha2::{Digest, Sha256};
use shared::model::{ExternalModel, ExternalSource};
use tokio::runtime::Handle;

use super::group::ProcessGroups;
use super::umbridge::{CallError, UmbridgeServer};
use super::{ExternalFailure, ExternalRun, program};

/// The minimum time that a server gets to identify itself.
const PATIENCE: Duration = Duration::from_secs(5);

/// The external models that this worker may run.
#[derive(Debug, Default)]
pub struct AllowedModels {
    /// The programs by file name.
    programs: BTreeMap<String, PathBuf>,
    servers: Vec<UmbridgeServer>,
    /// The running programs.
    groups: ProcessGroups,
    /// The last identity of each model by its name; absent if the model could not be asked.
    identities: Mutex<BTreeMap<String, String>>,
    /// State and hash of a program's file: the contents are read again only when the state differs.
    hashes: Mutex<BTreeMap<String, (FileState, String)>>,
}

/// Inode, length `[bytes]` and time of the last change `[s, ns]`.
type FileState = (u64, u64, i64, i64);

/// Why a model cannot be allowed.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub enum AllowedModelError {
    /// The file of the program does not exist.
    #[error("--allow-model {0}: no such file; a server begins with http:// or https://")]
    NoFile(String),
    /// Two files have the same name.
    #[error("--allow-model {0}: another program of the same name is allowed already")]
    Twice(String),
    /// The HTTP client cannot be set up.
    #[error("--allow-model {0}: {1}")]
    Server(String, String),
}

impl AllowedModels {
    /// Reads the operator's list: files of programs, and URLs of UM-Bridge servers, which are called on `runtime`.
    /// [`AllowedModelError`] names the argument.
    pub fn new(allowed: &[String], runtime: &Handle) -> Result<Self, AllowedModelError> {
        let mut models = AllowedModels::default();
        for argument in allowed {
            if argument.starts_with("http://") || argument.starts_with("https://") {
                let server = UmbridgeServer::new(argument, runtime.clone());
                let server = server.map_err(|e| AllowedModelError::Server(argument.clone(), e))?;
                models.servers.push(server);
                continue;
            }
            let no_file = || AllowedModelError::NoFile(argument.clone());
            // A name without a folder is a file in the working folder, not a program of the search path.
            let path = PathBuf::from(argument).canonicalize().map_err(|_| no_file())?;
            let named = PathBuf::from(argument);
            let name = named
                .file_name()
                .and_then(|name| name.to_str())
                .ok_or_else(no_file)?;
            if !path.is_file() {
                return Err(no_file());
            }
            if models.programs.insert(name.to_owned(), path).is_some() {
                return Err(AllowedModelError::Twice(argument.clone()));
            }
        }
        Ok(models)
    }

    /// Returns whether nothing is allowed.
    pub fn is_empty(&self) -> bool {
        self.programs.is_empty() && self.servers.is_empty()
    }

    /// Returns the models that the worker announces: the last identity of each by its name.
    pub fn announced(&self) -> BTreeMap<String, String> {
        lock(&self.identities).clone()
    }

    /// Asks every model for its identity. A server that is too busy to answer keeps its last identity.
    pub async fn refresh(&self) {
        let mut seen = BTreeMap::new();
        for name in self.programs.keys() {
            match self.hash(name) {
                Ok(identity) => drop(seen.insert(name.clone(), identity)),
                Err(reason) => tracing::warn!(reason, "a program cannot be read"),
            }
        }
        for server in &self.servers {
            let name_of = |model: &str| format!("{} {model}", server.url());
            match server.identities(PATIENCE).await {
                Ok(models) => seen.extend(
                    models
                        .into_iter()
                        .map(|(model, identity)| (name_of(&model), identity)),
                ),
                Err(CallError::Slow) => {
                    let identities = lock(&self.identities);
                    let served = identities
                        .iter()
                        .filter(|(name, _)| name.starts_with(&name_of("")));
                    seen.extend(served.map(|(name, identity)| (name.clone(), identity.clone())));
                }
                Err(error) => {
                    let reason = error.words(server.url());
                    tracing::warn!(reason, "a UM-Bridge server does not say what it is");
                }
            }
        }
        *lock(&self.identities) = seen;
    }

    /// Asks for the identity of a model.
    ///
    /// A server gets as much time for it as for a run, because it may answer one request at a time. The error is a sentence:
    /// the model is not allowed, or cannot be asked.
    pub fn identify(&self, model: &ExternalModel) -> Result<String, String> {
        let name = model.source.name();
        let identity = match &model.source {
            ExternalSource::Command { program } => self.hash(program),
            ExternalSource::Umbridge { url, model: served } => self.server(url).and_then(|server| {
                let patience = PATIENCE.max(Duration::from_secs_f64(model.time_s));
                let models = server.runtime().block_on(server.identities(patience));
                let models = models.map_err(|error| error.words(url))?;
                let entry = models.into_iter().find(|(candidate, _)| candidate == served);
                entry
                    .map(|(_, identity)| identity)
                    .ok_or_else(|| format!("{url} has no model {served}"))
            }),
        };
        let mut identities = lock(&self.identities);
        match &identity {
            Ok(identity) => identities.insert(name, identity.clone()),
            Err(_) => identities.remove(&name),
        };
        identity
    }

    /// Evaluates all runs of a model.
    pub(crate) fn evaluate(
        &self,
        model: &ExternalModel,
        runs: &[ExternalRun],
    ) -> Result<Vec<Vec<f64>>, ExternalFailure> {
        match &model.source {
            ExternalSource::Command { program } => {
                let path = self.program(program).map_err(ExternalFailure::Machine)?;
                program::evaluate(path, model, runs, &self.groups)
            }
            ExternalSource::Umbridge { url, model: name } => {
                let server = self.server(url).map_err(ExternalFailure::Machine)?;
                server.evaluate(name, model, runs)
            }
        }
    }

    /// Kills the running programs, and starts no more.
    pub fn stop(&self) {
        self.groups.stop();
    }

    fn program(&self, name: &str) -> Result<&PathBuf, String> {
        self.programs.get(name).ok_or_else(|| not_allowed(name))
    }

    fn server(&self, url: &str) -> Result<&UmbridgeServer, String> {
        let mut servers = self.servers.iter();
        servers
            .find(|server| server.url() == url)
            .ok_or_else(|| not_allowed(url))
    }

    /// Returns the SHA-256 of a program's file.
    fn hash(&self, name: &str) -> Result<String, String> {
        let path = self.program(name)?;
        let failed = |e: std::io::Error| format!("{}: {e}", path.display());
        let file = std::fs::metadata(path).map_err(failed)?;
        let state = (file.ino(), file.len(), file.mtime(), file.mtime_nsec());
        if let Some((seen, hash)) = lock(&self.hashes).get(name)
            && *seen == state
        {
            return Ok(hash.clone());
        }
        let digest = Sha256::digest(std::fs::read(path).map_err(failed)?);
        let hex: String = digest[..8].iter().map(|byte| format!("{byte:02x}")).collect();
        let hash = format!("command-{hex}");
        lock(&self.hashes).insert(name.to_owned(), (state, hash.clone()));
        Ok(hash)
    }
}

fn not_allowed(name: &str) -> String {
    format!("this worker does not run {name}: its operator allows it by --allow-model")
}

fn lock<T>(mutex: &Mutex<T>) -> MutexGuard<'_, T> {
    mutex.lock().unwrap_or_else(PoisonError::into_inner)
}
