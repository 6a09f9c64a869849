//! The coordinator's parts together, without HTTP and store.

mod sbc;
