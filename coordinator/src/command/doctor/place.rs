//! Checks the store of a service, the disk below it and the address.

use std::io::{ErrorKind, Write};
use std::net::SocketAddr;
use std::path::Path;
use std::time::{Duration, Instant};

use rustix::fs::statvfs;
use tokio::net::TcpListener;

use super::finding::Finding;
use super::service;
use store::{IdPage, Reader, StoreError, file_of, is_server, name_of};

/// The time of one write to disk above which a disk is slow, because every acknowledged result waits for one.
const SLOW: Duration = Duration::from_millis(100);
/// Free space below which there is a warning `[bytes]`.
const LITTLE_BYTES: u64 = 1_000_000_000;
/// Free space below which there is a failure `[bytes]`.
const TOO_LITTLE_BYTES: u64 = 100_000_000;

pub(super) async fn findings(store: &str, listen: SocketAddr) -> Vec<Finding> {
    if is_server(store) {
        let (stored, has_token) = read(store).await;
        let rows = rows(store, &stored).await;
        let address = address(listen, has_token).await;
        return std::iter::once(stored).chain(rows).chain([address]).collect();
    }
    let file = Path::new(file_of(store));
    let folder = match file.parent() {
        Some(folder) if !folder.as_os_str().is_empty() => folder,
        _ => Path::new("."),
    };
    let (stored, has_token) = stored(store, file).await;
    let rows = rows(store, &stored).await;
    let address = address(listen, has_token).await;
    let others = [writable(folder), space(folder), address];
    std::iter::once(stored).chain(rows).chain(others).collect()
}

/// Reports the content of the store, and whether it has had a token.
async fn stored(store: &str, file: &Path) -> (Finding, bool) {
    if !file.exists() {
        let name = file.display();
        return (
            Finding::ok("store", format!("{name} is not there yet; serve makes it")),
            false,
        );
    }
    read(store).await
}

async fn read(store: &str) -> (Finding, bool) {
    let name = name_of(store);
    let name = file_of(&name);
    let read = async {
        let reader = Reader::open(store).await?;
        if reader.is_blank().await? {
            return Ok(None);
        }
        let has_token = !reader.tokens().await?.is_empty();
        Ok::<_, StoreError>(Some((reader.calibrations(IdPage::ALL).await?, has_token)))
    };
    match read.await {
        Ok(None) => (
            Finding::ok("store", format!("{name} has no tables yet; serve makes them")),
            false,
        ),
        Ok(Some((rows, has_token))) => {
            let bad: Vec<String> = rows
                .iter()
                .filter(|(_, row)| row.is_err())
                .map(|(id, _)| id.to_string())
                .collect();
            let count = rows.len();
            let finding = match bad.as_slice() {
                [] => Finding::ok("store", format!("{name}: {count} calibrations")),
                bad => Finding::warn(
                    "store",
                    format!(
                        "{name}: rows of {} of {count} calibrations cannot be read: {}",
                        bad.len(),
                        bad.join(", ")
                    ),
                    "coordinator list says why; put a backup back, or go on without them",
                ),
            };
            (finding, has_token)
        }
        Err(error) => {
            let remedy = match is_server(store) {
                true => {
                    "start the server, or name another with --store (postgres://USER:PASSWORD@HOST/DATABASE)"
                }
                false => {
                    "name another file with --store, or put a backup back (coordinator backup makes them)"
                }
            };
            (Finding::fail("store", error.to_string(), remedy), false)
        }
    }
}

/// Reads the whole store, and verifies the checksums of its rows; `None` where there is no store, or where it cannot be read at all.
async fn rows(store: &str, stored: &Finding) -> Option<Finding> {
    if stored.is_failure() || (!is_server(store) && !Path::new(file_of(store)).exists()) {
        return None;
    }
    let name = name_of(store);
    let name = file_of(&name);
    let read = async {
        let reader = Reader::open(store).await?;
        if reader.is_blank().await? {
            return Ok(Vec::new());
        }
        reader.check_pages(store).await?;
        reader.check_rows().await
    };
    let remedy =
        "put a backup back (coordinator backup makes them), or delete the studies and compute them again";
    let checks = match read.await {
        Ok(checks) => checks,
        Err(error) => return Some(Finding::fail("rows", error.to_string(), remedy)),
    };
    let damaged: Vec<String> = checks
        .iter()
        .filter(|check| check.damaged > 0)
        .map(|check| {
            format!(
                "{} of table {} ({})",
                check.damaged,
                check.table,
                check.named.join("; ")
            )
        })
        .collect();
    let checked: u64 = checks.iter().map(|check| check.checked).sum();
    let unchecked: u64 = checks.iter().map(|check| check.unchecked).sum();
    if !damaged.is_empty() {
        let found = format!("{name}: damaged rows: {}", damaged.join(", "));
        return Some(Finding::fail("rows", found, remedy));
    }
    let older = match unchecked {
        0 => String::new(),
        n => format!("; {n} of earlier versions have no checksum"),
    };
    let seen = format!("{name}: {checked} rows have their checksum{older}");
    Some(Finding::ok("rows", seen))
}

