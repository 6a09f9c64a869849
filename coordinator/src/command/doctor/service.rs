//! Checks of a service: whether it answers, accepts the token, and has workers of this version.

use std::collections::BTreeMap;
use std::net::SocketAddr;
use std::time::Duration;

use anyhow::anyhow;
use serde::Deserialize;
use serde::de::DeserializeOwned;

use super::finding::Finding;
use crate::command::place::Place;
use crate::config::ClientArguments;
use crate::embedded::model_version;

/// Silence after which a worker counts as gone `[ms]`.
const SILENT_MS: u64 = 60_000;

/// Longest time to wait for an answer.
const PATIENCE: Duration = Duration::from_secs(5);

/// The fields of the answer of `/health` that the doctor uses.
#[derive(Deserialize)]
struct Health {
    version: String,
}

/// A worker in the answer of `/v1/workers`.
#[derive(Deserialize)]
struct Worker {
    model_version: String,
    quarantined: Option<String>,
    silent_ms: u64,
}

pub(super) async fn findings(url: &str, arguments: &ClientArguments) -> Vec<Finding> {
    let client = match Place::at(url, arguments) {
        Ok(client) => client,
        Err(error) => {
            let remedy = "--url http://HOST:PORT or https://HOST, with files that can be read";
            return vec![Finding::fail("service", format!("{error:#}"), remedy)];
        }
    };
    let health: Health = match ask(&client, "/health").await {
        Ok(health) => health,
        Err(error) => {
            let remedy = "is it running, and does a firewall let its port through? An https service needs a certificate that is trusted: --ca-certificate";
            return vec![Finding::fail("service", format!("{error:#}"), remedy)];
        }
    };
    let version = env!("CARGO_PKG_VERSION");
    let mut findings = vec![match health.version == version {
        true => Finding::ok("service", format!("{url}: version {version}")),
        false => Finding::warn(
            "service",
            format!("{url}: version {}, this program has {version}", health.version),
            "use programs of one version: verbs of another one may not understand its answers",
        ),
    }];
    match ask(&client, "/v1/workers").await {
        Ok(workers) => {
            findings.push(Finding::ok("token", "is accepted, or not asked for"));
            findings.extend(check_workers(&workers, url));
        }
        Err(error) => findings.push(Finding::fail(
            "token",
            format!("{error:#}"),
            "coordinator token add NAME --role read beside the store; then --token-file FILE or GROUSER_TOKEN",
        )),
    }
    findings
}

fn check_workers(workers: &BTreeMap<String, Worker>, url: &str) -> Vec<Finding> {
    let (here, gone): (Vec<_>, Vec<_>) = workers
        .iter()
        .partition(|(_, worker)| worker.silent_ms < SILENT_MS);
    let mut findings = Vec::new();
    match here.len() {
        0 => findings.push(Finding::warn(
            "workers",
            format!("none has been heard of in the last minute, {} before", gone.len()),
            format!("worker --coordinator {url} on a machine that computes, or serve --local-workers N"),
        )),
        count => findings.push(Finding::ok("workers", format!("{count} in the last minute"))),
    }
    for (name, worker) in here {
        if let Some(reason) = &worker.quarantined {
            let remedy = "it computes wrongly: look at its memory and its build, then start it anew";
            findings.push(Finding::warn(
                "worker",
                format!("{name} is quarantined: {reason}"),
                remedy,
            ));
        }
        if worker.model_version != model_version() {
            findings.push(Finding::warn(
                "worker",
                format!(
                    "{name} computes equations {}, this program has {}",
                    worker.model_version,
                    model_version()
                ),
                "use workers of the coordinator's version: a calibration takes one version alone",
            ));
        }
    }
    findings
}

/// Returns the version of the coordinator that listens at an address of this machine, if one does.
pub(super) async fn version_at(address: SocketAddr) -> Option<String> {
    let arguments = ClientArguments {
        token_file: None,
        ca_certificate: None,
    };
    let here = match (address.ip().is_unspecified(), address.is_ipv4()) {
        (true, true) => format!("127.0.0.1:{}", address.port()),
        (true, false) => format!("[::1]:{}", address.port()),
        (false, _) => address.to_string(),
    };
    let client = Place::at(&format!("http://{here}"), &arguments).ok()?;
    let health: Health = ask(&client, "/health").await.ok()?;
    Some(health.version)
}

/// Requests an answer from a service within [`PATIENCE`], because another program may accept the connection and stay silent.
async fn ask<T: DeserializeOwned>(service: &Place, path: &str) -> anyhow::Result<T> {
    let answer = tokio::time::timeout(PATIENCE, service.get(path)).await;
    answer.map_err(|_| anyhow!("no answer within {} s", PATIENCE.as_secs()))?
}

#[cfg(test)]
mod tests {
    use super::*;

    fn findings(workers: &[(&str, &str, Option<&str>, u64)]) -> String {
        let worker = |&(name, version, reason, silent_ms): &(&str, &str, Option<&str>, u64)| {
            let worker = Worker {
                model_version: version.to_owned(),
                quarantined: reason.map(str::to_owned),
                silent_ms,
            };
            (name.to_owned(), worker)
        };
        let workers = workers.iter().map(worker).collect();
        check_workers(&workers, "http://keeper:7070")
            .iter()
            .map(Finding::to_string)
            .collect()
    }

    #[test]
    fn workers_that_are_gone_of_another_version_or_quarantined_are_named() {
        let version = model_version();
        assert_eq!(
            findings(&[("a", version, None, 500)]),
            "ok    workers     1 in the last minute\n"
        );
        let none = findings(&[("a", version, None, 90_000)]);
        assert!(none.contains("1 before"), "{none}");
        assert!(
            none.starts_with("warn  workers") && none.contains("worker --coordinator http://keeper:7070"),
            "{none}"
        );
        let amiss = findings(&[("b", "scm-1", None, 1), ("c", version, Some("differs"), 1)]);
        assert!(
            amiss.contains("b computes equations scm-1") && amiss.contains("c is quarantined: differs"),
            "{amiss}"
        );
    }
}
