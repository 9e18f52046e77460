//! Why a session ends.

use shared::physics::PHYSICS_VERSION;
use shared::protocol::FollowError;
use shared::table::TableError;
use thiserror::Error;

/// Why a session ended. For a person to read.
#[derive(Debug, Error)]
pub(crate) enum SessionError {
    /// The server's table cannot be read.
    #[error("the server's table cannot be read: {0}")]
    Table(#[from] TableError),
    /// The table is not what its digest says.
    #[error("the server's table does not have the digest that the server says")]
    Digest,
    /// The table asks for an accuracy, and the server has not said what that means.
    #[error(
        "the server's table still asks for an accuracy; a server resolves that into a motion model and a tick rate"
    )]
    Unresolved,
    /// The server would compute other trajectories.
    #[error("the server runs physics version {theirs}, this game {PHYSICS_VERSION}: use the same release on both")]
    Physics { theirs: u32 },
    /// A stream that fits no game on this table.
    #[error(transparent)]
    Follow(#[from] FollowError),
    /// The server says goodbye.
    #[error("the server says goodbye: {0}")]
    Bye(String),
    /// A second welcome, or a refusal after the welcome.
    #[error("the server greets twice")]
    Greeting,
}

impl SessionError {
    /// In as many words as a banner has room for.
    pub(crate) fn headline(&self) -> &str {
        match self {
            Self::Table(_) | Self::Digest | Self::Unresolved => "UNREADABLE TABLE",
            Self::Physics { .. } => "ANOTHER RELEASE THERE",
            Self::Follow(_) | Self::Greeting => "GARBLED MESSAGES",
            Self::Bye(reason) => reason,
        }
    }
}
