//! The self-contained report: one HTML page that needs nothing from elsewhere, for screen and paper.
//!
//! # Layout
//! - `page`: the page. `section`: its parts, in reading order.
//! - `chart`: the pictures, drawn as inline SVG.
//! - `script`: the modules that draw the figures in the reader's browser, and their numbers.
//!
//! Names come from users; the templates escape every text, and so do the modules. Without scripts everything but the figures
//! stands there, and in place of each figure its numbers.

mod chart;
mod page;
mod script;
mod section;

pub use page::page;
