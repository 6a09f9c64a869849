//! ROS 1 bags (format 2.0): the wrenches of one topic as a table.
//!
//! A bag is a sequence of records, each of a header and data, which both state their length first; a header has fields `name=value`. Chunks hold
//! the records of connections and of messages; the index at the end is not needed. Source: <http://wiki.ros.org/Bags/Format/2.0>. Numbers are
//! little-endian.

use std::collections::{BTreeMap, BTreeSet};

use super::source_file::Hints;
use crate::complaint::Complaint;
use crate::table::{Cell, Form, Row, Table};

/// The beginning of a bag.
pub(super) const MAGIC: &[u8] = b"#ROSBAG V2.0\n";

const OF_MESSAGE: u8 = 2;
const OF_CHUNK: u8 = 5;
const OF_CONNECTION: u8 = 7;

/// Titles of the six axes, in the order of a message, with the units of ROS (REP 103).
const AXES: [&str; 6] = [
    "force.x [N]",
    "force.y [N]",
    "force.z [N]",
    "torque.x [N m]",
    "torque.y [N m]",
    "torque.z [N m]",
];
/// A nanosecond `[s]`.
const NANO: f64 = 1e-9;
/// Maximum number of kinds of messages in a sentence.
const LISTED: usize = 12;

/// A topic of a bag.
struct Topic {
    name: String,
    kind: String,
}

/// The wrenches of a bag.
#[derive(Default)]
struct Bag {
    /// Topics by the number of their connection.
    topics: BTreeMap<u32, Topic>,
    /// Each wrench with the number of its connection: time of the message, time at which it was received `[s]`, six axes.
    wrenches: Vec<(u32, [f64; 8])>,
}

/// Bytes that are read from their beginning.
struct Bytes<'a>(&'a [u8]);

impl<'a> Bytes<'a> {
    fn take(&mut self, count: usize) -> Result<&'a [u8], String> {
        let (taken, rest) = self
            .0
            .split_at_checked(count)
            .ok_or("the bag ends within a record: copy it again, or run `rosbag reindex`")?;
        self.0 = rest;
        Ok(taken)
    }

    fn u32(&mut self) -> Result<u32, String> {
        let bytes = self.take(4)?;
        Ok(u32::from_le_bytes(bytes.try_into().unwrap_or_default()))
    }

    fn f64(&mut self) -> Result<f64, String> {
        let bytes = self.take(8)?;
        Ok(f64::from_le_bytes(bytes.try_into().unwrap_or_default()))
    }

    /// Returns a time in seconds.
    fn time(&mut self) -> Result<f64, String> {
        Ok(f64::from(self.u32()?) + f64::from(self.u32()?) * NANO)
    }

    /// Returns the bytes whose number stands before them.
    fn counted(&mut self) -> Result<&'a [u8], String> {
        let count = self.u32()? as usize;
        self.take(count)
    }

    /// Returns the fields of a header.
    fn fields(&mut self) -> Result<BTreeMap<&'a [u8], &'a [u8]>, String> {
        let mut header = Bytes(self.counted()?);
        let mut fields = BTreeMap::new();
        while !header.0.is_empty() {
            let field = header.counted()?;
            let at = field.iter().position(|&byte| byte == b'=');
            let at = at.ok_or("a header of the bag has a field without =")?;
            fields.insert(&field[..at], &field[at + 1..]);
        }
        Ok(fields)
    }
}

fn text(bytes: Option<&&[u8]>) -> String {
    String::from_utf8_lossy(bytes.copied().unwrap_or_default()).into_owned()
}

impl Bag {
    /// Reads records; those of chunks are read within chunks.
    fn records(&mut self, bytes: &[u8], is_within: bool) -> Result<(), String> {
        let mut bytes = Bytes(bytes);
        while !bytes.0.is_empty() {
            let fields = bytes.fields()?;
            let data = bytes.counted()?;
            let field = |name: &str| fields.get(name.as_bytes());
            let connection = || field("conn").map(|bytes| Bytes(bytes).u32()).transpose();
            match field("op").and_then(|op| op.first()) {
                Some(&OF_CHUNK) if !is_within => match text(field("compression")).as_str() {
                    "none" => self.records(data, true)?,
                    other => {
                        return Err(format!(
                            "the bag is compressed by {other}: run `rosbag decompress` on it"
                        ));
                    }
                },
                Some(&OF_CONNECTION) => {
                    let (Some(number), name) = (connection()?, text(field("topic"))) else {
                        continue;
                    };
                    let kind = text(Bytes(&header_of(data)).fields()?.get("type".as_bytes()));
                    self.topics.insert(number, Topic { name, kind });
                }
                Some(&OF_MESSAGE) => {
                    let received = field("time").map(|bytes| Bytes(bytes).time()).transpose()?;
                    if let (Some(number), Some(received_s)) = (connection()?, received) {
                        self.message(number, received_s, data)?;
                    }
                }
                _ => {}
            }
        }
        Ok(())
    }

