//! Kubernetes: replicas of a deployment, by `kubectl`.
//!
//! The manifest (`deploy/kubernetes`) has the arguments of a pod; this module only sets the number of pods.

use serde::Deserialize;

use super::pilot::{PilotSettings, Pilots};
use super::program::{Invocation, ProgramError};

/// The fields of a Kubernetes deployment that are read.
#[derive(Deserialize)]
struct Deployment {
    spec: Spec,
    #[serde(default)]
    status: Status,
}

#[derive(Deserialize)]
struct Spec {
    replicas: u32,
}

#[derive(Deserialize, Default)]
#[serde(rename_all = "camelCase")]
struct Status {
    #[serde(default)]
    ready_replicas: u32,
}

fn kubectl(settings: &PilotSettings, arguments: &[&str]) -> Invocation {
    let arguments = arguments.iter().map(|&argument| argument.to_owned());
    Invocation::new("kubectl", arguments.chain(settings.options.iter().cloned()))
}

/// Returns the call that reads the deployment.
pub(super) fn list(settings: &PilotSettings) -> Invocation {
    kubectl(settings, &["get", "deployment", &settings.name, "--output=json"])
}

/// Reads the pilots from the answer; pods have no names here.
pub(super) fn pilots(answer: &str) -> Result<Pilots, ProgramError> {
    let Deployment { spec, status } = serde_json::from_str(answer).map_err(|_| ProgramError::Answer {
        program: "kubectl",
        answer: answer.trim().to_owned(),
    })?;
    let running = status.ready_replicas.min(spec.replicas) as usize;
    let pods = vec!["pod".to_owned(); spec.replicas as usize];
    let (running, pending) = pods.split_at(running);
    Ok(Pilots {
        pending: pending.to_vec(),
        running: running.to_vec(),
    })
}

/// Returns the call that sets the number of pods.
pub(super) fn set(settings: &PilotSettings, replicas: u32) -> Invocation {
    let name = format!("deployment/{}", settings.name);
    kubectl(settings, &["scale", &name, &format!("--replicas={replicas}")])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ready_pods_run_and_the_others_wait() {
        let pilots =
            pilots(r#"{"kind": "Deployment", "spec": {"replicas": 3}, "status": {"readyReplicas": 2}}"#);
        let pilots = pilots.unwrap();
        assert_eq!((pilots.running.len(), pilots.pending.len()), (2, 1));
        let none = super::pilots(r#"{"spec": {"replicas": 0}, "status": {}}"#).unwrap();
        assert_eq!(none.count(), 0);
        assert!(super::pilots("{}").is_err());
    }
}
