//! A table that can be chosen.

use std::sync::Arc;

use shared::table::Table;

use crate::view::View;

/// A table that can be chosen.
#[derive(Debug, Clone)]
pub(crate) struct Shelved {
    /// The table.
    pub(crate) table: Arc<Table>,
    /// What it is like, in a line.
    pub(crate) about: String,
    /// What its picture shows.
    pub(crate) view: Arc<View>,
}

impl PartialEq for Shelved {
    /// The digest tells tables apart.
    fn eq(&self, other: &Self) -> bool {
        self.table.digest == other.table.digest
    }
}
