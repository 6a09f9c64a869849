//! A gallery of wrong inputs: each gives one clear message, another exit code than 0, and leaves nothing behind.

mod files;
mod places;
mod requests;
