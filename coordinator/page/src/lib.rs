//! The page: ES modules without a build step, style sheets and the libraries that draw, embedded in the program.
//!
//! # Layout
//! - [`asset`]: the files, as a service serves them under `/page/`.
//! - [`report`]: one self-contained document with the same modules, which opens offline.
//! - `modules/`: `page.js` and `report.js` are where the two begin; `view/` what a person sees, `chart/` pictures, `part/` what views
//!   share, `rest/` questions to the service, `words/` quantities as people read them. `vendor/`: preact with htm, D3, Observable
//!   Plot, with their licences. `tests/`: of the modules, for Node.

pub mod asset;
pub mod report;
