//! `coordinator run`: everything in one process, in a folder that can be taken up again.

use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

use anyhow::{Context, bail};
use shared::api::{CalibrationState, NewCalibration, NewExperiment};
use shared::model::equations_of;
use tokio::net::TcpListener;

use super::Stop;
use super::job::{self, JobOnDisk};
use super::output::{note, say};
use super::progress::Display;
use crate::config::Run;
use crate::embedded::{LocalWorkers, model_version};
use crate::farm::Control;
use crate::result::{Study, report, terminal};
use crate::service::{LEASE_MS, Service};
use crate::store::CalibrationRow;

/// How often the display looks.
const LOOK: Duration = Duration::from_millis(100);

/// How a run ended.
enum End {
    Over,
    Stopped,
}

pub(super) async fn run(config: Run) -> anyhow::Result<()> {
    let job = job::read(&config.file)?;
    for text in terminal::notes(&job.spec) {
        note(&format!("note: {text}"));
    }
    let out = config
        .out
        .clone()
        .unwrap_or_else(|| Path::new("out").join(&job.name));
    // The address is taken before anything is written, so that a port in use leaves nothing behind.
    let listener = match config.listen {
        Some(address) => Some(
            TcpListener::bind(address)
                .await
                .with_context(|| format!("--listen {address}"))?,
        ),
        None => None,
    };
    std::fs::create_dir_all(&out).with_context(|| format!("--out {}", out.display()))?;
    let service = Service::open(&out.join("grouser.db").display().to_string(), LEASE_MS).await?;
    let result = in_folder(&config, &job, &out, &service, listener).await;
    service.close().await;
    result
}

async fn in_folder(
    config: &Run,
    job: &JobOnDisk,
    out: &Path,
    service: &Service,
    listener: Option<TcpListener>,
) -> anyhow::Result<()> {
    let study = take_up(job, out, service).await?;
    let rows = service.store().reader().study(study).await?;
    if rows.iter().any(|row| !row.state.is_final()) {
        match calibrate(config, study, service, listener).await? {
            End::Over => {}
            End::Stopped => {
                note("stopped; the same command goes on from here");
                return Ok(());
            }
        }
    }
    let rows = service.store().reader().study(study).await?;
    if let Some(row) = rows.iter().find(|row| row.state == CalibrationState::Finished) {
        let study = Study::load(&service.store().reader(), row).await?;
        write_results(&study, out)?;
        let files = format!(
            "\nin {}: summary.json, posterior.csv, report.html, grouser.db\n",
            out.display()
        );
        say(&(terminal::study(&study) + &files))?;
    }
    match rows.iter().find(|row| row.state != CalibrationState::Finished) {
        None => Ok(()),
        Some(row) => bail!(
            "calibration {} {}: {}",
            row.name,
            row.state.name(),
            row.message.as_deref().unwrap_or_default()
        ),
    }
}

/// The study of this folder: the stored one, if it is of the same job, or a new one.
async fn take_up(job: &JobOnDisk, out: &Path, service: &Service) -> anyhow::Result<i64> {
    let rows = service.store().reader().calibrations().await?;
    let Some(first) = rows.first() else {
        let experiment = NewExperiment {
            toml: job.experiment.toml.clone(),
            files: job.experiment.files.clone(),
        };
        let experiment = service.add_experiment(experiment).await?;
        let new = NewCalibration {
            experiment,
            toml: job.job.toml.clone(),
            files: job.job.files.clone(),
            name: Some(job.name.clone()),
        };
        return Ok(service.add_calibration(new).await?.study);
    };
    // The others of the study follow from the first.
    let stored = service.spec_of(first).await?;
    if !stored.same_as(&job.spec) {
        let differs =
            |(name, text): (&String, &String)| job.job.files.get(name).is_some_and(|now| now != text);
        let changed = first.job.files.iter().find(|&file| differs(file));
        let what = match changed {
            Some((name, _)) => format!("the effect file {name}"),
            None => "the job or its experiment".to_owned(),
        };
        bail!(
            "{} holds the calibration of another job: {what} has changed since; give another --out, or delete the folder",
            out.display()
        );
    }
    for row in rows.iter().filter(|row| row.study == first.study) {
        go_on(row, out, service).await?;
    }
    Ok(first.study)
}

