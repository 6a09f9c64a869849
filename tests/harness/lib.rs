//! The tools of the tests of the whole farm: real programs, real files, real HTTP.
//!
//! # Layout
//! - [`programs`]: builds the two programs once and runs them.
//! - [`process`]: a program that is running: its log, signals, its end.
//! - [`service`]: `coordinator serve` on a port and a store that outlive its process.
//! - [`http`]: a small blocking client.
//! - [`fake_worker`]: a worker that a test plays by hand.
//! - [`lying_proxy`]: makes a liar of an honest worker.
//! - [`umbridge_server`]: a UM-Bridge server that does what a test says.
//! - [`cylinder`]: the surface of a wheel as a mesh file.
//! - [`job`]: the files of a small job, and ways to change them.
//! - [`workspace`]: the workspace's own files.
//! - [`database`]: a store opened by another client. [`server`]: databases of a PostgreSQL server.
//! - [`text`]: comparing long texts.
//! - [`wait`]: waiting with a deadline.
//! - [`random`]: seeded numbers.
//! - [`chaos`]: a farm that suffers faults at random.

pub mod chaos;
pub mod cylinder;
pub mod database;
pub mod fake_worker;
pub mod http;
pub mod job;
pub mod lying_proxy;
pub mod process;
pub mod programs;
pub mod random;
pub mod server;
pub mod service;
pub mod text;
pub mod umbridge_server;
pub mod wait;
pub mod workspace;
