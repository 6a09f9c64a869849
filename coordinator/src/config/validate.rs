//! Settings of `coordinator validate`.

use clap::Args;

use super::model::ModelArguments;
use super::target::TargetArguments;
use result::validation::Factor;

/// Leave each level of a factor out in turn, and predict it by a calibration on the rest.
#[derive(Debug, Args)]
pub struct ValidateArguments {
    #[command(flatten)]
    pub target: TargetArguments,
    /// What is left out, level by level of the fitted runs.
    #[arg(long, value_enum, value_name = "FACTOR")]
    pub leave_out: LeaveOut,
    /// Calibrates by the calibration's own algorithm; by default, by lm, whose normal approximation takes a hundredth of the
    /// evaluations of a sampler.
    #[arg(long)]
    pub own_algorithm: bool,
    /// What is printed.
    #[arg(long, value_enum, default_value_t = ValidationFormat::Text)]
    pub format: ValidationFormat,
    /// Number of simulation threads in this process; by default, one per core.
    #[arg(long, env = "GROUSER_LOCAL_WORKERS")]
    pub local_workers: Option<usize>,
    #[command(flatten)]
    pub models: ModelArguments,
}

/// A factor of which one level after the other is left out.
#[derive(Debug, Clone, Copy, PartialEq, Eq, clap::ValueEnum)]
pub enum LeaveOut {
    /// Slip.
    Slip,
    /// Wheel load.
    Load,
    /// Speed of the rim.
    Speed,
    /// The wheel.
    Wheel,
    /// Slip angle.
    Angle,
}

impl From<LeaveOut> for Factor {
    fn from(factor: LeaveOut) -> Factor {
        match factor {
            LeaveOut::Slip => Factor::Slip,
            LeaveOut::Load => Factor::Load,
            LeaveOut::Speed => Factor::Speed,
            LeaveOut::Wheel => Factor::Wheel,
            LeaveOut::Angle => Factor::Angle,
        }
    }
}

/// Form in which a validation is printed.
#[derive(Debug, Clone, Copy, PartialEq, Eq, clap::ValueEnum)]
pub enum ValidationFormat {
    /// A table.
    Text,
    /// JSON with every row.
    Json,
}