    /// Takes a message if it is a wrench.
    fn message(&mut self, number: u32, received_s: f64, data: &[u8]) -> Result<(), String> {
        let Some(topic) = self.topics.get(&number) else {
            return Ok(());
        };
        let mut data = Bytes(data);
        let stamp_s = match topic.kind.as_str() {
            "geometry_msgs/Wrench" => received_s,
            "geometry_msgs/WrenchStamped" => {
                data.u32()?;
                let stamp_s = data.time()?;
                data.counted()?;
                stamp_s
            }
            _ => return Ok(()),
        };
        let mut wrench = [stamp_s, received_s, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0];
        for axis in &mut wrench[2..] {
            *axis = data.f64()?;
        }
        self.wrenches.push((number, wrench));
        Ok(())
    }
}

/// Returns the data of a connection as a header, which states its length.
fn header_of(data: &[u8]) -> Vec<u8> {
    let length = u32::try_from(data.len()).unwrap_or(u32::MAX);
    [&length.to_le_bytes(), data].concat()
}

/// Reads the wrenches of the stated topic, or of the only one that has any.
///
/// The rows are sorted by the time of the message, which is that of its header, or without one that at which it was received. Checked by
/// `tests/raw.rs` against a bag of the Python package `rosbags`.
pub(super) fn read(name: &str, bytes: &[u8], hints: &Hints) -> Result<Table, Box<Complaint>> {
    let mut table = Table {
        file: name.to_owned(),
        sheet: None,
        sheets: Vec::new(),
        form: Form::Variables,
        rows: Vec::new(),
        remarks: Vec::new(),
    };
    let mut bag = Bag::default();
    let records = bytes.strip_prefix(MAGIC).unwrap_or_default();
    bag.records(records, false)
        .map_err(|message| table.refusal(message))?;
    let mut counts: BTreeMap<&str, usize> = BTreeMap::new();
    for (number, _) in &bag.wrenches {
        let topic = bag.topics.get(number).map_or("", |topic| topic.name.as_str());
        *counts.entry(topic).or_default() += 1;
    }
    table.sheets = counts.keys().map(|&topic| topic.to_owned()).collect();
    let topic = match (&hints.sheet, table.sheets.as_slice()) {
        (_, []) => {
            let kinds: BTreeSet<&str> = bag.topics.values().map(|topic| topic.kind.as_str()).collect();
            let kinds: Vec<&str> = kinds.into_iter().take(LISTED).collect();
            return Err(table.refusal(format!(
                "the bag has no wrench (geometry_msgs/WrenchStamped or geometry_msgs/Wrench); it has {}",
                kinds.join(", ")
            )));
        }
        (Some(stated), topics) => {
            let topic = topics.iter().find(|topic| *topic == stated);
            let names = topics.iter().map(String::as_str);
            topic
                .cloned()
                .ok_or_else(|| table.refusal(shared::file::unknown_word("topic", stated, names)))?
        }
        (None, [topic]) => topic.clone(),
        (None, topics) if hints.takes_largest => {
            let largest = topics.iter().rev().max_by_key(|topic| counts.get(topic.as_str()));
            largest.cloned().unwrap_or_default()
        }
        (None, topics) => {
            return Err(table.refusal(format!(
                "several topics have wrenches: state `sheet = ` in the map, one of \"{}\"",
                topics.join("\", \"")
            )));
        }
    };
    let is_of_topic = |number: &u32| bag.topics.get(number).is_some_and(|known| known.name == topic);
    let mut wrenches: Vec<[f64; 8]> = bag
        .wrenches
        .iter()
        .filter(|(number, _)| is_of_topic(number))
        .map(|(_, wrench)| *wrench)
        .collect();
    wrenches.sort_by(|a, b| a[0].total_cmp(&b[0]));
    let titles = ["stamp [s]", "received [s]"].into_iter().chain(AXES);
    table.rows.push(Row {
        line: 0,
        cells: titles.map(Cell::from_text).collect(),
    });
    let row = |(place, wrench): (usize, [f64; 8])| Row {
        line: place + 1,
        cells: wrench.map(Cell::Number).to_vec(),
    };
    table.rows.extend(wrenches.into_iter().enumerate().map(row));
    table.sheet = Some(topic);
    Ok(table)
}
