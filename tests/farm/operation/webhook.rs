//! Web hooks: calls at pauses and ends, retries, allowed hosts, and hosts that do not answer.

use std::io::{BufRead, BufReader, Read, Write};
use std::net::{TcpListener, TcpStream};
use std::sync::mpsc;

use farm_tests::assert_contains;
use farm_tests::job::Job;
use farm_tests::programs::call;
use farm_tests::service::Service;
use farm_tests::wait::until_true;
use serde_json::{Value, json};

/// Reads a POST and answers it with a status; its body.
fn take(mut stream: TcpStream, status: &str) -> Value {
    let mut reader = BufReader::new(stream.try_clone().expect("a stream"));
    let (mut line, mut length) = (String::new(), 0);
    while reader.read_line(&mut line).expect("a line") > 2 {
        if let Some(value) = line.to_lowercase().strip_prefix("content-length: ") {
            length = value.trim().parse().expect("a length");
        }
        line.clear();
    }
    let mut body = vec![0; length];
    reader.read_exact(&mut body).expect("a body");
    let answer = format!("HTTP/1.1 {status}\r\nContent-Length: 0\r\nConnection: close\r\n\r\n");
    stream.write_all(answer.as_bytes()).expect("an answer");
    serde_json::from_slice(&body).expect("JSON")
}

/// Returns a server on a free port that fails the first POST and hands over the bodies of all.
fn server() -> (String, mpsc::Receiver<Value>) {
    let listener = TcpListener::bind("127.0.0.1:0").expect("a port");
    let url = format!(
        "http://{}/ended?key=1",
        listener.local_addr().expect("an address")
    );
    let (sender, bodies) = mpsc::channel();
    std::thread::spawn(move || {
        let mut status = "500 Internal Server Error";
        for stream in listener.incoming() {
            if sender.send(take(stream.expect("a connection"), status)).is_err() {
                return;
            }
            status = "204 No Content";
        }
    });
    (url, bodies)
}

/// Submits the small job by the command line.
fn submit(service: &Service, webhook: &str) -> farm_tests::programs::Ended {
    let job = Job::small()
        .write(&service.folder().join("job"))
        .display()
        .to_string();
    call(
        "coordinator submit {} --url {} --webhook {}",
        &[&job, &service.url(), &webhook],
    )
}

#[test]
fn the_pause_and_the_end_of_a_job_are_posted_and_tried_again() {
    let service = Service::start(&["--webhook-host", "127.0.0.1"]);
    let (url, bodies) = server();
    submit(&service, &url).success();
    service.act(1, "pause");
    let next = || {
        bodies
            .recv_timeout(std::time::Duration::from_secs(60))
            .expect("a POST")
    };
    let paused = json!({"study": 1, "calibration": 1, "name": "job", "state": "paused", "message": "paused by a user"});
    assert_eq!(next(), paused);
    assert_eq!(next(), paused, "the first answer was 500");
    service.act(1, "resume");
    let worker = service.worker("worker", 2);
    service.wait_for(1, "finished");
    drop(worker);
    assert_eq!(next()["state"], "finished");
    until_true("a line of the log", || {
        service.log().contains("told its web hook")
    });
    assert!(!service.log().contains("key=1"), "{}", service.log());
}

#[test]
fn a_host_that_is_not_listed_is_refused_and_a_silent_one_keeps_nobody_waiting() {
    let service = Service::start(&["--webhook-host", "127.0.0.1", "--local-workers", "2"]);
    let refused = submit(&service, "http://localhost:1/").refusal();
    assert_contains!(refused, "--webhook-host");
    let refused = submit(&service, "file:///etc/passwd").refusal();
    assert_contains!(refused, "scheme file is neither http nor https");
    assert_eq!(service.client.json("/v1/calibrations"), json!([]));
    // This server accepts connections and never answers.
    let silent = TcpListener::bind("127.0.0.1:0").expect("a port");
    let url = format!("http://{}/", silent.local_addr().expect("an address"));
    submit(&service, &url).success();
    service.wait_for(1, "finished");
    submit(&service, &url).success();
    service.wait_for(2, "finished");
}
