//! What single clients have to be told: what they have become, and how the line moves up.

use shared::protocol::{MOST_IN_LINE, ServerMessage};

use super::Lobby;
use crate::session::SessionState;

/// Clients far back in the line that are told at once how far they have moved up: a line of thousands moves for nobody's sake.
pub(super) const TOLD_AT_ONCE: usize = 64;

impl Lobby {
    /// What has to be told to single clients: what they have become. It counts as told.
    pub(crate) fn take_told(&mut self) -> Vec<(u32, ServerMessage)> {
        let mut untold = std::mem::take(&mut self.untold);
        let mut told = Vec::new();
        // Who comes stands at the end.
        let waiting = untold.iter().filter(|&&id| matches!(self.state(id), Some((SessionState::InLine, _)))).count();
        for place in (0..self.line.len()).rev() {
            if told.len() == waiting {
                break;
            }
            if untold.remove(&self.line[place]) {
                told.extend(self.tell_place(place));
            }
        }
        for client in untold {
            let Some(known) = self.clients.get_mut(&client) else { continue };
            known.told = None;
            let place = if let SessionState::Seated(place) = known.state { Some(place) } else { None };
            told.push((client, ServerMessage::You { client, place, line: None }));
        }
        told
    }

    /// What has to be told to those who moved up in the line: to the first of them, whom the roster names, and to some of the
    /// others, who have their turn one after the other. It counts as told.
    pub(crate) fn take_moved(&mut self) -> Vec<(u32, ServerMessage)> {
        let mut told = Vec::new();
        if !std::mem::take(&mut self.line_moved) {
            return told;
        }
        for place in 0..self.line.len().min(MOST_IN_LINE) {
            told.extend(self.tell_place(place));
        }
        let far = self.line.len().saturating_sub(MOST_IN_LINE);
        let most = told.len() + TOLD_AT_ONCE;
        for _ in 0..far {
            self.told_to = (self.told_to + 1) % far;
            told.extend(self.tell_place(MOST_IN_LINE + self.told_to));
            if told.len() == most {
                self.line_moved = true;
                break;
            }
        }
        told
    }

    /// What to tell who stands there in the line, if that is news.
    fn tell_place(&mut self, place: usize) -> Option<(u32, ServerMessage)> {
        let client = *self.line.get(place)?;
        let known = self.clients.get_mut(&client)?;
        let line = Some(u16::try_from(place + 1).unwrap_or(u16::MAX));
        (std::mem::replace(&mut known.told, line) != line)
            .then_some((client, ServerMessage::You { client, place: None, line }))
    }
}
