//! A calibrated wheel as a co-simulation unit by FMI 3.0.
//!
//! A simulator loads this library from an exported file and names the folder of its resources, where `model.json` holds a
//! [`shared::model::DrawnModel`]. It sets slip, load, speed and angle, makes a step, and reads the averages of the steady run. The code that
//! computes them is the worker's.
//!
//! # Layout
//! - `interface`: the C interface; the only file of the workspace with `unsafe`.
//! - `unit`: an instance without its C interface: variables by their numbers, a step. `error`: why a step has no result.
//!
//! # Source
//! Modelica Association 2023, *Functional Mock-up Interface Specification*, version 3.0.1. Checked by `tests/fmu`.

mod error;
mod interface;
mod unit;
