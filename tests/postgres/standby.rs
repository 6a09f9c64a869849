//! A standby takes over from a coordinator that dies.

use std::time::{Duration, Instant};

use farm_tests::http::Client;
use farm_tests::job::Job;
use farm_tests::process::{Process, Signal};
use farm_tests::programs::{call, coordinator, run};
use farm_tests::service::{Service, free_address};
use farm_tests::wait::{until, until_true};

/// The longest time until a calibration goes on after the end of its coordinator.
const TAKE_OVER: Duration = Duration::from_secs(10);

/// Returns the posterior of the job without disturbance.
fn undisturbed() -> String {
    let service = Service::start(&["--local-workers", "2"]);
    let id = service.calibrate(&Job::small());
    service.posterior_csv(id)
}

#[test]
fn a_standby_goes_on_with_the_same_bits_within_ten_seconds_of_a_kill() {
    let expected = undisturbed();
    let mut service = Service::start(&["--lease-ms", "2000"]);
    let mut standbys = vec![service.standby("standby-1"), service.standby("standby-2")];
    let id = service.submit(&Job::small());
    let _worker = service.worker("worker", 1);
    for least in [100, 250] {
        until("some evaluations", || {
            service.evaluations(id).filter(|&done| done >= least)
        });
        until_true("coordinators that stand by", || {
            let is_waiting =
                |standby: &mut farm_tests::process::Process| standby.log().contains("standing by");
            standbys.iter_mut().all(is_waiting)
        });
        let before = service.evaluations(id).expect("a count");
        match least {
            100 => service.kill(),
            // The standby that serves now is one of the two.
            _ => {
                let serving = standbys
                    .iter()
                    .position(|standby| standby.log().contains("serving"));
                standbys.remove(serving.expect("a standby serves")).kill();
            }
        }
        let killed = Instant::now();
        until("progress under the standby", || {
            service.evaluations(id).filter(|&done| done > before)
        });
        assert!(killed.elapsed() < TAKE_OVER, "{:?}", killed.elapsed());
        println!("went on {:.1} s after the kill", killed.elapsed().as_secs_f64());
    }
    service.wait_for(id, "finished");
    assert_eq!(service.posterior_csv(id), expected);
}

#[test]
fn a_standby_takes_over_from_a_halted_coordinator_which_ends_when_it_wakes_up() {
    let expected = undisturbed();
    let mut service = Service::start(&["--lease-ms", "2000"]);
    let id = service.submit(&Job::small());
    let worker = service.worker("worker", 1);
    until("some evaluations", || {
        service.evaluations(id).filter(|&done| done >= 100)
    });
    // The halted one keeps its address.
    let address = free_address();
    let words = [
        "serve",
        "--standby",
        "--insecure",
        "--listen",
        &address,
        "--store",
        service.store_name(),
    ];
    let standby = Process::start(coordinator(words), &service.folder().join("standby.log"));
    until_true("a coordinator that stands by", || {
        standby.log().contains("standing by")
    });
    service.signal(Signal::Stop);
    let halted = Instant::now();
    until_true("the standby serves", || standby.log().contains("serving"));
    assert!(halted.elapsed() < TAKE_OVER, "{:?}", halted.elapsed());
    println!("took over {:.1} s after the halt", halted.elapsed().as_secs_f64());
    service.signal(Signal::Continue);
    assert!(!service.wait(), "it says that it failed");
    drop(worker);
    let _worker = Process::worker(&format!("http://{address}"), 1, &service.folder().join("w2.log"));
    let there = Client(address.clone());
    until_true("the end of the calibration", || {
        there.json(&format!("/v1/calibrations/{id}"))["state"] == "finished"
    });
    let url = format!("http://{address}");
    let posterior = call("coordinator export {} --url {}", &[&id.to_string(), &url]).success();
    assert_eq!(posterior, expected);
}

#[test]
fn a_standby_takes_over_within_a_transaction_of_a_halted_coordinator_but_not_within_an_upgrade() {
    let mut service = Service::start(&[]);
    service.kill();
    let mut halted = service.database();
    until_true("the lock is free", || {
        halted.text("SELECT pg_try_advisory_lock(x'67726f75736572'::bigint)::text") == "true"
    });
    halted.execute("BEGIN; SET application_name = 'grouser upgrade'");
    let standby = service.standby("standby");
    let is_serving = || standby.log().contains("serving");
    std::thread::sleep(TAKE_OVER);
    assert!(!is_serving(), "{}", standby.log());
    halted.execute("SET application_name = 'grouser'");
    let begin = Instant::now();
    until_true("the standby serves", is_serving);
    assert!(begin.elapsed() < TAKE_OVER, "{:?}", begin.elapsed());
}

#[test]
fn a_second_coordinator_is_turned_away_and_the_password_is_not_shown() {
    let service = Service::start(&[]);
    let store = service.store_name().replacen("@", ":secret@", 1);
    let refusal = call("coordinator serve --listen 127.0.0.1:0 --store {}", &[&store]).refusal();
    assert!(refusal.ends_with("another coordinator is using it"), "{refusal}");
    assert!(refusal.contains("store postgres://"), "{refusal}");
    assert!(!refusal.contains("secret"), "{refusal}");
    let blank = farm_tests::server::ServerDatabase::new().expect("a server");
    let store = blank.url().replacen("@", ":secret@", 1);
    let refusal = run(coordinator(["serve", "--listen", "0.0.0.0:0", "--store", &store])).refusal();
    assert!(refusal.contains("has no token"), "{refusal}");
    assert!(!refusal.contains("secret"), "{refusal}");
}
