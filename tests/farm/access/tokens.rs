//! Tokens: roles, the demands on addresses that others reach, and the lines of the log.

use std::io::{BufRead, BufReader, Read, Write};
use std::net::TcpStream;

use farm_tests::assert_contains;
use farm_tests::fake_worker::{FakeWorker, evaluated, result};
use farm_tests::http::Client;
use farm_tests::job::{FIT_RUNS, Job};
use farm_tests::process::Process;
use farm_tests::programs;
use farm_tests::service::{Service, free_address};
use farm_tests::wait::{until, until_true};
use serde_json::{Value, json};

/// Makes a token by the command line.
fn add(service: &Service, name: &str, role: &str) -> String {
    let store = service.store_name().to_owned();
    let command = programs::coordinator(["token", "add", name, "--role", role, "--store", &store]);
    programs::run(command).success().trim().to_owned()
}

fn status(client: &Client, method: &str, path: &str, token: Option<&str>) -> u16 {
    let bearer = format!("Bearer {}", token.unwrap_or_default());
    let mut head = vec![("Content-Type", "application/json")];
    head.extend(token.map(|_| ("Authorization", bearer.as_str())));
    let body = (method == "POST").then_some(b"{}".as_slice());
    client
        .exchange(method, path, &head, body)
        .expect("an answer")
        .status
}

#[test]
fn each_role_does_its_own_and_no_more() {
    let mut service = Service::start(&[]);
    let id = service.submit(&Job::small());
    let tokens = ["read", "submit", "work"].map(|role| add(&service, &format!("anna-{role}"), role));
    until_true("a token asked for", || {
        status(&service.client, "GET", "/v1/calibrations", None) == 401
    });
    let [read, submit, work] = tokens.each_ref().map(String::as_str);
    let pause = format!("/v1/calibrations/{id}/pause");
    let resume = format!("/v1/calibrations/{id}/resume");
    for (method, path, token, expected) in [
        ("GET", "/health", None, 200),
        ("GET", "/metrics", None, 401),
        ("GET", "/openapi.json", None, 401),
        ("GET", "/v1/work/variants/0", None, 401),
        ("GET", "/metrics", Some(read), 200),
        ("GET", "/v1/calibrations", Some(read), 200),
        ("GET", "/v1/calibrations", Some(submit), 200),
        ("GET", "/v1/calibrations", Some(work), 403),
        ("GET", "/v1/calibrations", Some("grouser-0"), 401),
        ("GET", "/v1/work/variants/0", Some(submit), 403),
        ("GET", "/v1/work/variants/0", Some(work), 404),
        ("POST", "/v1/work/exchange", Some(submit), 403),
        ("POST", "/v1/work/exchange", Some(work), 400),
        ("POST", &pause, None, 401),
        ("POST", &pause, Some(read), 403),
        ("POST", &pause, Some(work), 403),
        ("POST", &pause, Some(submit), 200),
        ("POST", &resume, Some(submit), 200),
    ] {
        assert_eq!(
            status(&service.client, method, path, token),
            expected,
            "{method} {path} {token:?}"
        );
    }

    // One of our programs reads the token from a file, the other from the environment.
    let file = service.folder().join("token");
    std::fs::write(&file, format!("{submit}\n")).expect("a file");
    let file = file.display().to_string();
    let url = service.url();
    let list =
        |more: &[&str]| programs::run(programs::coordinator([&["list", "--url", &url], more].concat()));
    assert!(list(&["--token-file", &file]).success().contains("calibration"));
    assert!(list(&[]).refusal().starts_with("a token is needed"));
    let mut command = programs::worker(["--coordinator", &url, "--threads", "1"]);
    command.env("GROUSER_TOKEN", work);
    let worker = Process::start(command, &service.folder().join("worker.log"));
    until_true("a result of the worker", || {
        let mut command = programs::coordinator(["list", "--url", &url]);
        command.env("GROUSER_TOKEN", read);
        programs::run(command).success().contains("finished")
    });

    let store = service.store_name().to_owned();
    let revoke = programs::coordinator(["token", "revoke", "anna-read", "--store", &store]);
    programs::run(revoke).success();
    until_true("a token revoked", || {
        status(&service.client, "GET", "/v1/calibrations", Some(read)) == 401
    });
    let listed = programs::run(programs::coordinator(["token", "list", "--store", &store])).success();
    assert_contains!(listed, "anna-read", "revoked");

    let log = service.log() + &worker.log();
    assert_contains!(log, "by=anna-submit");
    let kept = std::fs::read(service.store()).expect("the store");
    for token in [read, submit, work] {
        assert!(!log.contains(token), "a token in the log");
        let bytes = token.as_bytes();
        assert!(
            !kept.windows(bytes.len()).any(|window| window == bytes),
            "a token in the store"
        );
        assert!(!listed.contains(token), "a token in the list");
    }
    // A store that has had a token still demands one after the last token is revoked.
    for name in ["anna-submit", "anna-work"] {
        programs::call("coordinator token revoke {} --store {}", &[&name, &store]).success();
    }
    service.crash();
    assert_eq!(status(&service.client, "GET", "/v1/calibrations", None), 401);
}

