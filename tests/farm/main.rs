//! The whole farm, black-box: the two programs as processes, SQLite files, HTTP.

mod architecture;
mod bad_input;
mod bevameter;
mod bit_identity;
mod conformance;
mod diagnostics;
mod discovery;
mod effects;
mod end_to_end;
mod forward;
mod histories;
mod leases;
mod likelihood;
mod mesh;
mod metamodel;
mod not_tried;
mod older_store;
mod point_fit;
mod posterior_prior;
mod rig;
mod search;
mod spatial;
mod stored_results;
mod study;
mod summary_contract;
mod wire;