/// Lets a stored calibration go on, where this program can.
async fn go_on(row: &CalibrationRow, out: &Path, service: &Service) -> anyhow::Result<()> {
    if let Some(reason) = service.left_alone(row.id) {
        bail!(
            "{} holds a calibration that cannot go on: {reason}",
            out.display()
        );
    }
    if let Some(pinned) = row
        .model_version
        .as_deref()
        .map(equations_of)
        .filter(|v| *v != model_version() && !row.state.is_final())
    {
        bail!(
            "{} holds a calibration begun with model version {pinned}, this program computes {}: give another --out, or finish it with the older program",
            out.display(),
            model_version()
        );
    }
    if row.state == CalibrationState::Paused {
        service.control(row.id, Control::Resume).await?;
    }
    Ok(())
}

async fn calibrate(
    config: &Run,
    study: i64,
    service: &Service,
    listener: Option<TcpListener>,
) -> anyhow::Result<End> {
    let stop = Stop::new();
    let server = listener.map(|listener| {
        if let Ok(address) = listener.local_addr() {
            note(&format!(
                "workers may join: worker --coordinator http://{address}"
            ));
        }
        tokio::spawn(crate::http::serve(listener, service.clone(), stop.wait()))
    });
    let cores = std::thread::available_parallelism().map_or(1, Into::into);
    let threads = config.local_workers.unwrap_or(cores);
    if threads == 0 && server.is_none() {
        bail!("--local-workers 0 needs --listen: nobody would simulate");
    }
    let began = Instant::now();
    let workers =
        (threads > 0).then(|| LocalWorkers::start(service.dispatcher().clone(), threads, stop.wait()));
    let failure = workers.as_ref().map(LocalWorkers::failure);
    let end = watch_until_over(study, service, failure).await;
    let wall_s = began.elapsed().as_secs_f64();
    stop.now();
    if let Some(workers) = workers {
        let share = workers.simulated_s() / (wall_s * workers.threads as f64);
        note(&format!(
            "{} local workers simulated {:.1} % of {wall_s:.1} s",
            workers.threads,
            100.0 * share
        ));
        workers.join().await;
    }
    if let Some(server) = server {
        // Workers elsewhere may be waiting in a poll; they are not waited for.
        server.abort();
    }
    end
}

/// Shows progress until every calibration of the study is over, or until ^C.
async fn watch_until_over(
    study: i64,
    service: &Service,
    failure: Option<impl Future<Output = String>>,
) -> anyhow::Result<End> {
    let failure = async {
        match failure {
            Some(failure) => failure.await,
            None => std::future::pending().await,
        }
    };
    tokio::pin!(failure);
    let stop = super::stop_signal()?;
    tokio::pin!(stop);
    let store_fails = service.store().writer().stopped();
    tokio::pin!(store_fails);
    let mut display = Display::new();
    loop {
        tokio::select! {
            () = &mut stop => { display.finish(); return Ok(End::Stopped); }
            () = &mut store_fails => bail!("the store can no longer be written; its log line says why"),
            reason = &mut failure => bail!("the local workers ended: {reason}"),
            () = tokio::time::sleep(LOOK) => {}
        }
        let mut statuses = service.list().await?;
        statuses.retain(|status| status.study == study && !status.state.is_final());
        let paused = statuses.iter().find(|s| s.state == CalibrationState::Paused);
        if let Some(status) = paused {
            display.finish();
            bail!(
                "paused: {}; the same command goes on from here",
                status.message.as_deref().unwrap_or_default()
            );
        }
        let Some(status) = statuses.first() else {
            display.finish();
            return Ok(End::Over);
        };
        display.show(status);
    }
}

/// Writes every result beside its final name first, so that a half-written file never takes that name.
fn write_results(study: &Study, out: &Path) -> anyhow::Result<()> {
    let summary = serde_json::to_string_pretty(&study.summary())?;
    let files: [(&str, String); 3] = [
        ("summary.json", summary + "\n"),
        ("posterior.csv", study.lead.posterior_table().to_csv()),
        ("report.html", report::page(study)),
    ];
    for (name, text) in files {
        let path: PathBuf = out.join(name);
        let partial = out.join(format!("{name}.part"));
        std::fs::write(&partial, text).with_context(|| partial.display().to_string())?;
        std::fs::rename(&partial, &path).with_context(|| path.display().to_string())?;
    }
    Ok(())
}
