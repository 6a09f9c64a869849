//! The commands of the command line.

mod backup;
mod check;
mod copy_store;
mod doctor;
mod effects;
mod export_file;
mod exposure;
mod folder;
mod growth;
mod import;
mod incoming;
mod job_on_disk;
mod library;
mod output;
mod place;
mod predict;
mod progress;
mod run;
mod run_table;
mod scale;
mod schema;
mod serve;
mod shell;
mod shutdown;
mod stream;
mod token;
mod validate;
mod verbs;
mod watch;

use crate::config::CoordinatorCommand;

pub use shutdown::Stopped;

/// Executes a command.
///
/// # Errors
/// The failure with its causes.
pub async fn execute(command: CoordinatorCommand) -> anyhow::Result<()> {
    match command {
        CoordinatorCommand::Run(run) => run::run(run).await,
        CoordinatorCommand::Check(file) => check::check(&file).await,
        CoordinatorCommand::Import(config) => import::import(&config),
        CoordinatorCommand::Serve(serve) => serve::serve(serve).await,
        CoordinatorCommand::Submit(submit) => verbs::submit(&submit).await,
        CoordinatorCommand::List(config) => verbs::list(&config).await,
        CoordinatorCommand::Status(target) => verbs::status(&target).await,
        CoordinatorCommand::Cancel(target) => verbs::control(&target, "cancel", "").await,
        CoordinatorCommand::Pause(target) => verbs::control(&target, "pause", "").await,
        CoordinatorCommand::Resume(resume) => verbs::resume(&resume).await,
        CoordinatorCommand::Compare(target) => verbs::compare(&target).await,
        CoordinatorCommand::Report(report) => verbs::report(&report).await,
        CoordinatorCommand::Export(export) => export_file::export(&export).await,
        CoordinatorCommand::Diagnose(target) => verbs::diagnose(&target).await,
        CoordinatorCommand::Validate(config) => validate::validate(&config).await,
        CoordinatorCommand::Predict(config) => predict::predict(&config).await,
        CoordinatorCommand::Decide(config) => predict::decide(&config).await,
        CoordinatorCommand::Watch(config) => watch::watch(&config).await,
        CoordinatorCommand::Stream(config) => stream::stream(config).await,
        CoordinatorCommand::Discover(discover) => growth::discover(&discover).await,
        CoordinatorCommand::Extend(extend) => growth::extend(&extend).await,
        CoordinatorCommand::AddRuns(runs) => growth::add_runs(&runs).await,
        CoordinatorCommand::Effects(config) => effects::effects(&config).await,
        CoordinatorCommand::Library(command) => library::library(&command).await,
        CoordinatorCommand::Archive(study) => verbs::archive(&study, "archive").await,
        CoordinatorCommand::Restore(study) => verbs::archive(&study, "restore").await,
        CoordinatorCommand::Delete(study) => verbs::delete(&study).await,
        CoordinatorCommand::Scale(arguments) => scale::scale(&arguments).await,
        CoordinatorCommand::Backup(config) => backup::backup(&config).await,
        CoordinatorCommand::CopyStore(config) => copy_store::copy(&config).await,
        CoordinatorCommand::Doctor(config) => doctor::doctor(&config).await,
        CoordinatorCommand::Completions { shell } => shell::completions(shell),
        CoordinatorCommand::Man { folder } => shell::man(&folder),
        CoordinatorCommand::Schema(config) => schema::schema(&config),
        CoordinatorCommand::Token(command) => token::token(&command).await,
        CoordinatorCommand::Worker(config) => Ok(crate::embedded::work(config).await?),
    }
}
