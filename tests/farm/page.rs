//! The page as a service serves it, and the report, which carries what the service answers.

use farm_tests::job::Job;
use farm_tests::programs::{call, coordinator, run};
use farm_tests::service::Service;
use serde_json::{Map, Value};

/// Returns the paths that a text of the page names.
fn named(text: &str) -> impl Iterator<Item = &str> {
    text.split('"').filter(|part| part.starts_with("/page/"))
}

#[test]
fn the_page_needs_no_token_and_nothing_from_elsewhere() {
    let service = Service::start(&[]);
    let added = [
        "token",
        "add",
        "reader",
        "--role",
        "read",
        "--store",
        service.store_name(),
    ];
    run(coordinator(added)).success();
    farm_tests::wait::until_true("tokens are asked for", || {
        service.client.get("/v1/studies").status == 401
    });
    for document in ["/", "/docs"] {
        let document = service.client.get(document);
        assert_eq!(document.status, 200, "{}", document.body);
        let policy = document.header("content-security-policy").expect("a policy");
        assert!(
            policy.starts_with("default-src 'none'; script-src 'self';"),
            "{policy}"
        );
        assert!(!document.body.contains("http"), "{}", document.body);
        assert!(named(&document.body).count() > 4);
        for path in named(&document.body) {
            let file = service.client.get(path);
            assert_eq!(file.status, 200, "{path}");
            assert!(
                !file
                    .header("content-type")
                    .unwrap_or("text/plain")
                    .starts_with("text/plain"),
                "{path}"
            );
        }
    }
    for path in [
        "/page/",
        "/page/none.js",
        "/page/../Cargo.toml",
        "/page/modules/%2e%2e/page.js",
    ] {
        assert_eq!(service.client.get(path).status, 404, "{path}");
    }
}

/// Returns the answers that a report carries.
fn answers(report: &str) -> Map<String, Value> {
    let (_, rest) = report.split_once("id=\"answers\">").expect("answers");
    let (answers, _) = rest.split_once("</script>").expect("their end");
    serde_json::from_str(answers).expect("JSON")
}

#[test]
fn a_report_carries_the_answers_of_the_service() {
    let service = Service::start(&["--local-workers", "2"]);
    let id = service.calibrate(&Job::small());
    let extension = serde_json::json!({"effect": "slip_sinkage"});
    let extended = service
        .client
        .post(&format!("/v1/calibrations/{id}/extend"), &extension);
    let extended = extended.json()["id"].as_i64().expect("an id");
    service.wait_for(extended, "finished");
    let report = call(
        "coordinator report {} --url {}",
        &[&extended.to_string(), &service.url()],
    )
    .success();
    let answers = answers(&report);
    // Seven of each calibration, those of the study, and the grid of predictions of the current model.
    assert_eq!(answers.len(), 2 * 7 + 1 + 1, "{:?}", answers.keys());
    for (path, answer) in &answers {
        assert_eq!(&service.client.json(path), answer, "{path}");
    }
    // The reports of the calibrations of a study differ in the calibration that they show first.
    assert!(report.contains(&format!("{{\"calibration\":{extended},\"study\":1}}")));
    let first = service.part(id, "report").body;
    assert!(first.contains(&format!("{{\"calibration\":{id},\"study\":1}}")));
}
