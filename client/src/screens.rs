//! What the screen says in each situation: the line on the display, the keys that work, the banner.

use shared::game::{Game, Phase, Seat};
use shared::physics::ball::Instant;

use crate::moment::Moment;
use crate::session::Session;

/// What the screen says.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub(crate) struct Words {
    /// On the display.
    pub(crate) message: String,
    /// What can be pressed, and what it does.
    pub(crate) keys: Vec<(String, String)>,
    /// Over the playfield, or empty.
    pub(crate) banner: String,
    /// Under the banner, or empty.
    pub(crate) sub_banner: String,
}

/// Name of the server's bot in a roster.
const BOT: &str = "BOT";
/// Seconds for which the title is shown over a game of the bot, and from one showing to the next: in between, its play
/// can be watched.
const TITLE: (f64, f64) = (6.0, 14.0);
/// Seconds for which a blinking line is there, and for which it is not.
const BLINK: (f64, f64) = (0.9, 0.35);

/// Seconds for which each of two lines that take turns is there.
const EACH_LINE: f64 = 1.6;

/// While there is no answer yet.
pub(crate) fn connecting(address: &str) -> Words {
    Words {
        message: "CONNECTING".to_owned(),
        keys: keys(&[("ESC", "QUIT")]),
        banner: "CONNECTING".to_owned(),
        sub_banner: address.to_owned(),
    }
}

/// After the end of a connection, or of an attempt at one.
pub(crate) fn lost(was_live: bool, reason: &str) -> Words {
    Words {
        message: "ENTER: TRY AGAIN".to_owned(),
        keys: keys(&[("ENTER", "TRY AGAIN"), ("ESC", "QUIT")]),
        banner: if was_live { "CONNECTION LOST" } else { "NO CONNECTION" }.to_owned(),
        sub_banner: reason.to_owned(),
    }
}

/// While a game is to be seen.
pub(crate) fn live(session: &Session, now: f64) -> Words {
    let Some(moment) = session.moment() else { return Words { message: "WELCOME".to_owned(), ..connecting("") } };
    let standing = Standing::of(session, &moment);
    let (banner, sub_banner) = standing.banner(now);
    let message = match session.effects().message(now) {
        _ if session.is_silent(now) => "NO SIGNAL".to_owned(),
        // Whatever else there is to say: the buttons are dead.
        _ if has_tilted(moment.game) && standing == Standing::Plunger => "TILT: HOLD SPACE".to_owned(),
        _ if has_tilted(moment.game) => "TILT".to_owned(),
        Some(message) => message.to_owned(),
        None => standing.message(),
    };
    Words { message, keys: standing.keys(session.table().file.cabinet.is_some()), banner, sub_banner }
}

/// How the person at the window stands to the game.
#[derive(Debug, Clone, PartialEq, Eq)]
enum Standing {
    /// Nobody plays, or the bot.
    Attract,
    /// Others play. `can_join`: the game stands at its start, and a seat is free.
    Watching { can_join: bool },
    /// In line, at that place.
    InLine(u16),
    /// Seated; the game is over. `won`: against somebody, with more points.
    Over { won: bool, points: u64 },
    /// It is the person's turn, and the ball waits for the plunger.
    Plunger,
    /// It is the person's turn.
    Turn,
    /// It is that player's turn.
    Waiting(String),
}

impl Standing {
    fn of(session: &Session, moment: &Moment<'_>) -> Self {
        let game = moment.game;
        let names = &session.roster().seats;
        let Some(seat) = session.seat() else {
            if let Some(place) = session.line() {
                return Self::InLine(place);
            }
            if names.iter().flatten().all(|name| name == BOT) {
                return Self::Attract;
            }
            let is_free = names.iter().any(Option::is_none) && session.roster().line.is_empty();
            return Self::Watching { can_join: is_free && game.is_at_start() };
        };
        match game.phase() {
            Phase::Play { seat: turn, .. } if turn == seat => {
                if is_on_plunger(game) {
                    Self::Plunger
                } else {
                    Self::Turn
                }
            }
            Phase::Play { seat: turn, .. } => {
                let name = names.get(usize::from(turn)).cloned().flatten();
                Self::Waiting(name.unwrap_or_else(|| format!("PLAYER {}", turn + 1)))
            }
            Phase::Idle | Phase::Over => {
                let (own, others): (Vec<_>, Vec<_>) =
                    (0..).zip(game.seats()).filter(|(_, other)| other.playing).partition(|(place, _)| *place == seat);
                let points = |seats: Vec<(u8, &Seat)>| seats.iter().map(|(_, seat)| seat.score.points).max();
                let own = points(own);
                let won = points(others).is_some_and(|others| own > Some(others));
                Self::Over { won, points: own.unwrap_or(0) }
            }
        }
    }

