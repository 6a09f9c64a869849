//! The same bits by whatever kind, however many workers, whatever is killed.

use farm_tests::service::Service;
use farm_tests::text::same;
use farm_tests::wait::until;

use super::{honest, job, program, program_job, write_program};

fn posterior(service: &Service, id: i64) -> String {
    service.wait_for(id, "finished");
    service.posterior_csv(id)
}

#[test]
fn one_worker_and_three_that_are_killed_give_the_same_bits_by_both_kinds() {
    let server = honest();
    let expected = {
        let service = Service::start(&[]);
        let id = service.submit(&job(&server.url));
        let _worker = service.worker_of("worker", 1, &server.url);
        posterior(&service, id)
    };
    assert_eq!(expected.lines().count(), 61);
    let mut service = Service::start(&["--lease-ms", "500"]);
    let folder = service.folder().to_owned();
    let path = write_program(&folder, &program(""));
    for (kind, allowed) in [(job(&server.url), &server.url), (program_job(), &path)] {
        let id = service.submit(&kind);
        let mut workers = ["a", "b", "c"].map(|name| service.worker_of(name, 1, allowed));
        for (victim, worker) in workers.iter_mut().enumerate() {
            let before = service.evaluations(id).unwrap_or_default();
            until("progress", || {
                let is_over = service.status(id)["state"] == "finished";
                (is_over || service.evaluations(id)? > before + 20).then_some(())
            });
            worker.kill();
            *worker = service.worker_of(&format!("again-{victim}"), 1, allowed);
            if victim == 1 {
                service.kill();
                service.restart();
            }
        }
        same(&posterior(&service, id), &expected);
    }
}
