//! A worker with coordinators of a single behaviour each.

use std::collections::BTreeMap;
use std::sync::{Arc, Mutex};
use std::time::Duration;

use shared::exchange::{ExchangeRequest, ExchangeResponse, Lease, WorkResult};
use shared::model::ModelVariant;
use shared::outcome::Outcome;

use super::exchange::{Coordinator, ExchangeError};
use super::limits::{Ended, WorkerLimits};
use super::{PullSettings, run};
use crate::fixture::under_loads;
use crate::model::VariantCache;

/// A coordinator that leases two evaluations of a variant and never sends the variant.
#[derive(Default)]
struct Silent {
    returned: Mutex<Vec<u64>>,
    is_asked: tokio::sync::Notify,
}

/// A coordinator that leases one evaluation of each of its variants at once, and no more.
struct Dealing {
    variants: BTreeMap<String, ModelVariant>,
    results: Mutex<Vec<WorkResult>>,
    returned: Mutex<Vec<u64>>,
    is_over: tokio::sync::Notify,
}

impl Dealing {
    fn new(variants: usize) -> Self {
        Self {
            variants: under_loads(variants).into_iter().collect(),
            results: Mutex::default(),
            returned: Mutex::default(),
            is_over: tokio::sync::Notify::new(),
        }
    }
}

impl Coordinator for Dealing {
    async fn exchange(
        &self,
        request: ExchangeRequest,
    ) -> Result<ExchangeResponse, (ExchangeError, Vec<WorkResult>)> {
        // A worker without leases asks at once; yielding lets the rest of the test run.
        tokio::task::yield_now().await;
        let mut results = self.results.lock().unwrap();
        results.extend(request.results);
        let mut returned = self.returned.lock().unwrap();
        returned.extend(request.returned);
        if results.len() + returned.len() == self.variants.len() {
            self.is_over.notify_one();
        }
        let hashes = self.variants.keys().filter(|_| request.received == 0).zip(1..);
        let leases = hashes.map(|(hash, number)| lease(number, hash)).collect();
        Ok(answer(leases))
    }

    async fn variant(&self, hash: &str) -> Result<Option<ModelVariant>, ExchangeError> {
        Ok(self.variants.get(hash).cloned())
    }
}

fn lease(number: u64, variant: &str) -> Lease {
    Lease {
        lease: number,
        calibration: 1,
        evaluation: number,
        seal: String::new(),
        variant: variant.into(),
        theta: Vec::new(),
        announce: false,
    }
}

fn answer(leases: Vec<Lease>) -> ExchangeResponse {
    ExchangeResponse {
        leases,
        lease_ms: 60_000,
        remaining: 2,
        in_hand: 1,
        workers: 1,
        duplicates: 0,
        refused: None,
    }
}

fn settings() -> PullSettings {
    PullSettings {
        name: "test".into(),
        queue_job: None,
        threads: 1,
        models: Arc::default(),
        limits: WorkerLimits::default(),
    }
}

impl Coordinator for Silent {
    async fn exchange(
        &self,
        request: ExchangeRequest,
    ) -> Result<ExchangeResponse, (ExchangeError, Vec<WorkResult>)> {
        let mut returned = self.returned.lock().unwrap();
        returned.extend(&request.returned);
        Ok(answer(if request.want > 0 {
            vec![lease(7, "unknown"), lease(8, "unknown")]
        } else {
            Vec::new()
        }))
    }

    async fn variant(&self, _hash: &str) -> Result<Option<ModelVariant>, ExchangeError> {
        self.is_asked.notify_one();
        std::future::pending().await
    }
}

#[tokio::test]
async fn a_worker_stops_while_a_variant_does_not_come_and_gives_its_leases_back() {
    let silent = Arc::new(Silent::default());
    let stop = silent.is_asked.notified();
    let ended = run(silent.clone(), settings(), Arc::default(), stop);
    let ended = tokio::time::timeout(Duration::from_secs(60), ended).await;
    assert_eq!(ended, Ok(Ok(Ended::Asked)));
    assert_eq!(*silent.returned.lock().unwrap(), [7, 8]);
}

#[tokio::test]
async fn a_batch_of_more_variants_than_the_cache_holds_is_evaluated() {
    let variants = VariantCache::MAX_VARIANTS + 100;
    let dealing = Arc::new(Dealing::new(variants));
    let stop = dealing.is_over.notified();
    let ended = run(dealing.clone(), settings(), Arc::default(), stop);
    let ended = tokio::time::timeout(Duration::from_secs(60), ended).await;
    assert_eq!(ended, Ok(Ok(Ended::Asked)));
    assert!(dealing.returned.lock().unwrap().is_empty());
    let results = dealing.results.lock().unwrap();
    let is_evaluated = |result: &WorkResult| matches!(result.outcome, Outcome::Evaluated(_));
    assert_eq!(
        results.iter().filter(|result| is_evaluated(result)).count(),
        variants
    );
}
