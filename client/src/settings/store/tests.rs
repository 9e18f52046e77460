//! What becomes of settings on a disk.

use macroquad::input::KeyCode;

use super::*;
use crate::settings::Control;
use crate::settings::keys::Key;

/// A folder of its own, which goes with the test.
struct Folder(PathBuf);

impl Folder {
    fn new(name: &str) -> Self {
        let folder = std::env::temp_dir().join(format!("starball-settings-{}-{name}", std::process::id()));
        fs::create_dir_all(&folder).unwrap();
        Self(folder)
    }

    fn file(&self) -> PathBuf {
        self.0.join("settings.ron")
    }

    fn names(&self) -> Vec<String> {
        let entries = fs::read_dir(&self.0).unwrap();
        let mut names: Vec<_> = entries.map(|entry| entry.unwrap().file_name().into_string().unwrap()).collect();
        names.sort();
        names
    }
}

impl Drop for Folder {
    fn drop(&mut self) {
        let _ = fs::remove_dir_all(&self.0);
    }
}

fn other() -> Settings {
    let mut settings = Settings {
        name: "Zoë \"Z\"".to_owned(),
        volume: 35,
        full_screen: true,
        window: (1600, 900),
        reduced_flashing: true,
        marked_lights: true,
        text_scale: 1.3,
        ..Settings::default()
    };
    settings.keys.rebind(Control::Plunger, vec![Key::of(KeyCode::RightControl).unwrap()]).unwrap();
    settings.keys.rebind(Control::NudgeLeft, Vec::new()).unwrap();
    settings
}

#[test]
fn what_is_written_is_read() {
    let folder = Folder::new("round");
    for settings in [Settings::default(), other()] {
        let mut store = Store::open(Some(folder.file()));
        store.settings = settings.clone();
        store.save();
        assert_eq!(Store::open(Some(folder.file())).settings, settings);
        assert_eq!(folder.names(), ["settings.ron"]);
    }
}

#[test]
fn a_folder_that_is_missing_is_made_and_a_file_is_written_only_to_change_it() {
    let folder = Folder::new("new");
    let file = folder.0.join("a").join("b").join("settings.ron");
    let mut store = Store::open(Some(file.clone()));
    assert!(!file.exists());
    store.save();
    fs::write(&file, "(volume: 1)").unwrap();
    store.save();
    assert_eq!(fs::read_to_string(&file).unwrap(), "(volume: 1)");
    store.settings.volume = 2;
    store.save();
    assert_eq!(read(&file).unwrap().unwrap().volume, 2);
}

#[test]
fn a_bad_file_is_named_with_its_line_and_put_aside() {
    let folder = Folder::new("bad");
    for (text, line, part) in [
        ("(\n    volume: loud,\n)", 2, "integer"),
        ("(\n    volume: 5,\n", 2, "end of"),
        ("(\n    keys: (\n        plunger: [\"Spacebar\"],\n    ),\n)", 3, "such as \"LeftShift\""),
        ("(\n    keys: (plunger: [\"Z\"]),\n)", 2, "Z is already a key of LEFT FLIPPER"),
        ("(\n    text_scale: \"large\",\n)", 2, "float"),
        ("(\n\n    name: \"\u{7}\",\n)", 3, "control"),
        ("nonsense", 1, "Settings"),
        ("", 1, "opening"),
    ] {
        fs::write(folder.file(), text).unwrap();
        let error = read(&folder.file()).unwrap_err().to_string();
        assert!(error.starts_with(&format!("{}:{line}: ", folder.file().display())), "{text:?}: {error}");
        assert!(error.contains(part), "{text:?}: {error}");
        let mut store = Store::open(Some(folder.file()));
        assert_eq!(
            (&store.settings, folder.names().as_slice()),
            (&Settings::default(), &["settings.ron.bad".to_owned()][..])
        );
        store.save();
        assert_eq!(fs::read_to_string(folder.0.join("settings.ron.bad")).unwrap(), text);
        assert_eq!(read(&folder.file()).unwrap(), Some(Settings::default()));
    }
}

#[test]
fn neither_bytes_nor_great_lengths_are_settings() {
    let folder = Folder::new("bytes");
    for bytes in [vec![0xff, 0xfe, 0], vec![b' '; 70_000]] {
        fs::write(folder.file(), bytes).unwrap();
        assert!(matches!(read(&folder.file()), Err(StoreError::Bad { line: 0, .. })));
    }
}

#[test]
fn where_nothing_can_be_read_or_written_the_game_goes_on() {
    let folder = Folder::new("stuck");
    // A folder in the place of the file, a file in the place of the folder.
    fs::create_dir(folder.file()).unwrap();
    fs::write(folder.0.join("file"), "x").unwrap();
    for file in [folder.file(), folder.0.join("file").join("settings.ron")] {
        let mut store = Store::open(Some(file));
        assert_eq!(store.settings, Settings::default());
        store.settings.volume = 1;
        store.save();
        store.save();
    }
    assert_eq!(folder.names(), ["file", "settings.ron"]);
    Store::open(None).save();
}

#[test]
fn a_write_that_fails_leaves_the_file_as_it_was() {
    let folder = Folder::new("atomic");
    fs::write(folder.file(), "(volume: 9)").unwrap();
    // What is written beside it cannot be: there is a folder of that name.
    let beside = folder.0.canonicalize().unwrap().join(format!("settings.ron.{}.new", std::process::id()));
    fs::create_dir(&beside).unwrap();
    assert!(write(&folder.file(), &other()).is_err());
    assert_eq!(fs::read_to_string(folder.file()).unwrap(), "(volume: 9)");
}

#[cfg(unix)]
#[test]
fn a_link_stays_one() {
    let folder = Folder::new("link");
    let real = folder.0.join("real.ron");
    fs::write(&real, "()").unwrap();
    std::os::unix::fs::symlink(&real, folder.file()).unwrap();
    write(&folder.file(), &other()).unwrap();
    assert!(fs::symlink_metadata(folder.file()).unwrap().is_symlink());
    assert_eq!(read(&real).unwrap(), Some(other()));
}
