//! The service as its operator sees it: figures, alerts, web hooks, encryption.

mod figures;
mod tls;
mod webhook;
