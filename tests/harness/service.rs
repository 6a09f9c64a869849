//! `coordinator serve` on a port and a store that outlive its process: a file, or a database where the tests are told of a server.

use std::net::TcpListener;
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicU16, Ordering};

use serde_json::{Value, json};
use tempfile::TempDir;

use crate::database::Database;
use crate::http::Client;
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
    /// Starts a service on an empty store; `more` are arguments such as `--lease-ms`. It verifies nothing unless `--verify-percent` is
    /// among them: what workers played by hand answer is nothing that a second one would.
    pub fn start(more: &[&str]) -> Service {
        Service::start_at(free_address(), more)
    }

    /// Starts a service on an empty store that may have so many files and connections open.
    ///
    /// # Panics
    /// It does not start.
    pub fn start_with_descriptors(max_descriptors: u32) -> Service {
        let mut service = Service::start(&[]);
        service.kill();
        service.max_descriptors = Some(max_descriptors);
        service.restart();
        service
    }

    /// Starts a service on an empty store at an address.
    ///
    /// # Panics
    /// It does not start.
    pub fn start_at(address: String, more: &[&str]) -> Service {
        let folder = tempfile::tempdir().expect("a folder for the store");
        let database = ServerDatabase::new();
        let store_name = match &database {
            Some(database) => database.url(),
            None => format!("sqlite://{}", folder.path().join("grouser.db").display()),
        };
        Service::of(address, folder, database, store_name, more)
    }

    /// Starts a service on a store that is there.
    ///
    /// # Panics
    /// It does not start.
    pub fn start_on(store_name: &str, more: &[&str]) -> Service {
        let folder = tempfile::tempdir().expect("a folder for the log");
        Service::of(free_address(), folder, None, store_name.to_owned(), more)
    }

    fn of(
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

    /// Starts it again, on the same store and port.
    ///
    /// # Panics
    /// It runs, or does not start.
    pub fn restart(&mut self) {
        assert!(self.process.is_none(), "the service is running");
        let command = programs::coordinator(&self.arguments);
        let command = match self.max_descriptors {
            Some(count) => programs::with_descriptors(count, &command),
            None => command,
        };
        let mut process = Process::start(command, &self.folder.path().join("coordinator.log"));
        until("an answer of the service", || {
            assert!(process.is_running(), "the service ended:\n{}", process.log());
            self.client.try_get("/health").ok().filter(|r| r.status == 200)
        });
        self.process = Some(process);
    }

    /// Kills it with SIGKILL.
    ///
    /// # Panics
    /// It is not running.
    pub fn kill(&mut self) {
        self.process.take().expect("the service is running").kill();
    }

    /// Sends SIGTERM and waits for its end; whether that was orderly.
    ///
    /// # Panics
    /// It is not running.
    pub fn terminate(&mut self) -> bool {
        let mut process = self.process.take().expect("the service is running");
        process.signal(Signal::Terminate);
        process.wait().success()
    }

    /// Waits for its end; whether that was orderly.
    ///
    /// # Panics
    /// It is not running, or does not end in time.
    #[track_caller]
    pub fn wait(&mut self) -> bool {
        self.process
            .take()
            .expect("the service is running")
            .wait()
            .success()
    }

    /// URL for workers and verbs.
    pub fn url(&self) -> String {
        format!("http://{}", self.client.0)
    }

    /// Memory that its process holds `[kB]`.
    ///
    /// # Panics
    /// It is not running.
    pub fn resident_kb(&self) -> u64 {
        self.process
            .as_ref()
            .expect("the service is running")
            .resident_kb()
            .expect("the service is running")
    }

    /// What the operating system keeps of answers that their clients have not taken `[bytes]`, and the number of connections that
    /// are open, proc(5).
    ///
    /// # Panics
    /// The system does not say.
    pub fn untaken(&self) -> (u64, usize) {
        let port = self
            .client
            .0
            .rsplit_once(':')
            .and_then(|(_, port)| port.parse().ok());
        let port: u16 = port.expect("an address has a port");
        let table = std::fs::read_to_string("/proc/net/tcp").expect("a table of connections");
        let ours = format!(":{port:04X}");
        let (mut bytes, mut open) = (0, 0);
        for line in table.lines() {
            let words: Vec<&str> = line.split_whitespace().collect();
            let [_, local, _, state, queues, ..] = words[..] else {
                continue;
            };
            let queue = queues
                .split(':')
                .next()
                .and_then(|text| u64::from_str_radix(text, 16).ok());
            if local.ends_with(&ours) && state != "0A" {
                bytes += queue.unwrap_or_default();
                open += usize::from(state == "01");
            }
        }
        (bytes, open)
    }

    /// The largest memory that it ever held `[kB]`.
    ///
    /// # Panics
    /// It is not running.
    pub fn peak_kb(&self) -> u64 {
        self.process
            .as_ref()
            .expect("the service is running")
            .peak_kb()
            .expect("the service is running")
    }

    /// The file of its store.
    ///
    /// # Panics
    /// Its store is in a server.
    #[track_caller]
    pub fn store(&self) -> PathBuf {
        let file = self.store_name.strip_prefix("sqlite://");
        file.expect("this test is of stores in files").into()
    }

    /// Its store, as `--store` takes it.
    pub fn store_name(&self) -> &str {
        &self.store_name
    }

    /// Its store, opened beside it.
    #[track_caller]
    pub fn database(&self) -> Database {
        Database::open(&self.store_name)
    }

    /// The database of its store.
    ///
    /// # Panics
    /// Its store is a file.
    #[track_caller]
    pub fn server_database(&self) -> &ServerDatabase {
        self.database
            .as_ref()
            .expect("GROUSER_TEST_POSTGRES names a server")
    }

    /// Starts another coordinator on the same store and address, which waits for the end of this one.
    #[track_caller]
    pub fn standby(&self, name: &str) -> Process {
        let mut arguments = self.arguments.clone();
        arguments.push("--standby".into());
        let log = self.folder.path().join(format!("{name}.log"));
        Process::start(programs::coordinator(&arguments), &log)
    }

    /// A folder for whatever a test writes.
    pub fn folder(&self) -> &Path {
        self.folder.path()
    }

    /// Starts a worker of this service with a log of its own.
    pub fn worker(&self, name: &str, threads: usize) -> Process {
        Process::worker(
            &self.url(),
            threads,
            &self.folder.path().join(format!("{name}.log")),
        )
    }

    /// Starts a worker that runs a model that is not ours: the file of a program, or the URL of a server.
    pub fn worker_of(&self, name: &str, threads: usize, model: &str) -> Process {
        let (url, threads) = (self.url(), threads.to_string());
        let arguments = [
            "--coordinator",
            &url,
            "--threads",
            &threads,
            "--allow-model",
            model,
        ];
        let log = self.folder.path().join(format!("{name}.log"));
        Process::start(crate::programs::worker(arguments), &log)
    }

    /// Starts a worker of one thread that says JSON.
    pub fn json_worker(&self, name: &str) -> Process {
        self.json_worker_at(&self.url(), name)
    }

    /// Starts a worker that talks to a proxy in front of the service.
    pub fn json_worker_at(&self, url: &str, name: &str) -> Process {
        let mut command = crate::programs::worker(["--coordinator", url, "--threads", "1"]);
        command.env("GROUSER_WIRE", "json");
        Process::start(command, &self.folder.path().join(format!("{name}.log")))
    }

    /// Submits a job by plain HTTP; its id.
    ///
    /// # Panics
    /// It is refused.
    #[track_caller]
    pub fn submit(&self, job: &Job) -> i64 {
        let experiment = self.client.post("/v1/experiments", &job.experiment_json());
        assert_eq!(experiment.status, 201, "{}", experiment.body);
        let new =
            json!({"experiment": experiment.json()["id"], "toml": job.job, "files": job.effect_files()});
        let created = self.client.post("/v1/calibrations", &new);
        assert_eq!(created.status, 201, "{}", created.body);
        created.json()["id"].as_i64().expect("an id")
    }

    /// The status of a calibration.
    #[track_caller]
    pub fn status(&self, id: i64) -> Value {
        self.client.json(&format!("/v1/calibrations/{id}"))
    }

    /// Evaluations done so far; `None` where the service does not say (it is away, or the calibration is over).
    pub fn evaluations(&self, id: i64) -> Option<u64> {
        let response = self.client.try_get(&format!("/v1/calibrations/{id}")).ok()?;
        (response.status == 200).then(|| response.json()["progress"]["evaluations"].as_u64())?
    }

    /// Waits until a calibration is in a state.
    ///
    /// # Panics
    /// It ends in another one, or does not get there.
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

    /// The posterior of a finished calibration, as `export --format csv` writes it.
    #[track_caller]
    pub fn posterior_csv(&self, id: i64) -> String {
        programs::run(programs::coordinator([
            "export",
            &id.to_string(),
            "--url",
            &self.url(),
        ]))
        .success()
    }

    /// A figure of the metrics page.
    ///
    /// # Panics
    /// There is no such figure.
    #[track_caller]
    pub fn metric(&self, name: &str) -> u64 {
        let page = self.client.get("/metrics").body;
        let line = page
            .lines()
            .find_map(|line| line.strip_prefix(name)?.strip_prefix(' '));
        line.and_then(|value| value.parse().ok())
            .unwrap_or_else(|| panic!("no {name} in\n{page}"))
    }

    /// The record of the only worker, once it has been heard of.
    ///
    /// # Panics
    /// There are several.
    #[track_caller]
    pub fn only_worker(&self) -> Option<Value> {
        let workers = self.client.json("/v1/workers");
        let records = workers.as_object()?;
        assert!(records.len() < 2, "{workers}");
        records.values().next().cloned()
    }

    /// The version of the equations that the program `worker` computes, as it says to this service.
    #[track_caller]
    pub fn model_version(&self) -> String {
        let worker = self.worker("version", 1);
        let record = until("a word of a worker", || self.only_worker());
        drop(worker);
        record["model_version"].as_str().unwrap_or_default().to_owned()
    }

    /// The service's standard error, over all its starts.
    ///
    /// # Panics
    /// The log is gone.
    pub fn log(&self) -> String {
        let log = std::fs::read(self.folder.path().join("coordinator.log")).expect("the log can be read");
        String::from_utf8_lossy(&log).into_owned()
    }
}

/// An address on which nothing listens, outside the range that the system gives to outgoing connections: it stays
/// free while its service is down.
///
/// # Panics
/// Every port is taken.
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
