//! A proxy between workers and the coordinator, which can cut and halt connections.

use std::io::{Read, Result, Write};
use std::net::{Shutdown, TcpListener, TcpStream};
use std::sync::{Arc, Mutex, MutexGuard};
use std::time::Duration;

/// The direction of bytes.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Toward {
    /// Requests.
    Coordinator,
    /// Answers.
    Workers,
}

/// All connections, and their next disturbance.
#[derive(Debug, Default)]
pub struct Network {
    /// Every connection is cut after this number of bytes in this direction.
    pub cut_after: Option<(Toward, usize)>,
    /// The number of connections so far.
    pub connections: usize,
    /// Connections with a smaller number forward nothing.
    halted_below: usize,
    open: Vec<TcpStream>,
}

impl Network {
    /// Closes every connection.
    pub fn cut(&mut self) {
        self.cut_after = None;
        for stream in self.open.drain(..) {
            // The call fails only for a connection that its program has closed already.
            let _ = stream.shutdown(Shutdown::Both);
        }
    }

    /// Lets every present connection forward nothing from now on; later connections are unaffected.
    pub fn halt(&mut self) {
        self.halted_below = self.connections;
    }

    /// Counts bytes that are about to pass; returns how many of them pass before the cut, if the cut falls among them.
    fn last_before_cut(&mut self, toward: Toward, length: usize) -> Option<usize> {
        let (_, left) = self.cut_after.as_mut().filter(|(which, _)| *which == toward)?;
        if *left < length {
            return Some(*left);
        }
        *left -= length;
        None
    }
}

/// A proxy on a free port; it ends with the process of the test.
#[derive(Debug, Clone)]
pub struct Proxy {
    target: String,
    network: Arc<Mutex<Network>>,
}

impl Proxy {
    /// Starts a proxy in front of an address; returns it with the URL for workers.
    pub fn start(target: &str) -> (Proxy, String) {
        let listener = TcpListener::bind("127.0.0.1:0").expect("a free port");
        let url = format!("http://{}", listener.local_addr().expect("an address"));
        let proxy = Proxy {
            target: target.to_owned(),
            network: Arc::default(),
        };
        let listening = proxy.clone();
        std::thread::spawn(move || {
            for worker in listener.incoming().flatten() {
                // Without a coordinator the connection of the worker is closed.
                let _ = listening.connect(worker);
            }
        });
        (proxy, url)
    }

    /// Returns the network, to be disturbed.
    pub fn network(&self) -> MutexGuard<'_, Network> {
        self.network.lock().expect("no thread of the proxy panics")
    }

    /// Connects a worker with the coordinator, and forwards bytes both ways until one side closes.
    fn connect(&self, worker: TcpStream) -> Result<()> {
        let coordinator = TcpStream::connect(&self.target)?;
        let ways = [
            (Toward::Coordinator, worker.try_clone()?, coordinator.try_clone()?),
            (Toward::Workers, coordinator.try_clone()?, worker.try_clone()?),
        ];
        let mut network = self.network();
        let number = network.connections;
        network.connections += 1;
        network.open.extend([worker, coordinator]);
        for (toward, from, to) in ways {
            let proxy = self.clone();
            std::thread::spawn(move || {
                // Either side may close at any time.
                let _ = proxy.forward(number, toward, &from, &to);
                let _ = from.shutdown(Shutdown::Both);
                let _ = to.shutdown(Shutdown::Both);
            });
        }
        Ok(())
    }

    fn forward(&self, number: usize, toward: Toward, mut from: &TcpStream, mut to: &TcpStream) -> Result<()> {
        let mut buffer = [0; 2048];
        loop {
            let length = from.read(&mut buffer)?;
            if length == 0 {
                return Ok(());
            }
            while number < self.network().halted_below {
                std::thread::sleep(Duration::from_millis(20));
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
