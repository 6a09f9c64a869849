//! SQL statements that run on SQLite and on PostgreSQL.
//!
//! A statement is written with SQLite's parameters, `?` or `?1`; for PostgreSQL they become `$1`. `migrations/postgres` defines the
//! functions of SQLite that statements use. Parts that only one database has (PRAGMAs, locks, sizes) are in `file` and `server`.

use std::marker::PhantomData;

use futures::stream::BoxStream;
use futures::{StreamExt, TryStreamExt};
use sqlx::postgres::PgRow;
use sqlx::sqlite::SqliteRow;
use sqlx::{AssertSqlSafe, Connection as _, PgConnection, PgPool, Postgres, SqlSafeStr, SqlStr, Sqlite};
use sqlx::{Decode, Row as _, SqliteConnection, SqlitePool, Type};

/// The replacement of NUL in a text, because PostgreSQL's texts cannot contain NUL.
pub(super) const NUL: &str = "\u{2400}";

/// A connection that may write.
#[derive(Debug)]
pub(super) enum Connection {
    Sqlite(SqliteConnection),
    Postgres(PgConnection),
}

/// The connections that read, by kind of database.
#[derive(Debug, Clone)]
pub(super) enum Pool {
    Sqlite(SqlitePool),
    Postgres(PgPool),
}

/// The connection or pool that executes a statement.
pub(super) enum On<'a> {
    Connection(&'a mut Connection),
    Pool(&'a Pool),
}

impl<'a> From<&'a mut Connection> for On<'a> {
    fn from(connection: &'a mut Connection) -> Self {
        On::Connection(connection)
    }
}

impl<'a> From<&'a Pool> for On<'a> {
    fn from(pool: &'a Pool) -> Self {
        On::Pool(pool)
    }
}

impl Connection {
    /// Begins a transaction that writes. It is rolled back if the connection ends before [`Connection::commit`].
    pub(super) async fn begin(&mut self) -> Result<(), sqlx::Error> {
        let begin = match self {
            Connection::Sqlite(_) => "BEGIN IMMEDIATE",
            Connection::Postgres(_) => "BEGIN",
        };
        query(begin).execute(self).await.map(drop)
    }

    pub(super) async fn commit(&mut self) -> Result<(), sqlx::Error> {
        query("COMMIT").execute(self).await.map(drop)
    }

    pub(super) async fn rollback(&mut self) -> Result<(), sqlx::Error> {
        query("ROLLBACK").execute(self).await.map(drop)
    }

    pub(super) async fn close(self) -> Result<(), sqlx::Error> {
        match self {
            Connection::Sqlite(connection) => connection.close().await,
            Connection::Postgres(connection) => connection.close().await,
        }
    }
}

impl Pool {
    /// Opens a connection that sees the store as it is at this moment.
    pub(super) async fn view(&self) -> Result<Connection, sqlx::Error> {
        let (mut connection, begin) = match self {
            Pool::Sqlite(pool) => (Connection::Sqlite(pool.acquire().await?.detach()), "BEGIN"),
            Pool::Postgres(pool) => (
                Connection::Postgres(pool.acquire().await?.detach()),
                "BEGIN ISOLATION LEVEL REPEATABLE READ READ ONLY",
            ),
        };
        query(begin).execute(&mut connection).await?;
        Ok(connection)
    }

    pub(super) async fn close(&self) {
        match self {
            Pool::Sqlite(pool) => pool.close().await,
            Pool::Postgres(pool) => pool.close().await,
        }
    }

    pub(super) fn is_closed(&self) -> bool {
        match self {
            Pool::Sqlite(pool) => pool.is_closed(),
            Pool::Postgres(pool) => pool.is_closed(),
        }
    }
}

/// A value in a column or of a parameter.
#[derive(Debug, Clone, PartialEq)]
pub(super) enum Value {
    Integer(Option<i64>),
    Real(Option<f64>),
    Truth(Option<bool>),
    Text(Option<String>),
    Bytes(Option<Vec<u8>>),
}

