//! Effects that users add to a service's catalogue: `POST /v1/effects`, and the jobs that name them.

use farm_tests::assert_contains;
use farm_tests::http::Response;
use farm_tests::job::{GAIN, Job};
use farm_tests::json::item_count;
use farm_tests::programs;
use farm_tests::service::Service;
use farm_tests::wait::until_true;
use serde_json::{Value, json};

/// Returns the effect with another fixed shift `[N]`.
fn gain(shift_n: &str) -> String {
    GAIN.replace("prior = 0.25", &format!("prior = {shift_n}"))
}

#[track_caller]
fn add(service: &Service, text: &str) -> Response {
    service.client.post("/v1/effects", &json!({"text": text}))
}

#[track_caller]
fn says(response: &Response, status: u16, kind: &str, message: &str) {
    let error = &response.json()["error"];
    assert_eq!(
        (response.status, &error["type"]),
        (status, &kind.into()),
        "{error}"
    );
    assert_eq!(error["message"], message);
}

/// Returns the small job with these effects.
fn job(effects: &str) -> Job {
    let with = format!("shear_velocity_m_s = 0.001\neffects = {effects}");
    Job::small().in_job("shear_velocity_m_s = 0.001", &with)
}

/// Text of the effect file of this name that is stored with a calibration.
fn stored(service: &Service, id: i64, file: &str) -> String {
    let files = service
        .database()
        .text(&format!("SELECT files FROM calibrations WHERE id = {id}"));
    let files: Value = serde_json::from_str(&files).expect("the files of a job");
    files[file]
        .as_str()
        .unwrap_or_else(|| panic!("{file} in {files}"))
        .to_owned()
}

#[test]
fn each_text_of_a_name_is_a_version_and_survives_a_restart() {
    let mut service = Service::start(&[]);
    let first = add(&service, GAIN);
    assert_eq!(first.status, 201, "{}", first.body);
    assert_eq!(first.json()["name"], "my_gain");
    assert_eq!(first.json()["version"]["version"], 1);
    assert_eq!(first.json()["version"]["created_by"], Value::Null);
    let again = add(&service, GAIN);
    assert_eq!((again.status, again.json()), (200, first.json()));
    let second = add(&service, &gain("0.5"));
    assert_eq!(second.status, 201);
    assert_eq!(second.json()["version"]["version"], 2);
    assert_eq!(add(&service, GAIN).json(), first.json());

    service.crash();
    let list = service.client.json("/v1/effects");
    let last = list.as_array().and_then(|list| list.last()).expect("effects");
    assert_eq!(item_count(&list), 53);
    assert_eq!(last["name"], "my_gain");
    assert_eq!(last["origin"], "own");
    assert_eq!(last["version"], 2);
    assert_eq!(list[0]["origin"], "library");
    assert_eq!(list[0]["version"], Value::Null);
    let page = service.client.json("/v1/effects/my_gain");
    assert_eq!((&page["text"], &page["effect"]), (&gain("0.5").into(), last));
    assert_eq!(
        page["versions"],
        json!([first.json()["version"], second.json()["version"]])
    );
    assert_eq!(page["signature"]["strengths"][0]["parameter"], "gain");
    assert_eq!(service.client.json("/v1/effects/my_gain@1")["text"], GAIN);
    says(
        &service.client.get("/v1/effects/my_gain@3"),
        404,
        "not_found",
        "effect my_gain has no version \"3\"; the last one is 2",
    );
}

#[test]
fn a_study_keeps_the_version_that_it_began_with() {
    let service = Service::start(&[]);
    add(&service, GAIN);
    let old = service.submit(&job("[\"torque_gain\", \"my_gain\"]"));
    add(&service, &gain("0.5"));
    let new = service.submit(&job("[\"my_gain\"]"));
    let named = service.submit(&job("[\"my_gain@1\"]"));
    assert_eq!(stored(&service, old, "my_gain@1.toml"), GAIN);
    assert_eq!(stored(&service, new, "my_gain@2.toml"), gain("0.5"));
    assert_eq!(stored(&service, named, "my_gain@1.toml"), GAIN);
    let _worker = service.worker("worker", 2);
    for id in [old, new, named] {
        service.wait_for(id, "finished");
    }
    let effects = |id: i64| service.result(id, "summary")["calibrations"][0]["effects"].clone();
    assert_eq!(effects(old), json!(["torque_gain", "my_gain"]));
    assert_eq!(effects(new), json!(["my_gain"]));
    // A job on disk is submitted with the effect that it names, which the program itself does not know.
    let folder = service.folder().join("job");
    let path = job("[\"my_gain@1\"]").write(&folder).display().to_string();
    let submit = || programs::run(programs::coordinator(["submit", &path, "--url", &service.url()]));
    assert_eq!(submit().success(), "calibration 4 of study 4\n");
    assert_eq!(stored(&service, 4, "my_gain@1.toml"), GAIN);
    job("[\"my_gian\"]").write(&folder);
    let refusal = submit().refusal();
    assert_contains!(refusal, "job.toml: [model] effects: unknown effect \"my_gian\"");
    // A job with the file beside it gives the same bits.
    let beside = job("[]")
        .in_job("effects = []", "effect_files = [\"gain.toml\"]")
        .beside("gain.toml", GAIN);
    let beside = service.calibrate(&beside);
    assert_eq!(service.posterior_csv(beside), service.posterior_csv(named));
    assert_ne!(service.posterior_csv(beside), service.posterior_csv(new));

    let base = service.submit(&Job::small());
    let extended = service.client.post(
        &format!("/v1/calibrations/{base}/extend"),
        &json!({"effect": "my_gain"}),
    );
    assert_eq!(extended.status, 201, "{}", extended.body);
    let extended = extended.json()["id"].as_i64().expect("an id");
    assert_eq!(stored(&service, extended, "my_gain@2.toml"), gain("0.5"));
    assert_eq!(service.status(extended)["name"], "calibration+my_gain");
}

