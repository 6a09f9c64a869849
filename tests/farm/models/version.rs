//! Who may run which model.

use farm_tests::service::Service;
use farm_tests::wait::until;

use super::{program, program_job, write_program};

#[test]
fn a_worker_runs_nothing_that_its_operator_has_not_allowed_and_says_so() {
    let service = Service::start(&[]);
    let mark = service.folder().join("started");
    let text = program(&format!("open({:?}, \"w\").close()", mark.display().to_string()));
    write_program(service.folder(), &text);
    let id = service.submit(&program_job());
    let worker = service.worker("worker", 1);
    until("a word of the worker", || {
        let log = worker.log();
        (log.contains("is of the model wheel.py") && log.contains("--allow-model")).then_some(())
    });
    assert_eq!(service.metric("grouser_leases_given_total"), 0);
    assert!(!mark.exists());
    assert_eq!(service.status(id)["state"], "queued");
}
