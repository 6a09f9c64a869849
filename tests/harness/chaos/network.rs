//! What the network does with bytes.

use std::net::{Shutdown, TcpStream};
use std::time::Duration;

/// How the network is.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Weather {
    Passing,
    /// Connections are closed as soon as they are opened.
    Refusing,
    /// Every part of a message takes so long.
    Late(Duration),
    /// Nothing passes; what was silent is closed afterwards.
    Silent,
}

/// Where bytes go.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Toward {
    Coordinator,
    Workers,
}

/// All connections, and what is about to happen to them.
#[derive(Debug)]
pub(super) struct Network {
    weather: Weather,
    /// Every connection is cut after so many more bytes in this direction.
    cut_after: Option<(Toward, usize)>,
    open: Vec<TcpStream>,
}

impl Network {
    pub(super) fn new() -> Network {
        Network {
            weather: Weather::Passing,
            cut_after: None,
            open: Vec::new(),
        }
    }

    pub(super) fn weather(&self) -> Weather {
        self.weather
    }

    /// Changes the weather; connections that were silent are closed.
    pub(super) fn set(&mut self, weather: Weather) {
        if std::mem::replace(&mut self.weather, weather) == Weather::Silent {
            self.cut();
        }
    }

    /// Takes the two ends of a connection.
    pub(super) fn add(&mut self, ends: [TcpStream; 2]) {
        self.open.extend(ends);
    }

    /// Closes every connection.
    pub(super) fn cut(&mut self) {
        self.cut_after = None;
        for stream in self.open.drain(..) {
            // Whoever has left is cut already.
            let _ = stream.shutdown(Shutdown::Both);
        }
    }

    /// Closes every connection after so many more bytes in a direction.
    pub(super) fn cut_after(&mut self, toward: Toward, bytes: usize) {
        self.cut_after = Some((toward, bytes));
    }

    /// Counts bytes that are about to pass; how many of them do before the cut, if it comes now.
    pub(super) fn last_of(&mut self, toward: Toward, length: usize) -> Option<usize> {
        let (_, left) = self.cut_after.as_mut().filter(|(which, _)| *which == toward)?;
        if *left < length {
            return Some(*left);
        }
        *left -= length;
        None
    }
}
