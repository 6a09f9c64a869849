//! `coordinator serve` on a port and a store that outlive its process: a file, or a database where the tests are given a server.

use std::net::TcpListener;
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicU16, Ordering};

use serde_json::{Value, json};
use tempfile::TempDir;

use crate::database::Database;
use crate::http::{Client, Response};
use crate::job::Job;
use crate::process::{Process, Signal};
use crate::programs;
use crate::server::ServerDatabase;
use crate::wait::until;

/// A service that can be killed and started again where it was.
#[derive(Debug)]
pub struct Service {
    /// The client of its address.
    pub client: Client,
    folder: TempDir,
    database: Option<ServerDatabase>,
    store_name: String,
    arguments: Vec<String>,
    max_descriptors: Option<u32>,
    process: Option<Process>,
}

impl Service {
    /// Starts a service on an empty store; `more` are arguments such as `--lease-ms`. It verifies no evaluation unless `--verify-percent`
    /// is among them, because a second worker would not repeat the invented answers of a [`FakeWorker`](crate::fake_worker::FakeWorker).
    pub fn start(more: &[&str]) -> Service {
        Service::start_at(free_address(), more)
    }

    /// Starts a service on an empty store that may have at most this many files and connections open.
    pub fn start_with_descriptors(max_descriptors: u32) -> Service {
        let mut service = Service::start(&[]);
        service.kill();
        service.max_descriptors = Some(max_descriptors);
        service.restart();
        service
    }

    /// Starts a service on an empty store at an address.
    pub fn start_at(address: String, more: &[&str]) -> Service {
        let folder = tempfile::tempdir().expect("a folder for the store");
        let database = ServerDatabase::new();
        let store_name = match &database {
            Some(database) => database.url(),
            None => format!("sqlite://{}", folder.path().join("grouser.db").display()),
        };
        Service::launch(address, folder, database, store_name, more)
    }

    /// Starts a service on an existing store.
    pub fn start_on(store_name: &str, more: &[&str]) -> Service {
        let folder = tempfile::tempdir().expect("a folder for the log");
        Service::launch(free_address(), folder, None, store_name.to_owned(), more)
    }

    fn launch(
        address: String,
        folder: TempDir,
        database: Option<ServerDatabase>,
        store_name: String,
        more: &[&str],
    ) -> Service {
        let mut arguments = ["serve", "--listen", &address, "--store", &store_name]
            .map(str::to_owned)
            .to_vec();
        arguments.extend(more.iter().map(|&a| a.to_owned()));
        if !more.contains(&"--verify-percent") {
            arguments.extend(["--verify-percent", "0"].map(str::to_owned));
        }
        let mut service = Service {
            client: Client(address),
            folder,
            database,
            store_name,
            arguments,
            max_descriptors: None,
            process: None,
        };
        service.restart();
        service
    }

    /// Kills it and starts it again on the same store and port.
    pub fn crash(&mut self) {
        self.kill();
        self.restart();
    }

    /// Starts it again on the same store and port.
    pub fn restart(&mut self) {
        assert!(self.process.is_none(), "the service is running");
        let mut command = programs::coordinator(&self.arguments);
        if let Some(count) = self.max_descriptors {
            command = programs::with_descriptors(count, &command);
        }
        let mut process = Process::start(command, &self.folder.path().join("coordinator.log"));
        until("an answer of the service", || {
            assert!(process.is_running(), "the service ended:\n{}", process.log());
            self.client.try_get("/health").ok().filter(|r| r.status == 200)
        });
        self.process = Some(process);
    }

    /// Kills it with SIGKILL.
    pub fn kill(&mut self) {
        self.process.take().expect("the service is running").kill();
    }

    /// Sends it a signal.
    #[track_caller]
    pub fn signal(&self, signal: Signal) {
        self.process().signal(signal);
    }

    /// Sends SIGTERM and waits for the end; returns whether the service exited with status 0.
    pub fn terminate(&mut self) -> bool {
        self.process().signal(Signal::Terminate);
        self.wait()
    }

    /// Waits for the end; returns whether the service exited with status 0.
    #[track_caller]
    pub fn wait(&mut self) -> bool {
        let process = self.process.take();
        process.expect("the service is running").wait().success()
    }

    fn process(&self) -> &Process {
        self.process.as_ref().expect("the service is running")
    }

    /// Returns the URL for workers and verbs.
    pub fn url(&self) -> String {
        format!("http://{}", self.client.0)
    }

    /// Memory that its process holds `[kB]`.
    pub fn resident_kb(&self) -> u64 {
        self.process().resident_kb().expect("the service is running")
    }

