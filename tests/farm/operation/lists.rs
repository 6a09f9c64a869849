//! Lists page by page.

use farm_tests::job::Job;
use farm_tests::json::{items, whole};
use farm_tests::programs::{coordinator, run};
use farm_tests::service::Service;
use serde_json::{Value, json};

fn ids(list: &Value) -> Vec<u64> {
    items(list).map(|entry| whole(&entry["id"])).collect()
}

/// Returns the numbers of the entries of a list, of which each page has two.
fn paged(service: &Service, path: &str, between: impl Fn(usize)) -> Vec<u64> {
    let mut found: Vec<u64> = Vec::new();
    for page in 0.. {
        let after = found
            .last()
            .map_or_else(String::new, |last| format!("&after={last}"));
        let entries = ids(&service.client.json(&format!("{path}?limit=2{after}")));
        let is_last = entries.len() < 2;
        found.extend(entries);
        if is_last {
            break;
        }
        between(page);
    }
    found
}

#[test]
fn pages_of_a_list_are_together_the_list_whatever_is_archived_between_them() {
    let service = Service::start(&[]);
    for _ in 0..7 {
        let id = service.submit(&Job::small());
        service
            .client
            .post(&format!("/v1/calibrations/{id}/cancel"), &json!({}));
    }
    let archive = |study: u64| {
        let path = format!("/v1/studies/{study}/archive");
        assert_eq!(service.client.post(&path, &json!({})).status, 200);
    };
    archive(2);
    for path in ["/v1/calibrations", "/v1/studies"] {
        assert_eq!(paged(&service, path, |_| {}), [1, 3, 4, 5, 6, 7], "{path}");
        assert_eq!(ids(&service.client.json(path)), [1, 3, 4, 5, 6, 7], "{path}");
    }
    assert_eq!(paged(&service, "/v1/experiments", |_| {}), [1, 2, 3, 4, 5, 6, 7]);
    let found = paged(&service, "/v1/calibrations", |page| {
        if page == 0 {
            archive(1);
            archive(5);
        }
    });
    assert_eq!(found, [1, 3, 4, 6, 7]);
    let list =
        |more: &[&str]| run(coordinator([&["list", "--url", &service.url()], more].concat())).success();
    let lines = |more: &[&str]| {
        list(more)
            .lines()
            .filter(|line| line.contains("cancelled"))
            .count()
    };
    assert_eq!(
        [lines(&[]), lines(&["--limit", "2"]), lines(&["--after", "4"])],
        [4, 2, 2]
    );
}

#[test]
fn effects_and_workers_have_pages_by_name_and_limits_have_bounds() {
    let service = Service::start(&[]);
    let whole_list = service.client.json("/v1/effects");
    let names: Vec<&str> = items(&whole_list)
        .filter_map(|effect| effect["name"].as_str())
        .collect();
    let page = service
        .client
        .json(&format!("/v1/effects?limit=2&after={}", names[1]));
    let behind: Vec<&str> = items(&page)
        .filter_map(|effect| effect["name"].as_str())
        .collect();
    assert_eq!(behind, names[2..4]);
    assert_eq!(service.client.json("/v1/workers?limit=1&after=a"), json!({}));
    for limit in ["0", "10001"] {
        let refused = service.client.get(&format!("/v1/calibrations?limit={limit}"));
        assert_eq!(refused.status, 400);
        assert_eq!(
            refused.json()["error"]["message"],
            format!("limit = {limit} must lie in 1 to 10000")
        );
    }
}
