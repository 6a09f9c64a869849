//! A proxy that falsifies a digit of some results of a worker on their way to the coordinator.

use std::io::{BufRead, BufReader, Read, Write};
use std::net::{TcpListener, TcpStream};
use std::sync::Arc;
use std::sync::atomic::{AtomicUsize, Ordering};

/// The bytes before the falsified value.
const BEFORE: &[u8] = b"\"drawbar_pull_n\":[";

/// A proxy between workers that speak JSON and a coordinator; it lives as long as the test's process.
#[derive(Debug)]
pub struct LyingProxy {
    address: String,
    lies: Arc<AtomicUsize>,
}

impl LyingProxy {
    /// Starts a proxy in front of an address. It forwards the first `honest` results unchanged, then falsifies one in `one_in`.
    pub fn start(target: &str, honest: usize, one_in: usize) -> LyingProxy {
        let listener = TcpListener::bind("127.0.0.1:0").expect("a free port");
        let address = listener.local_addr().expect("an address").to_string();
        let (results, lies) = (Arc::new(AtomicUsize::new(0)), Arc::new(AtomicUsize::new(0)));
        let (target, count) = (target.to_owned(), lies.clone());
        std::thread::spawn(move || {
            for client in listener.incoming().flatten() {
                let (target, results, lies) = (target.clone(), results.clone(), lies.clone());
                std::thread::spawn(move || {
                    let lie = || {
                        let n = results.fetch_add(1, Ordering::Relaxed);
                        let is_lie = n >= honest && n % one_in == 0;
                        lies.fetch_add(usize::from(is_lie), Ordering::Relaxed);
                        is_lie
                    };
                    // The worker opens a broken connection again.
                    let _ = forward(&client, &target, lie);
                });
            }
        });
        LyingProxy { address, lies: count }
    }

    /// Returns the URL for workers.
    pub fn url(&self) -> String {
        format!("http://{}", self.address)
    }

    /// Returns the number of falsified results.
    pub fn lies(&self) -> usize {
        self.lies.load(Ordering::Relaxed)
    }
}

/// Forwards the requests of a connection one by one, and the bytes of the answers at once.
fn forward(client: &TcpStream, target: &str, lie: impl Fn() -> bool) -> std::io::Result<()> {
    let mut server = TcpStream::connect(target)?;
    let (mut answers, mut back) = (server.try_clone()?, client.try_clone()?);
    std::thread::spawn(move || std::io::copy(&mut answers, &mut back));
    let mut requests = BufReader::new(client);
    loop {
        let (mut head, mut length) = (Vec::new(), 0);
        loop {
            let mut line = Vec::new();
            if requests.read_until(b'\n', &mut line)? == 0 {
                return Ok(());
            }
            let text = String::from_utf8_lossy(&line).to_ascii_lowercase();
            if let Some(value) = text.strip_prefix("content-length:") {
                length = value.trim().parse().unwrap_or(0);
            }
            head.extend_from_slice(&line);
            if text.trim().is_empty() {
                break;
            }
        }
        let mut body = vec![0; length];
        requests.read_exact(&mut body)?;
        change(&mut body, &lie);
        server.write_all(&head)?;
        server.write_all(&body)?;
    }
}

/// Changes the last digit of the first drawbar pull of some results.
fn change(body: &mut [u8], lie: impl Fn() -> bool) {
    let mut at = 0;
    while let Some(found) = body[at..].windows(BEFORE.len()).position(|w| w == BEFORE) {
        at += found + BEFORE.len();
        let end = body[at..].iter().position(|b| b",]".contains(b)).unwrap_or(0);
        let digit = body[at..at + end].iter_mut().rev().find(|b| b.is_ascii_digit());
        if let Some(digit) = digit.filter(|_| lie()) {
            *digit = if *digit == b'9' { b'1' } else { *digit + 1 };
        }
    }
}
