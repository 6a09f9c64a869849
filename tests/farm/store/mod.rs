//! The store under fire: bad rows, foreign locks, damage, other names for its file, other versions; what is copied and
//! removed; reading where nothing can be written.

mod backup;
mod bad_row;
mod damage;
mod lock;
mod read_only;
mod removal;

use std::path::Path;

use farm_tests::programs::{Ended, coordinator, run};
use farm_tests::service::free_address;

/// The message of a service that is refused a store.
fn serve(store: &Path) -> Ended {
    let store = format!("sqlite://{}", store.display());
    run(coordinator([
        "serve",
        "--listen",
        &free_address(),
        "--store",
        &store,
    ]))
}
