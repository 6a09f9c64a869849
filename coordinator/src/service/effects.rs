//! Effects that users add to the catalogue, and the ones that a job names.

use formula::Effect;
use formula::catalogue::find;
use sha2::{Digest, Sha256};
use shared::file::{FileError, FileSet};
use shared::model::effects::read_user_effect;

use super::background::in_background;
use super::clock::now_ms;
use super::error::ServiceError;
use super::handle::Service;
use job::{EffectOnNodes, ModelSwitch, PlainParameter, ServiceEffect, check_effect, foreign_effects};
use record::Extension;
use store::{AddedEffect, NewEffect, StoredEffect};

/// Names of an effect file and a job in messages.
const EFFECT: &str = "effect.toml";
const JOB: &str = "job.toml";

impl Service {
    /// Stores an effect file as the next version of its effect, unless a version has the same text.
    ///
    /// # Errors
    /// [`ServiceError`]: the file is malformed, or the name belongs to the library.
    pub async fn add_effect(&self, text: String, by: Option<String>) -> Result<AddedEffect, ServiceError> {
        let read = in_background(move || {
            if let Ok(effect) = Effect::read(&text)
                && find(&effect.name).is_some()
            {
                return Err(ServiceError::OfLibrary(effect.name));
            }
            let effect = read_user_effect(EFFECT, &text)?;
            check_effect(EFFECT, &effect)?;
            Ok::<_, ServiceError>(effect)
        });
        let effect = read.await?;
        let digest = Sha256::digest(effect.text.as_bytes());
        let new = NewEffect {
            name: effect.name,
            digest: digest.iter().map(|byte| format!("{byte:02x}")).collect(),
            text: effect.text,
            created_by: by,
            now_ms: now_ms(),
        };
        Ok(self.store().writer().add_effect(new).await?)
    }

    /// Reads all versions of the effect `NAME`, and the last one, or for `NAME@VERSION` that version; `None` if no user has added the
    /// effect.
    ///
    /// # Errors
    /// [`ServiceError`]: the effect has no such version.
    pub async fn user_effect(
        &self,
        named: &str,
    ) -> Result<Option<(Vec<StoredEffect>, StoredEffect)>, ServiceError> {
        let (name, version) = match named.split_once('@') {
            Some((name, version)) => (name, Some(version)),
            None => (named, None),
        };
        let versions = self.store().reader().effect_versions(name).await?;
        let Some(last) = versions.last() else {
            return Ok(None);
        };
        let Some(version) = version else {
            let last = last.clone();
            return Ok(Some((versions, last)));
        };
        let is_meant = |stored: &&StoredEffect| stored.version.version.to_string() == version;
        let meant = versions.iter().find(is_meant).cloned();
        let missing = || ServiceError::NoVersion {
            name: name.to_owned(),
            version: version.to_owned(),
            last: last.version.version,
        };
        let meant = meant.ok_or_else(missing)?;
        Ok(Some((versions, meant)))
    }

    /// Reads the effects that a job lists and that users have added.
    ///
    /// # Errors
    /// [`ServiceError`]: an effect has no such version.
    pub(super) async fn listed_user_effects(
        &self,
        job: &FileSet,
    ) -> Result<Vec<ServiceEffect>, ServiceError> {
        let toml = job.toml.clone();
        let listed = in_background(move || Ok::<_, ServiceError>(foreign_effects(&toml)));
        let mut effects = Vec::new();
        for named in listed.await? {
            effects.extend(self.as_file(&named).await?);
        }
        Ok(effects)
    }

    /// Replaces the name of an effect that a user has added by the file of the effect.
    pub(super) async fn with_user_effect(&self, extension: Extension) -> Result<Extension, ServiceError> {
        let Extension::Effect(named) = &extension else {
            return Ok(extension);
        };
        let is_ours = find(named).is_some()
            || PlainParameter::find(named).is_some()
            || ModelSwitch::find(named).is_some()
            || EffectOnNodes::find(named).is_some();
        let file = if is_ours { None } else { self.as_file(named).await? };
        Ok(match file {
            Some(file) => Extension::File {
                name: file.file,
                text: file.text,
            },
            None => extension,
        })
    }

    /// Reads an effect that users have added, as a file that states its version.
    async fn as_file(&self, named: &str) -> Result<Option<ServiceEffect>, ServiceError> {
        let stored = self.user_effect(named).await.map_err(|error| match error {
            missing @ ServiceError::NoVersion { .. } => FileError::whole(JOB, missing.to_string()).into(),
            error => error,
        })?;
        let service_effect = |effect: StoredEffect| {
            ServiceEffect::new(
                named.to_owned(),
                &effect.name,
                effect.version.version,
                effect.text,
            )
        };
        Ok(stored.map(|(_, effect)| service_effect(effect)))
    }
}
