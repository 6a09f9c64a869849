//! Who may do what: pages of other sites, tokens and roles, listening where others reach the service, how much, how slowly, and who hangs up.

mod foreign_page;
mod hang_up;
mod limits;
mod slow_clients;
mod tokens;
