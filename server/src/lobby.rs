//! The lobby: who is connected, who sits where, who is next in line. It decides; the room turns its decisions into
//! inputs of the game.

use std::collections::{BTreeMap, VecDeque};

use bytes::Bytes;
use shared::game::{Action, SEATS};
use shared::protocol::{MOST_IN_LINE, Roster, ServerMessage};
use tokio::sync::mpsc;

use crate::connection::frame_of;
use crate::session::SessionState;

/// A connected client.
#[derive(Debug)]
struct Client {
    name: String,
    state: SessionState,
    direct: mpsc::Sender<Bytes>,
    /// It has not been told yet who is there and what it is.
    is_stale: bool,
}

/// Who has a seat.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Sitter {
    /// The bot.
    Bot,
    /// A client.
    Client(u32),
}

/// What the lobby needs to know of the game.
#[derive(Debug, Clone, Copy)]
pub(crate) struct GameView {
    /// Somebody can still join: no game, or one that stands at its start.
    pub(crate) is_at_start: bool,
    /// A game is being played.
    pub(crate) is_playing: bool,
}

/// Who is connected, who sits where, who is next.
#[derive(Debug, Default)]
pub(crate) struct Lobby {
    clients: BTreeMap<u32, Client>,
    seats: [Option<Sitter>; SEATS],
    line: VecDeque<u32>,
}

/// Something the game has to be told: a seat and what it does.
pub(crate) type Deed = (u8, Action);

impl Lobby {
    /// A client came in; it watches until it asks for more.
    pub(crate) fn add(&mut self, id: u32, name: String, direct: mpsc::Sender<Bytes>) {
        self.clients.insert(id, Client { name, state: SessionState::Watching, direct, is_stale: true });
        self.note_change();
    }

    /// What a client is; `None` if it is gone.
    pub(crate) fn state(&self, id: u32) -> Option<SessionState> {
        self.clients.get(&id).map(|client| client.state)
    }

    /// A client asks for a seat, or for the next game.
    pub(crate) fn play(&mut self, id: u32, game: GameView) -> Vec<Deed> {
        match self.state(id) {
            Some(SessionState::Seated(seat)) if !game.is_playing => vec![(seat, Action::Start)],
            Some(SessionState::Watching) => {
                self.line.push_back(id);
                tracing::debug!(client = id, "gets in line");
                self.set_state(id, SessionState::InLine);
                self.fill_seats(game)
            }
            _ => Vec::new(),
        }
    }

    /// A client gives its seat or its place in the line back.
    pub(crate) fn leave(&mut self, id: u32, game: GameView) -> Vec<Deed> {
        let Some(state) = self.state(id) else { return Vec::new() };
        self.line.retain(|&waiting| waiting != id);
        self.set_state(id, SessionState::Watching);
        // Whoever asks is told, even if nothing changed.
        self.clients.entry(id).and_modify(|client| client.is_stale = true);
        match state {
            SessionState::Seated(seat) => {
                tracing::info!("{} leaves seat {}", self.name_of(seat), seat + 1);
                self.seats[usize::from(seat)] = None;
                let mut deeds = vec![(seat, Action::Stand)];
                deeds.extend(self.fill_seats(game));
                deeds
            }
            SessionState::Watching | SessionState::InLine => Vec::new(),
        }
    }

    /// A client is gone.
    pub(crate) fn remove(&mut self, id: u32, game: GameView) -> Vec<Deed> {
        let deeds = self.leave(id, game);
        if self.clients.remove(&id).is_some() {
            self.note_change();
        }
        deeds
    }

    /// Seats who is next in line, as far as the game lets anybody in.
    pub(crate) fn fill_seats(&mut self, game: GameView) -> Vec<Deed> {
        let mut deeds = Vec::new();
        while let Some(&next) = self.line.front() {
            // Against nobody but the bot, or nobody at all, a person begins at once.
            let alone = !self.has_people();
            if !alone && !game.is_at_start {
                break;
            }
            if alone {
                deeds.extend(self.send_bot_away());
            }
            let Some(seat) = self.seats.iter().position(Option::is_none) else { break };
            self.line.pop_front();
            self.seats[seat] = Some(Sitter::Client(next));
            tracing::info!("{} takes seat {}", self.name_of(seat as u8), seat + 1);
            self.set_state(next, SessionState::Seated(seat as u8));
            deeds.push((seat as u8, Action::Sit));
            if alone {
                deeds.push((seat as u8, Action::Start));
            }
        }
        deeds
    }

