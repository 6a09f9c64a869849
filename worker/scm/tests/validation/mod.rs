//! The expected figures of effects and of the three-dimensional model, with the model's results.
//!
//! Tests assert the rows oracle by oracle; `cargo bench -p scm --bench validation` prints them. Volumes (oracle 4) need the
//! terrain itself and are tested in `spatial::run::rolling`.
//!
//! # Layout
//! - `row`: one expected figure.
//! - `profile`: independently computed pressure along a smooth wheel with uniform pressure across it.
//! - `plate`, `smooth_wheel`, `quasi_static`, `grousered`, `effects`, `convergence`, `scaling`, `power`, `displacement`, `grousers`,
//!   `tread`, `side_wall`, `flow`, `hull`, `other_implementation`: the oracles.

pub(crate) mod convergence;
pub(crate) mod displacement;
pub(crate) mod effects;
pub(crate) mod flow;
pub(crate) mod grousered;
pub(crate) mod grousers;
pub(crate) mod hull;
pub(crate) mod other_implementation;
pub(crate) mod plate;
pub(crate) mod power;
mod profile;
pub(crate) mod quasi_static;
mod row;
pub(crate) mod scaling;
pub(crate) mod side_wall;
pub(crate) mod smooth_wheel;
pub(crate) mod tread;

pub(crate) use row::{Row, Rows};

/// An oracle: its name, and the function that adds its rows.
pub(crate) type Oracle = (&'static str, fn(&mut Rows));

/// All oracles, in the order of the table.
pub(crate) const ORACLES: [Oracle; 15] = [
    ("plate", plate::add),
    ("smooth wheel", smooth_wheel::add),
    ("quasi-static", quasi_static::add),
    ("quasi-static with grousers", grousered::add),
    ("effects", effects::add),
    ("convergence", convergence::add),
    ("scaling", scaling::add),
    ("power", power::add),
    ("displacement", displacement::add),
    ("grousers", grousers::add),
    ("tread", tread::add),
    ("side wall", side_wall::add),
    ("flow", flow::add),
    ("hull", hull::add),
    ("other implementation", other_implementation::add),
];

/// Returns the rows of one oracle.
pub(crate) fn rows(add: fn(&mut Rows)) -> Vec<Row> {
    let mut rows = Rows::default();
    add(&mut rows);
    rows.into_rows()
}
