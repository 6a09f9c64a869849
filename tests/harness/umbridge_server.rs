//! A UM-Bridge server whose replies a test chooses.

use std::io::{BufRead, BufReader, Read, Write};
use std::net::{TcpListener, TcpStream};
use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};
use std::time::Duration;

use serde_json::{Value, json};

/// A reply to `/Evaluate`.
#[derive(Debug, Clone, PartialEq)]
pub enum Reply {
    /// The channels, as the text of a JSON list of lists.
    Output(String),
    /// A status and its body.
    Status(u16, String),
    /// An empty reply after this time.
    Hang(Duration),
}

impl Reply {
    /// Returns three channels in one vector.
    pub fn channels(channels: [f64; 3]) -> Reply {
        Reply::Output(json!([channels]).to_string())
    }
}

/// A question to the model: the properties of the run, the parameters, and its number, from 0.
#[derive(Debug, Clone, PartialEq)]
pub struct Question {
    /// The first input.
    pub run: Vec<f64>,
    /// The second input.
    pub parameters: Vec<f64>,
    /// The number of earlier questions.
    pub number: u64,
}

/// A server of one model, `wheel`, with two inputs of two numbers and one output of three.
#[derive(Debug)]
pub struct UmbridgeServer {
    /// Its URL.
    pub url: String,
    state: Arc<State>,
}

#[derive(Debug, Default)]
struct State {
    version: AtomicU64,
    evaluations: AtomicU64,
}

impl UmbridgeServer {
    /// Starts a server on a free port; it ends with the test.
    pub fn start(answer: impl Fn(&Question) -> Reply + Send + Sync + 'static) -> UmbridgeServer {
        let listener = TcpListener::bind("127.0.0.1:0").expect("a free port");
        let address = listener.local_addr().expect("an address");
        let (state, answer) = (Arc::new(State::default()), Arc::new(answer));
        let shared = state.clone();
        std::thread::spawn(move || {
            for stream in listener.incoming().flatten() {
                let (state, answer) = (shared.clone(), answer.clone());
                std::thread::spawn(move || converse(&stream, &state, &*answer));
            }
        });
        UmbridgeServer {
            url: format!("http://{address}"),
            state,
        }
    }

    /// Returns the number of evaluations so far.
    pub fn evaluations(&self) -> u64 {
        self.state.evaluations.load(Ordering::SeqCst)
    }

    /// Reports another version of the model from now on.
    pub fn change_version(&self) {
        self.state.version.fetch_add(1, Ordering::SeqCst);
    }
}

/// Answers requests until the client hangs up.
fn converse(stream: &TcpStream, state: &State, answer: &dyn Fn(&Question) -> Reply) {
    let mut reader = BufReader::new(stream);
    // The call fails only for a client that has gone, which needs no answer.
    let _ = stream.set_nodelay(true);
    while let Some((path, body)) = request(&mut reader) {
        let (status, text) = respond(&path, &body, state, answer);
        let head = format!("HTTP/1.1 {status} _\r\nContent-Length: {}\r\n\r\n", text.len());
        let mut stream = stream;
        if stream.write_all((head + &text).as_bytes()).is_err() {
            return;
        }
    }
}

/// Path and body of the next request.
fn request(reader: &mut BufReader<&TcpStream>) -> Option<(String, Value)> {
    let mut first = String::new();
    reader.read_line(&mut first).ok().filter(|read| *read > 0)?;
    let path = first.split(' ').nth(1)?.to_owned();
    let mut length = 0;
    loop {
        let mut line = String::new();
        reader.read_line(&mut line).ok().filter(|read| *read > 0)?;
        let line = line.trim().to_ascii_lowercase();
        if line.is_empty() {
            break;
        }
        if let Some(value) = line.strip_prefix("content-length:") {
            length = value.trim().parse().ok()?;
        }
    }
    let mut body = vec![0; length];
    reader.read_exact(&mut body).ok()?;
    Some((path, serde_json::from_slice(&body).unwrap_or(Value::Null)))
}

fn respond(path: &str, body: &Value, state: &State, answer: &dyn Fn(&Question) -> Reply) -> (u16, String) {
    let version = state.version.load(Ordering::SeqCst);
    let numbers = |input: &Value| -> Vec<f64> {
        let list = input.as_array().into_iter().flatten();
        list.filter_map(Value::as_f64).collect()
    };
    match path {
        "/Info" => (
            200,
            json!({"protocolVersion": 1.0, "models": ["wheel"], "version": version}).to_string(),
        ),
        "/ModelInfo" => (200, json!({"support": {"Evaluate": true}}).to_string()),
        "/InputSizes" => (200, json!({"inputSizes": [2, 2]}).to_string()),
        "/OutputSizes" => (200, json!({"outputSizes": [3]}).to_string()),
        _ => {
            let question = Question {
                run: numbers(&body["input"][0]),
                parameters: numbers(&body["input"][1]),
                number: state.evaluations.fetch_add(1, Ordering::SeqCst),
            };
            match answer(&question) {
                Reply::Output(output) => (200, format!("{{\"output\": {output}}}")),
                Reply::Status(status, body) => (status, body),
                Reply::Hang(time) => {
                    std::thread::sleep(time);
                    (200, "{}".to_owned())
                }
            }
        }
    }
}