    fn message(&self) -> String {
        match self {
            Self::Attract => "PRESS ENTER".to_owned(),
            Self::Watching { can_join: true } => "ENTER: JOIN".to_owned(),
            Self::Watching { can_join: false } => "WATCHING".to_owned(),
            Self::InLine(1) => "YOU ARE NEXT".to_owned(),
            Self::InLine(place) => format!("IN LINE: {place}"),
            Self::Over { won: true, .. } => "YOU WIN".to_owned(),
            Self::Over { won: false, .. } => "GAME OVER".to_owned(),
            Self::Plunger => "HOLD SPACE, LET GO".to_owned(),
            Self::Turn => "SHOOT".to_owned(),
            Self::Waiting(name) => format!("{name} PLAYS"),
        }
    }

    /// `can_nudge`: the table moves when it is nudged.
    fn keys(&self, can_nudge: bool) -> Vec<(String, String)> {
        match self {
            Self::Attract => keys(&[("ENTER", "PLAY"), ("F4", "PHYSICS"), ("F11", "FULL SCREEN"), ("ESC", "QUIT")]),
            Self::Watching { can_join: true } => {
                keys(&[("ENTER", "JOIN THE GAME"), ("F4", "PHYSICS"), ("ESC", "QUIT")])
            }
            Self::Watching { can_join: false } => keys(&[("ENTER", "GET IN LINE"), ("F4", "PHYSICS"), ("ESC", "QUIT")]),
            Self::InLine(_) => keys(&[("ESC", "LEAVE THE LINE")]),
            Self::Over { .. } => keys(&[("ENTER", "PLAY AGAIN"), ("ESC", "LEAVE")]),
            Self::Plunger | Self::Turn => {
                let nudge: &[_] = if can_nudge { &[("Q, W, E", "NUDGE")] } else { &[] };
                let play: &[_] = &[("L SHIFT, Z", "LEFT"), ("R SHIFT, /", "RIGHT"), ("SPACE", "PLUNGER")];
                keys(&[play, nudge, &[("ESC", "LEAVE")]].concat())
            }
            Self::Waiting(_) => keys(&[("ESC", "LEAVE")]),
        }
    }

    fn banner(&self, now: f64) -> (String, String) {
        let blinks = |text: &str| {
            let is_on = now % (BLINK.0 + BLINK.1) < BLINK.0;
            if is_on { text.to_owned() } else { " ".to_owned() }
        };
        match self {
            Self::Attract if now % TITLE.1 < TITLE.0 => ("STARBALL".to_owned(), blinks("PRESS ENTER TO PLAY")),
            Self::Over { won, points } => {
                let turn = now % (2.0 * EACH_LINE) < EACH_LINE;
                let line = if turn { format!("{points} POINTS") } else { "ENTER: PLAY AGAIN".to_owned() };
                (if *won { "YOU WIN" } else { "GAME OVER" }.to_owned(), line)
            }
            _ => Default::default(),
        }
    }
}

/// Whether a game has tilted, and the ball is not lost yet.
fn has_tilted(game: &Game) -> bool {
    game.tilt().tilted && matches!(game.phase(), Phase::Play { serve_in: 0, .. })
}

/// Whether a ball lies where the plunger can launch it.
fn is_on_plunger(game: &Game) -> bool {
    let scene = &game.table().scene;
    let now = Instant::start_of(game.tick());
    game.world().state().balls.iter().any(|ball| {
        let (position, velocity) = ball.at(now, scene.tick_seconds);
        let near = |pull: f64, plunger: &shared::physics::plunger::PlungerSpec| {
            plunger.distance(pull, position) < 2.0 * scene.radius(0)
        };
        let plungers = scene.plungers.iter().zip(&game.world().state().plungers);
        velocity.length() < 0.3 && plungers.into_iter().any(|(spec, state)| near(state.pull, spec))
    })
}

fn keys(keys: &[(&str, &str)]) -> Vec<(String, String)> {
    keys.iter().map(|(key, does)| ((*key).to_owned(), (*does).to_owned())).collect()
}
