//! The whole farm, black-box: the two programs as processes, SQLite files, HTTP.

mod bad_input;
mod bit_identity;
mod forward;
mod leases;
