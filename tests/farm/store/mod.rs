//! The store under fire: bad rows, foreign locks, damage, other names for its file, other versions; what is copied and
//! removed; reading where nothing can be written.

mod backup;
mod bad_row;
mod damage;
mod lock;
mod read_only;
mod removal;

use serde_json::{Value, json};

fn rejected() -> Value {
    json!({"rejected": {"kind": "no_support", "condition": 3, "message": "sinkage 0.2 m exceeds the radius 0.1 m"}})
}
