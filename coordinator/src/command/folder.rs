//! The folder of a run: its store, the computation of its study, and its results.

use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

use anyhow::{Context, bail};
use shared::api::CalibrationState;
use shared::model::equations_of;
use tokio::net::TcpListener;

use super::exposure::exposure;
use super::output::{note, say, width};
use super::progress::{Display, Parts};
use super::shutdown::{Shutdown, Stopped, stop_signal};
use crate::config::{ExposureArguments, ModelArguments};
use crate::embedded::{LocalModels, LocalWorkers};
use crate::http::Exposure;
use crate::service::{FarmSettings, LEASE_MS, Service, VERIFIED_PERCENT};
use farm::Control;
use farm::calibration::VerificationRule;
use job::{Apply, Spec};
use record::CalibrationRow;
use report::{StudyFile, terminal};
use result::DiscoveryRound;
use result::discovery::effect_files;
use store::IdPage;

/// Interval between two updates of the display.
const LOOK: Duration = Duration::from_millis(100);

/// Whether the tables and flags of a study are printed.
#[derive(Debug, Clone, Copy)]
pub(super) enum Details {
    /// Only the report has tables and flags.
    Hidden,
    /// Tables and flags are printed, with the search of the given calibration or, without one, with the last search.
    Shown {
        /// The calibration whose search is printed.
        searched: Option<i64>,
    },
}

impl Details {
    pub(super) fn new(verbose: bool, searched: Option<i64>) -> Self {
        match verbose {
            true => Details::Shown { searched },
            false => Details::Hidden,
        }
    }
}

/// A folder with its open store.
pub(super) struct Folder {
    /// Path of the folder.
    pub(super) out: PathBuf,
    /// The store, and a farm for it.
    pub(super) service: Service,
    local_workers: Option<usize>,
    models: LocalModels,
    server: Option<(TcpListener, Exposure)>,
}

impl Folder {
    /// Opens the store of an existing folder. Remote workers may join at the listener.
    pub(super) async fn open(
        out: &Path,
        local_workers: Option<usize>,
        models: &ModelArguments,
        listener: Option<(TcpListener, &ExposureArguments)>,
    ) -> anyhow::Result<Folder> {
        let models = LocalModels::new(&models.allow_model).map_err(anyhow::Error::msg)?;
        let store = out.join("grouser.db").display().to_string();
        // Without a listener, this program is the only worker.
        let verified_share = listener.as_ref().map_or(0.0, |_| VERIFIED_PERCENT / 100.0);
        let settings = FarmSettings {
            lease_ms: LEASE_MS,
            rule: VerificationRule::with_share(verified_share),
        };
        let service = Service::open(&store, settings).await?;
        let server = match listener {
            Some((listener, config)) => {
                let reader = service.store().reader();
                let exposure = exposure(listener.local_addr()?, config, &reader, &store).await?;
                Some((listener, exposure))
            }
            None => None,
        };
        Ok(Folder {
            out: out.to_owned(),
            service,
            local_workers,
            models,
            server,
        })
    }

    /// Continues the calibrations of a study.
    pub(super) async fn go_on(&self, study: i64) -> anyhow::Result<()> {
        for row in self.service.store().reader().study(study).await? {
            self.go_on_with(&row).await?;
        }
        Ok(())
    }

    async fn go_on_with(&self, row: &CalibrationRow) -> anyhow::Result<()> {
        let (service, out) = (&self.service, &self.out);
        if let Some(reason) = service.left_alone(row.id) {
            bail!(
                "{} holds a calibration that cannot be resumed: {reason}",
                out.display()
            );
        }
        if !row.state.is_final() {
            self.check_equations(row).await?;
        }
        if row.state == CalibrationState::Paused {
            service
                .control(row.id, Control::Resume { skip_faults: false })
                .await?;
        }
        Ok(())
    }

