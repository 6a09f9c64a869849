//! A copy of a whole store from a file to a server, or from a server to a file.

use futures::TryStreamExt;
use sqlx::AssertSqlSafe;

use super::blob;
use super::error::StoreError;
use super::place::{is_server, name_of};
use super::reader::Reader;
use super::sql::{Conflict, Connection, Kind, Row, Value, insert, query, query_as, query_scalar};
use super::theta::theta;
use super::{migrations, opening};

/// The number of rows that one statement inserts. With the columns of the widest table, they have fewer parameters than either database
/// accepts.
const ROWS: usize = 1_000;
/// The tables that other tables refer to, in an order in which they can be filled.
const FIRST: [&str; 3] = ["experiments", "studies", "calibrations"];

struct Table {
    name: String,
    /// Columns with their kinds. SQLite has no Boolean type, so the kinds are read from the server's tables.
    columns: Vec<(String, Kind)>,
}

/// Copies all rows of a store, as they are at one moment, to another store that has none. Returns how many rows each table has.
///
/// Either everything is copied or nothing. The number of the last start is copied too, so that the numbers of later starts continue it.
///
/// # Errors
/// [`StoreError`]: both are files or both are servers, the source is of an earlier version or damaged, the target has rows or is in use.
pub async fn copy_store(from: &str, to: &str) -> Result<Vec<(String, u64)>, StoreError> {
    let unfit = |path: &str, reason: &str| StoreError::Unfit {
        path: name_of(path),
        reason: reason.into(),
    };
    match (is_server(from), is_server(to)) {
        (true, true) => {
            return Err(unfit(
                to,
                "both are servers; pg_dump and pg_restore copy one to another",
            ));
        }
        (false, false) => {
            return Err(unfit(
                to,
                "both are files; coordinator backup copies one to another",
            ));
        }
        _ => {}
    }
    let reader = Reader::open(from).await?;
    if version(&reader).await? != Some(migrations::VERSION) {
        return Err(unfit(
            from,
            "its tables are of an earlier version, or absent; coordinator serve brings them up to date",
        ));
    }
    let wrap = |path: &str| {
        let path = path.to_owned();
        move |source| StoreError::new(&path, source)
    };
    let mut source = reader.pool.view().await.map_err(wrap(from))?;
    let (mut target, _lock) = opening::to_write(to).await?;
    let server = if is_server(from) { &mut source } else { &mut target };
    let tables = tables(server).await?;
    target.begin().await.map_err(wrap(to))?;
    let mut copied = Vec::with_capacity(tables.len());
    for table in &tables {
        if count(&mut target, table).await.map_err(wrap(to))? > 0 {
            return Err(unfit(
                to,
                &format!("table {} has rows; a store is copied to an empty one", table.name),
            ));
        }
        let read = copy_rows(&mut source, &mut target, table).await?;
        let written = count(&mut target, table).await.map_err(wrap(to))?;
        if written != read {
            return Err(unfit(
                to,
                &format!("table {} has {written} rows after {read} were copied", table.name),
            ));
        }
        copied.push((table.name.clone(), read));
    }
    if is_server(to) {
        number_on(&mut target).await.map_err(wrap(to))?;
    }
    target.commit().await.map_err(wrap(to))?;
    target.close().await.map_err(wrap(to))?;
    Ok(copied)
}

/// Returns the version of the tables; `None` where there are no tables.
async fn version(reader: &Reader) -> Result<Option<i64>, StoreError> {
    if !reader.has_table("_sqlx_migrations").await? {
        return Ok(None);
    }
    let version = query_scalar("SELECT max(version) FROM _sqlx_migrations");
    Ok(version.fetch_one(&reader.pool).await?)
}

