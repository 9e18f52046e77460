//! Which message is legal in which state of a session: one table. Anything else ends the session with a reason.

use shared::protocol::ClientMessage;

/// What a client is to the room.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum SessionState {
    /// It watches.
    Watching,
    /// It watches and waits for a seat.
    InLine,
    /// It has that seat.
    Seated(u8),
}

/// The table.
///
/// | message | watching | in line | seated |
/// |---|---|---|---|
/// | `Act` with a control | no | no | yes |
/// | `Act` with anything else | no | no | no |
/// | `Play` | yes | yes | yes |
/// | `Leave` | yes | yes | yes |
/// | `Ping` | yes | yes | yes |
pub fn is_legal(state: SessionState, message: &ClientMessage) -> bool {
    match message {
        ClientMessage::Act { action, .. } => matches!(state, SessionState::Seated(_)) && action.is_control(),
        ClientMessage::Play | ClientMessage::Leave | ClientMessage::Ping { .. } => true,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use shared::game::Action;

    #[test]
    fn only_a_seated_client_works_controls_and_nobody_seats_himself() {
        let flip = ClientMessage::Act { tick: 0, action: Action::Flipper { right: false, pressed: true } };
        let sit = ClientMessage::Act { tick: 0, action: Action::Sit };
        let states = [SessionState::Watching, SessionState::InLine, SessionState::Seated(0)];
        assert_eq!(states.map(|state| is_legal(state, &flip)), [false, false, true]);
        assert_eq!(states.map(|state| is_legal(state, &sit)), [false; 3]);
        assert_eq!(states.map(|state| is_legal(state, &ClientMessage::Leave)), [true; 3]);
    }
}
