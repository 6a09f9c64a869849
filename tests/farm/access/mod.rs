//! Who may do what: pages of other sites, tokens and roles, listening where others reach the service, and how much.

mod foreign_page;
mod limits;
mod tokens;