    /// Returns the largest memory that it ever held `[kB]`.
    pub fn peak_kb(&self) -> u64 {
        self.process().peak_kb().expect("the service is running")
    }

    /// Returns the bytes of answers that the operating system holds because their clients have not read them, and the number of open
    /// connections, from proc(5).
    pub fn unread(&self) -> (u64, usize) {
        let port = self.client.0.rsplit(':').next();
        let port: u16 = port
            .and_then(|port| port.parse().ok())
            .expect("an address has a port");
        let table = std::fs::read_to_string("/proc/net/tcp").expect("a table of connections");
        let local_end = format!(":{port:04X}");
        let (mut bytes, mut open) = (0, 0);
        for line in table.lines() {
            let words: Vec<&str> = line.split_whitespace().collect();
            let [_, local, _, state, queues, ..] = words[..] else {
                continue;
            };
            if local.ends_with(&local_end) && state != "0A" {
                let queue = queues.split(':').next().unwrap_or_default();
                bytes += u64::from_str_radix(queue, 16).unwrap_or_default();
                open += usize::from(state == "01");
            }
        }
        (bytes, open)
    }

    /// Returns the file of its store.
    #[track_caller]
    pub fn store(&self) -> PathBuf {
        let file = self.store_name.strip_prefix("sqlite://");
        file.expect("this test is of stores in files").into()
    }

    /// Returns the value of `--store` for its store.
    pub fn store_name(&self) -> &str {
        &self.store_name
    }

    /// Opens its store with another client.
    #[track_caller]
    pub fn database(&self) -> Database {
        Database::open(&self.store_name)
    }

    /// Returns the database of its store.
    #[track_caller]
    pub fn server_database(&self) -> &ServerDatabase {
        let database = self.database.as_ref();
        database.expect("GROUSER_TEST_POSTGRES names a server")
    }

    /// Starts another coordinator on the same store and address, which waits for the end of this one.
    #[track_caller]
    pub fn standby(&self, name: &str) -> Process {
        let mut arguments = self.arguments.clone();
        arguments.push("--standby".into());
        let log = self.folder.path().join(format!("{name}.log"));
        Process::start(programs::coordinator(&arguments), &log)
    }

    /// Returns a folder for the files of a test.
    pub fn folder(&self) -> &Path {
        self.folder.path()
    }

    /// Starts a worker with a log of its own.
    pub fn worker(&self, name: &str, threads: usize) -> Process {
        self.worker_with(name, threads, &[])
    }

    /// Starts a worker that may run an external model: the file of a program, or the URL of a server.
    pub fn worker_of(&self, name: &str, threads: usize, model: &str) -> Process {
        self.worker_with(name, threads, &["--allow-model", model])
    }

    /// Starts a worker with further arguments.
    pub fn worker_with(&self, name: &str, threads: usize, more: &[&str]) -> Process {
        let (url, threads) = (self.url(), threads.to_string());
        let words = [&["--coordinator", &url, "--threads", &threads], more].concat();
        Process::start(
            programs::worker(words),
            &self.folder.path().join(format!("{name}.log")),
        )
    }

    /// Starts a worker of one thread that sends JSON.
    pub fn json_worker(&self, name: &str) -> Process {
        self.json_worker_at(&self.url(), name)
    }

    /// Starts a worker of one thread that sends JSON to a proxy in front of the service.
    pub fn json_worker_at(&self, url: &str, name: &str) -> Process {
        let mut command = programs::worker(["--coordinator", url, "--threads", "1"]);
        command.env("GROUSER_WIRE", "json");
        Process::start(command, &self.folder.path().join(format!("{name}.log")))
    }

    /// Posts a document that must be created; returns the answer.
    #[track_caller]
    pub fn create(&self, path: &str, body: &Value) -> Value {
        let response = self.client.post(path, body);
        assert_eq!(response.status, 201, "{path}: {}", response.body);
        response.json()
    }

    /// Submits a job by plain HTTP; returns its id.
    #[track_caller]
    pub fn submit(&self, job: &Job) -> i64 {
        let experiment = self.create("/v1/experiments", &job.experiment_json())["id"].take();
        let new = json!({"experiment": experiment, "toml": job.job, "files": job.effect_files()});
        id(&self.create("/v1/calibrations", &new))
    }

    /// Submits a job and waits until its calibration is finished; returns its id.
    #[track_caller]
    pub fn calibrate(&self, job: &Job) -> i64 {
        let id = self.submit(job);
        self.wait_for(id, "finished");
        id
    }

