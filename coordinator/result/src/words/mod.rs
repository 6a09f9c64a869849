//! Words: numbers, units, probabilities and citations as people read them.
//!
//! - `number`: formats of numbers. `probability`: formats of probabilities. `data_channel`: names and units of channels.
//! - `rejection`: reasons of rejections. `campaign`: the source of measurements. `date`: days of the calendar.

pub mod campaign;
pub mod data_channel;
pub mod date;
pub mod number;
pub mod probability;
pub mod rejection;
