//! What is mutated: the files in `tests/fuzz/corpus`, and samples that are made anew, so that a change of the messages or of
//! the table leaves something to start from. `cargo test --package starball-tests --test fuzz -- --ignored` writes the samples
//! into the corpus.

use std::path::{Path, PathBuf};

use starball_tests::samples;

const TARGETS: [&str; 4] = ["frame", "message", "replay", "table"];
/// Most bytes of all files.
const MOST_BYTES: usize = 300_000;

fn folder(target: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("fuzz/corpus").join(target)
}

fn files(target: &str) -> Vec<PathBuf> {
    let files = std::fs::read_dir(folder(target)).expect("every target has a corpus");
    let mut paths: Vec<_> = files.map(|file| file.expect("a file").path()).collect();
    // The order in which the system tells them differs.
    paths.sort();
    paths
}

fn samples_of(target: &str) -> Vec<Vec<u8>> {
    let bytes = |texts: Vec<String>| texts.into_iter().map(String::into_bytes).collect();
    match target {
        "frame" => samples::frames(),
        "message" => samples::messages(),
        "table" => bytes(samples::tables()),
        "replay" => bytes(samples::replays()),
        _ => unreachable!("{target} is no target"),
    }
}

/// All that a target starts from, the samples first.
pub(crate) fn of(target: &str) -> Vec<Vec<u8>> {
    let mut corpus = samples_of(target);
    for path in files(target) {
        let bytes = std::fs::read(path).expect("a file of the corpus");
        if !corpus.contains(&bytes) {
            corpus.push(bytes);
        }
    }
    corpus
}

#[test]
fn the_corpus_is_small() {
    let mut bytes = 0;
    for target in TARGETS {
        let files = files(target);
        assert!((10..=60).contains(&files.len()), "{target} has {} files", files.len());
        bytes += files.iter().map(|path| std::fs::metadata(path).expect("a file").len() as usize).sum::<usize>();
    }
    assert!(bytes <= MOST_BYTES, "{bytes} bytes");
}

#[test]
#[ignore = "writes the samples into the corpus: after a change of messages, tables or replays"]
fn write_samples() {
    for target in TARGETS {
        std::fs::create_dir_all(folder(target)).expect("a folder");
        let is_sample = |path: &Path| path.file_name().is_some_and(|name| name.to_string_lossy().starts_with("sample"));
        for old in files(target).iter().filter(|path| is_sample(path)) {
            std::fs::remove_file(old).expect("removed");
        }
        for (number, sample) in samples_of(target).into_iter().enumerate() {
            std::fs::write(folder(target).join(format!("sample{number:02}")), sample).expect("written");
        }
    }
}