#[test]
fn the_keys_of_a_file_may_come_as_json() {
    let service = Service::start(&[]);
    let effect = json!({
        "name": "pull_shift", "summary": "s", "source": "a guess", "drawbar_pull": "drawbar_pull + shift_n",
        "parameters": {"shift_n": {"unit": "N", "neutral": 0, "prior": {"normal": [0, 0.5]}}},
    });
    let added = service.client.post("/v1/effects", &json!({"effect": effect}));
    assert_eq!(added.status, 201, "{}", added.body);
    let page = service.client.json("/v1/effects/pull_shift");
    assert_eq!(
        page["effect"]["parameters"][0]["prior"],
        json!({"normal": [0, 0.5]})
    );
    let id = service.submit(&job("[\"pull_shift\"]"));
    let text = stored(&service, id, "pull_shift@1.toml");
    assert_eq!(page["text"], text);
    // The form in which it is kept can be sent again.
    assert_eq!(add(&service, &text).status, 200);
}

#[test]
fn what_is_no_effect_of_one_s_own_is_refused_with_the_reason() {
    let service = Service::start(&[]);
    let unit = add(&service, &GAIN.replace("1 + gain", "1 + width"));
    says(
        &unit,
        422,
        "invalid_file",
        "effect.toml line 4, column 44: both sides of + must have the same unit, not J and N",
    );
    let prior = add(&service, &GAIN.replace("[0.0, 0.2]", "[0.0, -0.2]"));
    let message = "effect.toml line 5: prior of parameter gain: sd -0.2 is not above 0";
    says(&prior, 422, "invalid_file", message);
    let taken = add(&service, &GAIN.replace("my_gain", "sled_tare"));
    let message = "the effect sled_tare belongs to the library: give yours another name";
    says(&taken, 409, "conflict", message);
    for body in [json!({}), json!({"text": GAIN, "effect": {}})] {
        let response = service.client.post("/v1/effects", &body);
        assert_eq!(response.status, 400);
        assert_eq!(response.json()["error"]["type"], "invalid_body");
    }
    let long = add(&service, &format!("{GAIN}#{}", "x".repeat(64 << 10)));
    says(
        &long,
        413,
        "too_large",
        "the body is above the limit of 65536 bytes for this route",
    );
    assert_eq!(item_count(&service.client.json("/v1/effects")), 52);

    add(&service, GAIN);
    let experiment = service
        .client
        .post("/v1/experiments", &Job::small().experiment_json());
    let submit = |effects: &str| {
        let new = json!({"experiment": experiment.json()["id"], "toml": job(effects).job});
        service.client.post("/v1/calibrations", &new)
    };
    // The line of a mistake is that of the text that was sent.
    let mut wrong = job("[\"my_gain\"]");
    wrong.job = wrong.job.replace("kappa = 0.0", "kapa = 0.0");
    let line = wrong
        .job
        .lines()
        .position(|line| line.starts_with("kapa"))
        .expect("a line")
        + 1;
    let new = json!({"experiment": experiment.json()["id"], "toml": wrong.job});
    let refused = service.client.post("/v1/calibrations", &new).body;
    assert_contains!(refused, &format!("job.toml line {line}: unknown"));
    let message = "job.toml: effect my_gain has no version \"2\"; the last one is 1";
    says(&submit("[\"my_gain@2\"]"), 422, "invalid_file", message);
    let message = "job.toml: effect_files: \"my_gain@1.toml\" appears twice";
    says(
        &submit("[\"my_gain\", \"my_gain@1\"]"),
        422,
        "invalid_file",
        message,
    );
}

#[test]
fn only_who_may_submit_adds_an_effect_and_the_store_says_who_did() {
    let mut service = Service::start(&[]);
    let store = service.store_name().to_owned();
    let token = |name: &str, role: &str| {
        let command = programs::coordinator(["token", "add", name, "--role", role, "--store", &store]);
        programs::run(command).success().trim().to_owned()
    };
    let [read, submit] = [token("reader", "read"), token("anna", "submit")];
    let send = |token: &str| {
        let bearer = format!("Bearer {token}");
        let head = [
            ("Content-Type", "application/json"),
            ("Authorization", bearer.as_str()),
        ];
        service
            .client
            .post_bytes("/v1/effects", &head, json!({"text": GAIN}).to_string().as_bytes())
    };
    until_true("a token asked for", || add(&service, GAIN).status == 401);
    assert_eq!(send(&read).status, 403);
    let added = send(&submit);
    assert!([200, 201].contains(&added.status), "{}", added.body);
    let log = service.log();
    assert!(log.contains("by=\"anna\"") || log.contains("by=anna"), "{log}");
    service.terminate();
}
