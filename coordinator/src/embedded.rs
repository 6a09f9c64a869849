//! Local workers in this process, and the program `worker` as a verb; the only place that knows the worker.

use std::future::Future;
use std::sync::Arc;

use shared::exchange::{ExchangeRequest, ExchangeResponse, WorkResult};
use shared::model::{ExternalModel, ModelVariant};
use shared::outcome::Outcome;
use statistics::{Subchain, SubchainEnd};
use tokio::sync::watch;
use worker::evaluator::SimulationClock;
use worker::external::allowed::AllowedModels;
use worker::pull::exchange::{Coordinator, ExchangeError};
use worker::pull::limits::WorkerLimits;
use worker::pull::{PullSettings, run};

use farm::dispatch::Dispatcher;

pub use worker::config::WorkerConfig;
pub use worker::program::ProgramError as WorkerError;

/// Whether this machine can run what was built; asked before anything else.
///
/// # Errors
/// A sentence that says how to build for this machine.
pub fn check_processor() -> Result<(), String> {
    worker::processor::check().map_err(|e| e.to_string())
}

/// Does what the program `worker` does.
pub async fn work(config: WorkerConfig) -> Result<(), WorkerError> {
    worker::program::execute(config).await
}

/// The farm as a worker in the same process sees it.
///
/// It does not wait for the store: such a worker dies with the coordinator, so nobody could resend what was
/// acknowledged too early, and a lost evaluation is computed again to the same bits.
struct InProcess(Dispatcher);

impl Coordinator for InProcess {
    async fn exchange(
        &self,
        request: ExchangeRequest,
    ) -> Result<ExchangeResponse, (ExchangeError, Vec<WorkResult>)> {
        match self.0.exchange(request).await {
            Ok((response, _)) => Ok(response),
            Err(stopped) => Err((ExchangeError::Refused(stopped.to_string()), Vec::new())),
        }
    }

    async fn variant(&self, hash: &str) -> Result<Option<ModelVariant>, ExchangeError> {
        self.0
            .variant(hash.to_owned())
            .await
            .map_err(|e| ExchangeError::Refused(e.to_string()))
    }
}

/// Local workers and what they have done.
#[derive(Debug)]
pub struct LocalWorkers {
    /// How many threads simulate.
    pub threads: usize,
    clock: Arc<SimulationClock>,
    failure: watch::Receiver<Option<String>>,
    task: tokio::task::JoinHandle<()>,
}

/// Version of the equations of our models that local workers compute.
pub fn model_version() -> &'static str {
    worker::model_version()
}

/// The models that are not ours that local workers run, as their operator allows.
#[derive(Debug, Clone, Default)]
pub struct LocalModels(Arc<AllowedModels>);

impl LocalModels {
    /// Reads what the operator allows; to be called on a runtime.
    ///
    /// # Errors
    /// A sentence that names the argument.
    pub fn new(allowed: &[String]) -> Result<Self, String> {
        let models = AllowedModels::new(allowed, &tokio::runtime::Handle::current());
        models
            .map(|models| LocalModels(Arc::new(models)))
            .map_err(|e| e.to_string())
    }

    /// Version of the equations that local workers compute for a model: of ours, or that of one that is not; asks it, and blocks.
    ///
    /// # Errors
    /// A sentence: the model is not allowed here, or does not answer.
    pub fn equations(&self, external: Option<&ExternalModel>) -> Result<String, String> {
        match external {
            None => Ok(model_version().to_owned()),
            Some(model) => self.0.identify(model),
        }
    }
}

/// Process and time: fresh for every process, also where each is the first of its container.
fn local_name() -> String {
    let since = std::time::SystemTime::now().duration_since(std::time::UNIX_EPOCH);
    format!(
        "local-{}-{:x}",
        std::process::id(),
        since.map_or(0, |d| d.as_millis())
    )
}

impl LocalWorkers {
    /// Starts so many threads; they stop when `shutdown` is ready.
    pub fn start(
        dispatcher: Dispatcher,
        threads: usize,
        models: &LocalModels,
        shutdown: impl Future<Output = ()> + Send + 'static,
    ) -> Self {
        let clock = Arc::new(SimulationClock::default());
        let settings = PullSettings {
            name: local_name(),
            queue_job: None,
            threads,
            limits: WorkerLimits::default(),
            models: models.0.clone(),
        };
        let work = run(Arc::new(InProcess(dispatcher)), settings, clock.clone(), shutdown);
        let (failed, failure) = watch::channel(None);
        let task = tokio::spawn(async move {
            if let Err(error) = work.await {
                failed.send_replace(Some(error.to_string()));
            }
        });
        LocalWorkers {
            threads,
            clock,
            failure,
            task,
        }
    }

    /// Ready with the reason when the workers have failed; never, as long as they have not.
    pub fn failure(&self) -> impl Future<Output = String> + Send + 'static {
        let mut failure = self.failure.clone();
        async move {
            let reason = match failure.wait_for(Option::is_some).await {
                Ok(reason) => reason.clone(),
                Err(_) => None,
            };
            match reason {
                Some(reason) => reason,
                None => std::future::pending().await,
            }
        }
    }

    /// Seconds spent simulating, summed over the threads.
    pub fn simulated_s(&self) -> f64 {
        self.clock.simulated_s()
    }

    /// Waits until the threads have given back what they held.
    pub async fn join(self) {
        // A panic of the task has been logged where it happened.
        let _ = self.task.await;
    }
}

/// A variant evaluated in this thread, without a farm: for pilots and signatures.
#[derive(Debug)]
pub struct Evaluate(worker::model::CompiledVariant);

impl Evaluate {
    /// Makes a variant of one of our models ready.
    ///
    /// # Errors
    /// A sentence that names what is not known.
    pub fn new(variant: &ModelVariant) -> Result<Self, String> {
        Self::with(variant, &LocalModels::default())
    }

    /// The same of any model that is allowed here.
    ///
    /// # Errors
    /// A sentence that names what is not known.
    pub fn with(variant: &ModelVariant, models: &LocalModels) -> Result<Self, String> {
        worker::model::CompiledVariant::new(variant, &models.0)
            .map(Evaluate)
            .map_err(|e| e.to_string())
    }

    /// Simulates every condition at one parameter vector.
    pub fn evaluate(&self, theta: &[f64]) -> Outcome {
        self.0.evaluate(theta)
    }

    /// Evaluates what a lease would ask for.
    pub fn serve(
        &self,
        theta: &[f64],
        subchain: Option<&Subchain>,
    ) -> (Option<Outcome>, Option<SubchainEnd>) {
        self.0.serve(theta, subchain)
    }

    /// Drawbar pull `[N]`, torque \[N m\] and sinkage `[m]` of every condition, each alone: a refusal leaves the others.
    pub fn each(&self, theta: &[f64]) -> Vec<Result<[f64; 3], String>> {
        let channels = self.0.each(theta).into_iter();
        channels
            .map(|a| {
                a.map(|a| [a.drawbar_pull_n, a.torque_n_m, a.sinkage_m])
                    .map_err(|rejection| rejection.message)
            })
            .collect()
    }
}