/// Writes to the disk as a store does, and measures the time.
fn writable(folder: &Path) -> Finding {
    let probe = folder.join(format!(".grouser-doctor-{}", std::process::id()));
    let begin = Instant::now();
    // An existing file or link of this name belongs to somebody else.
    let made = std::fs::File::create_new(&probe);
    let written = made.and_then(|mut file| {
        let written = file.write_all(&[0; 4096]).and_then(|()| file.sync_all());
        std::fs::remove_file(&probe).and(written)
    });
    let took = begin.elapsed();
    let name = folder.display();
    match written {
        Ok(()) if took > SLOW => Finding::warn(
            "disk",
            format!("{name}: a record is safe after {} ms", took.as_millis()),
            "put the store on a faster disk: every acknowledged result waits for it",
        ),
        Ok(()) => Finding::ok(
            "disk",
            format!("{name}: a record is safe after {} ms", took.as_millis()),
        ),
        Err(error) => Finding::fail(
            "disk",
            format!("{name} cannot be written: {error}"),
            "make the folder its user's (chown, chmod), or only read with serve --read-only",
        ),
    }
}

fn space(folder: &Path) -> Finding {
    let name = folder.display();
    match statvfs(folder) {
        Ok(disk) => free_space(&name.to_string(), disk.f_bavail.saturating_mul(disk.f_frsize)),
        Err(error) => Finding::fail(
            "space",
            format!("{name}: {error}"),
            "name a folder that is there with --store",
        ),
    }
}

fn free_space(name: &str, free_bytes: u64) -> Finding {
    let seen = format!("{name}: {:.1} GB are free", free_bytes as f64 / 1e9);
    let remedy = "make room, or put the store elsewhere; coordinator delete STUDY frees space inside a store";
    match free_bytes {
        0..TOO_LITTLE_BYTES => Finding::fail("space", seen, remedy),
        TOO_LITTLE_BYTES..LITTLE_BYTES => Finding::warn("space", seen, remedy),
        _ => Finding::ok("space", seen),
    }
}

/// Checks whether a service can listen at an address, or already listens there.
async fn address(listen: SocketAddr, has_token: bool) -> Finding {
    let refused = match TcpListener::bind(listen).await {
        Ok(_) if !listen.ip().is_loopback() && !has_token => {
            return Finding::warn(
                "address",
                format!("{listen} is free; others reach it, and the store has no token"),
                "coordinator token add NAME --role submit: serve does not start there without one",
            );
        }
        Ok(_) => return Finding::ok("address", format!("{listen} is free")),
        Err(error) => error,
    };
    if refused.kind() != ErrorKind::AddrInUse {
        let remedy = "name an address of this machine with --listen; ports below 1024 are root's";
        return Finding::fail("address", format!("{listen}: {refused}"), remedy);
    }
    match service::version_at(listen).await {
        Some(version) => Finding::ok(
            "address",
            format!("{listen} is in use by a coordinator of version {version}"),
        ),
        None => Finding::fail(
            "address",
            format!("{listen} is in use by another program"),
            "name another address with --listen; ss -ltnp says whose it is",
        ),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn little_space_is_a_warning_and_none_a_failure() {
        assert!(free_space("/", 99_999_999).is_failure());
        let text = free_space("/", 500_000_000).to_string();
        assert!(
            text.starts_with("warn  space       /: 0.5 GB are free\n"),
            "{text}"
        );
        assert!(free_space("/", LITTLE_BYTES).to_string().starts_with("ok"));
    }
}
