//! The file that settings are in: read once, written whole or not at all, and never at the price of what somebody wrote in it.

use std::fs;
use std::io::{self, Read, Write};
use std::path::{Path, PathBuf};

use ron::ser::PrettyConfig;
use thiserror::Error;

use super::Settings;

/// Bytes that are read of a settings file at the most: fifty times what one has.
const MOST_BYTES: u64 = 65_536;

/// What a written file begins with.
const HEADING: &str = "// Starball's settings. The game writes this file when something changes and when it ends; edit it while it does not run.\n\
    // Keys go by names such as LeftShift, RightShift, Z, Slash, Left, Space, Key1, Kp0.\n";

/// Why settings cannot be read or written.
#[derive(Debug, Error)]
pub(crate) enum StoreError {
    /// The file cannot be had.
    #[error("{}: {error}", file.display())]
    Io {
        /// Which file.
        file: PathBuf,
        /// Why.
        error: io::Error,
    },
    /// It can be read, but means nothing.
    #[error("{}:{line}: {problem}", file.display())]
    Bad {
        /// Which file.
        file: PathBuf,
        /// From 1; 0: all of it.
        line: usize,
        /// What is wrong, and what would be right.
        problem: String,
    },
}

/// Settings, and where they are kept.
#[derive(Debug)]
pub(crate) struct Store {
    /// What is in use.
    pub(crate) settings: Settings,
    /// `None`: they are not kept.
    file: Option<PathBuf>,
    /// What the file has.
    kept: Option<Settings>,
}

/// The file where this platform keeps settings; `None` if it has no place for them.
pub(crate) fn usual_file() -> Option<PathBuf> {
    let folders = directories::ProjectDirs::from("", "", "starball")?;
    Some(folders.config_dir().join("settings.ron"))
}

impl Store {
    /// Reads the settings of a file. Whatever is wrong with it is logged in a line, and the settings are the usual ones: a
    /// file that is not there is a new player's, one that means nothing is put aside, one that cannot be read is let be.
    pub(crate) fn open(file: Option<PathBuf>) -> Self {
        let unkept = || Self { settings: Settings::default(), file: None, kept: None };
        let Some(file) = file else { return unkept() };
        match read(&file) {
            Ok(kept) => Self { settings: kept.clone().unwrap_or_default(), file: Some(file), kept },
            Err(error @ StoreError::Bad { .. }) => match put_aside(&file) {
                Ok(aside) => {
                    tracing::warn!("{error}; the usual settings are used, the file is {} now", aside.display());
                    Self { file: Some(file), ..unkept() }
                }
                Err(_) => {
                    tracing::warn!("{error}; the usual settings are used, and none are kept");
                    unkept()
                }
            },
            Err(error @ StoreError::Io { .. }) => {
                tracing::warn!("{error}; the usual settings are used, and none are kept");
                unkept()
            }
        }
    }

    /// Writes the settings, if the file has others. If it cannot be written, that is logged once, and not tried again.
    pub(crate) fn save(&mut self) {
        let Some(file) = self.file.as_ref().filter(|_| self.kept.as_ref() != Some(&self.settings)) else { return };
        match write(file, &self.settings) {
            Ok(()) => self.kept = Some(self.settings.clone()),
            Err(error) => {
                tracing::warn!("{error}; the settings are not kept");
                self.file = None;
            }
        }
    }
}

/// The settings in a file; `None` if there is no file.
fn read(file: &Path) -> Result<Option<Settings>, StoreError> {
    let mut bytes = Vec::new();
    let opened = fs::File::open(file).and_then(|opened| opened.take(MOST_BYTES + 1).read_to_end(&mut bytes));
    match opened {
        Ok(_) => {}
        Err(error) if error.kind() == io::ErrorKind::NotFound => return Ok(None),
        Err(error) => return Err(StoreError::Io { file: file.to_owned(), error }),
    }
    let bad = |line, problem| StoreError::Bad { file: file.to_owned(), line, problem };
    if bytes.len() as u64 > MOST_BYTES {
        return Err(bad(0, format!("more than the {MOST_BYTES} bytes that settings may have")));
    }
    let text = String::from_utf8(bytes).map_err(|_| bad(0, "no text; UTF-8 would be right".to_owned()))?;
    match ron::from_str(&text) {
        Ok(settings) => Ok(Some(settings)),
        Err(error) => Err(bad(error.span.start.line, error.code.to_string())),
    }
}

/// Renames a file that means nothing, so that it can be mended; an older one of that name is replaced.
fn put_aside(file: &Path) -> io::Result<PathBuf> {
    let mut aside = file.as_os_str().to_owned();
    aside.push(".bad");
    let aside = PathBuf::from(aside);
    fs::rename(file, &aside).map(|()| aside)
}

/// Writes a file beside it first, so that whatever happens meanwhile, one of the two is whole.
fn write(file: &Path, settings: &Settings) -> Result<(), StoreError> {
    let failed = |error| StoreError::Io { file: file.to_owned(), error };
    let pretty = PrettyConfig::new().compact_arrays(true).struct_names(false);
    let body = ron::ser::to_string_pretty(settings, pretty).map_err(|error| failed(io::Error::other(error)))?;
    // Who keeps the file elsewhere and a link here, keeps the link.
    let target = fs::canonicalize(file).unwrap_or_else(|_| file.to_owned());
    if let Some(folder) = target.parent() {
        fs::create_dir_all(folder).map_err(failed)?;
    }
    let mut beside = target.as_os_str().to_owned();
    beside.push(format!(".{}.new", std::process::id()));
    let beside = PathBuf::from(beside);
    let written = fs::File::create(&beside).and_then(|mut new| {
        new.write_all(HEADING.as_bytes())?;
        new.write_all(body.as_bytes())?;
        new.write_all(b"\n")?;
        // Some file systems would otherwise rename first and write later.
        new.sync_all()
    });
    written.and_then(|()| fs::rename(&beside, &target)).map_err(|error| {
        let _ = fs::remove_file(&beside);
        failed(error)
    })
}

#[cfg(test)]
mod tests;
