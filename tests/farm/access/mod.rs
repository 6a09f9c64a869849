//! Who may do what: pages of other sites, tokens and roles, listening where others reach the service, how much, and how slowly.

mod foreign_page;
mod limits;
mod slow_clients;
mod tokens;