/// The kind of value that a column holds.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Kind {
    Integer,
    Real,
    Truth,
    Text,
    Bytes,
}

/// Implements `From` for the Rust types of each kind of value.
macro_rules! values {
    ($($kind:ident: $($renumbered:ty),+;)+) => {$($(
        impl From<$renumbered> for Value {
            fn from(value: $renumbered) -> Self {
                Value::$kind(Some(value.into()))
            }
        }
        impl From<Option<$renumbered>> for Value {
            fn from(value: Option<$renumbered>) -> Self {
                Value::$kind(value.map(Into::into))
            }
        }
    )+)+};
}

values! {
    Integer: i64, u32;
    Real: f64;
    Truth: bool;
    Text: String, &str, &String;
    Bytes: Vec<u8>;
}

impl From<&Option<String>> for Value {
    fn from(value: &Option<String>) -> Self {
        Value::Text(value.clone())
    }
}

/// A row of a result.
pub(super) enum Row {
    Sqlite(SqliteRow),
    Postgres(PgRow),
}

/// A type that both databases can decode from a column.
pub(super) trait Column<'r>:
    Decode<'r, Sqlite> + Type<Sqlite> + Decode<'r, Postgres> + Type<Postgres>
{
}

impl<'r, T> Column<'r> for T where T: Decode<'r, Sqlite> + Type<Sqlite> + Decode<'r, Postgres> + Type<Postgres>
{}

impl Row {
    pub(super) fn try_get<'r, T: Column<'r>>(&'r self, column: &str) -> Result<T, sqlx::Error> {
        match self {
            Row::Sqlite(row) => row.try_get(column),
            Row::Postgres(row) => row.try_get(column),
        }
    }

    /// Reads a column as a value of a kind.
    pub(super) fn value(&self, column: &str, kind: Kind) -> Result<Value, sqlx::Error> {
        Ok(match kind {
            Kind::Integer => Value::Integer(self.try_get(column)?),
            Kind::Real => Value::Real(self.try_get(column)?),
            Kind::Truth => Value::Truth(self.try_get(column)?),
            Kind::Text => Value::Text(self.try_get(column)?),
            Kind::Bytes => Value::Bytes(self.try_get(column)?),
        })
    }

    /// Reads a column of which the table guarantees the type.
    pub(super) fn get<'r, T: Column<'r>>(&'r self, column: &str) -> T {
        match self {
            Row::Sqlite(row) => row.get(column),
            Row::Postgres(row) => row.get(column),
        }
    }
}

/// A row as a tuple.
pub(super) trait Tuple:
    for<'r> sqlx::FromRow<'r, SqliteRow> + for<'r> sqlx::FromRow<'r, PgRow>
{
}

impl<T> Tuple for T where T: for<'r> sqlx::FromRow<'r, SqliteRow> + for<'r> sqlx::FromRow<'r, PgRow> {}

/// A statement with its parameters.
pub(super) struct Query {
    sql: SqlStr,
    values: Vec<Value>,
    is_kept: bool,
}

/// Makes a statement; a connection prepares it once.
pub(super) fn query(sql: impl SqlSafeStr) -> Query {
    Query {
        sql: sql.into_sql_str(),
        values: Vec::new(),
        is_kept: true,
    }
}

/// Builds the statement of one of the databases with its parameters bound.
macro_rules! bound {
    ($sql:expr, $query:expr, $nul:expr) => {{
        let mut statement = sqlx::query($sql).persistent($query.is_kept);
        for value in $query.values {
            statement = match value {
                Value::Integer(value) => statement.bind(value),
                Value::Real(value) => statement.bind(value),
                Value::Truth(value) => statement.bind(value),
                Value::Text(value) => statement.bind(value.map($nul)),
                Value::Bytes(value) => statement.bind(value),
            };
        }
        statement
    }};
}

