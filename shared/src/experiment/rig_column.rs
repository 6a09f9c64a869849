//! The columns of `runs.csv` that name the state of the rig which runs share.

/// A column of ids: runs with one id were made in one state of the rig.
#[derive(
    Debug,
    Clone,
    Copy,
    PartialEq,
    Eq,
    PartialOrd,
    Ord,
    serde::Serialize,
    serde::Deserialize,
    strum::IntoStaticStr,
)]
#[serde(rename_all = "snake_case")]
#[strum(serialize_all = "snake_case")]
pub enum RigColumn {
    /// The day, or the mounting of the wheel.
    Session,
    /// The taring of the sensors.
    Zero,
    /// The person at the rig.
    Operator,
}

impl RigColumn {
    /// Every column, in the order of the file.
    pub const ALL: [RigColumn; 3] = [RigColumn::Session, RigColumn::Zero, RigColumn::Operator];

    /// Returns the name of the column.
    pub fn name(self) -> &'static str {
        self.into()
    }
}
