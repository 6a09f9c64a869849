//! The network: a proxy between workers and coordinator.

use std::io::{Read, Write};
use std::net::{Shutdown, TcpListener, TcpStream};
use std::sync::{Arc, Mutex, MutexGuard};

/// The direction of bytes.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Toward {
    Coordinator,
    Workers,
}

/// All connections, and what is about to happen to them.
#[derive(Debug, Default)]
pub(super) struct Network {
    /// Every connection is cut after this number of bytes in this direction.
    pub(super) cut_after: Option<(Toward, usize)>,
    open: Vec<TcpStream>,
}

impl Network {
    /// Closes every connection.
    pub(super) fn cut(&mut self) {
        self.cut_after = None;
        for stream in self.open.drain(..) {
            // A stream that its program has left is cut already.
            let _ = stream.shutdown(Shutdown::Both);
        }
    }

    /// Counts bytes that are about to pass; the number that passes before the cut, if it comes now.
    fn last_before_cut(&mut self, toward: Toward, length: usize) -> Option<usize> {
        let (_, left) = self.cut_after.as_mut().filter(|(which, _)| *which == toward)?;
        if *left < length {
            return Some(*left);
        }
        *left -= length;
        None
    }
}

/// A proxy on a free port.
#[derive(Debug, Clone)]
pub(super) struct Proxy {
    to: String,
    network: Arc<Mutex<Network>>,
}

impl Proxy {
    /// Starts a proxy to an address; the URL for workers.
    pub(super) fn start(to: &str) -> (Proxy, String) {
        let listener = TcpListener::bind("127.0.0.1:0").expect("a free port");
        let url = format!("http://{}", listener.local_addr().expect("an address"));
        let proxy = Proxy {
            to: to.to_owned(),
            network: Arc::default(),
        };
        let listening = proxy.clone();
        std::thread::spawn(move || {
            for worker in listener.incoming().flatten() {
                // A connection that cannot be made is closed.
                let _ = listening.join(worker);
            }
        });
        (proxy, url)
    }

    /// The network, to be changed.
    pub(super) fn network(&self) -> MutexGuard<'_, Network> {
        self.network.lock().expect("no thread of the proxy panics")
    }

    /// Connects a worker with the coordinator, and lets bytes pass both ways until one side closes.
    fn join(&self, worker: TcpStream) -> std::io::Result<()> {
        let coordinator = TcpStream::connect(&self.to)?;
        let ways = [
            (Toward::Coordinator, worker.try_clone()?, coordinator.try_clone()?),
            (Toward::Workers, coordinator.try_clone()?, worker.try_clone()?),
        ];
        self.network().open.extend([worker, coordinator]);
        for (toward, from, to) in ways {
            let proxy = self.clone();
            std::thread::spawn(move || {
                // Either side may be cut at any time.
                let _ = proxy.pass(toward, &from, &to);
                let _ = from.shutdown(Shutdown::Both);
                let _ = to.shutdown(Shutdown::Both);
            });
        }
        Ok(())
    }

    fn pass(&self, toward: Toward, mut from: &TcpStream, mut to: &TcpStream) -> std::io::Result<()> {
        let mut buffer = [0; 2048];
        loop {
            let length = from.read(&mut buffer)?;
            if length == 0 {
                return Ok(());
            }
            let last = self.network().last_before_cut(toward, length);
            to.write_all(&buffer[..last.unwrap_or(length)])?;
            if last.is_some() {
                self.network().cut();
                return Ok(());
            }
        }
    }
}
