//! A model gives the same bits by either kind, with any number of workers, and after any kill.

use farm_tests::service::Service;
use farm_tests::text::same;
use farm_tests::wait::until;

use super::{honest, job, program, program_job, short, write_program};

fn posterior(service: &Service, id: i64) -> String {
    service.wait_for(id, "finished");
    service.posterior_csv(id)
}

#[test]
fn one_worker_and_three_that_are_killed_give_the_same_bits_by_both_kinds() {
    let server = honest();
    let by_server = short(job(&server.url));
    let expected = {
        let service = Service::start(&[]);
        let id = service.submit(&by_server);
        let _worker = service.worker_of("worker", 1, &server.url);
        posterior(&service, id)
    };
    assert_eq!(expected.lines().count(), 21);
    let mut service = Service::start(&["--lease-ms", "500"]);
    let folder = service.folder().to_owned();
    let path = write_program(&folder, &program(""));
    let mut kills = 0;
    for (job, allowed) in [(by_server, &server.url), (short(program_job()), &path)] {
        let id = service.submit(&job);
        let mut workers = ["a", "b", "c"].map(|name| service.worker_of(name, 1, allowed));
        for (victim, worker) in workers.iter_mut().enumerate() {
            let before = service.evaluations(id).unwrap_or_default();
            let is_over = until("progress", || {
                let is_over = service.status(id)["state"] == "finished";
                (is_over || service.evaluations(id)? > before + 10).then_some(is_over)
            });
            kills += usize::from(!is_over);
            worker.kill();
            *worker = service.worker_of(&format!("again-{victim}"), 1, allowed);
            if victim == 1 {
                service.crash();
            }
        }
        same(&posterior(&service, id), &expected);
    }
    assert!(kills >= 3, "only {kills} workers were killed before the end");
}
