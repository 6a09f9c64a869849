//! The connections of a service: their number, and the time that each may keep the service waiting.
//!
//! When all places are taken, a new connection replaces the one that has waited longest for its client. Thus clients that connect and then
//! neither send nor receive data cannot lock others out.

use std::sync::{Arc, Weak};
use std::time::Duration;

use axum::Router;
use axum::extract::Request;
use hyper::server::conn::http1;
use hyper::service::{Service as _, service_fn};
use hyper_util::rt::{TokioIo, TokioTimer};
use hyper_util::server::graceful::{GracefulShutdown, Watcher};
use hyper_util::service::TowerToHyperService;
use rustix::process::{Resource, getrlimit, setrlimit};
use socket2::SockRef;
use tokio::io::{AsyncRead, AsyncWrite};
use tokio::net::{TcpListener, TcpStream};
use tokio::sync::{OwnedSemaphorePermit, Semaphore};
use tokio_rustls::TlsAcceptor;

use super::activity::Activity;
use super::client_stream::ClientStream;

/// The largest number of connections at a time.
const CONNECTIONS: u64 = 4096;
/// File descriptors that are reserved for the store, for outputs and for a connection that waits for its place.
const OTHER_DESCRIPTORS: u64 = 64;
/// The time within which the head of a request, or the greeting of TLS, must arrive. A connection without requests is closed after it, too.
const HEADER_TIME: Duration = Duration::from_secs(15);
/// The time after which a connection is closed whose client does not receive available data.
const TAKING_TIME: Duration = Duration::from_secs(30);
/// The size of the operating system's buffer for data that the client has not received `[bytes]`; Linux doubles it for its own use.
const SEND_BUFFER: usize = 64 << 10;
/// The largest head of a request, and the largest part of a body that is read ahead `[bytes]`.
const BUFFER: usize = 64 << 10;
/// The time that a connection has waited for its client, after which it may be closed in favour of another.
const GRACE: Duration = Duration::from_millis(250);
/// The pause after an error of the operating system, and between searches for a connection to close.
const PAUSE: Duration = Duration::from_millis(100);

/// Returns the number of connections that the file descriptors allow, after requesting as many descriptors as the operating system grants.
fn max_connections() -> usize {
    let mut limit = getrlimit(Resource::Nofile);
    let wanted = CONNECTIONS + OTHER_DESCRIPTORS;
    if limit.current.is_some_and(|current| current < wanted) {
        limit.current = Some(limit.maximum.map_or(wanted, |maximum| maximum.min(wanted)));
        // Where this is refused, the limit is unchanged.
        let _ = setrlimit(Resource::Nofile, limit);
    }
    let descriptors = getrlimit(Resource::Nofile).current.unwrap_or(wanted);
    let count = descriptors
        .saturating_sub(OTHER_DESCRIPTORS)
        .clamp(1, CONNECTIONS);
    usize::try_from(count).unwrap_or(1)
}

/// Bounds the memory for clients that receive nothing. Connections inherit this setting from their listener.
fn bound_untaken(listener: &TcpListener) {
    let socket = SockRef::from(listener);
    let limit = socket
        .set_send_buffer_size(SEND_BUFFER)
        .and_then(|()| socket.set_tcp_user_timeout(Some(TAKING_TIME)));
    if let Err(error) = limit {
        tracing::warn!(%error, "clients that do not take their answers are not bounded");
    }
}

/// The limited places for connections.
struct Places {
    free: Arc<Semaphore>,
    count: usize,
    /// The connections that have a place; some of them may have ended.
    taken: Vec<Weak<Activity>>,
}

impl Places {
    fn new(count: usize) -> Self {
        Places {
            free: Arc::new(Semaphore::new(count)),
            count,
            taken: Vec::new(),
        }
    }

    /// Waits for a place for a new connection.
    async fn take(&mut self, activity: &Arc<Activity>) -> OwnedSemaphorePermit {
        let place = loop {
            if let Ok(place) = self.free.clone().try_acquire_owned() {
                break place;
            }
            self.make_place();
            let freed = tokio::time::timeout(PAUSE, self.free.clone().acquire_owned()).await;
            // The semaphore is never closed.
            if let Ok(Ok(place)) = freed {
                break place;
            }
        };
        if self.taken.len() >= 2 * self.count {
            self.taken.retain(|taken| taken.strong_count() > 0);
        }
        self.taken.push(Arc::downgrade(activity));
        place
    }