/// Runs a method of the statement of either database, and maps its result.
macro_rules! run {
    ($query:expr, $on:expr, $method:ident, $sqlite:expr, $postgres:expr) => {
        match $on.into() {
            On::Connection(Connection::Sqlite(connection)) => {
                let statement = bound!($query.sql, $query, |text| text);
                statement.$method(connection).await.map($sqlite)
            }
            On::Pool(Pool::Sqlite(pool)) => {
                let statement = bound!($query.sql, $query, |text| text);
                statement.$method(pool).await.map($sqlite)
            }
            On::Connection(Connection::Postgres(connection)) => {
                let statement = bound!(numbered(&$query.sql), $query, without_nul);
                statement.$method(connection).await.map($postgres)
            }
            On::Pool(Pool::Postgres(pool)) => {
                let statement = bound!(numbered(&$query.sql), $query, without_nul);
                statement.$method(pool).await.map($postgres)
            }
        }
    };
}

/// Replaces NUL in a text, which PostgreSQL does not accept.
fn without_nul(text: String) -> String {
    match text.contains('\0') {
        true => text.replace('\0', NUL),
        false => text,
    }
}

impl Query {
    /// Binds the value of the next parameter.
    pub(super) fn bind(mut self, value: impl Into<Value>) -> Query {
        self.values.push(value.into());
        self
    }

    /// Executes the statement. Returns how many rows it changed.
    pub(super) async fn execute(self, on: impl Into<On<'_>>) -> Result<u64, sqlx::Error> {
        run!(self, on, execute, |done| done.rows_affected(), |done| done
            .rows_affected())
    }

    pub(super) async fn fetch_all(self, on: impl Into<On<'_>>) -> Result<Vec<Row>, sqlx::Error> {
        fn rows<R>(rows: Vec<R>, row: fn(R) -> Row) -> Vec<Row> {
            rows.into_iter().map(row).collect()
        }
        run!(self, on, fetch_all, |all| rows(all, Row::Sqlite), |all| rows(
            all,
            Row::Postgres
        ))
    }

    /// Returns the rows as a stream.
    pub(super) fn fetch(self, connection: &mut Connection) -> BoxStream<'_, Result<Row, sqlx::Error>> {
        match connection {
            Connection::Sqlite(connection) => {
                let statement = bound!(self.sql, self, |text| text);
                statement.fetch(connection).map_ok(Row::Sqlite).boxed()
            }
            Connection::Postgres(connection) => {
                let statement = bound!(numbered(&self.sql), self, without_nul);
                statement.fetch(connection).map_ok(Row::Postgres).boxed()
            }
        }
    }

    pub(super) async fn fetch_optional(self, on: impl Into<On<'_>>) -> Result<Option<Row>, sqlx::Error> {
        Ok(self.fetch_all(on).await?.into_iter().next())
    }

    pub(super) async fn fetch_one(self, on: impl Into<On<'_>>) -> Result<Row, sqlx::Error> {
        self.fetch_optional(on).await?.ok_or(sqlx::Error::RowNotFound)
    }
}

/// A statement whose rows are tuples.
pub(super) struct QueryAs<T>(Query, PhantomData<T>);

/// Makes a statement whose rows are tuples.
pub(super) fn query_as<T: Tuple>(sql: impl SqlSafeStr) -> QueryAs<T> {
    QueryAs(query(sql), PhantomData)
}

impl<T: Tuple> QueryAs<T> {
    /// Binds the value of the next parameter.
    pub(super) fn bind(self, value: impl Into<Value>) -> QueryAs<T> {
        QueryAs(self.0.bind(value), PhantomData)
    }

    pub(super) async fn fetch_all(self, on: impl Into<On<'_>>) -> Result<Vec<T>, sqlx::Error> {
        let tuple = |row: Row| match row {
            Row::Sqlite(row) => T::from_row(&row),
            Row::Postgres(row) => T::from_row(&row),
        };
        self.0.fetch_all(on).await?.into_iter().map(tuple).collect()
    }

    pub(super) async fn fetch_optional(self, on: impl Into<On<'_>>) -> Result<Option<T>, sqlx::Error> {
        Ok(self.fetch_all(on).await?.into_iter().next())
    }

