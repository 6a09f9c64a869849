//! Connections: how many there may be, and how long each may take to say what it wants.

use std::sync::Arc;
use std::time::Duration;

use axum::Router;
use hyper::server::conn::http1;
use hyper_util::rt::{TokioIo, TokioTimer};
use hyper_util::server::graceful::GracefulShutdown;
use hyper_util::service::TowerToHyperService;
use rustix::process::{Resource, getrlimit, setrlimit};
use tokio::net::TcpListener;
use tokio::sync::Semaphore;
use tokio_rustls::TlsAcceptor;

/// Most connections at a time.
const CONNECTIONS: u64 = 4096;
/// File descriptors that are left to the store and to outputs.
const OTHER_DESCRIPTORS: u64 = 64;
/// The head of a request, or the greeting of TLS, must have arrived after this time; a connection without requests is closed
/// after it too.
const HEADER_TIME: Duration = Duration::from_secs(15);
/// Largest head of a request, and most that is read ahead of a body `[bytes]`.
const BUFFER: usize = 64 << 10;
/// Pause after an error of the operating system.
const PAUSE: Duration = Duration::from_millis(100);

/// As many connections as descriptors allow, after asking for as many descriptors as the operating system grants.
fn most_connections() -> usize {
    let mut limit = getrlimit(Resource::Nofile);
    let wanted = CONNECTIONS + OTHER_DESCRIPTORS;
    if limit.current.is_some_and(|current| current < wanted) {
        limit.current = Some(limit.maximum.map_or(wanted, |maximum| maximum.min(wanted)));
        // Where it is refused, the limit stays what it was.
        let _ = setrlimit(Resource::Nofile, limit);
    }
    let descriptors = getrlimit(Resource::Nofile).current.unwrap_or(wanted);
    let most = descriptors
        .saturating_sub(OTHER_DESCRIPTORS)
        .clamp(1, CONNECTIONS);
    usize::try_from(most).unwrap_or(1)
}

/// Answers connections until `shutdown` is ready, then lets requests in progress end.
pub(super) async fn serve(
    listener: TcpListener,
    tls: Option<TlsAcceptor>,
    router: Router,
    shutdown: impl Future<Output = ()>,
) {
    let slots = Arc::new(Semaphore::new(most_connections()));
    let connections = GracefulShutdown::new();
    let mut http = http1::Builder::new();
    http.timer(TokioTimer::new())
        .header_read_timeout(HEADER_TIME)
        .max_buf_size(BUFFER);
    let mut shutdown = std::pin::pin!(shutdown);
    loop {
        let next = async {
            let slot = slots.clone().acquire_owned().await;
            (slot, listener.accept().await)
        };
        let (slot, accepted) = tokio::select! {
            next = next => next,
            () = &mut shutdown => break,
        };
        let Ok((stream, _)) = accepted else {
            tokio::time::sleep(PAUSE).await;
            continue;
        };
        let service = TowerToHyperService::new(router.clone());
        let (http, tls, watcher) = (http.clone(), tls.clone(), connections.watcher());
        tokio::spawn(async move {
            // A broken connection is its client's affair.
            match tls {
                None => drop(
                    watcher
                        .watch(http.serve_connection(TokioIo::new(stream), service))
                        .await,
                ),
                Some(tls) => {
                    let greeted = tokio::time::timeout(HEADER_TIME, tls.accept(stream)).await;
                    if let Ok(Ok(stream)) = greeted {
                        drop(
                            watcher
                                .watch(http.serve_connection(TokioIo::new(stream), service))
                                .await,
                        );
                    }
                }
            }
            drop(slot);
        });
    }
    drop(listener);
    connections.shutdown().await;
}
