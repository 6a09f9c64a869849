//! Workers in the middle of a long evaluation: asked to stop, or with an answer that hangs.

use std::io::{Read, Write};
use std::net::{SocketAddr, TcpListener, TcpStream};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::time::{Duration, Instant};

use farm_tests::job::Job;
use farm_tests::process::{Process, Signal};
use farm_tests::service::Service;
use farm_tests::wait::until;

/// A job of which an evaluation takes tens of seconds.
pub(super) fn long() -> Job {
    Job::small().in_job(
        "kind = \"quasi_static\"",
        "kind = \"scm\"\ndem_spacing_m = 0.008\ntravel_step_m = 0.0000005\nsteady_travel_m = 0.2",
    )
}

/// Waits until the only worker holds a lease that it has begun.
pub(super) fn begun(service: &Service) {
    until("a lease in hand", || {
        let holds = service.only_worker().and_then(|w| w["holds"].as_u64());
        holds.filter(|&holds| holds > 0)
    });
    // The evaluation begins with the answer.
    std::thread::sleep(Duration::from_millis(200));
}

#[test]
fn a_worker_that_is_asked_to_stop_gives_a_long_evaluation_back() {
    let service = Service::start(&["--lease-ms", "60000"]);
    let id = service.submit(&long());
    let mut worker = service.worker("busy", 1);
    begun(&service);
    let asked = Instant::now();
    worker.signal(Signal::Terminate);
    assert!(worker.wait().success(), "{}", worker.log());
    assert!(asked.elapsed() < Duration::from_secs(10), "{:?}", asked.elapsed());
    assert!(worker.log().contains("unfinished=1"), "{}", worker.log());
    assert_eq!(service.metric("grouser_leases_out"), 0);
    assert_eq!(service.metric("grouser_leases_failed_total"), 0);
    assert_eq!(service.status(id)["state"], "running");
}

/// A proxy whose connections of the moment can be halted; later ones pass.
struct HaltingProxy {
    address: SocketAddr,
    /// Connections so far; those below the second number are halted.
    connections: Arc<AtomicUsize>,
    halted: Arc<AtomicUsize>,
}

impl HaltingProxy {
    fn start(to: String) -> HaltingProxy {
        let listener = TcpListener::bind("127.0.0.1:0").expect("a port");
        let address = listener.local_addr().expect("an address");
        let (connections, halted) = (Arc::new(AtomicUsize::new(0)), Arc::new(AtomicUsize::new(0)));
        let (count, below) = (connections.clone(), halted.clone());
        std::thread::spawn(move || {
            for client in listener.incoming().flatten() {
                let number = count.fetch_add(1, Ordering::AcqRel);
                let server = TcpStream::connect(&to).expect("the service answers");
                let ended = Arc::new(AtomicBool::new(false));
                for (from, into) in [(&client, &server), (&server, &client)] {
                    let (mut from, mut into) = (
                        from.try_clone().expect("a socket"),
                        into.try_clone().expect("a socket"),
                    );
                    let (below, ended) = (below.clone(), ended.clone());
                    std::thread::spawn(move || {
                        let mut bytes = [0; 65_536];
                        while let Ok(count @ 1..) = from.read(&mut bytes) {
                            while number < below.load(Ordering::Acquire) && !ended.load(Ordering::Acquire) {
                                std::thread::sleep(Duration::from_millis(20));
                            }
                            if into.write_all(&bytes[..count]).is_err() {
                                break;
                            }
                        }
                        ended.store(true, Ordering::Release);
                        let _ = into.shutdown(std::net::Shutdown::Both);
                    });
                }
            }
        });
        HaltingProxy {
            address,
            connections,
            halted,
        }
    }

    /// Halts every connection that there is now.
    fn halt(&self) {
        let now = self.connections.load(Ordering::Acquire);
        self.halted.store(now, Ordering::Release);
    }
}

#[test]
fn leases_are_renewed_while_an_answer_hangs() {
    let service = Service::start(&["--lease-ms", "1500"]);
    let id = service.submit(&long());
    let proxy = HaltingProxy::start(service.client.0.clone());
    let url = format!("http://{}", proxy.address);
    let _worker = Process::worker(&url, 1, &service.folder().join("busy.log"));
    begun(&service);
    proxy.halt();
    let before = proxy.connections.load(Ordering::Acquire);
    // Four times as long as a lease lasts.
    std::thread::sleep(Duration::from_secs(6));
    assert!(
        proxy.connections.load(Ordering::Acquire) > before,
        "nothing was sent beside"
    );
    assert_eq!(service.metric("grouser_leases_out"), 1);
    assert_eq!(service.metric("grouser_leases_failed_total"), 0);
    assert_eq!(service.status(id)["state"], "running");
}
