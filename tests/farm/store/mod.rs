//! The store under fire.

mod bad_row;
