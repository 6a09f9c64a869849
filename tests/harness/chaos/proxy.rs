//! A proxy between workers and coordinator: the network is what it makes of it.

use std::io::{Read, Write};
use std::net::{Shutdown, TcpListener, TcpStream};
use std::sync::{Arc, Mutex, MutexGuard};
use std::time::Duration;

use super::network::{Network, Toward, Weather};

/// A proxy on a port of its own.
#[derive(Debug)]
pub(super) struct Proxy {
    address: String,
    network: Arc<Mutex<Network>>,
}

fn locked(network: &Mutex<Network>) -> MutexGuard<'_, Network> {
    network.lock().expect("no thread of the proxy panics")
}

impl Proxy {
    /// Starts a proxy to an address.
    pub(super) fn start(to: &str) -> Proxy {
        let listener = TcpListener::bind("127.0.0.1:0").expect("a free port");
        let address = listener.local_addr().expect("an address").to_string();
        let network = Arc::new(Mutex::new(Network::new()));
        let (shared, to) = (network.clone(), to.to_owned());
        std::thread::spawn(move || {
            for worker in listener.incoming().flatten() {
                if locked(&shared).weather() != Weather::Refusing
                    && let Ok(coordinator) = TcpStream::connect(&to)
                {
                    // A connection that cannot be taken is closed.
                    let _ = join(&shared, worker, coordinator);
                }
            }
        });
        Proxy { address, network }
    }

    /// Where workers find the coordinator.
    pub(super) fn url(&self) -> String {
        format!("http://{}", self.address)
    }

    /// The network, to be changed.
    pub(super) fn network(&self) -> MutexGuard<'_, Network> {
        locked(&self.network)
    }
}

/// Lets bytes pass both ways until one side closes.
fn join(network: &Arc<Mutex<Network>>, worker: TcpStream, coordinator: TcpStream) -> std::io::Result<()> {
    let ways = [
        (Toward::Coordinator, worker.try_clone()?, coordinator.try_clone()?),
        (Toward::Workers, coordinator.try_clone()?, worker.try_clone()?),
    ];
    locked(network).add([worker, coordinator]);
    for (toward, from, to) in ways {
        let network = network.clone();
        std::thread::spawn(move || {
            // Either side may be cut at any time.
            let _ = pass(&network, toward, &from, &to);
            let _ = from.shutdown(Shutdown::Both);
            let _ = to.shutdown(Shutdown::Both);
        });
    }
    Ok(())
}

fn pass(
    network: &Mutex<Network>,
    toward: Toward,
    mut from: &TcpStream,
    mut to: &TcpStream,
) -> std::io::Result<()> {
    let mut buffer = [0; 2048];
    loop {
        let length = from.read(&mut buffer)?;
        let weather = locked(network).weather();
        match weather {
            _ if length == 0 => return Ok(()),
            Weather::Passing | Weather::Refusing => {}
            Weather::Late(time) => std::thread::sleep(time),
            Weather::Silent => {
                while locked(network).weather() == Weather::Silent {
                    std::thread::sleep(Duration::from_millis(10));
                }
                return Ok(());
            }
        }
        let last = locked(network).last_of(toward, length);
        to.write_all(&buffer[..last.unwrap_or(length)])?;
        if last.is_some() {
            locked(network).cut();
            return Ok(());
        }
    }
}
