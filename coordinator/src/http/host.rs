//! The check of a request's host and origin, because a page of another site must not access the service through a browser.
//!
//! A name that an attacker resolves to this machine is refused as a foreign `Host`, and a page of another site by its `Origin`. An IP
//! address as `Host` cannot be redirected in this way.

use std::net::{IpAddr, SocketAddr};

use axum::http::HeaderMap;
use axum::http::header::{HOST, HeaderName, ORIGIN};
use axum::http::uri::Authority;
use shared::api::ErrorKind;

use super::error::HttpError;

/// The hosts of the service.
#[derive(Debug, Clone)]
pub(super) struct Hosts {
    listening: IpAddr,
    names: Vec<String>,
}

impl Hosts {
    /// Makes the hosts of a listening address, with further names of the service.
    pub(super) fn new(listening: SocketAddr, names: Vec<String>) -> Hosts {
        Hosts {
            listening: listening.ip(),
            names,
        }
    }

    /// Refuses a request that names a foreign host, or that comes from a page of another host.
    pub(super) fn check(&self, headers: &HeaderMap) -> Result<(), HttpError> {
        let text = |name: HeaderName| headers.get(name).map(|value| value.to_str().unwrap_or_default());
        let forbidden = |message: String| Err(HttpError::new(ErrorKind::Forbidden, message));
        let count = headers.get_all(HOST).iter().count();
        if count > 1 {
            // A proxy before the service may use the other of the two fields.
            let message = format!("Host: {count} header fields must be 1");
            return Err(HttpError::new(ErrorKind::InvalidBody, message));
        }
        let stated = text(HOST).unwrap_or_default();
        let host = stated.parse::<Authority>().ok();
        let Some(host) = host.filter(|host| self.is_ours(host.host())) else {
            return forbidden(format!(
                "Host \"{stated}\" is not this service; start it with --host NAME if it is reached by that name"
            ));
        };
        match text(ORIGIN) {
            None => Ok(()),
            Some(origin) if is_of(origin, &host) => Ok(()),
            Some(origin) => forbidden(format!(
                "Origin \"{origin}\" is another site than Host \"{stated}\""
            )),
        }
    }

    fn is_ours(&self, host: &str) -> bool {
        let address = host
            .trim_start_matches('[')
            .trim_end_matches(']')
            .parse::<IpAddr>();
        let is_listened_to = match address {
            Ok(address) => {
                address == self.listening
                    || self.listening.is_unspecified()
                    || (self.listening.is_loopback() && address.is_loopback())
            }
            Err(_) => {
                let local = self.listening.is_loopback() || self.listening.is_unspecified();
                local && host.eq_ignore_ascii_case("localhost")
            }
        };
        is_listened_to || self.names.iter().any(|name| name.eq_ignore_ascii_case(host))
    }
}

/// Returns whether an origin, as in `https://farm.example:8443`, belongs to a host.
fn is_of(origin: &str, host: &Authority) -> bool {
    let place = origin
        .split_once("://")
        .map(|(_, place)| place.parse::<Authority>());
    matches!(place, Some(Ok(place)) if place == *host)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn accepts(listening: &str, names: &[&str], host: &str, origin: Option<&str>) -> bool {
        let names = names.iter().map(|&name| name.to_owned()).collect();
        let mut headers = HeaderMap::new();
        headers.insert(HOST, host.parse().unwrap());
        if let Some(origin) = origin {
            headers.insert(ORIGIN, origin.parse().unwrap());
        }
        Hosts::new(listening.parse().unwrap(), names)
            .check(&headers)
            .is_ok()
    }

    #[test]
    fn a_loopback_service_is_named_by_loopback_alone() {
        for host in [
            "127.0.0.1:7070",
            "localhost:7070",
            "LOCALHOST",
            "[::1]:7070",
            "127.0.0.2",
        ] {
            assert!(accepts("127.0.0.1:7070", &[], host, None), "{host}");
        }
        for host in [
            "evil.example",
            "localhost.evil.example",
            "192.0.2.1:7070",
            "",
            "a b",
            "127.0.0.1.evil.example",
        ] {
            assert!(!accepts("127.0.0.1:7070", &[], host, None), "{host}");
        }
        assert!(accepts(
            "127.0.0.1:7070",
            &["farm.example"],
            "Farm.Example:443",
            None
        ));
    }

    #[test]
    fn a_service_on_every_address_is_named_by_any_address_and_by_no_foreign_name() {
        for host in ["192.0.2.1:7070", "[2001:db8::1]:7070", "localhost"] {
            assert!(accepts("0.0.0.0:7070", &[], host, None), "{host}");
        }
        assert!(!accepts("0.0.0.0:7070", &[], "evil.example", None));
        assert!(!accepts("192.0.2.1:7070", &[], "192.0.2.2:7070", None));
        assert!(!accepts("192.0.2.1:7070", &[], "localhost:7070", None));
    }

    #[test]
    fn a_page_is_of_the_same_host_and_port() {
        let ours = |origin| accepts("127.0.0.1:7070", &[], "127.0.0.1:7070", Some(origin));
        assert!(ours("http://127.0.0.1:7070"));
        assert!(!ours("http://127.0.0.1:8080"));
        assert!(!ours("http://evil.example"));
        assert!(!ours("null"));
        assert!(accepts(
            "127.0.0.1:1",
            &["farm.example"],
            "farm.example",
            Some("https://farm.example")
        ));
    }
}
