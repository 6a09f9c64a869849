//! Tables are read one at a time, also where clients hang up before they have their answer.

use std::io::Write;
use std::net::TcpStream;
use std::time::{Duration, Instant};

use base64::Engine as _;
use base64::prelude::BASE64_STANDARD;
use farm_tests::service::Service;
use serde_json::json;

/// Returns a request with two million cells, which has 5 MB and takes some hundred MB while it is read.
fn post(service: &Service) -> Vec<u8> {
    let row = "1;".repeat(999) + "1\n";
    let table = "a;".repeat(999) + "a\n" + &row.repeat(2000);
    let body = json!({"name": "a.csv", "content_base64": BASE64_STANDARD.encode(table)}).to_string();
    let head = format!(
        "POST /v1/import/guess HTTP/1.1\r\nHost: {}\r\nContent-Type: application/json\r\nContent-Length: {}\r\nConnection: close\r\n\r\n",
        service.client.0,
        body.len()
    );
    [head.into_bytes(), body.into_bytes()].concat()
}

fn send(service: &Service, post: &[u8]) -> TcpStream {
    let mut stream = TcpStream::connect(&service.client.0).expect("a connection");
    stream.write_all(post).expect("the whole request");
    stream
}

/// Sends a table and waits for the answer.
fn answered(service: &Service, post: &[u8]) {
    let mut answer = String::new();
    std::io::Read::read_to_string(&mut send(service, post), &mut answer).expect("an answer");
    assert!(answer.starts_with("HTTP/1.1 200"), "{:.200}", answer);
}

#[test]
fn tables_whose_clients_hang_up_take_the_memory_of_one() {
    let service = Service::start(&[]);
    let post = post(&service);
    let before = service.resident_kb();
    answered(&service, &post);
    let one = service.peak_kb() - before;
    for _ in 0..6 {
        let stream = send(&service, &post);
        // The client hangs up while the table is read, or after a wait for its turn.
        let (patience, begun) = (Instant::now() + Duration::from_millis(500), before + one / 2);
        while service.resident_kb() < begun && Instant::now() < patience {
            std::thread::yield_now();
        }
        drop(stream);
    }
    // Tables are read in order, so that all earlier ones are done when this one is answered.
    answered(&service, &post);
    let all = service.peak_kb() - before;
    assert!(
        all < 2 * one,
        "one table takes {one} kB, six whose clients hang up {all} kB"
    );
}
