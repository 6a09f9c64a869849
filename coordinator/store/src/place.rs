//! The place of a store: the path of its file, or the URL of a server.

/// Returns whether a store stands in a PostgreSQL server.
pub fn is_server(path: &str) -> bool {
    ["postgres://", "postgresql://"]
        .iter()
        .any(|scheme| path.starts_with(scheme))
}

/// Returns the name of a store for messages: its path, or its URL without the password.
pub fn name_of(path: &str) -> String {
    let Some((scheme, rest)) = path.split_once("://").filter(|_| is_server(path)) else {
        return path.to_owned();
    };
    // A password may stand before the host or in the query. It may contain any character, although the URL is invalid then.
    let first = || rest.split([':', '/', '?', '@']).next().unwrap_or_default();
    match rest.rsplit_once('@') {
        Some((before, _)) if before.contains('?') => format!("{scheme}://{}…", first()),
        Some((_, place)) => {
            let place = place.split('?').next().unwrap_or_default();
            format!("{scheme}://{}@{place}", first())
        }
        None => format!("{scheme}://{}", rest.split('?').next().unwrap_or_default()),
    }
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
            ("postgres://me:a/b@host/db", "postgres://me@host/db"),
            ("postgres://me:a?b@host/db", "postgres://me…"),
            ("postgres://host/db?password=a@b", "postgres://host…"),
            ("postgresql:///farm?host=/run/postgresql", "postgresql:///farm"),
        ] {
            assert_eq!(name_of(path), name);
        }
    }
}