    /// Closes the connection that has waited longest for its client.
    fn make_place(&self) {
        let open = self.taken.iter().filter_map(Weak::upgrade);
        let waiting = open.filter_map(|activity| Some((activity.waiting()?, activity)));
        let longest = waiting.max_by_key(|(time, _)| *time);
        if let Some((_, activity)) = longest.filter(|(time, _)| *time >= GRACE) {
            activity.close();
        }
    }
}

/// Answers connections until `shutdown` is ready, then lets requests in progress end.
pub(super) async fn serve(
    listener: TcpListener,
    tls: Option<TlsAcceptor>,
    router: Router,
    shutdown: impl Future<Output = ()>,
) {
    let mut places = Places::new(max_connections());
    let connections = GracefulShutdown::new();
    bound_untaken(&listener);
    let mut http = http1::Builder::new();
    http.timer(TokioTimer::new())
        .header_read_timeout(HEADER_TIME)
        .max_buf_size(BUFFER);
    let mut shutdown = std::pin::pin!(shutdown);
    loop {
        let next = async {
            let (stream, _) = listener.accept().await?;
            let activity = Activity::begin();
            let place = places.take(&activity).await;
            Ok::<_, std::io::Error>((stream, activity, place))
        };
        let accepted = tokio::select! {
            next = next => next,
            () = &mut shutdown => break,
        };
        let Ok((stream, activity, place)) = accepted else {
            tokio::time::sleep(PAUSE).await;
            continue;
        };
        let connection = Connection {
            http: http.clone(),
            router: router.clone(),
            watcher: connections.watcher(),
            activity,
        };
        let tls = tls.clone();
        tokio::spawn(async move {
            connection.answer(stream, tls).await;
            drop(place);
        });
    }
    drop(listener);
    connections.shutdown().await;
}

/// The handler of one connection.
struct Connection {
    http: http1::Builder,
    router: Router,
    watcher: Watcher,
    activity: Arc<Activity>,
}

impl Connection {
    /// Answers requests until either side ends the connection, or its place is needed for another one.
    async fn answer(self, stream: TcpStream, tls: Option<TlsAcceptor>) {
        let activity = self.activity.clone();
        let stream = ClientStream::new(stream, activity.clone());
        let answered = async {
            match tls {
                None => self.requests(stream).await,
                Some(tls) => {
                    let greeted = tokio::time::timeout(HEADER_TIME, tls.accept(stream)).await;
                    if let Ok(Ok(stream)) = greeted {
                        self.requests(stream).await;
                    }
                }
            }
        };
        tokio::select! {
            () = answered => {}
            () = activity.closed() => {}
        }
    }

    async fn requests(self, stream: impl AsyncRead + AsyncWrite + Send + Unpin + 'static) {
        let router = TowerToHyperService::new(self.router);
        let activity = self.activity;
        let service = service_fn(move |request| {
            let mut request: Request<hyper::body::Incoming> = request;
            request.extensions_mut().insert(activity.clone());
            router.call(request)
        });
        let connection = self.http.serve_connection(TokioIo::new(stream), service);
        // A broken connection needs no message; its client has ended it.
        let _ = self.watcher.watch(connection).await;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[tokio::test]
    async fn a_new_connection_takes_the_place_of_the_one_that_waits_for_its_client() {
        let mut places = Places::new(2);
        let (busy, silent) = (Activity::begin(), Activity::begin());
        let _answering = busy.answer();
        let (_busy_place, silent_place) = (places.take(&busy).await, places.take(&silent).await);
        let silent_ends = async {
            silent.closed().await;
            drop(silent_place);
        };
        let new = Activity::begin();
        let (_place, ()) = tokio::join!(places.take(&new), silent_ends);
        assert_eq!(places.free.available_permits(), 0);
    }
}