/// Opens the stream of a calibration's events, and waits for the first event.
fn watch(service: &Service, id: i64, token: &str) -> BufReader<TcpStream> {
    let mut stream = TcpStream::connect(&service.client.0).expect("a connection");
    let head = format!(
        "GET /v1/calibrations/{id}/events HTTP/1.1\r\nHost: 127.0.0.1\r\nAuthorization: Bearer {token}\r\n\
         Connection: close\r\n\r\n"
    );
    stream.write_all(head.as_bytes()).expect("a request");
    let mut reader = BufReader::new(stream);
    let mut line = String::new();
    while !line.starts_with("event: ") {
        line.clear();
        assert!(reader.read_line(&mut line).expect("a stream of events") > 0);
    }
    reader
}

#[test]
fn a_revoked_token_ends_the_streams_and_polls_that_it_began() {
    let service = Service::start(&[]);
    let client = &service.client;
    let id = service.submit(&Job::small());
    let [read, work, submit] = ["read", "work", "submit"].map(|role| add(&service, role, role));
    until_true("a token asked for", || {
        status(client, "GET", "/v1/calibrations", None) == 401
    });
    let pause = format!("/v1/calibrations/{id}/pause");
    assert_eq!(status(client, "POST", &pause, Some(&submit)), 200);

    let mut events = watch(&service, id, &read);
    let events = std::thread::spawn(move || events.read_to_end(&mut Vec::new()));
    let mut request = FakeWorker::new(client, "parked").request();
    (request["want"], request["wait_ms"]) = (1.into(), 30_000.into());
    let (poller, bearer) = (client.clone(), format!("Bearer {work}"));
    let poll = std::thread::spawn(move || {
        let head = [
            ("Content-Type", "application/json"),
            ("Authorization", bearer.as_str()),
        ];
        let body = request.to_string();
        poller.exchange("POST", "/v1/work/exchange", &head, Some(body.as_bytes()))
    });
    let bearer = format!("Bearer {submit}");
    until_true("a parked poll", || {
        let head = [("Authorization", bearer.as_str())];
        let workers = client
            .exchange("GET", "/v1/workers", &head, None)
            .expect("an answer");
        workers.body.contains("parked")
    });

    for name in ["read", "work"] {
        let store = service.store_name();
        let revoke = programs::coordinator(["token", "revoke", name, "--store", store]);
        programs::run(revoke).success();
    }
    for (path, token) in [("/v1/calibrations", &read), ("/v1/work/variants/0", &work)] {
        until_true("a token revoked", || {
            status(client, "GET", path, Some(token)) == 401
        });
    }
    let resume = format!("/v1/calibrations/{id}/resume");
    assert_eq!(status(client, "POST", &resume, Some(&submit)), 200);
    let answer = poll.join().expect("a poll").expect("an answer");
    assert_eq!(answer.status, 401, "{}", answer.body);
    assert_contains!(answer.body, "unknown or revoked");
    until_true("the end of the stream", || events.is_finished());
}

#[test]
fn a_worker_of_another_token_touches_no_lease_of_one_with_the_same_name() {
    let service = Service::start(&[]);
    let client = &service.client;
    service.submit(&Job::small());
    let [lab, other, read] =
        [("lab", "work"), ("other", "work"), ("read", "read")].map(|(name, role)| add(&service, name, role));
    until_true("a token asked for", || {
        status(client, "GET", "/v1/calibrations", None) == 401
    });
    let worker = FakeWorker::new(client, "host-7");
    let exchange = |token: &str, change: &dyn Fn(&mut Value)| -> Value {
        let mut request = worker.request();
        change(&mut request);
        let bearer = format!("Bearer {token}");
        let head = [
            ("Content-Type", "application/json"),
            ("Authorization", bearer.as_str()),
        ];
        let body = request.to_string();
        let answer = client.exchange("POST", "/v1/work/exchange", &head, Some(body.as_bytes()));
        answer.expect("an answer").json()
    };
    let leases = exchange(&lab, &|request| request["want"] = 3.into())["leases"].clone();
    let leases = leases.as_array().expect("leases");
    assert_eq!(leases.len(), 3);
    // It has received nothing, returns them and answers one.
    let refused = exchange(&other, &|request| {
        request["received"] = 0.into();
        request["returned"] = leases.iter().map(|lease| lease["lease"].clone()).collect();
        request["results"] = json!([result(&leases[0], evaluated(&leases[0], FIT_RUNS))]);
    });
    assert_eq!(refused["duplicates"], 1, "{refused}");
    let bearer = format!("Bearer {read}");
    let head = [("Authorization", bearer.as_str())];
    let workers = client
        .exchange("GET", "/v1/workers", &head, None)
        .expect("an answer")
        .json();
    assert_eq!(workers["lab/host-7"]["holds"], 3, "{workers}");
    assert_eq!(workers["other/host-7"]["completed"], 0, "{workers}");
    let taken = exchange(&lab, &|request| {
        request["results"] = json!([result(&leases[0], evaluated(&leases[0], FIT_RUNS))]);
    });
    assert_eq!(taken["duplicates"], 0, "{taken}");
}

