//! The service as its operator sees it: figures, alerts, web hooks, encryption.

mod doctor;
mod figures;
mod shell;
mod tls;
mod webhook;
