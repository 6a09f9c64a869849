//! Where a store stands: the name of its file, or the URL of a server.

/// Whether a store stands in a PostgreSQL server.
pub(crate) fn is_server(path: &str) -> bool {
    ["postgres://", "postgresql://"]
        .iter()
        .any(|scheme| path.starts_with(scheme))
}

/// What a store is called in messages: its file, or its URL without the password.
pub(crate) fn name_of(path: &str) -> String {
    let Some((scheme, rest)) = path.split_once("://").filter(|_| is_server(path)) else {
        return path.to_owned();
    };
    let (authority, place) = rest.split_at(rest.find(['/', '?']).unwrap_or(rest.len()));
    let authority = match authority.rsplit_once('@') {
        Some((user, host)) => format!("{}@{host}", user.split(':').next().unwrap_or_default()),
        None => authority.to_owned(),
    };
    // A password may also stand among the settings.
    let place = place.split('?').next().unwrap_or_default();
    format!("{scheme}://{authority}{place}")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_name_has_no_password() {
        for (path, name) in [
            ("sqlite://a?b.db", "sqlite://a?b.db"),
            ("a:b@c.db", "a:b@c.db"),
            (
                "postgres://me:secret@host:5432/farm",
                "postgres://me@host:5432/farm",
            ),
            (
                "postgres://me:se@cret@host/farm?password=x",
                "postgres://me@host/farm",
            ),
            ("postgresql:///farm?host=/run/postgresql", "postgresql:///farm"),
        ] {
            assert_eq!(name_of(path), name);
        }
    }
}
