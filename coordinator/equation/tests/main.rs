//! Formulas of curves whose law is known.

mod setup;

mod knots;
mod library;
mod limit;
mod recovery;
mod text;
