//! Requests from pages of other sites in a user's browser are refused, by content type, `Origin` and `Host`.

use farm_tests::assert_contains;
use farm_tests::job::Job;
use farm_tests::service::Service;
use serde_json::json;

#[test]
fn a_foreign_page_neither_pauses_resumes_cancels_nor_searches() {
    let service = Service::start(&[]);
    let id = service.submit(&Job::small());
    let path = |verb: &str| format!("/v1/calibrations/{id}/{verb}");
    let json = ("Content-Type", "application/json");
    let host = service.client.0.clone();
    let ours = format!("http://{host}");
    for verb in ["pause", "resume", "cancel", "discovery", "extend"] {
        let post = |head: &[(&str, &str)], body: Option<&[u8]>| {
            let answer = service.client.exchange("POST", &path(verb), head, body);
            let answer = answer.expect("an answer");
            let kind = answer.json()["error"]["type"]
                .as_str()
                .unwrap_or_default()
                .to_owned();
            (answer.status, kind)
        };
        let unsupported = (415, "unsupported_media_type".to_owned());
        assert_eq!(post(&[], None), unsupported, "{verb} without a body");
        for form in [
            "text/plain",
            "application/x-www-form-urlencoded",
            "multipart/form-data",
        ] {
            assert_eq!(
                post(&[("Content-Type", form)], Some(b"{}")),
                unsupported,
                "{verb} as {form}"
            );
        }
        let forbidden = (403, "forbidden".to_owned());
        for origin in [
            "http://evil.example",
            "null",
            "http://127.0.0.1:1",
            "https://localhost",
        ] {
            assert_eq!(
                post(&[json, ("Origin", origin)], Some(b"{}")),
                forbidden,
                "{verb} from {origin}"
            );
        }
        for foreign in ["evil.example", "evil.example:7070", "192.0.2.7"] {
            assert_eq!(
                post(&[json, ("Host", foreign)], Some(b"{}")),
                forbidden,
                "{verb} to {foreign}"
            );
        }
    }
    assert_eq!(service.status(id)["state"], "queued");
    let foreign = service
        .client
        .exchange("GET", "/v1/calibrations", &[("Host", "evil.example")], None);
    assert_eq!(foreign.expect("an answer").status, 403, "a foreign name reads");

    let own = service
        .client
        .exchange("POST", &path("pause"), &[json, ("Origin", &ours)], Some(b"{}"));
    assert_eq!(own.expect("an answer").json(), json!({"state": "paused"}));
}

#[test]
fn a_proxy_is_reached_by_the_names_that_it_is_started_with() {
    let service = Service::start(&["--host", "farm.example"]);
    let get = |host: &str| {
        let answer = service
            .client
            .exchange("GET", "/v1/calibrations", &[("Host", host)], None);
        answer.expect("an answer").status
    };
    assert_eq!(get("farm.example"), 200);
    assert_eq!(get("farm.example:8443"), 200);
    assert_eq!(get("localhost"), 200);
    assert_eq!(get("other.example"), 403);
    let both = [("Host", "farm.example"), ("Host", "other.example")];
    for head in [both, [both[1], both[0]]] {
        let answer = service.client.exchange("GET", "/v1/calibrations", &head, None);
        let answer = answer.expect("an answer");
        assert_eq!(answer.status, 400, "{}", answer.body);
        assert_contains!(answer.body, "Host: 2 header fields must be 1");
    }
}