    /// The bot takes the first seat, if nobody else wants one.
    pub(crate) fn seat_bot(&mut self) -> Vec<Deed> {
        if self.seats.iter().any(Option::is_some) || !self.line.is_empty() {
            return Vec::new();
        }
        self.seats[0] = Some(Sitter::Bot);
        self.note_change();
        vec![(0, Action::Sit), (0, Action::Start)]
    }

    fn send_bot_away(&mut self) -> Vec<Deed> {
        let Some(seat) = self.seats.iter().position(|sitter| *sitter == Some(Sitter::Bot)) else {
            return Vec::new();
        };
        self.seats[seat] = None;
        self.note_change();
        vec![(seat as u8, Action::Stand)]
    }

    /// Whether a person has a seat.
    pub(crate) fn has_people(&self) -> bool {
        self.seats.iter().any(|sitter| matches!(sitter, Some(Sitter::Client(_))))
    }

    /// Whether the bot has a seat.
    pub(crate) fn has_bot(&self) -> bool {
        self.seats.contains(&Some(Sitter::Bot))
    }

    /// The name of who sits there.
    pub(crate) fn name_of(&self, seat: u8) -> &str {
        match self.seats.get(usize::from(seat)) {
            Some(Some(Sitter::Bot)) => "BOT",
            Some(Some(Sitter::Client(id))) => self.clients.get(id).map_or("?", |client| &client.name),
            _ => "nobody",
        }
    }

    /// How many are connected.
    pub(crate) fn len(&self) -> usize {
        self.clients.len()
    }

    /// Tells everybody who has not been told yet who is there, and what they are. A client that takes nothing just now
    /// is told the next time.
    pub(crate) fn tell_news(&mut self) {
        if !self.clients.values().any(|client| client.is_stale) {
            return;
        }
        let roster = frame_of(&ServerMessage::Roster(self.roster()));
        for (id, client) in &mut self.clients {
            if !client.is_stale {
                continue;
            }
            let seat = match client.state {
                SessionState::Seated(seat) => Some(seat),
                _ => None,
            };
            let line = self.line.iter().position(|waiting| waiting == id);
            let line = line.map(|place| u16::try_from(place + 1).unwrap_or(u16::MAX));
            let you = frame_of(&ServerMessage::You { seat, line });
            client.is_stale = client.direct.try_send(roster.clone()).is_err() || client.direct.try_send(you).is_err();
        }
    }

    /// Who is there.
    fn roster(&self) -> Roster {
        let seated = self.seats.iter().filter(|sitter| matches!(sitter, Some(Sitter::Client(_)))).count();
        let mut seats = <[Option<String>; SEATS]>::default();
        for (seat, name) in (0..).zip(&mut seats) {
            *name = self.seats[usize::from(seat)].map(|_| self.name_of(seat).to_owned());
        }
        let names = self.line.iter().filter_map(|id| self.clients.get(id));
        Roster {
            seats,
            line: names.map(|client| client.name.clone()).take(MOST_IN_LINE).collect(),
            spectators: u32::try_from(self.clients.len().saturating_sub(seated)).unwrap_or(u32::MAX),
        }
    }

    /// Sends one client a message that it can do without: one that takes nothing just now does not get it.
    pub(crate) fn tell(&self, id: u32, message: &ServerMessage) {
        if let Some(client) = self.clients.get(&id)
            && client.direct.try_send(frame_of(message)).is_err()
        {
            tracing::debug!(client = id, "takes nothing just now");
        }
    }

    /// Sends every client a message, ahead of the frames that all share.
    pub(crate) fn tell_all(&self, message: &ServerMessage) {
        for &id in self.clients.keys() {
            self.tell(id, message);
        }
    }

