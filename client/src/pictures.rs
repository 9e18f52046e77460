//! Pictures of the window that the player takes. The frame only copies its pixels; they are packed and written on a thread.

use std::fs::OpenOptions;
use std::io;
use std::path::{Path, PathBuf};
use std::thread::JoinHandle;

use image::{ColorType, ImageError, ImageFormat};
use macroquad::texture::{Image, get_screen_data};
use thiserror::Error;

/// Seconds for which the screen says where a picture is.
const SAID: f64 = 4.0;
/// Pictures that a folder may have of this game.
const MOST: u32 = 99_999;

/// Pictures that are being saved, and where the last one went.
#[derive(Debug)]
pub(crate) struct Pictures {
    folder: Option<PathBuf>,
    saving: Option<JoinHandle<Result<PathBuf, PictureError>>>,
    /// What there is to say, and until when.
    word: Option<(String, f64)>,
}

impl Pictures {
    /// Pictures go where this system has them; where it has no such place, beside the settings.
    pub(crate) fn new(settings: Option<&Path>) -> Self {
        let users = directories::UserDirs::new();
        let pictures =
            users.as_ref().and_then(directories::UserDirs::picture_dir).map(|folder| folder.join("Starball"));
        let folder = pictures.or_else(|| settings.and_then(Path::parent).map(Path::to_owned));
        Self { folder, saving: None, word: None }
    }

    /// Takes a picture of what is on the screen.
    pub(crate) fn take(&mut self, now: f64) {
        if self.saving.as_ref().is_some_and(|saving| !saving.is_finished()) {
            // As fast as a key repeats is faster than a disk.
            return;
        }
        let word = match self.folder.as_deref().map(reserve) {
            Some(Ok(file)) => {
                tracing::info!("a picture goes to {}", file.display());
                let picture = get_screen_data();
                self.saving = Some(std::thread::spawn(move || save(picture, &file).map(|()| file)));
                "SAVING A PICTURE".to_owned()
            }
            Some(Err(error)) => {
                tracing::warn!("no picture: {error}");
                "NO PICTURE: CANNOT WRITE".to_owned()
            }
            None => "NO PICTURE: NO PLACE FOR IT".to_owned(),
        };
        self.word = Some((word, now + SAID));
    }

    /// What the screen is to say of it.
    pub(crate) fn word(&mut self, now: f64) -> Option<&str> {
        if self.saving.as_ref().is_some_and(JoinHandle::is_finished) {
            self.word = self.finish().map(|word| (word, now + SAID));
        }
        self.word.as_ref().filter(|(_, until)| now < *until).map(|(word, _)| word.as_str())
    }

    /// Waits for what is being saved, and says what became of it.
    pub(crate) fn finish(&mut self) -> Option<String> {
        match self.saving.take()?.join() {
            Ok(Ok(file)) => Some(format!("SAVED {}", last_parts(&file))),
            Ok(Err(error)) => {
                tracing::warn!("no picture: {error}");
                Some("NO PICTURE: CANNOT WRITE".to_owned())
            }
            // It has said on the terminal what went wrong.
            Err(_) => None,
        }
    }
}

/// Why a picture is not there.
#[derive(Debug, Error)]
#[error("cannot write {file}: {error}; a folder with room that can be written to would be right")]
pub(crate) struct PictureError {
    file: String,
    error: ImageError,
}

/// Writes a picture of the screen, whose rows are from the lowest to the highest.
///
/// # Errors
/// If there is no room, or it may not be written.
pub(crate) fn save(mut picture: Image, file: &Path) -> Result<(), PictureError> {
    // The window's alpha means nothing, but a viewer would take it for transparency.
    picture.bytes.iter_mut().skip(3).step_by(4).for_each(|alpha| *alpha = u8::MAX);
    let (width, height) = (u32::from(picture.width), u32::from(picture.height));
    let rows: Vec<u8> = picture.bytes.chunks_exact(4 * width as usize).rev().flatten().copied().collect();
    image::save_buffer_with_format(file, &rows, width, height, ColorType::Rgba8, ImageFormat::Png).map_err(|error| {
        // Half a picture is none.
        let _ = std::fs::remove_file(file);
        PictureError { file: file.display().to_string(), error }
    })
}

/// An empty file of a name that no other one has, for a picture in a folder.
fn reserve(folder: &Path) -> io::Result<PathBuf> {
    let says_where = |error: io::Error| io::Error::new(error.kind(), format!("{}: {error}", folder.display()));
    std::fs::create_dir_all(folder).map_err(says_where)?;
    for number in 1..=MOST {
        let file = folder.join(format!("starball-{number:03}.png"));
        match OpenOptions::new().write(true).create_new(true).open(&file) {
            Ok(_) => return Ok(file),
            Err(error) if error.kind() == io::ErrorKind::AlreadyExists => {}
            Err(error) => return Err(says_where(error)),
        }
    }
    Err(says_where(io::Error::other("it is full of them")))
}

/// Folder and name, as a display has room for.
fn last_parts(file: &Path) -> String {
    let name =
        |path: Option<&std::ffi::OsStr>| path.map_or_else(String::new, |part| part.to_string_lossy().to_uppercase());
    format!("{}/{}", name(file.parent().and_then(Path::file_name)), name(file.file_name()))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_picture_has_a_name_of_its_own() {
        let folder = std::env::temp_dir().join(format!("starball-pictures-{}", std::process::id()));
        let names: Vec<_> = (0..3).map(|_| reserve(&folder).unwrap()).collect();
        assert_eq!(names[2], folder.join("starball-003.png"));
        std::fs::remove_file(&names[1]).unwrap();
        assert_eq!(reserve(&folder).unwrap(), names[1]);
        assert!(reserve(&names[0]).unwrap_err().to_string().contains("starball-001.png"));
        assert_eq!(last_parts(Path::new("/home/ann/Pictures/Starball/starball-001.png")), "STARBALL/STARBALL-001.PNG");
        std::fs::remove_dir_all(&folder).unwrap();
    }

    #[test]
    fn a_picture_is_a_png_without_transparency() {
        let file = std::env::temp_dir().join(format!("starball-picture-{}.png", std::process::id()));
        let picture = || Image { bytes: vec![10, 20, 30, 0, 40, 50, 60, 0], width: 1, height: 2 };
        save(picture(), &file).unwrap();
        let bytes = std::fs::read(&file).unwrap();
        std::fs::remove_file(&file).unwrap();
        let read = Image::from_file_with_format(&bytes, None).unwrap();
        assert_eq!(read.bytes, [40, 50, 60, 255, 10, 20, 30, 255], "the screen's lowest row comes first");
        let problem = save(picture(), Path::new("/no/such/folder/x.png")).unwrap_err().to_string();
        assert!(problem.starts_with("cannot write /no/such/folder/x.png: "), "{problem}");
    }
}
