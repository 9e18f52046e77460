//! The lobby: who is connected, who has which place, who is next in line, who stays after a game. It decides; the room
//! turns its decisions into inputs of the game.

mod told;

use std::collections::{BTreeMap, BTreeSet, VecDeque};
use std::sync::Arc;

use shared::game::{Action, SEATS};
use shared::protocol::{MOST_IN_LINE, Mode, Roster};

use crate::chatter::Chatter;
use crate::session::SessionState;

/// A connected client.
#[derive(Debug)]
struct Client {
    name: String,
    state: SessionState,
    /// It has, or had, a place.
    had_place: bool,
    /// The place in the line that it was told.
    told: Option<u16>,
}

/// Who has a place.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Sitter {
    /// The bot.
    Bot,
    /// A client.
    Client(u32),
}

/// What the lobby needs to know of the room's games.
#[derive(Debug, Clone, Copy)]
pub(crate) struct GameView {
    /// Somebody can still join: no game, or one that stands at its start.
    pub(crate) is_at_start: bool,
    /// A game is being played.
    pub(crate) is_playing: bool,
}

/// How much of the roster changed since it was sent.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) enum News {
    /// Nothing.
    #[default]
    None,
    /// How many watch, or who waits.
    Count,
    /// Who plays.
    Names,
}

/// Who is connected, who sits where, who is next.
#[derive(Debug)]
pub(crate) struct Lobby {
    mode: Mode,
    /// Of all places, so many are used.
    count: usize,
    /// The bot plays against whoever is alone, where each has a board.
    has_opponent: bool,
    clients: BTreeMap<u32, Client>,
    /// Who has not been told yet what they are.
    untold: BTreeSet<u32>,
    places: [Option<Sitter>; SEATS],
    line: VecDeque<u32>,
    /// Somebody in it may not know their place any more.
    line_moved: bool,
    /// Up to here whoever stands far back was told.
    told_to: usize,
    /// Who won the last game and stayed: the client, and how often in a row.
    champion: Option<(u32, u32)>,
    news: News,
    chatter: Arc<Chatter>,
}

/// Something the game has to be told: a place and what its player does.
pub(crate) type Deed = (u8, Action);

impl Lobby {
    /// With nobody in it.
    pub(crate) fn new(mode: Mode, places: usize, has_bot: bool, chatter: Arc<Chatter>) -> Self {
        Self {
            mode,
            count: places.clamp(1, SEATS),
            has_opponent: has_bot && mode == Mode::HeadToHead && places > 1,
            clients: BTreeMap::new(),
            untold: BTreeSet::new(),
            places: [None; SEATS],
            line: VecDeque::new(),
            line_moved: false,
            told_to: 0,
            champion: None,
            news: News::None,
            chatter,
        }
    }

    /// A client came in; it watches until it asks for more.
    pub(crate) fn add(&mut self, id: u32, name: String) {
        let state = SessionState::Watching;
        self.clients.insert(id, Client { name, state, had_place: false, told: None });
        self.untold.insert(id);
        self.note(News::Count);
    }

    /// What a client is, and whether it has or had a place; `None` if it is gone.
    pub(crate) fn state(&self, id: u32) -> Option<(SessionState, bool)> {
        self.clients.get(&id).map(|client| (client.state, client.had_place))
    }

    /// A client asks for a place, or for the next game.
    pub(crate) fn play(&mut self, id: u32, game: GameView) -> Vec<Deed> {
        match self.state(id) {
            Some((SessionState::Seated(place), _)) if !game.is_playing => self.start(place),
            Some((SessionState::Watching, _)) => {
                self.line.push_back(id);
                tracing::debug!(client = id, "gets in line");
                self.set_state(id, SessionState::InLine);
                self.fill_places(game)
            }
            _ => Vec::new(),
        }
    }

    /// Begins the next game: on one board for everybody there, else on the board of each.
    fn start(&mut self, place: u8) -> Vec<Deed> {
        if self.mode != Mode::HeadToHead {
            return vec![(place, Action::Start)];
        }
        let mut deeds = Vec::new();
        let taken = self.places.iter().flatten().count();
        if taken == 1 && self.has_opponent {
            deeds.extend(self.seat_bot());
        }
        let places = (0..SEATS as u8).filter(|&place| self.places[usize::from(place)].is_some());
        deeds.extend(places.map(|place| (place, Action::Start)));
        deeds
    }

