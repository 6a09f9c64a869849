//! The service as its operator sees it: figures, health, alerts, web hooks, encryption.

mod doctor;
mod figures;
mod health;
mod lists;
mod shell;
mod tls;
mod webhook;
