//! The place of a calibration in its study.

use serde::{Deserialize, Serialize};
use strum::{EnumString, IntoStaticStr};
use utoipa::ToSchema;

use crate::discovery::Extension;

/// The result that a calibration computes.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, ToSchema, EnumString, IntoStaticStr)]
#[serde(rename_all = "snake_case")]
#[strum(serialize_all = "snake_case")]
pub enum Role {
    /// A sample of the posterior.
    Sample,
    /// The most probable parameters, by `lm`, `ga` or `cma-es`.
    Fit,
    /// A search for missing effects.
    Search,
}

impl Role {
    /// Returns the word in the store.
    pub fn name(self) -> &'static str {
        self.into()
    }

    /// Returns the role of a word.
    pub fn from_name(name: &str) -> Option<Role> {
        name.parse().ok()
    }
}

/// The change of a calibration's job from that of its parent.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Change {
    /// The model and the measurements are the same; this algorithm calibrates them.
    Algorithm(String),
    /// The calibration uses another of the models that the submitted job compares, by its number in the job, from 0.
    Model(usize),
    /// The model has an addition.
    Add(Extension),
    /// The model lacks these effects.
    Drop(Vec<String>),
    /// Number of runs that the experiment has gained.
    Runs(usize),
}

/// The place of a calibration in its study. Held by `study::lineage`, which follows the parents.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Membership {
    /// Kind of result that the calibration computes.
    pub role: Role,
    /// The calibration whose model the member changes or searches; `None` for the submitted calibration.
    pub parent: Option<i64>,
    /// The change from the parent's job. `None` for the submitted calibration, for a search, and where an earlier version did not
    /// store enough to know it.
    pub change: Option<Change>,
}

impl Membership {
    /// Returns the calibration that a job was submitted for.
    pub fn submitted(role: Role) -> Self {
        Membership {
            role,
            parent: None,
            change: None,
        }
    }

    /// Returns a calibration that follows from another one.
    pub fn changed(role: Role, parent: i64, change: Change) -> Self {
        Membership {
            role,
            parent: Some(parent),
            change: Some(change),
        }
    }

    /// Returns the search of a calibration's model.
    pub fn search_of(calibration: i64) -> Self {
        Membership {
            role: Role::Search,
            parent: Some(calibration),
            change: None,
        }
    }

    /// Returns whether this is a search for missing effects.
    pub fn is_search(&self) -> bool {
        self.role == Role::Search
    }
}