#[test]
fn an_address_that_others_reach_demands_a_token_or_says_what_insecure_means() {
    let folder = tempfile::tempdir().expect("a folder");
    let store = format!("sqlite://{}", folder.path().join("grouser.db").display());
    let address = free_address().replace("127.0.0.1", "0.0.0.0");
    let serve = ["serve", "--listen", &address, "--store", &store];
    let refusal = programs::run(programs::coordinator(serve)).refusal();
    assert_contains!(
        refusal,
        &format!("coordinator token add NAME --role submit --store {store}")
    );

    let client = Client(address.replace("0.0.0.0", "127.0.0.1"));
    let log = folder.path().join("log");
    let insecure = programs::coordinator(serve.iter().chain(&["--insecure"]));
    let process = Process::start(insecure, &log);
    until("an answer", || client.try_get("/health").ok());
    assert_eq!(status(&client, "GET", "/v1/calibrations", None), 200);
    assert_contains!(process.log(), "nobody is asked for a token");
    drop(process);

    let add = programs::coordinator(["token", "add", "w", "--role", "work", "--store", &store]);
    let token = programs::run(add).success().trim().to_owned();
    let _process = Process::start(programs::coordinator(serve), &log);
    until("an answer", || client.try_get("/health").ok());
    assert_eq!(status(&client, "GET", "/v1/calibrations", None), 401);
    assert_eq!(status(&client, "GET", "/v1/work/variants/0", Some(&token)), 404);
    let refused = FakeWorker::new(&client, "w");
    assert_eq!(refused.send(&refused.request()).status, 401);
}

#[test]
fn a_token_has_one_holder_and_a_plain_name() {
    let service = Service::start(&[]);
    let store = service.store_name().to_owned();
    let run = |arguments: &[&str]| {
        let arguments = [&["token"], arguments, &["--store", store.as_str()]].concat();
        programs::run(programs::coordinator(arguments))
    };
    let first = run(&["add", "anna", "--role", "read"]).success();
    let again = run(&["add", "anna", "--role", "submit"]).refusal();
    assert_contains!(again, "has a token anna already");
    let odd = run(&["add", "an na", "--role", "read"]).refusal();
    assert!(odd.starts_with("name \"an na\" must have"), "{odd}");
    let absent = run(&["revoke", "bert"]).refusal();
    assert!(absent.ends_with("has no token bert"), "{absent}");
    run(&["revoke", "anna"]).success();
    let second = run(&["add", "anna", "--role", "submit"]).success();
    assert_ne!(first, second);
}

#[test]
fn the_description_of_the_interface_has_tokens_and_refusals() {
    let service = Service::start(&[]);
    let document = service.client.json("/openapi.json");
    assert_eq!(
        document["components"]["securitySchemes"]["token"]["scheme"],
        "bearer"
    );
    for (path, item) in document["paths"].as_object().expect("paths") {
        for (method, operation) in item.as_object().expect("operations") {
            let all = ["400", "401", "403", "408", "413", "415", "429"];
            let due = if method == "post" { &all[..] } else { &all[..3] };
            for status in due {
                assert!(
                    !operation["responses"][status].is_null(),
                    "{method} {path}: {status}"
                );
            }
        }
    }
}

#[test]
fn a_token_that_was_made_elsewhere_is_taken_once_and_again() {
    let service = Service::start(&[]);
    let store = service.store_name().to_owned();
    let file = service.folder().join("farm.token");
    let secret = "0123456789abcdef0123456789abcdef";
    let add = |role: &str| {
        let file = file.display().to_string();
        let words = [
            "token", "add", "farm", "--role", role, "--from", &file, "--store", &store,
        ];
        programs::run(programs::coordinator(words))
    };
    std::fs::write(&file, "short\n").expect("a file");
    let refused = add("work").refusal();
    assert_contains!(refused, "a token of 5 characters must have at least 32");
    std::fs::write(&file, format!("{secret}\n")).expect("a file");
    assert_eq!(add("work").success(), "");
    assert_eq!(add("work").success(), "", "as when a pod starts again");
    let refused = add("submit").refusal();
    assert_contains!(refused, "has this token already, as farm with the role work");
    let becomes = |secret: &str, expected: u16| {
        until_true("the token", || {
            let listed = status(&service.client, "GET", "/v1/work/demand", Some(secret));
            listed == expected
        });
    };
    becomes(secret, 200);
    let other = "fedcba9876543210fedcba9876543210";
    std::fs::write(&file, format!("{other}\n")).expect("a file");
    assert_eq!(add("work").success(), "", "as when a secret is changed");
    becomes(other, 200);
    becomes(secret, 401);
    programs::call("coordinator token revoke farm --store {}", &[&store]).success();
    becomes(other, 401);
    assert!(add("work").stderr.contains("was revoked, and stays so"));
    becomes(other, 401);
}
