//! Which models that are not ours this worker runs.
//!
//! A job names a program by its file name, or a server by its URL; only what the operator has allowed is run, and where a program
//! lies is the operator's choice. So a job from the network starts nothing else, and gives no arguments.

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

/// Shortest time that a server has to say what it is.
const PATIENCE: Duration = Duration::from_secs(5);

/// The models that are not ours that this worker runs.
#[derive(Debug, Default)]
pub struct AllowedModels {
    /// By file name.
    programs: BTreeMap<String, PathBuf>,
    servers: Vec<UmbridgeServer>,
    /// The programs that run.
    groups: ProcessGroups,
    /// The identity of each model by its name, as last seen; absent where it cannot be asked.
    identities: Mutex<BTreeMap<String, String>>,
    /// What is known of a program's file: its contents are read again only where this differs.
    hashes: Mutex<BTreeMap<String, (FileState, String)>>,
}

/// Inode, length `[bytes]` and time of the last change `[s, ns]`.
type FileState = (u64, u64, i64, i64);

/// Why a model cannot be allowed.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub enum AllowedModelError {
    /// There is no such file.
    #[error("--allow-model {0}: no such file; a server begins with http:// or https://")]
    NoFile(String),
    /// Two files have one name.
    #[error("--allow-model {0}: another program of the same name is allowed already")]
    Twice(String),
    /// The HTTP client cannot be set up.
    #[error("--allow-model {0}: {1}")]
    Server(String, String),
}

impl AllowedModels {
    /// Reads what the operator allows: files of programs, and URLs of UM-Bridge servers, which are talked to on `runtime`.
    ///
    /// # Errors
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
            // A name without a folder is a file here, not a program of the search path.
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

    /// Whether nothing is allowed.
    pub fn is_empty(&self) -> bool {
        self.programs.is_empty() && self.servers.is_empty()
    }

    /// What a worker says that it runs: the identity of each model by its name, as last seen.
    pub fn announced(&self) -> BTreeMap<String, String> {
        lock(&self.identities).clone()
    }

    /// Asks every model for its identity again. A server that is too busy to say is taken for what it was.
    pub async fn refresh(&self) {
        let mut seen = BTreeMap::new();
        for name in self.programs.keys() {
            match self.hash(name) {
                Ok(identity) => drop(seen.insert(name.clone(), identity)),
                Err(reason) => tracing::warn!(reason, "a program cannot be read"),
            }
        }
        for server in &self.servers {
            let of = |model: &str| format!("{} {model}", server.url());
            match server.identities(PATIENCE).await {
                Ok(models) => seen.extend(models.into_iter().map(|(model, identity)| (of(&model), identity))),
                Err(CallError::Slow) => {
                    let known = lock(&self.identities);
                    let own = known.iter().filter(|(name, _)| name.starts_with(&of("")));
                    seen.extend(own.map(|(name, identity)| (name.clone(), identity.clone())));
                }
                Err(error) => {
                    let reason = error.words(server.url());
                    tracing::warn!(reason, "a UM-Bridge server does not say what it is");
                }
            }
        }
        *lock(&self.identities) = seen;
    }

    /// The identity of a model, asked for again. A server may take as long for it as for a run: it may answer one request at a time.
    ///
    /// # Errors
    /// A sentence: it is not allowed, or cannot be asked.
    pub fn identify(&self, model: &ExternalModel) -> Result<String, String> {
        let name = model.source.name();
        let identity = match &model.source {
            ExternalSource::Command { program } => self.hash(program),
            ExternalSource::Umbridge { url, model: own } => self.server(url).and_then(|server| {
                let patience = PATIENCE.max(Duration::from_secs_f64(model.time_s));
                let models = server.runtime().block_on(server.identities(patience));
                let models = models.map_err(|error| error.words(url))?;
                let model = own;
                let own = models.into_iter().find(|(own, _)| own == model);
                own.map(|(_, identity)| identity)
                    .ok_or_else(|| format!("{url} has no model {model}"))
            }),
        };
        let mut identities = lock(&self.identities);
        match &identity {
            Ok(identity) => identities.insert(name, identity.clone()),
            Err(_) => identities.remove(&name),
        };
        identity
    }

    /// Evaluates all runs.
    ///
    /// # Errors
    /// [`ExternalFailure`].
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

    /// Kills the programs that run, and begins none any more.
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

    /// The SHA-256 of a program's file.
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
