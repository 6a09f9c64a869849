//! Wrong requests to the service: 4xx with a type and a message, and nothing is stored.

use farm_tests::assert_contains;
use farm_tests::http::Response;
use farm_tests::job::{GAIN, Job};
use farm_tests::json::word;
use farm_tests::service::Service;
use serde_json::json;

fn error(response: &Response) -> (u16, String, String) {
    let body = response.json();
    let text = |key: &str| word(&body["error"][key]).to_owned();
    (response.status, text("type"), text("message"))
}

fn is(response: &Response, status: u16, kind: &str, message: &str) {
    assert_eq!(error(response), (status, kind.to_owned(), message.to_owned()));
}

#[test]
fn malformed_files_over_http_are_422_and_leave_nothing() {
    let service = Service::start(&[]);
    let bad = Job::small().in_runs("r00,w,s,0.05,60.0", "r00,w,s,0.05,-60.0");
    let refused = service.client.post("/v1/experiments", &bad.experiment_json());
    is(
        &refused,
        422,
        "invalid_file",
        "runs.csv line 4: wheel_load_n -60 N must be > 0 N",
    );
    let missing = service
        .client
        .post("/v1/experiments", &json!({"toml": Job::small().experiment}));
    is(
        &missing,
        422,
        "invalid_file",
        "experiment.toml: file \"runs.csv\" is named but was not sent",
    );

    let experiment = service
        .client
        .post("/v1/experiments", &Job::small().experiment_json())
        .json()["id"]
        .clone();
    assert_eq!(experiment, 1, "a refused experiment took an id");
    let post = |job: &Job| {
        service
            .client
            .post("/v1/calibrations", &json!({"experiment": 1, "toml": job.job}))
    };
    is(
        &post(&Job::small().in_job("kappa = 0.0", "kapa = 0.0")),
        422,
        "invalid_file",
        "job.toml line 9: unknown parameter \"kapa\"; the nearest known is \"kappa\"",
    );
    let astray = json!({"experiment": 1, "toml": Job::small().job, "files": {"gain.toml": GAIN}});
    is(
        &service.client.post("/v1/calibrations", &astray),
        422,
        "invalid_file",
        "job.toml: unknown file \"gain.toml\"; none is expected here",
    );
    let names: Vec<String> = (0..60_000).map(|i| format!("\"e{i}\"")).collect();
    let effects = format!("kind = \"quasi_static\"\neffects = [{}]", names.join(", "));
    is(
        &post(&Job::small().in_job("kind = \"quasi_static\"", &effects)),
        422,
        "invalid_file",
        "job.toml: [model] 60000 effects must be at most 10",
    );
    is(
        &post(&Job::small().sampler(9, [2, 4], 1)),
        422,
        "invalid_file",
        "job.toml: [sampler] 9 particles are too few for 4 parameters, which need at least 10",
    );
    assert_eq!(service.client.json("/v1/calibrations"), json!([]));
    assert_eq!(service.client.json("/v1/studies"), json!([]));
    let created = post(&Job::small());
    assert_eq!((created.status, created.json()["id"].as_i64()), (201, Some(1)));
}

#[test]
fn bodies_that_are_not_the_expected_json_are_400() {
    let service = Service::start(&[]);
    let unknown = json!({"toml": "", "fils": {}}).to_string();
    let exchange = json!({"worker": "w", "protocol": 1, "want": -1}).to_string();
    for (path, body, what) in [
        ("/v1/experiments", "not json", "JSON"),
        ("/v1/experiments", "{\"toml\": 5}", "toml"),
        ("/v1/experiments", unknown.as_str(), "fils"),
        ("/v1/calibrations", "{}", "experiment"),
        ("/v1/work/exchange", exchange.as_str(), "want"),
        ("/v1/work/exchange", "[]", "invalid"),
    ] {
        let (status, kind, message) = error(&service.client.post_text(path, body));
        assert_eq!(status, 400, "{path} {body}: {message}");
        assert_eq!(kind.as_str(), "invalid_body", "{path} {body}: {message}");
        assert!(message.contains(what), "{path} {body}: {message}");
    }
}

#[test]
fn an_oversized_body_is_413_and_the_service_goes_on() {
    let service = Service::start(&[]);
    let body = format!("{{\"toml\": \"{}\"}}", "x".repeat(64 << 20));
    let (status, kind, message) = error(&service.client.post_text("/v1/experiments", &body));
    assert_eq!((status, kind.as_str()), (413, "too_large"), "{message}");
    assert_contains!(message, "limit");
    assert_eq!(service.submit(&Job::small()), 1);
}

#[test]
fn what_is_not_there_is_404_and_what_does_not_fit_is_409() {
    let service = Service::start(&[]);
    let client = &service.client;
    is(
        &client.get("/v1/calibrations/9"),
        404,
        "not_found",
        "there is no calibration 9",
    );
    is(
        &client.get("/v1/studies/9"),
        404,
        "not_found",
        "there is no study 9",
    );
    is(
        &client.get("/v2/calibrations"),
        404,
        "not_found",
        "there is no /v2/calibrations; /openapi.json lists all paths",
    );
    let hash = "0".repeat(32);
    let variant = client.get(&format!("/v1/work/variants/{hash}"));
    is(
        &variant,
        404,
        "not_found",
        &format!("no calibration in progress uses variant {hash}"),
    );
    assert_eq!(error(&client.get("/v1/calibrations/nine")).0, 404);
    let wrong = client.post(
        "/v1/calibrations",
        &json!({"experiment": 9, "toml": Job::small().job}),
    );
    is(&wrong, 404, "not_found", "there is no experiment 9");
    let method = client
        .send("DELETE", "/v1/calibrations", None)
        .expect("an answer");
    assert_eq!(error(&method).0, 404, "{method:?}");
    for path in [
        "",
        "/stages",
        "/samples",
        "/posterior",
        "/comparison",
        "/predictions",
        "/diagnostics",
        "/flags",
        "/summary",
        "/report",
        "/events",
    ] {
        assert_eq!(
            error(&client.get(&format!("/v1/calibrations/9{path}"))).0,
            404,
            "{path}"
        );
    }

    let id = service.submit(&Job::small());
    let post = |verb: &str| client.post(&format!("/v1/calibrations/{id}/{verb}"), &json!({}));
    for path in [
        "posterior",
        "comparison",
        "predictions",
        "diagnostics",
        "flags",
        "summary",
        "report",
    ] {
        let message = "calibration 1 is queued; results are available when it is finished";
        is(
            &client.get(&format!("/v1/calibrations/{id}/{path}")),
            409,
            "conflict",
            message,
        );
    }
    is(
        &post("resume"),
        409,
        "conflict",
        "calibration 1 is queued; it cannot be resumed",
    );
    assert_eq!(post("cancel").json(), json!({"state": "cancelled"}));
    is(
        &post("cancel"),
        409,
        "conflict",
        "calibration 1 is cancelled; it cannot be cancelled",
    );
    is(
        &post("pause"),
        409,
        "conflict",
        "calibration 1 is cancelled; it cannot be paused",
    );
    let stage = client.get(&format!("/v1/calibrations/{id}/samples?stage=first"));
    assert_eq!(error(&stage).0, 400, "{stage:?}");
}