/// Returns the store's tables and their columns, as a server describes them. Tables that others refer to come first.
async fn tables(server: &mut Connection) -> Result<Vec<Table>, StoreError> {
    let columns: Vec<(String, String, String)> = query_as(
        "SELECT c.table_name::text, c.column_name::text, c.data_type::text
         FROM information_schema.columns c JOIN information_schema.tables t USING (table_schema, table_name)
         WHERE c.table_schema = current_schema() AND t.table_type = 'BASE TABLE' AND c.table_name <> '_sqlx_migrations'
         ORDER BY c.table_name, c.ordinal_position",
    )
    .fetch_all(server)
    .await?;
    let mut tables: Vec<Table> = Vec::new();
    for (table, column, kind) in columns {
        let kind = match kind.as_str() {
            "bigint" => Kind::Integer,
            "double precision" => Kind::Real,
            "boolean" => Kind::Truth,
            "text" => Kind::Text,
            "bytea" => Kind::Bytes,
            _ => {
                let what = format!("column {column} of table {table} is of type {kind}, which no store has");
                return Err(StoreError::Corrupt(what));
            }
        };
        if tables.last().is_none_or(|last| last.name != table) {
            let columns = Vec::new();
            tables.push(Table { name: table, columns });
        }
        if let Some(last) = tables.last_mut() {
            last.columns.push((column, kind));
        }
    }
    tables.sort_by_key(|table| {
        FIRST
            .iter()
            .position(|&name| name == table.name)
            .unwrap_or(FIRST.len())
    });
    Ok(tables)
}

async fn count(connection: &mut Connection, table: &Table) -> Result<u64, sqlx::Error> {
    let sql = format!("SELECT count(*) FROM {}", table.name);
    let count: i64 = query_scalar(AssertSqlSafe(sql)).fetch_one(connection).await?;
    Ok(count.unsigned_abs())
}

/// Copies the rows of a table. Returns how many were read.
async fn copy_rows(
    source: &mut Connection,
    target: &mut Connection,
    table: &Table,
) -> Result<u64, StoreError> {
    let names: Vec<&str> = table.columns.iter().map(|(name, _)| name.as_str()).collect();
    // A row of these tables may refer to an earlier row of the same table.
    let order = if FIRST.contains(&table.name.as_str()) {
        " ORDER BY id"
    } else {
        ""
    };
    let select = format!("SELECT {} FROM {}{order}", names.join(", "), table.name);
    let rows = query(AssertSqlSafe(select)).fetch(source);
    let mut batches = rows.map_err(StoreError::from).try_chunks(ROWS);
    let mut read = 0;
    while let Some(batch) = batches.try_next().await.map_err(|stopped| stopped.1)? {
        let values: Result<Vec<_>, _> = batch.iter().map(|row| values(row, &table.columns)).collect();
        read += batch.len() as u64;
        insert(&table.name, &names, values?, &Conflict::Keep)
            .execute(&mut *target)
            .await?;
    }
    Ok(read)
}

fn values(row: &Row, columns: &[(String, Kind)]) -> Result<Vec<Value>, StoreError> {
    let value = |(column, kind): &(String, Kind)| {
        Ok(match kind {
            Kind::Bytes => Value::Bytes(bytes(row, column)?),
            kind => row.value(column, *kind)?,
        })
    };
    columns.iter().map(value).collect()
}

/// Returns the bytes of a column. A parameter vector of before migration 9, which a file keeps as text, is converted to bytes.
fn bytes(row: &Row, column: &str) -> Result<Option<Vec<u8>>, StoreError> {
    match column {
        "theta" => Ok(Some(blob::encode(&theta(row)?))),
        _ => Ok(row.try_get(column)?),
    }
}

/// Makes a server number its next rows after those that were copied.
async fn number_on(server: &mut Connection) -> Result<(), sqlx::Error> {
    let columns: Vec<(String, String)> = query_as(
        "SELECT table_name::text, column_name::text FROM information_schema.columns
         WHERE table_schema = current_schema() AND is_identity = 'YES'",
    )
    .fetch_all(&mut *server)
    .await?;
    for (table, column) in columns {
        let sql = format!(
            "SELECT setval(pg_get_serial_sequence('{table}', '{column}'), (SELECT coalesce(max({column}), 0) + 1 FROM {table}), false)"
        );
        query(AssertSqlSafe(sql)).fetch_one(&mut *server).await?;
    }
    Ok(())
}
