//! A small blocking HTTP client. It speaks HTTP/1.0, so that an answer ends where its connection ends.

use std::io::{BufRead, BufReader, Read, Write};
use std::net::TcpStream;
use std::time::Duration;

use serde_json::Value;

/// An answer.
#[derive(Debug, Clone)]
pub struct Response {
    /// Status code.
    pub status: u16,
    /// Head lines, names in lower case.
    pub head: Vec<(String, String)>,
    /// Body, as text.
    pub body: String,
    /// Body, as bytes.
    pub bytes: Vec<u8>,
}

impl Response {
    /// Returns the value of a head line.
    pub fn header(&self, name: &str) -> Option<&str> {
        let line = self.head.iter().find(|(n, _)| n == name);
        line.map(|(_, value)| value.as_str())
    }

    /// Returns the body as JSON.
    #[track_caller]
    pub fn json(&self) -> Value {
        serde_json::from_str(&self.body).unwrap_or_else(|e| panic!("{e} in {}", self.body))
    }
}

/// The destination of requests: an address, as in `127.0.0.1:7070`.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Client(pub String);

impl Client {
    /// Returns the answer to `GET path` with any status; an error means that there was no connection, or that it broke.
    pub fn try_get(&self, path: &str) -> std::io::Result<Response> {
        self.send("GET", path, None)
    }

    /// Returns the answer to `GET path`, with any status.
    #[track_caller]
    pub fn get(&self, path: &str) -> Response {
        self.try_get(path).unwrap_or_else(|e| panic!("GET {path}: {e}"))
    }

    /// Returns the JSON of `GET path` that must succeed.
    #[track_caller]
    pub fn json(&self, path: &str) -> Value {
        let response = self.get(path);
        assert_eq!(response.status, 200, "GET {path}: {}", response.body);
        response.json()
    }

    /// `POST path` with a JSON body, with any status.
    #[track_caller]
    pub fn post(&self, path: &str, body: &Value) -> Response {
        self.post_text(path, &body.to_string())
    }

    /// `POST path` with a text that is declared to be JSON, with any status.
    #[track_caller]
    pub fn post_text(&self, path: &str, body: &str) -> Response {
        self.send("POST", path, Some(body))
            .unwrap_or_else(|e| panic!("POST {path}: {e}"))
    }

    /// `POST path` with a body and these head lines, with any status.
    #[track_caller]
    pub fn post_bytes(&self, path: &str, head: &[(&str, &str)], body: &[u8]) -> Response {
        self.exchange("POST", path, head, Some(body))
            .unwrap_or_else(|e| panic!("POST {path}: {e}"))
    }

    /// Sends a request; a body is declared to be JSON. An error means that there was no connection, or that it broke.
    pub fn send(&self, method: &str, path: &str, body: Option<&str>) -> std::io::Result<Response> {
        let head: &[(&str, &str)] = match body {
            Some(_) => &[("Content-Type", "application/json")],
            None => &[],
        };
        self.exchange(method, path, head, body.map(str::as_bytes))
    }

    /// Sends a request with these head lines; a `Host` among them replaces the address of the client.
    pub fn exchange(
        &self,
        method: &str,
        path: &str,
        head: &[(&str, &str)],
        body: Option<&[u8]>,
    ) -> std::io::Result<Response> {
        let (status, head, mut reader) = self.open(method, path, head, body)?;
        let mut text = Vec::new();
        reader.read_to_end(&mut text)?;
        let length = head.iter().find(|(name, _)| name == "content-length");
        let length = length.and_then(|(_, value)| value.parse().ok());
        if length.is_some_and(|length: usize| length != text.len()) {
            return Err(std::io::ErrorKind::UnexpectedEof.into());
        }
        Ok(Response {
            status,
            head,
            body: String::from_utf8_lossy(&text).into_owned(),
            bytes: text,
        })
    }

    /// Opens a stream of server-sent events and hands each event with its data to `take`, until that returns `false` or the stream
    /// ends. Returns whether the stream ended.
    pub fn events(&self, path: &str, mut take: impl FnMut(&str, &str) -> bool) -> bool {
        let (status, _, mut reader) = self.open("GET", path, &[], None).expect("a stream of events");
        assert_eq!(status, 200, "GET {path}");
        let (mut line, mut event) = (String::new(), String::new());
        loop {
            line.clear();
            if reader.read_line(&mut line).expect("a line of the stream") == 0 {
                return true;
            }
            if let Some(name) = line.strip_prefix("event: ") {
                event = name.trim_end().to_owned();
            } else if let Some(data) = line.strip_prefix("data: ")
                && !take(&event, data.trim_end())
            {
                return false;
            }
        }
    }

    #[expect(
        clippy::type_complexity,
        reason = "status, head and reader of the body, for two callers here"
    )]
    fn open(
        &self,
        method: &str,
        path: &str,
        head: &[(&str, &str)],
        body: Option<&[u8]>,
    ) -> std::io::Result<(u16, Vec<(String, String)>, BufReader<TcpStream>)> {
        let mut stream = TcpStream::connect(&self.0)?;
        stream.set_read_timeout(Some(Duration::from_secs(60)))?;
        let mut request = format!("{method} {path} HTTP/1.0\r\n");
        let names_host = head.iter().any(|(name, _)| name.eq_ignore_ascii_case("host"));
        let host = ("Host", self.0.as_str());
        for (name, value) in head.iter().chain((!names_host).then_some(&host)) {
            request += &format!("{name}: {value}\r\n");
        }
        if let Some(body) = body {
            request += &format!("Content-Length: {}\r\n", body.len());
        }
        request += "\r\n";
        stream.write_all(request.as_bytes())?;
        if let Some(body) = body {
            // A server may answer and close the connection before it has read the whole body; its answer can still be read.
            let _ = stream.write_all(body);
        }
        let mut reader = BufReader::new(stream);
        let mut line = String::new();
        reader.read_line(&mut line)?;
        let status = line.split(' ').nth(1).and_then(|code| code.parse().ok());
        let status = status.ok_or(std::io::ErrorKind::UnexpectedEof)?;
        let mut head = Vec::new();
        loop {
            line.clear();
            reader.read_line(&mut line)?;
            match line.trim_end().split_once(": ") {
                Some((name, value)) => head.push((name.to_lowercase(), value.to_owned())),
                None => return Ok((status, head, reader)),
            }
        }
    }
}