    /// Returns the version of the equations that local workers compute for a job's model; `None` where they do not run the model, but
    /// remote workers may join.
    ///
    /// # Errors
    /// Neither local nor remote workers would run the model.
    pub(super) async fn equations_of(&self, spec: &Spec) -> anyhow::Result<Option<String>> {
        let external = spec.model.external.clone();
        let models = self.models.clone();
        match tokio::task::spawn_blocking(move || models.equations(external.as_ref())).await? {
            Ok(equations) => Ok(Some(equations)),
            Err(message) if self.server.is_none() => bail!(message),
            Err(_) => Ok(None),
        }
    }

    /// Checks that local workers can continue a calibration: that they run its model in the version that it is pinned to.
    async fn check_equations(&self, row: &CalibrationRow) -> anyhow::Result<()> {
        let spec = self.service.spec_of(row).await?;
        let Some(equations) = self.equations_of(&spec).await? else {
            return Ok(());
        };
        match row.model_version.as_deref().map(equations_of) {
            Some(pinned) if pinned != equations => bail!(
                "{} holds a calibration started with model version {pinned}, but this program computes {equations}: give another --out, or finish it with the older one",
                self.out.display()
            ),
            _ => Ok(()),
        }
    }

    /// Brings a study to its end.
    pub(super) async fn bring_to_end(&mut self, study: i64) -> anyhow::Result<()> {
        let reader = self.service.store().reader();
        let rows = reader.study(study).await?;
        let is_over = rows.iter().all(|row| row.state.is_final());
        if !is_over || self.service.next_step(study).await?.is_some() {
            self.calibrate(study).await?;
        }
        Ok(())
    }

