//! The page: ES modules without a build step, style sheets and the libraries that draw, embedded in the program.
//!
//! # Layout
//! - [`asset`]: the files, as a service serves them under `/page/`.
//! - [`report`]: one self-contained document with the same modules, which opens offline.
//! - `modules/`: `page.js` and `report.js` are the entry points. `view/` has the views, `chart/` the pictures, `part/` shared parts
//!   of views, `rest/` requests to the service, `words/` quantities in readable form. `vendor/`: preact with htm, D3, Observable
//!   Plot, with their licences. `tests/`: tests of the modules, for Node.

pub mod asset;
pub mod report;
