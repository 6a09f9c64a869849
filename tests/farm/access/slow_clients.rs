//! Slow clients, which do not read their answers or stop in the middle of a request.

use std::io::{Read, Write};
use std::net::{Shutdown, TcpStream};
use std::time::Duration;

use farm_tests::assert_contains;
use farm_tests::fake_worker::FakeWorker;
use farm_tests::job::Job;
use farm_tests::service::Service;
use farm_tests::wait::until_true;

/// The number of descriptors with which a service has room for 256 connections.
const DESCRIPTORS: u32 = 320;

/// Returns a client that sends requests and reads no answer.
fn asker(service: &Service) -> TcpStream {
    let mut stream = TcpStream::connect(&service.client.0).expect("a connection");
    let requested = "GET /page/vendor/d3.js HTTP/1.1\r\nHost: 127.0.0.1\r\n\r\n".repeat(40);
    // The service may already have closed the connection in favour of another one.
    let _ = stream.write_all(requested.as_bytes());
    stream
}

#[test]
fn clients_that_read_nothing_shut_nobody_out_and_cost_little() {
    let service = Service::start_with_descriptors(DESCRIPTORS);
    let before = service.resident_kb();
    let _askers: Vec<TcpStream> = (0..400).map(|_| asker(&service)).collect();
    for _ in 0..5 {
        assert_eq!(service.client.get("/health").status, 200);
    }
    let (unread, open) = service.unread();
    assert!(open > 200, "{open} connections are open");
    assert!(
        unread < 64 << 20,
        "{unread} bytes wait for {open} clients, a quarter of a megabyte for each at most"
    );
    let grown = service.resident_kb().saturating_sub(before);
    assert!(grown < 50_000, "{open} connections take {grown} kB");
}

#[test]
fn a_client_that_reads_nothing_is_hung_up_on_and_one_that_waits_is_not() {
    let service = Service::start(&[]);
    let id = service.submit(&Job::small());
    let mut watcher = TcpStream::connect(&service.client.0).expect("a connection");
    let watched =
        format!("GET /v1/calibrations/{id}/events HTTP/1.1\r\nHost: 127.0.0.1\r\nConnection: close\r\n\r\n");
    watcher.write_all(watched.as_bytes()).expect("a request");
    let _asker = asker(&service);
    until_true("two connections", || service.unread().1 == 2);
    until_true("the end of the one that reads nothing", || {
        let (unread, open) = service.unread();
        unread == 0 && open == 1
    });
    let cancelled = service.act(id, "cancel");
    assert_eq!(cancelled.status, 200);
    let mut events = String::new();
    watcher.read_to_string(&mut events).expect("a stream of events");
    assert_contains!(events, "\"state\":\"cancelled\"");
}

/// Sends half of a body of 63 MiB; returns the connection, and the answer if it comes within 20 s.
fn half_sent(service: &Service) -> (TcpStream, String) {
    let size = 63 << 20;
    let mut stream = TcpStream::connect(&service.client.0).expect("a connection");
    let head = format!(
        "POST /v1/experiments HTTP/1.1\r\nHost: 127.0.0.1\r\nContent-Type: application/json\r\nContent-Length: {size}\r\n\r\n"
    );
    stream.write_all(head.as_bytes()).expect("a head");
    // The service closes the connection after a refusal.
    let _ = stream.write_all(&vec![b' '; size / 2]);
    stream
        .set_read_timeout(Some(Duration::from_secs(20)))
        .expect("a time limit");
    let mut answer = vec![0; 1000];
    let length = stream.read(&mut answer).unwrap_or_default();
    (stream, String::from_utf8_lossy(&answer[..length]).into_owned())
}

#[test]
fn half_sent_bodies_fill_no_memory_and_keep_no_worker_from_posting() {
    let service = Service::start(&[]);
    let id = service.submit(&Job::small());
    let worker = FakeWorker::new(&service.client, "worker");
    let leases = worker.take(1);
    let before = service.resident_kb();
    let senders = std::thread::scope(|scope| {
        let senders: Vec<_> = (0..12).map(|_| scope.spawn(|| half_sent(&service))).collect();
        senders
            .into_iter()
            .map(|sender| sender.join().expect("a sender"))
            .collect::<Vec<_>>()
    });
    let refused = senders.iter().filter(|(_, answer)| {
        answer.starts_with("HTTP/1.1 429")
            && answer.contains("retry-after: 1")
            && answer.contains("bytes are free")
    });
    let refused = refused.count();
    let silent = senders.iter().filter(|(_, answer)| answer.is_empty()).count();
    assert!((1..=2).contains(&silent) && refused + silent == 12, "{senders:?}");
    let grown = service.resident_kb().saturating_sub(before);
    assert!(grown < 150_000, "the halves of {silent} bodies take {grown} kB");

    assert_eq!(service.client.get("/health").status, 200);
    let padded = " ".repeat(3 << 20) + &worker.request().to_string();
    assert_eq!(service.client.post_text("/v1/work/exchange", &padded).status, 200);
    worker.answer(&leases, |lease| {
        farm_tests::fake_worker::evaluated(lease, farm_tests::job::FIT_RUNS)
    });
    assert_eq!(service.evaluations(id), Some(1));

    for (sender, _) in senders {
        let _ = sender.shutdown(Shutdown::Both);
    }
    until_true("memory given back", || {
        service.resident_kb().saturating_sub(before) < 50_000
    });
    let large = " ".repeat(63 << 20) + &Job::small().experiment_json().to_string();
    assert_eq!(service.client.post_text("/v1/experiments", &large).status, 201);
}

#[test]
fn a_body_that_breaks_the_rules_of_http_is_not_called_too_large() {
    let service = Service::start(&[]);
    let mut stream = TcpStream::connect(&service.client.0).expect("a connection");
    let head = "POST /v1/experiments HTTP/1.1\r\nHost: 127.0.0.1\r\nContent-Type: application/json\r\nTransfer-Encoding: chunked\r\nConnection: close\r\n\r\n";
    stream.write_all(head.as_bytes()).expect("a head");
    let _ = stream.write_all(format!("2;{}\r\n{{}}\r\n0\r\n\r\n", "x".repeat(40_000)).as_bytes());
    let mut answer = Vec::new();
    let _ = stream.read_to_end(&mut answer);
    let answer = String::from_utf8_lossy(&answer);
    assert!(answer.starts_with("HTTP/1.1 400"), "{answer}");
    assert_contains!(answer, "the body cannot be read: ", "extension");
}