    /// Brings a study to its end, writes its results and prints them.
    pub(super) async fn finish(mut self, study: i64, details: Details) -> anyhow::Result<()> {
        self.bring_to_end(study).await?;
        // A calibration that was taken back before its end is cancelled, and this is no failure of the study.
        let (rows, _) = self.service.store().reader().members_and_withdrawn(study).await?;
        if let Some(row) = rows.iter().find(|row| row.state == CalibrationState::Finished) {
            let rounds = self.service.search_rounds(study).await?;
            self.write_results(row.id, &rounds).await?;
            say(&self.results(row.id, &rounds, details).await?)?;
        }
        if let Some(failure) = self.service.study_overview(study).await?.failure {
            bail!(failure.text);
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

    /// Makes the text that is printed about a study.
    async fn results(
        &self,
        calibration: i64,
        rounds: &[DiscoveryRound],
        details: Details,
    ) -> anyhow::Result<String> {
        let file = async |file| self.service.study_file(calibration, file).await;
        let story = serde_json::from_str(&file(StudyFile::Story).await?)?;
        let Details::Shown { searched } = details else {
            let brief = file(StudyFile::Brief).await?;
            return Ok(terminal::run_end(&brief, &story, &self.out, width()));
        };
        let mut text = file(StudyFile::Details).await? + "\n";
        let named = rounds.iter().find(|r| Some(r.calibration) == searched);
        if let Some(round) = named.or(rounds.last()) {
            let place = format!("--out {}", self.out.display());
            text += &terminal::discovery::text(&round.record, round.calibration, &place, &self.out);
            text.push('\n');
        }
        text += &terminal::story(&story, &self.out, width());
        Ok(text + &terminal::ending(&self.out))
    }

    /// Simulates until the study is over, or until an interrupt.
    async fn calibrate(&mut self, study: i64) -> anyhow::Result<()> {
        let server = self.server.take();
        let service = &self.service;
        let stop = Shutdown::new();
        let server = server.map(|(listener, exposure)| {
            let address = exposure.listening;
            let scheme = if exposure.tls.is_some() { "https" } else { "http" };
            note(&format!(
                "workers may join: worker --coordinator {scheme}://{address}"
            ));
            tokio::spawn(crate::http::serve(
                listener,
                service.clone(),
                exposure,
                stop.wait(),
            ))
        });
        let cores = std::thread::available_parallelism().map_or(1, Into::into);
        let threads = self.local_workers.unwrap_or(cores);
        if threads == 0 && server.is_none() {
            bail!("--local-workers 0 needs --listen: there would be no worker");
        }
        let began = Instant::now();
        let workers = (threads > 0)
            .then(|| LocalWorkers::start(service.dispatcher().clone(), threads, &self.models, stop.wait()));
        let failure = workers.as_ref().map(LocalWorkers::failure);
        let end = watch_until_over(study, service, failure).await;
        let wall_s = began.elapsed().as_secs_f64();
        stop.now();
        if let Some(workers) = workers {
            let share = workers.simulated_s() / (wall_s * workers.threads as f64);
            tracing::debug!(threads = workers.threads, wall_s, share, "simulated");
            workers.join().await;
        }
        if let Some(server) = server {
            // Remote workers may be in a long poll, which must not delay the end.
            server.abort();
        }
        end
    }

    /// Writes every result to a temporary name first, so that no file is ever incomplete under its final name.
    async fn write_results(&self, calibration: i64, rounds: &[DiscoveryRound]) -> anyhow::Result<()> {
        let mut files = Vec::new();
        for file in [
            StudyFile::Summary,
            StudyFile::Posterior,
            StudyFile::Predictions,
            StudyFile::Report,
        ] {
            files.push((file.name(), self.service.study_file(calibration, file).await?));
        }
        files.extend(rounds.iter().flat_map(|round| effect_files(&round.record)));
        for (name, text) in files {
            let path: PathBuf = self.out.join(&name);
            let partial = self.out.join(format!("{name}.part"));
            std::fs::write(&partial, text).with_context(|| partial.display().to_string())?;
            std::fs::rename(&partial, &path).with_context(|| path.display().to_string())?;
        }
        Ok(())
    }
}

/// Shows progress until every calibration of the study is over and it takes no further step, or until an interrupt.
async fn watch_until_over(
    study: i64,
    service: &Service,
    failure: Option<impl Future<Output = String>>,
) -> anyhow::Result<()> {
    let failure = async {
        match failure {
            Some(failure) => failure.await,
            None => std::future::pending().await,
        }
    };
    tokio::pin!(failure);
    let stop = stop_signal()?;
    tokio::pin!(stop);
    let store_fails = service.store().writer().stopped();
    tokio::pin!(store_fails);
    let mut display = Display::new(parts(study, service).await?);
    loop {
        tokio::select! {
            signal = &mut stop => { display.finish(); return Err(Stopped::by(signal).into()); }
            () = &mut store_fails => bail!("the store can no longer be written; see the log"),
            reason = &mut failure => bail!("the local workers ended: {reason}"),
            () = tokio::time::sleep(LOOK) => {}
        }
        let mut statuses = service.list(true, IdPage::ALL).await?;
        statuses.retain(|status| status.study == study);
        let members = statuses.len();
        statuses.retain(|status| !status.state.is_final());
        let paused = statuses.iter().find(|s| s.state == CalibrationState::Paused);
        if let Some(status) = paused {
            display.finish();
            bail!(
                "paused: {}; the same command resumes from here",
                status.message.as_deref().unwrap_or_default()
            );
        }
        let Some(status) = statuses.first() else {
            if service.advance(study).await? {
                continue;
            }
            display.finish();
            return Ok(());
        };
        display.show(status, members - statuses.len());
    }
}

/// Returns what is known of the parts of a study.
async fn parts(study: i64, service: &Service) -> anyhow::Result<Parts> {
    let rows = service.store().reader().study(study).await?;
    let Some(first) = rows.first() else {
        return Ok(Parts::Calibrations(0));
    };
    let spec = service.spec_of(first).await?;
    Ok(match spec.discovery.apply {
        Apply::Off => Parts::Calibrations(rows.len().max(spec.models)),
        Apply::Ask if spec.models == 1 => Parts::WithSearch,
        Apply::Ask | Apply::Auto | Apply::Leading => Parts::Rounds,
    })
}
