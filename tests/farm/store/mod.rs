//! The store under fire: bad rows, foreign locks, damage, other names for its file, other versions.

mod bad_row;
mod damage;
mod lock;
