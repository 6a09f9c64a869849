//! Who may do what: pages of other sites, tokens and roles, listening where others reach the service.

mod foreign_page;
mod tokens;
