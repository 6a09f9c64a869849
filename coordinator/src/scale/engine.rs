//! The engines that start pilots: Slurm, HyperQueue, Kubernetes.

use super::pilot::{PilotSettings, Pilots};
use super::program::{Invocation, ProgramError};
use super::{hyperqueue, kubernetes, slurm};

/// An engine that starts pilots.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Engine {
    /// Slurm, with the batch script of a pilot.
    Slurm {
        /// Text of the script.
        script: String,
    },
    /// HyperQueue.
    HyperQueue,
    /// A deployment in Kubernetes.
    Kubernetes,
}

/// The default batch script of a pilot of Slurm.
pub const SLURM_PILOT: &str = include_str!("../../../deploy/slurm/pilot.sh");

/// A change of the number of pilots, as calls of the engine's program.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct Change {
    /// The number of pilots to start.
    pub started: u32,
    /// The number of pilots to end.
    pub ended: u32,
    pub(super) invocations: Vec<Invocation>,
}

impl Engine {
    /// Asks the engine for its pilots.
    pub async fn pilots(&self, settings: &PilotSettings) -> Result<Pilots, ProgramError> {
        match self {
            Engine::Slurm { .. } => slurm::pilots(&slurm::list(settings).run().await?),
            Engine::HyperQueue => hyperqueue::pilots(&hyperqueue::list().run().await?, settings),
            Engine::Kubernetes => kubernetes::pilots(&kubernetes::list(settings).run().await?),
        }
    }

    /// Returns the change that brings the number of pilots to the wanted one.
    ///
    /// Kubernetes ends surplus pods. Of other engines, only waiting pilots are cancelled, and running pilots end by themselves when they
    /// have no work.
    pub fn resize(&self, settings: &PilotSettings, pilots: &Pilots, wanted: u32) -> Change {
        let present = pilots.count();
        let started = wanted.saturating_sub(present);
        let too_many = present.saturating_sub(wanted);
        let (ended, invocations) = match self {
            Engine::Kubernetes => (too_many, vec![kubernetes::set(settings, wanted)]),
            Engine::Slurm { .. } | Engine::HyperQueue if too_many > 0 => {
                let waiting = pilots.pending.len();
                let ended = waiting.min(too_many as usize);
                // The newest pilots are cancelled first, because they would wait longest.
                let cancelled = self.cancel(&pilots.pending[waiting - ended..]);
                (ended as u32, Vec::from_iter(cancelled))
            }
            Engine::Slurm { script } => (0, slurm::start(settings, script, started)),
            Engine::HyperQueue => (0, hyperqueue::start(settings, started)),
        };
        match started + ended {
            0 => Change::default(),
            _ => Change {
                started,
                ended,
                invocations,
            },
        }
    }

    /// Returns the change that ends all pilots.
    pub fn end(&self, settings: &PilotSettings, pilots: &Pilots) -> Change {
        let all = [&pilots.pending[..], &pilots.running[..]].concat();
        Change {
            started: 0,
            ended: pilots.count(),
            invocations: match self {
                Engine::Kubernetes => vec![kubernetes::set(settings, 0)],
                Engine::Slurm { .. } | Engine::HyperQueue => Vec::from_iter(self.cancel(&all)),
            },
        }
    }

    /// Returns the call that cancels pilots by their names.
    fn cancel(&self, pilots: &[String]) -> Option<Invocation> {
        match self {
            _ if pilots.is_empty() => None,
            Engine::Slurm { .. } => Some(slurm::cancel(pilots)),
            Engine::HyperQueue => Some(hyperqueue::cancel(pilots)),
            Engine::Kubernetes => None,
        }
    }
}

impl Change {
    /// Calls the engine's programs.
    pub async fn make(self) -> Result<(), ProgramError> {
        for invocation in self.invocations {
            invocation.run().await?;
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn settings() -> PilotSettings {
        PilotSettings {
            name: "w".into(),
            coordinator: "http://keeper:7070".into(),
            worker: "worker".into(),
            threads: 4,
            max_idle_s: 120.0,
            token_file: None,
            ca_certificate: None,
            options: Vec::new(),
        }
    }

    fn pilots(pending: &[&str], running: &[&str]) -> Pilots {
        let owned = |names: &[&str]| names.iter().map(|&name| name.to_owned()).collect();
        Pilots {
            pending: owned(pending),
            running: owned(running),
        }
    }

    #[test]
    fn too_many_that_wait_are_taken_back_and_those_that_run_are_left() {
        let there = pilots(&["7_1", "7_2"], &["7_0"]);
        for (engine, program) in [
            (
                Engine::Slurm {
                    script: String::new(),
                },
                "scancel",
            ),
            (Engine::HyperQueue, "hq"),
        ] {
            let change = engine.resize(&settings(), &there, 2);
            assert_eq!((change.started, change.ended), (0, 1));
            assert_eq!(change.invocations[0].program, program);
            assert_eq!(change.invocations[0].arguments.last().unwrap(), "7_2");
            assert_eq!(engine.resize(&settings(), &there, 0).ended, 2);
            assert_eq!(engine.resize(&settings(), &there, 3), Change::default());
            assert_eq!(
                engine.resize(&settings(), &pilots(&[], &["1"]), 0),
                Change::default()
            );
            assert_eq!(engine.end(&settings(), &there).ended, 3);
            assert!(engine.end(&settings(), &pilots(&[], &[])).invocations.is_empty());
        }
    }

    #[test]
    fn replicas_are_set_where_they_are_others() {
        let there = pilots(&["pod"], &["pod"]);
        let change = Engine::Kubernetes.resize(&settings(), &there, 5);
        assert_eq!((change.started, change.ended), (3, 0));
        assert_eq!(change.invocations, [kubernetes::set(&settings(), 5)]);
        assert_eq!(Engine::Kubernetes.resize(&settings(), &there, 1).ended, 1);
        assert_eq!(
            Engine::Kubernetes.resize(&settings(), &there, 2),
            Change::default()
        );
    }
}