    fn set_state(&mut self, id: u32, state: SessionState) {
        if let Some(client) = self.clients.get_mut(&id)
            && client.state != state
        {
            client.state = state;
            self.note_change();
        }
    }

    /// Everybody has to be told.
    fn note_change(&mut self) {
        for client in self.clients.values_mut() {
            client.is_stale = true;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const START: GameView = GameView { is_at_start: true, is_playing: false };
    const EARLY: GameView = GameView { is_at_start: true, is_playing: true };
    const LATE: GameView = GameView { is_at_start: false, is_playing: true };

    fn lobby_with(names: &[&str]) -> Lobby {
        let mut lobby = Lobby::default();
        for (id, name) in (0..).zip(names) {
            lobby.add(id, (*name).to_owned(), mpsc::channel(1).0);
        }
        lobby
    }

    #[test]
    fn the_first_person_sends_the_bot_away_and_starts() {
        let mut lobby = lobby_with(&["Ann"]);
        assert_eq!(lobby.seat_bot(), [(0, Action::Sit), (0, Action::Start)]);
        assert_eq!(lobby.play(0, LATE), [(0, Action::Stand), (0, Action::Sit), (0, Action::Start)]);
        assert_eq!(lobby.name_of(0), "Ann");
        assert!(lobby.seat_bot().is_empty());
    }

    #[test]
    fn others_join_at_the_start_up_to_four_and_wait_later() {
        let mut lobby = lobby_with(&["Ann", "Bob", "Cid", "Dan", "Eve"]);
        lobby.play(0, START);
        for seat in 1..SEATS as u8 {
            assert_eq!(lobby.play(u32::from(seat), EARLY), [(seat, Action::Sit)]);
        }
        assert!(lobby.play(4, EARLY).is_empty(), "all seats are taken");
        assert_eq!(lobby.state(4), Some(SessionState::InLine));
        // Bob leaves in mid-game: Eve has to wait for its end.
        assert_eq!(lobby.leave(1, LATE), [(1, Action::Stand)]);
        assert_eq!(lobby.fill_seats(START), [(1, Action::Sit)]);
        assert_eq!(lobby.name_of(1), "Eve");
    }

    #[test]
    fn the_next_in_line_starts_when_everybody_has_left() {
        let mut lobby = lobby_with(&["Ann", "Bob"]);
        lobby.play(0, START);
        lobby.play(1, LATE);
        assert_eq!(lobby.remove(0, LATE), [(0, Action::Stand), (0, Action::Sit), (0, Action::Start)]);
        assert_eq!(lobby.name_of(0), "Bob");
    }

    /// A client in line had a stall, its queue was full, and it never learned that it had been seated.
    #[test]
    fn who_took_nothing_for_a_while_is_told_later() {
        let mut lobby = Lobby::default();
        let (direct, mut frames) = mpsc::channel(2);
        lobby.add(0, "Ann".to_owned(), direct);
        lobby.tell_news();
        lobby.play(0, START);
        lobby.tell_news();
        let told = |frames: &mut mpsc::Receiver<Bytes>| {
            let mut last = None;
            while let Ok(frame) = frames.try_recv() {
                if let Ok(ServerMessage::You { seat, .. }) = shared::protocol::decode(&frame) {
                    last = Some(seat);
                }
            }
            last
        };
        assert_eq!(told(&mut frames), Some(None), "the second news found the queue full");
        lobby.tell_news();
        assert_eq!(told(&mut frames), Some(Some(0)));
        lobby.tell_news();
        assert_eq!(told(&mut frames), None, "nobody is told twice");
    }

    #[test]
    fn whoever_gives_up_a_place_in_line_is_not_seated() {
        let mut lobby = lobby_with(&["Ann", "Bob"]);
        lobby.play(0, START);
        lobby.play(1, LATE);
        assert!(lobby.leave(1, LATE).is_empty());
        assert!(lobby.fill_seats(START).is_empty());
        let roster = lobby.roster();
        assert_eq!((roster.spectators, roster.line.len()), (1, 0));
    }
}
