//! The verbs of the command line.

mod check;
mod effects;
mod folder;
mod growth;
mod job_on_disk;
mod output;
mod progress;
mod run;
mod serve;
mod source;
mod verbs;

use tokio::sync::watch;

use crate::config::Command;

/// Carries out a verb.
///
/// # Errors
/// Whatever went wrong, as one chain of sentences.
pub async fn execute(command: Command) -> anyhow::Result<()> {
    match command {
        Command::Run(run) => run::run(run).await,
        Command::Check(file) => check::check(&file).await,
        Command::Serve(serve) => serve::serve(serve).await,
        Command::Submit(submit) => verbs::submit(&submit).await,
        Command::List(source) => verbs::list(&source).await,
        Command::Status(target) => verbs::status(&target).await,
        Command::Cancel(target) => verbs::control(&target, "cancel").await,
        Command::Pause(target) => verbs::control(&target, "pause").await,
        Command::Resume(target) => verbs::control(&target, "resume").await,
        Command::Compare(target) => verbs::compare(&target).await,
        Command::Report(report) => verbs::report(&report).await,
        Command::Export(export) => verbs::export(&export).await,
        Command::Diagnose(target) => verbs::diagnose(&target).await,
        Command::Discover(discover) => growth::discover(&discover).await,
        Command::Extend(extend) => growth::extend(&extend).await,
        Command::AddRuns(runs) => growth::add_runs(&runs).await,
        Command::Effects(config) => effects::effects(&config).await,
    }
}

/// Ready at ^C or SIGTERM.
fn stop_signal() -> anyhow::Result<impl Future<Output = ()> + Send + 'static> {
    use tokio::signal::unix::{SignalKind, signal};
    let mut terminate = signal(SignalKind::terminate())?;
    Ok(async move {
        tokio::select! {
            _ = terminate.recv() => {}
            _ = tokio::signal::ctrl_c() => {}
        }
    })
}

/// Tells everything that was started here to stop.
struct Stop(watch::Sender<bool>);

impl Stop {
    fn new() -> Self {
        Stop(watch::Sender::new(false))
    }

    fn now(&self) {
        self.0.send_replace(true);
    }

    /// Ready when it is time to stop.
    fn wait(&self) -> impl Future<Output = ()> + Send + 'static {
        let mut stopped = self.0.subscribe();
        async move { drop(stopped.wait_for(|s| *s).await) }
    }
}
