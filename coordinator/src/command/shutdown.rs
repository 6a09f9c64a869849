//! The stop signal of a running program.

use tokio::sync::watch;

/// A signal that asks the program to stop.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum StopSignal {
    /// SIGINT, as from Ctrl-C.
    Interrupt,
    /// The signal SIGTERM.
    Terminate,
}

/// The error of a command that a signal stopped before its work was done.
#[derive(Debug, thiserror::Error)]
#[error("stopped; the same command resumes from here")]
pub struct Stopped(StopSignal);

impl Stopped {
    pub(super) fn by(signal: StopSignal) -> Self {
        Stopped(signal)
    }

    /// Returns the exit status: 128 plus the number of the signal, as in shells.
    pub fn exit_status(&self) -> u8 {
        match self.0 {
            StopSignal::Interrupt => 130,
            StopSignal::Terminate => 143,
        }
    }
}

/// Returns a future that is ready at SIGINT or SIGTERM.
pub(super) fn stop_signal() -> anyhow::Result<impl Future<Output = StopSignal> + Send + 'static> {
    use tokio::signal::unix::{SignalKind, signal};
    let mut terminate = signal(SignalKind::terminate())?;
    Ok(async move {
        tokio::select! {
            _ = terminate.recv() => StopSignal::Terminate,
            _ = tokio::signal::ctrl_c() => StopSignal::Interrupt,
        }
    })
}

/// A sender that tells the tasks of a command to stop.
pub(super) struct Shutdown(watch::Sender<bool>);

impl Shutdown {
    pub(super) fn new() -> Self {
        Shutdown(watch::Sender::new(false))
    }

    pub(super) fn now(&self) {
        self.0.send_replace(true);
    }

    /// Returns a future that is ready when it is time to stop.
    pub(super) fn wait(&self) -> impl Future<Output = ()> + Send + 'static {
        let mut stopped = self.0.subscribe();
        async move { drop(stopped.wait_for(|s| *s).await) }
    }
}