    /// The next game, begun by the room because nobody else does; nothing if nobody is there.
    pub(crate) fn start_for_all(&mut self) -> Vec<Deed> {
        match self.places.iter().position(Option::is_some) {
            Some(place) => self.start(place as u8),
            None => Vec::new(),
        }
    }

    /// A client gives its place, or its place in the line, back.
    pub(crate) fn leave(&mut self, id: u32, game: GameView) -> Vec<Deed> {
        let Some((state, _)) = self.state(id) else { return Vec::new() };
        self.line.retain(|&waiting| waiting != id);
        self.set_state(id, SessionState::Watching);
        // Whoever asks is told, even if nothing changed.
        self.untold.insert(id);
        match state {
            SessionState::Seated(place) => {
                let mut deeds = vec![self.vacate(place)];
                deeds.extend(self.fill_places(game));
                deeds
            }
            SessionState::InLine => {
                self.line_moved = true;
                Vec::new()
            }
            SessionState::Watching => Vec::new(),
        }
    }

    fn vacate(&mut self, place: u8) -> Deed {
        if self.chatter.may_speak() {
            tracing::info!("{} leaves place {}", self.name_of(place), place + 1);
        }
        let sitter = self.places[usize::from(place)].take();
        if let (Some(Sitter::Client(id)), Some((champion, _))) = (sitter, self.champion)
            && id == champion
        {
            self.champion = None;
        }
        self.note(News::Names);
        (place, Action::Stand)
    }

    /// A client is gone.
    pub(crate) fn remove(&mut self, id: u32, game: GameView) -> Vec<Deed> {
        let deeds = self.leave(id, game);
        if self.clients.remove(&id).is_some() {
            self.untold.remove(&id);
            self.note(News::Count);
        }
        deeds
    }

    /// Seats who is next in line, as far as the game lets anybody in.
    pub(crate) fn fill_places(&mut self, game: GameView) -> Vec<Deed> {
        let mut deeds = Vec::new();
        while let Some(&next) = self.line.front() {
            // Against nobody but the bot, or nobody at all, a person begins at once.
            let alone = !self.has_people();
            if !alone && !game.is_at_start {
                break;
            }
            // Whoever comes second takes the bot's place.
            let is_full = self.free_place().is_none();
            if alone || is_full {
                deeds.extend(self.send_bot_away());
            }
            let Some(place) = self.free_place() else { break };
            self.line.pop_front();
            self.places[usize::from(place)] = Some(Sitter::Client(next));
            if self.chatter.may_speak() {
                tracing::info!("{} takes place {}", self.name_of(place), place + 1);
            }
            self.set_state(next, SessionState::Seated(place));
            self.line_moved = true;
            deeds.push((place, Action::Sit));
            if alone {
                deeds.extend(self.start(place));
            }
        }
        deeds
    }

    fn free_place(&self) -> Option<u8> {
        self.places[..self.count].iter().position(Option::is_none).map(|place| place as u8)
    }

    /// A game is over, with these points of those who played it and are still there. Who won against others stays; of the rest
    /// as many as wait make room: the bot first, then those with the fewest points. Whoever played alone makes room too.
    pub(crate) fn make_room(&mut self, scores: &[(u8, u64)], winner: Option<u8>) -> Vec<Deed> {
        self.crown(winner);
        let free = self.places[..self.count].iter().filter(|place| place.is_none()).count();
        let needed = self.line.len().saturating_sub(free);
        let is_bot = |place: u8| self.sitter(place) == Some(Sitter::Bot);
        let mut leaving: Vec<(u8, u64)> = scores.to_vec();
        leaving.retain(|&(place, _)| self.sitter(place).is_some() && (Some(place) != winner || is_bot(place)));
        leaving.sort_by_key(|&(place, points)| (!is_bot(place), points, u8::MAX - place));
        let mut deeds = Vec::new();
        for (place, _) in leaving.into_iter().take(needed) {
            if let Some(Sitter::Client(id)) = self.sitter(place) {
                self.set_state(id, SessionState::Watching);
            }
            deeds.push(self.vacate(place));
        }
        deeds
    }