    /// Extends a calibration by an effect; returns the id of the new calibration.
    #[track_caller]
    pub fn extend(&self, calibration: i64, effect: &str) -> i64 {
        let path = format!("/v1/calibrations/{calibration}/extend");
        id(&self.create(&path, &json!({ "effect": effect })))
    }

    /// Posts to a verb of a calibration, such as `pause`.
    #[track_caller]
    pub fn act(&self, calibration: i64, verb: &str) -> Response {
        self.client
            .post(&format!("/v1/calibrations/{calibration}/{verb}"), &json!({}))
    }

    /// Returns the answer to `GET` of a part of a calibration, such as `report`.
    #[track_caller]
    pub fn part(&self, calibration: i64, part: &str) -> Response {
        self.client.get(&format!("/v1/calibrations/{calibration}/{part}"))
    }

    /// Returns the JSON of a result of a calibration, such as `summary`, which must be there.
    #[track_caller]
    pub fn result(&self, calibration: i64, part: &str) -> Value {
        self.client
            .json(&format!("/v1/calibrations/{calibration}/{part}"))
    }

    /// Returns the status of a calibration.
    #[track_caller]
    pub fn status(&self, id: i64) -> Value {
        self.client.json(&format!("/v1/calibrations/{id}"))
    }

    /// Returns the number of evaluations so far; `None` while the service does not answer or the calibration is not in progress.
    pub fn evaluations(&self, id: i64) -> Option<u64> {
        let response = self.client.try_get(&format!("/v1/calibrations/{id}")).ok()?;
        (response.status == 200).then(|| response.json()["progress"]["evaluations"].as_u64())?
    }

    /// Waits until a calibration is in a state; fails where it ends or pauses in another one.
    #[track_caller]
    pub fn wait_for(&self, id: i64, state: &str) -> Value {
        until(&format!("calibration {id} {state}"), || {
            let status = self.status(id);
            let now = status["state"].as_str().unwrap_or_default().to_owned();
            let over = ["finished", "failed", "cancelled"].contains(&now.as_str());
            assert!(now == state || !over, "{status}");
            assert!(now == state || now != "paused", "{status}");
            (now == state).then_some(status)
        })
    }

    /// Returns the posterior of a finished calibration, as `export --format csv` writes it.
    #[track_caller]
    pub fn posterior_csv(&self, id: i64) -> String {
        programs::call("coordinator export {} --url {}", &[&id.to_string(), &self.url()]).success()
    }

    /// Returns a figure of the metrics page.
    #[track_caller]
    pub fn metric(&self, name: &str) -> u64 {
        let page = self.client.get("/metrics").body;
        let mut lines = page.lines();
        let value = lines.find_map(|line| line.strip_prefix(name)?.strip_prefix(' '));
        let value = value.and_then(|value| value.parse().ok());
        value.unwrap_or_else(|| panic!("no {name} in\n{page}"))
    }

    /// Returns the record of the only worker; `None` before its first exchange.
    #[track_caller]
    pub fn only_worker(&self) -> Option<Value> {
        let workers = self.client.json("/v1/workers");
        let records = workers.as_object()?;
        assert!(records.len() < 2, "{workers}");
        records.values().next().cloned()
    }

    /// Returns the version of the equations that the program `worker` states to this service.
    #[track_caller]
    pub fn model_version(&self) -> String {
        let worker = self.worker("version", 1);
        let record = until("an exchange of a worker", || self.only_worker());
        drop(worker);
        record["model_version"].as_str().unwrap_or_default().to_owned()
    }

    /// Returns the standard error of the service since its first start.
    pub fn log(&self) -> String {
        let log = std::fs::read(self.folder.path().join("coordinator.log")).expect("the log can be read");
        String::from_utf8_lossy(&log).into_owned()
    }
}

/// Returns the number under `id` in an answer.
#[track_caller]
pub fn id(answer: &Value) -> i64 {
    answer["id"]
        .as_i64()
        .unwrap_or_else(|| panic!("no id in {answer}"))
}

/// Returns an address on which nothing listens, outside the range that the system gives to outgoing connections: it stays free while its
/// service is down.
pub fn free_address() -> String {
    static NEXT: AtomicU16 = AtomicU16::new(0);
    let start = (std::process::id() % 10_000) as u16;
    for _ in 0..10_000 {
        let port = 20_000 + (start + NEXT.fetch_add(1, Ordering::Relaxed)) % 10_000;
        let address = format!("127.0.0.1:{port}");
        if TcpListener::bind(&address).is_ok() {
            return address;
        }
    }
    panic!("no free port");
}
