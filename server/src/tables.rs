//! Tables by name: shipped ones, and files.

use std::io::Read;
use std::path::Path;
use std::sync::Arc;

use crate::measure;
use shared::table::{MOST_SCENE_TEXT, SHIPPED, Table};

/// The shipped table called `name`, or else the one in the file of that name. What it asks for by `accuracy` is resolved, once
/// and for all who join: the cheapest setting of this machine that keeps it.
///
/// # Errors
/// One line that says what is wrong, and where in the file; or that the accuracy cannot be reached, and what can.
pub fn load_table(name: &str) -> Result<Arc<Table>, String> {
    let table = read_table(name)?;
    let Some(accuracy) = table.accuracy else { return Ok(Arc::new(table)) };
    let (resolved, what) = measure::resolve(&table, &accuracy)?;
    tracing::info!("{}: {what}", table.name);
    Ok(Arc::new(resolved))
}

/// The same as it is written: it may still ask for an accuracy.
///
/// # Errors
/// One line that says what is wrong, and where in the file.
pub fn read_table(name: &str) -> Result<Table, String> {
    let table = match Table::shipped(name) {
        Some(shipped) => shipped,
        None => Table::parse(name, &read(name)?),
    };
    table.map_err(|error| error.to_string())
}

fn read(name: &str) -> Result<String, String> {
    let no_table = |error: std::io::Error| {
        let shipped: Vec<_> = SHIPPED.iter().map(|shipped| shipped.name).collect();
        format!("{name:?} is no shipped table ({}), and as a file: {error}", shipped.join(", "))
    };
    load_text(name.as_ref(), MOST_SCENE_TEXT).map_err(no_table)
}

/// The text in a file, cut one byte after `most`: enough to refuse it, whatever the file is.
///
/// # Errors
/// If the file cannot be read, or is no text.
pub fn load_text(path: &Path, most: usize) -> std::io::Result<String> {
    let mut source = String::new();
    std::fs::File::open(path)?.take(most as u64 + 1).read_to_string(&mut source)?;
    Ok(source)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Whoever joins gets what was chosen here, as part of the table.
    #[test]
    fn a_table_that_asks_for_an_accuracy_is_loaded_with_motion_and_rate() {
        let text = |asked: &str| {
            format!(
                "Scene(gravity: (0.0, -1.0), accuracy: {asked}, balls: [(position: (0.5, 0.5), velocity: (1.0, 2.0))], elements: [
                    Ring(center: (0.5, 0.5), radius: 0.5, restitution: 0.9)])"
            )
        };
        let file = std::env::temp_dir().join(format!("starball-accuracy-{}.ron", std::process::id()));
        let load = |asked| {
            std::fs::write(&file, text(asked)).unwrap_or_else(|error| panic!("{error}"));
            load_table(&file.display().to_string())
        };
        let table = load("(tolerance: 1e-6, horizon: Bounces(3))").unwrap_or_else(|error| panic!("{error}"));
        assert_eq!((table.accuracy, table.has_rules), (None, false));
        assert!(table.source.contains("motion: Exact, tick_hz: "), "{}", table.source);
        let error = load("(tolerance: 1e-15, horizon: Bounces(30))").expect_err("numbers of 53 bits cannot");
        assert!(error.contains("cannot be reached") && error.contains("the best is"), "{error}");
        std::fs::remove_file(file).unwrap_or_else(|error| panic!("{error}"));
    }

    #[test]
    fn shipped_tables_come_by_name_and_others_by_file() {
        assert_eq!(load_table("classic").map(|table| table.name.clone()), Ok("Classic".to_owned()));
        let file = concat!(env!("CARGO_MANIFEST_DIR"), "/../shared/tables/classic.ron");
        assert_eq!(load_table(file).map(|table| table.name.clone()), Ok("Classic".to_owned()));
        let error = load_table("nowhere").expect_err("there is none");
        assert!(error.contains("no shipped table (classic, lighthouse)") && error.contains("as a file"), "{error}");
    }
}