    pub(super) async fn fetch_one(self, on: impl Into<On<'_>>) -> Result<T, sqlx::Error> {
        self.fetch_optional(on).await?.ok_or(sqlx::Error::RowNotFound)
    }
}

/// A statement whose rows have one column.
pub(super) struct QueryScalar<T>(QueryAs<(T,)>);

/// Makes a statement whose rows have one column.
pub(super) fn query_scalar<T>(sql: impl SqlSafeStr) -> QueryScalar<T>
where
    (T,): Tuple,
{
    QueryScalar(query_as(sql))
}

impl<T> QueryScalar<T>
where
    (T,): Tuple,
{
    /// Binds the value of the next parameter.
    pub(super) fn bind(self, value: impl Into<Value>) -> QueryScalar<T> {
        QueryScalar(self.0.bind(value))
    }

    pub(super) async fn fetch_all(self, on: impl Into<On<'_>>) -> Result<Vec<T>, sqlx::Error> {
        Ok(self
            .0
            .fetch_all(on)
            .await?
            .into_iter()
            .map(|(value,)| value)
            .collect())
    }

    pub(super) async fn fetch_optional(self, on: impl Into<On<'_>>) -> Result<Option<T>, sqlx::Error> {
        Ok(self.0.fetch_optional(on).await?.map(|(value,)| value))
    }

    pub(super) async fn fetch_one(self, on: impl Into<On<'_>>) -> Result<T, sqlx::Error> {
        Ok(self.0.fetch_one(on).await?.0)
    }
}

/// The treatment of a row whose key exists already.
pub(super) enum Conflict<'a> {
    /// The old row stays, and the new one is dropped.
    Keep,
    /// The new row replaces the old one; these columns are the key.
    Replace(&'a [&'a str]),
}

/// Makes a statement that inserts rows.
pub(super) fn insert(table: &str, columns: &[&str], rows: Vec<Vec<Value>>, conflict: &Conflict<'_>) -> Query {
    let row = format!("({})", vec!["?"; columns.len()].join(", "));
    let places = vec![row.as_str(); rows.len()].join(", ");
    let conflict = match conflict {
        Conflict::Keep => "DO NOTHING".to_owned(),
        Conflict::Replace(key) => {
            let updated = columns.iter().filter(|column| !key.contains(column));
            let taken: Vec<String> = updated.map(|c| format!("{c} = excluded.{c}")).collect();
            format!("({}) DO UPDATE SET {}", key.join(", "), taken.join(", "))
        }
    };
    let columns = columns.join(", ");
    let insert = format!("INSERT INTO {table} ({columns}) VALUES {places} ON CONFLICT {conflict}");
    Query {
        // A statement of many rows is large and seldom repeated, so it is not kept prepared.
        is_kept: rows.len() == 1,
        values: rows.into_iter().flatten().collect(),
        sql: AssertSqlSafe(insert).into_sql_str(),
    }
}

/// Replaces SQLite's parameters by PostgreSQL's, except inside quotes.
fn numbered(sql: &SqlStr) -> SqlStr {
    let mut text = String::with_capacity(sql.as_str().len() + 64);
    let (mut is_quoted, mut count) = (false, 0);
    let mut rest = sql.as_str().chars().peekable();
    while let Some(c) = rest.next() {
        is_quoted ^= c == '\'';
        if c != '?' || is_quoted {
            text.push(c);
            continue;
        }
        text.push('$');
        if !rest.peek().is_some_and(char::is_ascii_digit) {
            count += 1;
            text += &count.to_string();
        }
    }
    AssertSqlSafe(text).into_sql_str()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn parameters_are_numbered_and_quotes_left_alone() {
        let renumbered = |sql: &'static str| numbered(&sql.into_sql_str()).as_str().to_owned();
        assert_eq!(renumbered("a = ? AND b = ?"), "a = $1 AND b = $2");
        assert_eq!(
            renumbered("a = ?2 AND b = ?1 AND c = ?12"),
            "a = $2 AND b = $1 AND c = $12"
        );
        assert_eq!(renumbered("a = '?''?' AND b = ?"), "a = '?''?' AND b = $1");
    }
}
