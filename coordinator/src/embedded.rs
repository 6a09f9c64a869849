//! Local workers in this process, and the verb `worker`. No other file uses the crate `worker`.

use std::future::Future;
use std::sync::Arc;

use prediction::recording::CompiledModel;
use shared::channel::Channel;
use shared::exchange::{ExchangeRequest, ExchangeResponse, WorkResult};
use shared::model::{ExternalModel, ModelVariant};
use shared::outcome::Outcome;
use tokio::sync::watch;
use worker::evaluator::SimulationClock;
use worker::external::allowed::AllowedModels;
use worker::pull::exchange::{Coordinator, ExchangeError};
use worker::pull::limits::WorkerLimits;
use worker::pull::{PullSettings, run};

use farm::dispatch::Dispatcher;

pub use worker::config::WorkerConfig;
pub use worker::program::ProgramError as WorkerError;

/// Checks that this machine can run the program. This is called before anything else.
///
/// # Errors
/// A sentence that tells how to build for this machine.
pub fn check_processor() -> Result<(), String> {
    worker::processor::check().map_err(|e| e.to_string())
}

/// Runs the program `worker`.
pub async fn work(config: WorkerConfig) -> Result<(), WorkerError> {
    worker::program::execute(config).await
}

/// The farm as the coordinator of a worker in the same process.
///
/// Its answers do not wait for the store. If the process ends, its workers end too, so they cannot resend lost results; a restart computes
/// these again, to the same bits.
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

/// Local workers and their state.
#[derive(Debug)]
pub struct LocalWorkers {
    /// The number of simulation threads.
    pub threads: usize,
    clock: Arc<SimulationClock>,
    failure: watch::Receiver<Option<String>>,
    task: tokio::task::JoinHandle<()>,
}

/// Returns the version of the built-in equations that local workers compute.
pub fn model_version() -> &'static str {
    worker::model_version()
}

/// The external models that local workers run, as their operator allows.
#[derive(Debug, Clone, Default)]
pub struct LocalModels(Arc<AllowedModels>);

impl LocalModels {
    /// Reads the models that the operator allows. It must be called on a runtime.
    ///
    /// # Errors
    /// A sentence that names the argument.
    pub fn new(allowed: &[String]) -> Result<Self, String> {
        let models = AllowedModels::new(allowed, &tokio::runtime::Handle::current());
        models
            .map(|models| LocalModels(Arc::new(models)))
            .map_err(|e| e.to_string())
    }

    /// Returns the version of the equations that local workers compute for a model. An external model is asked for its version, which
    /// blocks.
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

/// Returns a name from process id and time. It is new for every process, even where each has the same id in its container.
fn local_name() -> String {
    let since = std::time::SystemTime::now().duration_since(std::time::UNIX_EPOCH);
    format!(
        "local-{}-{:x}",
        std::process::id(),
        since.map_or(0, |d| d.as_millis())
    )
}

impl LocalWorkers {
    /// Starts simulation threads, which stop when `shutdown` is ready.
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

    /// Returns a future that yields the reason once the workers have failed, and never otherwise.
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

    /// Returns the seconds spent simulating, summed over the threads.
    pub fn simulated_s(&self) -> f64 {
        self.clock.simulated_s()
    }

    /// Waits until the threads have returned their leases.
    pub async fn join(self) {
        // A panic of the task has been logged where it happened.
        let _ = self.task.await;
    }
}

/// A variant that is evaluated in this thread without a farm, for pilots and signatures.
#[derive(Debug)]
pub struct Evaluate(worker::model::CompiledVariant);

impl Evaluate {
    /// Compiles a variant of a built-in model.
    ///
    /// # Errors
    /// A sentence that names the unknown part.
    pub fn new(variant: &ModelVariant) -> Result<Self, String> {
        Self::with(variant, &LocalModels::default())
    }

    /// Compiles a variant of any model that is allowed here.
    ///
    /// # Errors
    /// A sentence that names the unknown part.
    pub fn with(variant: &ModelVariant, models: &LocalModels) -> Result<Self, String> {
        worker::model::CompiledVariant::new(variant, &models.0)
            .map(Evaluate)
            .map_err(|e| e.to_string())
    }

    /// Returns the model of the only condition of a variant, as a recording is followed by it.
    pub fn at_one_condition(self) -> CompiledModel {
        Box::new(move |theta| match self.evaluate(theta) {
            Outcome::Evaluated(observables) => {
                let value = |channel| observables.channel(channel).first().copied().unwrap_or(f64::NAN);
                Ok(Some(Channel::ALL.map(value)))
            }
            Outcome::Rejected(_) => Ok(None),
            Outcome::Fault(fault) => Err(fault.message),
        })
    }

    /// Simulates every condition at one parameter vector.
    pub fn evaluate(&self, theta: &[f64]) -> Outcome {
        self.0.evaluate(theta)
    }

    /// Evaluates every condition alone, so that a rejection leaves the others. Returns drawbar pull `[N]`, torque \[N m\] and sinkage
    /// `[m]`.
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
