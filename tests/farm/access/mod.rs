//! Access to the service: pages of other sites, tokens and roles, addresses that others reach, limits, slow clients and hang-ups.

mod foreign_page;
mod hang_up;
mod limits;
mod slow_clients;
mod tokens;
