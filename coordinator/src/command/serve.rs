//! `coordinator serve`: the service.

use anyhow::{Context, bail};
use tokio::net::TcpListener;

use super::shutdown::{Shutdown, stop_signal};
use crate::config::ServeArguments;
use crate::embedded::LocalWorkers;
use crate::service::Service;

pub(super) async fn serve(config: ServeArguments) -> anyhow::Result<()> {
    if config.lease_ms < 100 {
        bail!("--lease-ms {} ms must be >= 100 ms", config.lease_ms);
    }
    let listener = TcpListener::bind(config.listen)
        .await
        .with_context(|| format!("--listen {}", config.listen))?;
    let service = Service::open(&config.store, config.lease_ms).await?;
    let address = listener.local_addr()?;
    tracing::info!(%address, store = config.store, "serving");

    let stop = Shutdown::new();
    let workers = (config.local_workers > 0)
        .then(|| LocalWorkers::start(service.dispatcher().clone(), config.local_workers, stop.wait()));
    let server = tokio::spawn(crate::http::serve(listener, service.clone(), stop.wait()));
    let signal = stop_signal()?;
    tokio::select! {
        () = service.keep_growing() => {}
        () = signal => tracing::info!("stopping; workers will reconnect"),
        () = service.store().writer().stopped() => bail!("the store can no longer be written; see the log"),
    }
    stop.now();
    if let Some(workers) = workers {
        workers.join().await;
    }
    // Long polls end with the farm, so the server has nobody left to wait for.
    service.close().await;
    server.abort();
    Ok(())
}
