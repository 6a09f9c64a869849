//! `coordinator scale`: starts and ends workers on machines of a queue, according to the work of a service.

use std::time::{Duration, Instant};

use anyhow::{Context, bail};
use shared::api::WorkDemand;

use super::place::Place;
use super::shutdown::stop_signal;
use crate::config::{EngineKind, ScaleArguments};
use crate::scale::budget::{Cost, Vain};
use crate::scale::engine::{Engine, SLURM_PILOT};
use crate::scale::pilot::PilotSettings;
use crate::scale::policy::{Patience, Policy};

pub(super) async fn scale(arguments: &ScaleArguments) -> anyhow::Result<()> {
    if arguments.min > arguments.max {
        bail!("--min {} must be at most --max {}", arguments.min, arguments.max);
    }
    let service = Place::at(&arguments.url, &arguments.client)?;
    let mut scaler = Scaler {
        service,
        engine: engine(arguments)?,
        settings: settings(arguments)?,
        policy: Policy {
            min: arguments.min,
            max: arguments.max,
            threads: arguments.threads,
            finish_within_s: arguments.finish_within,
        },
        cost: Cost::default(),
        vain: Vain::default(),
        patience: Patience::default(),
        seen: Instant::now(),
    };
    if arguments.once {
        return scaler.round(None).await.map(drop);
    }
    let stop = stop_signal()?;
    tokio::pin!(stop);
    loop {
        // A round may fail while the service or the queue restarts, and the next one may succeed.
        match scaler.round(arguments.cost_cap_thread_h).await {
            Ok(Round::Spent) => return Ok(()),
            Ok(Round::Done) => {}
            Err(error) => tracing::warn!("nothing is changed: {error:#}"),
        }
        tokio::select! {
            _ = &mut stop => {
                tracing::info!("stopped; pilots end by themselves when they have nothing to do");
                return Ok(());
            }
            () = tokio::time::sleep(Duration::from_secs_f64(arguments.every)) => {}
        }
    }
}

fn engine(arguments: &ScaleArguments) -> anyhow::Result<Engine> {
    Ok(match (arguments.engine, &arguments.script) {
        (EngineKind::Slurm, None) => Engine::Slurm {
            script: SLURM_PILOT.to_owned(),
        },
        (EngineKind::Slurm, Some(file)) => Engine::Slurm {
            script: std::fs::read_to_string(file).with_context(|| file.display().to_string())?,
        },
        (_, Some(_)) => bail!("--script: only Slurm has batch scripts"),
        (EngineKind::HyperQueue, None) => Engine::HyperQueue,
        (EngineKind::Kubernetes, None) => Engine::Kubernetes,
    })
}

fn settings(arguments: &ScaleArguments) -> anyhow::Result<PilotSettings> {
    // Relative paths are made absolute, because each pilot starts in another folder.
    let whole = |file: &Option<std::path::PathBuf>| {
        let whole = file.as_ref().map(std::path::absolute).transpose();
        whole.context("the current folder")
    };
    Ok(PilotSettings {
        name: arguments.name.clone(),
        coordinator: arguments.worker_url.as_ref().unwrap_or(&arguments.url).clone(),
        worker: arguments.worker.clone(),
        threads: arguments.threads,
        max_idle_s: arguments.max_idle,
        token_file: whole(&arguments.client.token_file)?,
        ca_certificate: whole(&arguments.client.ca_certificate)?,
        options: arguments.options.clone(),
    })
}

/// The result of a round.
enum Round {
    Done,
    /// The limit of the cost is reached, and all pilots are ended.
    Spent,
}

/// The rounds, each of which reads the waiting work and the pilots, and starts or ends pilots.
struct Scaler {
    service: Place,
    engine: Engine,
    settings: PilotSettings,
    policy: Policy,
    cost: Cost,
    vain: Vain,
    patience: Patience,
    /// Time of the last round.
    seen: Instant,
}

impl Scaler {
    async fn round(&mut self, cap_thread_h: Option<f64>) -> anyhow::Result<Round> {
        let pilots = self.engine.pilots(&self.settings).await?;
        let elapsed = std::mem::replace(&mut self.seen, Instant::now()).elapsed();
        let threads = pilots.running.len() as u64 * u64::from(self.settings.threads);
        self.cost.add(threads, elapsed);
        if let Some(cap) = cap_thread_h.filter(|&cap| self.cost.thread_h() >= cap) {
            let end = self.engine.end(&self.settings, &pilots);
            let ended = end.ended;
            end.make().await?;
            let cost = self.cost.thread_h();
            tracing::warn!(
                ended,
                "pilots have cost {cost:.2} of {cap} thread-hours: all are ended"
            );
            return Ok(Round::Spent);
        }
        let demand: WorkDemand = self.service.get("/v1/work/demand").await?;
        let computed = demand.completed_in_queues;
        if let Some(pause) = self.vain.seen(&pilots, computed, demand.queued > 0, elapsed) {
            tracing::warn!(
                "pilots ended while work waits, and none has sent a result; the next are started in {} s: their log says why",
                pause.as_secs()
            );
        }
        let present = pilots.count();
        let wanted = self.policy.wanted(&demand, present);
        let idle = Duration::from_secs_f64(self.settings.max_idle_s);
        let wanted = self
            .patience
            .wanted(wanted, present, demand.in_hand > 0, elapsed, idle);
        let wanted = match self.vain.may_start() {
            true => wanted,
            false => wanted.min(present),
        };
        let change = self.engine.resize(&self.settings, &pilots, wanted);
        let (started, ended) = (change.started, change.ended);
        if ended > 0 {
            self.vain.took_back();
        }
        change.make().await?;
        if started + ended > 0 {
            tracing::info!(
                queued = demand.queued,
                leased = demand.leased,
                evaluations_left = demand.evaluations_left,
                evaluation_s = demand.evaluation_s,
                pending = pilots.pending.len(),
                running = pilots.running.len(),
                wanted,
                started,
                ended,
                thread_h = self.cost.thread_h(),
                "pilots"
            );
        }
        Ok(Round::Done)
    }
}
