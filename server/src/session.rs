//! Which message is legal in which state of a session: one table. Anything else ends the session with a reason.

use shared::protocol::{ClientMessage, Mode};

/// What a client is to the room.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum SessionState {
    /// It watches.
    Watching,
    /// It watches and waits for a place.
    InLine,
    /// It has that place.
    Seated(u8),
}

/// The table.
///
/// | message | watching | in line | seated |
/// |---|---|---|---|
/// | `Act` with a control | only if it had a place | only if it had a place | yes |
/// | `Act` with anything else | no | no | no |
/// | `Vote`, where the crowd plays | yes | yes | yes, without effect |
/// | `Vote`, elsewhere | no | no | no |
/// | `Pause`, where the host allows it | only if it had a place | only if it had a place | yes |
/// | `Pause`, elsewhere | no | no | no |
/// | `Stream` that there is | yes | yes | yes |
/// | `Play`, `Leave`, `Ping`, `Differs` | yes | yes | yes |
///
/// A client that had a place may not have heard yet that it lost it: its controls and pauses are legal and have no effect.
pub fn is_legal(mode: Mode, can_pause: bool, state: SessionState, had_place: bool, message: &ClientMessage) -> bool {
    let had_place = had_place || matches!(state, SessionState::Seated(_));
    match message {
        ClientMessage::Act { action, .. } => had_place && action.is_control(),
        ClientMessage::Pause(_) => had_place && can_pause,
        ClientMessage::Vote { .. } => mode == Mode::Crowd,
        ClientMessage::Stream(stream) => stream.check().is_ok(),
        ClientMessage::Play | ClientMessage::Leave | ClientMessage::Ping { .. } | ClientMessage::Differs { .. } => true,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use shared::game::Action;
    use shared::protocol::{Form, Stream};

    const STATES: [SessionState; 3] = [SessionState::Watching, SessionState::InLine, SessionState::Seated(0)];

    fn legal(mode: Mode, had_place: bool, message: &ClientMessage) -> [bool; 3] {
        STATES.map(|state| is_legal(mode, false, state, had_place, message))
    }

    #[test]
    fn the_table_holds() {
        let flip = ClientMessage::Act { tick: 0, action: Action::Flipper { right: false, pressed: true } };
        let sit = ClientMessage::Act { tick: 0, action: Action::Sit };
        let vote = ClientMessage::Vote { action: 0 };
        let stream = |hz| ClientMessage::Stream(Stream { form: Form::Inputs, hz });
        assert_eq!(legal(Mode::Challenge, false, &flip), [false, false, true]);
        assert_eq!(legal(Mode::Challenge, true, &flip), [true; 3]);
        assert_eq!(legal(Mode::Challenge, true, &sit), [false; 3]);
        assert_eq!(legal(Mode::Crowd, false, &vote), [true; 3]);
        assert_eq!(legal(Mode::Challenge, false, &vote), [false; 3]);
        assert_eq!(legal(Mode::HeadToHead, false, &vote), [false; 3]);
        assert_eq!(legal(Mode::Challenge, false, &stream(60)), [true; 3]);
        assert_eq!(legal(Mode::Challenge, false, &stream(61)), [false; 3]);
        for pause in [true, false] {
            let pause = ClientMessage::Pause(pause);
            let allowed = |had| STATES.map(|state| is_legal(Mode::Challenge, true, state, had, &pause));
            assert_eq!((allowed(false), allowed(true)), ([false, false, true], [true; 3]));
            assert_eq!(legal(Mode::Challenge, true, &pause), [false; 3]);
        }
        let others = [
            ClientMessage::Play,
            ClientMessage::Leave,
            ClientMessage::Ping { nonce: 1 },
            ClientMessage::Differs { tick: 1, digest: 1 },
        ];
        for message in others {
            assert_eq!(legal(Mode::Crowd, false, &message), [true; 3]);
        }
    }
}
