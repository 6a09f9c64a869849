//! The two forms of an exchange, byte by byte: accepted and refused messages, and the same calibration with both.

use farm_tests::fake_worker::PROTOCOL;
use farm_tests::http::Response;
use farm_tests::job::{FIT_RUNS, Job};
use farm_tests::service::Service;
use farm_tests::text::same;
use shared::channel::Channel;
use shared::exchange::{ExchangeRequest, ExchangeResponse, Lease, WorkResult};
use shared::model::ModelVariant;
use shared::outcome::{Observables, Outcome};
use shared::wire::WireForm::{self, Json, MessagePack};

const PATH: &str = "/v1/work/exchange";

fn request(want: u32, results: Vec<WorkResult>) -> ExchangeRequest {
    ExchangeRequest {
        worker: "typed".into(),
        protocol: PROTOCOL,
        model_version: "fake-1".into(),
        models: Default::default(),
        queue_job: None,
        threads: 1,
        evaluation_s: None,
        results,
        holding: Vec::new(),
        returned: Vec::new(),
        started: Vec::new(),
        received: u64::MAX,
        want,
        wait_ms: 0,
    }
}

fn result(lease: &Lease, observables: Observables) -> WorkResult {
    WorkResult {
        lease: lease.lease,
        calibration: lease.calibration,
        evaluation: lease.evaluation,
        seal: lease.seal.clone(),
        outcome: Outcome::Evaluated(observables),
        repeated: None,
    }
}

/// Returns the answer of a worker about the fitted channels, and nothing else.
fn fitted() -> Observables {
    Observables {
        drawbar_pull_n: vec![0.1 + 0.2; FIT_RUNS],
        torque_n_m: vec![f64::MIN_POSITIVE; FIT_RUNS],
        sinkage_m: vec![1.0 / 3.0; FIT_RUNS],
        ..Observables::default()
    }
}

fn post(service: &Service, message: &ExchangeRequest, form: WireForm, accept: &str) -> Response {
    let bytes = message.to_bytes(form).expect("a message");
    let head = [("Content-Type", form.media_type()), ("Accept", accept)];
    service.client.post_bytes(PATH, &head, &bytes)
}

#[track_caller]
fn answer(response: &Response, form: WireForm) -> ExchangeResponse {
    assert_eq!(response.status, 200, "{}", response.body);
    assert_eq!(response.header("content-type"), Some(form.media_type()));
    ExchangeResponse::from_bytes(&response.bytes, form).expect("an answer")
}

#[test]
fn an_answer_has_the_form_of_the_request_or_the_one_that_is_accepted() {
    let service = Service::start(&[]);
    service.submit(&Job::small());
    for (form, accept, answered) in [
        (Json, "*/*", Json),
        (MessagePack, "*/*", MessagePack),
        (MessagePack, "application/json", Json),
        (Json, "text/html, application/vnd.msgpack;q=0.9", MessagePack),
    ] {
        let response = answer(&post(&service, &request(1, Vec::new()), form, accept), answered);
        assert_eq!(response.leases.len(), 1, "{form} {accept}");
        let done = result(&response.leases[0], fitted());
        let response = answer(&post(&service, &request(0, vec![done]), form, accept), answered);
        assert_eq!(response.duplicates, 0, "{form} {accept}");
    }
    assert_eq!(service.metric("grouser_evaluations_completed_total"), 4);
}

#[test]
fn only_what_is_fitted_is_asked_for_while_sampling() {
    let service = Service::start(&[]);
    service.submit(&Job::small());
    let ask = || {
        answer(
            &post(&service, &request(1, Vec::new()), MessagePack, "*/*"),
            MessagePack,
        )
    };
    let lease = ask().leases[0].clone();
    let variant = service
        .client
        .json(&format!("/v1/work/variants/{}", lease.variant));
    let variant: ModelVariant = serde_json::from_value(variant).expect("a variant");
    assert_eq!(
        variant.channels,
        [Channel::DrawbarPull, Channel::Torque, Channel::Sinkage]
    );
    // A result without one of the channels fails its lease.
    let short = Observables {
        torque_n_m: Vec::new(),
        ..fitted()
    };
    let taken = request(0, vec![result(&lease, short)]);
    answer(&post(&service, &taken, MessagePack, "*/*"), MessagePack);
    assert_eq!(service.metric("grouser_evaluations_completed_total"), 0);
    let workers = service.client.json("/v1/workers");
    assert_eq!(workers["typed"]["faults"], 1);
}

#[test]
fn a_wrong_body_in_either_form_is_refused_and_the_service_goes_on() {
    let service = Service::start(&[]);
    service.submit(&Job::small());
    let whole = request(1, Vec::new());
    let [json, packed] = [Json, MessagePack].map(|form| whole.to_bytes(form).expect("a message"));
    let post = |media: &str, body: &[u8]| {
        let response = service.client.post_bytes(PATH, &[("Content-Type", media)], body);
        let kind = response.json()["error"]["type"].clone();
        (response.status, kind.as_str().unwrap_or_default().to_owned())
    };
    let refused = |status: u16, kind: &str| (status, kind.to_owned());
    for media in [
        "",
        "text/plain",
        "application/cbor",
        "application/msgpack2",
        "json",
    ] {
        assert_eq!(
            post(media, &json),
            refused(415, "unsupported_media_type"),
            "{media}"
        );
    }
    let none = service.client.post_bytes(PATH, &[], &packed);
    assert_eq!(none.status, 415, "{}", none.body);
    let bad = refused(400, "invalid_body");
    let [of_json, of_packed] = [Json, MessagePack].map(WireForm::media_type);
    assert_eq!(post(of_json, &packed), bad);
    assert_eq!(post(of_packed, &json), bad);
    for end in 0..packed.len() {
        assert_eq!(post(of_packed, &packed[..end]), bad, "cut at byte {end}");
    }
    let more = [packed.as_slice(), &[0xc0]].concat();
    assert_eq!(post(of_packed, &more), bad);
    // An array, a map, a string and bytes that declare four billion items, and deep nesting.
    for head in [0xdd, 0xdf, 0xdb, 0xc6] {
        assert_eq!(post(of_packed, &[head, 0xff, 0xff, 0xff, 0xff, 0x01]), bad);
    }
    assert_eq!(post(of_packed, &vec![0x91; 1 << 20]), bad);
    assert_eq!(
        post(of_packed, &vec![0x00; (64 << 20) + 1]),
        refused(413, "too_large")
    );
    let lease = answer(
        &service
            .client
            .post_bytes(PATH, &[("Content-Type", of_packed)], &packed),
        MessagePack,
    )
    .leases[0]
        .clone();
    for wrong in [f64::NAN, f64::INFINITY] {
        let mut observables = fitted();
        observables.sinkage_m[3] = wrong;
        let sent = request(0, vec![result(&lease, observables)]);
        let body = sent.to_bytes(MessagePack).expect("a message");
        assert_eq!(post(of_packed, &body), bad, "{wrong}");
    }
    assert_eq!(service.metric("grouser_evaluations_completed_total"), 0);
    assert_eq!(service.client.get("/health").status, 200);
}

#[test]
fn a_worker_that_says_json_gives_the_same_bytes() {
    let posterior = |start: fn(&Service) -> farm_tests::process::Process| {
        let service = Service::start(&[]);
        let id = service.submit(&Job::small());
        let _worker = start(&service);
        service.wait_for(id, "finished");
        service.posterior_csv(id)
    };
    let packed = posterior(|service| service.worker("packed", 1));
    let read_along = posterior(|service| service.json_worker("json"));
    same(&read_along, &packed);
}
