//! Tables by name: shipped ones, and files.

use std::io::Read;
use std::path::Path;
use std::sync::Arc;

use shared::table::{MOST_SCENE_TEXT, SHIPPED, Table};

/// The shipped table called `name`, or else the one in the file of that name.
///
/// # Errors
/// One line that says what is wrong, and where in the file.
pub fn load_table(name: &str) -> Result<Arc<Table>, String> {
    let table = match Table::shipped(name) {
        Some(shipped) => shipped,
        None => Table::parse(name, &read(name)?),
    };
    table.map(Arc::new).map_err(|error| error.to_string())
}

fn read(name: &str) -> Result<String, String> {
    let no_table = |error: std::io::Error| {
        let shipped: Vec<_> = SHIPPED.iter().map(|(name, _)| *name).collect();
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

    #[test]
    fn shipped_tables_come_by_name_and_others_by_file() {
        assert_eq!(load_table("classic").map(|table| table.name.clone()), Ok("Classic".to_owned()));
        let file = concat!(env!("CARGO_MANIFEST_DIR"), "/../shared/tables/classic.ron");
        assert_eq!(load_table(file).map(|table| table.name.clone()), Ok("Classic".to_owned()));
        let error = load_table("nowhere").expect_err("there is none");
        assert!(error.contains("no shipped table (classic)") && error.contains("as a file"), "{error}");
    }
}
