//! Films from files: replays, as a server writes them.

use std::path::Path;
use std::sync::Arc;

use shared::game::replay::{MOST_TEXT, Replay};
use shared::table::{SHIPPED, Table};
use starball_server::{load_table, load_text};

use super::Film;

/// Reads a replay for the table of that name or file; without one, for the shipped table that it was recorded on.
///
/// # Errors
/// One line that says what is wrong with which file, and what would be right.
pub(crate) fn read(path: &Path, table: Option<&str>) -> Result<Film, String> {
    let file = path.display();
    let text = load_text(path, MOST_TEXT).map_err(|error| format!("cannot read {file}: {error}"))?;
    let replay = Replay::parse(&file.to_string(), &text).map_err(|error| error.to_string())?;
    let table = match table {
        Some(table) => load_table(table)?,
        None => shipped(&replay).ok_or_else(|| {
            let names: Vec<&str> = SHIPPED.iter().map(|shipped| shipped.name).collect();
            format!(
                "{file} was recorded on table {:?} with digest {:016x}, which is none of those that are shipped ({}): --table \
                 with the file of that table would be right",
                replay.table_name(),
                replay.table_digest(),
                names.join(", ")
            )
        })?,
    };
    Film::of_replay(&replay, table).map_err(|error| format!("{file}: {error}"))
}

/// The shipped table that a replay was recorded on.
fn shipped(replay: &Replay) -> Option<Arc<Table>> {
    let tables = SHIPPED.iter().filter_map(|shipped| load_table(shipped.name).ok());
    let mut tables = tables.filter(|table| table.digest == replay.table_digest());
    tables.next()
}