    fn crown(&mut self, winner: Option<u8>) {
        let Some(Sitter::Client(id)) = winner.and_then(|place| self.places[usize::from(place)]) else {
            self.champion = None;
            return self.note(News::Names);
        };
        let before = self.champion.filter(|&(champion, _)| champion == id).map_or(0, |(_, wins)| wins);
        self.champion = Some((id, before + 1));
        self.note(News::Names);
    }

    /// The bot takes the first place, if nobody else wants one.
    pub(crate) fn attract(&mut self) -> Vec<Deed> {
        if self.places.iter().any(Option::is_some) || !self.line.is_empty() {
            return Vec::new();
        }
        let mut deeds = self.seat_bot();
        deeds.extend(self.start_for_all());
        deeds
    }

    /// The bot takes a place.
    fn seat_bot(&mut self) -> Vec<Deed> {
        let Some(place) = self.free_place() else { return Vec::new() };
        self.places[usize::from(place)] = Some(Sitter::Bot);
        self.note(News::Names);
        vec![(place, Action::Sit)]
    }

    fn send_bot_away(&mut self) -> Vec<Deed> {
        let bots = (0..SEATS as u8).filter(|&place| self.places[usize::from(place)] == Some(Sitter::Bot));
        let bots: Vec<u8> = bots.collect();
        bots.into_iter().map(|place| self.vacate(place)).collect()
    }

    /// Whether a person has a place.
    pub(crate) fn has_people(&self) -> bool {
        self.places.iter().any(|sitter| matches!(sitter, Some(Sitter::Client(_))))
    }

    /// Whether somebody waits.
    pub(crate) fn has_line(&self) -> bool {
        !self.line.is_empty()
    }

    /// Who has that place.
    pub(crate) fn sitter(&self, place: u8) -> Option<Sitter> {
        self.places.get(usize::from(place)).copied().flatten()
    }

    /// The name of who sits there.
    pub(crate) fn name_of(&self, place: u8) -> &str {
        match self.sitter(place) {
            Some(Sitter::Bot) => "BOT",
            Some(Sitter::Client(id)) => self.clients.get(&id).map_or("?", |client| &client.name),
            None => "nobody",
        }
    }

    /// How many are connected.
    pub(crate) fn len(&self) -> usize {
        self.clients.len()
    }

    /// How much there is to tell everybody.
    pub(crate) fn news(&self) -> News {
        self.news
    }

    /// Who is there. It counts as told.
    pub(crate) fn take_roster(&mut self) -> Roster {
        self.news = News::None;
        let seated = self.places.iter().filter(|sitter| matches!(sitter, Some(Sitter::Client(_)))).count();
        let mut places = <[Option<String>; SEATS]>::default();
        for (place, name) in (0..).zip(&mut places) {
            *name = self.sitter(place).map(|_| self.name_of(place).to_owned());
        }
        let names = self.line.iter().filter_map(|id| self.clients.get(id));
        let count = |count: usize| u32::try_from(count).unwrap_or(u32::MAX);
        let champion = self.champion.and_then(|(id, wins)| {
            let place = self.places.iter().position(|sitter| *sitter == Some(Sitter::Client(id)))?;
            Some((place as u8, wins))
        });
        Roster {
            places,
            line: names.map(|client| client.name.clone()).take(MOST_IN_LINE).collect(),
            waiting: count(self.line.len()),
            spectators: count(self.clients.len().saturating_sub(seated)),
            champion,
        }
    }

    fn set_state(&mut self, id: u32, state: SessionState) {
        if let Some(client) = self.clients.get_mut(&id)
            && client.state != state
        {
            let is_seated = matches!(state, SessionState::Seated(_));
            client.had_place |= is_seated;
            client.state = state;
            self.untold.insert(id);
            self.note(if is_seated { News::Names } else { News::Count });
        }
    }

    fn note(&mut self, news: News) {
        self.news = self.news.max(news);
    }
}

#[cfg(test)]
mod tests;
