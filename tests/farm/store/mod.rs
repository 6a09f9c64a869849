//! The store: bad rows, locks of other programs, damage, other names of its file, other versions, backups, removal of studies, and read-only
//! use.

mod backup;
mod bad_row;
mod damage;
mod lock;
mod read_only;
mod removal;

use std::path::Path;

use farm_tests::programs::{Ended, call};
use farm_tests::service::free_address;

/// Starts a service on a store that it should refuse.
fn serve(store: &Path) -> Ended {
    let store = format!("sqlite://{}", store.display());
    call(
        "coordinator serve --listen {} --store {}",
        &[&free_address(), &store],
    )
}
