//! A store in a PostgreSQL server: a standby that takes over, a server that goes away, and stores that move between file and server.

mod copies;
mod standby;
mod troubles;
