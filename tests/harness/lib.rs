//! The tools of the tests of the whole farm: real programs, real files, real HTTP.
//!
//! A helper panics, and so fails its test, where a program, a file or an answer is not as the helper's documentation says.
//!
//! # Layout
//! - [`programs`]: builds the two programs once and runs them.
//! - [`process`]: a running program: its log, its signals and its end.
//! - [`service`]: `coordinator serve` on a port and a store that outlive its process.
//! - [`http`]: a small blocking client.
//! - [`fake_worker`]: a worker whose every message is written by a test.
//! - [`proxy`]: cuts and halts connections of workers.
//! - [`lying_proxy`]: falsifies some results of a worker.
//! - [`umbridge_server`]: a UM-Bridge server whose replies a test chooses.
//! - [`cylinder`]: the surface of a wheel as a mesh file.
//! - [`job`]: the files of a small job, and ways to change them.
//! - [`json`]: values in JSON documents.
//! - [`workspace`]: the files of the workspace.
//! - [`database`]: a store opened by another client. [`server`]: databases of a PostgreSQL server.
//! - [`text`]: checks of long texts.
//! - [`wait`]: waiting with a deadline.
//! - [`random`]: seeded pseudo-random numbers.
//! - [`chaos`]: a farm that suffers random faults.

pub mod chaos;
pub mod cylinder;
pub mod database;
pub mod fake_worker;
pub mod http;
pub mod job;
pub mod json;
pub mod lying_proxy;
pub mod process;
pub mod programs;
pub mod proxy;
pub mod random;
pub mod server;
pub mod service;
pub mod text;
pub mod umbridge_server;
pub mod wait;
pub mod workspace;
