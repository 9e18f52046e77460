//! What the screen says in each situation: the line on the display, the keys that work, the banner.

use shared::game::{Game, Phase};
use shared::physics::ball::Instant;
use shared::protocol::Mode;

use crate::moment::Moment;
use crate::render::grouped;
use crate::session::{Outcome, Session};
use crate::settings::{Bindings, Control};

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
pub(crate) const TITLE: (f64, f64) = (6.0, 14.0);
/// Seconds for which a blinking line is there, and for which it is not.
const BLINK: (f64, f64) = (0.9, 0.35);

/// Seconds for which each of two lines that take turns is there.
const EACH_LINE: f64 = 1.6;

/// How the room is played, and against whom.
pub(crate) fn title(session: &Session) -> String {
    match session.mode() {
        Mode::Challenge => "CHALLENGE".to_owned(),
        Mode::HeadToHead => "HEAD TO HEAD".to_owned(),
        Mode::Crowd => {
            let player = session.contestants().iter().find(|one| one.place.is_some());
            format!("THE CROWD AGAINST {}", player.map_or("ANYONE", |one| &one.name))
        }
    }
}

/// While a game is to be seen.
pub(crate) fn live(session: &Session, bindings: &Bindings, now: f64) -> Words {
    let main = session.main_board();
    let Some(moment) = session.moment(main) else {
        return Words { message: "WELCOME".to_owned(), ..Words::default() };
    };
    if session.is_paused() {
        return paused();
    }
    let standing = Standing::of(session, &moment);
    let (banner, sub_banner) = standing.banner(now);
    let message = match session.effects(main).and_then(|effects| effects.message(now)) {
        _ if session.is_silent(now) => "NO SIGNAL".to_owned(),
        // Whatever else there is to say: the buttons are dead.
        _ if has_tilted(moment.game) && standing == Standing::Plunger => hold_plunger("TILT: HOLD ", bindings, ""),
        _ if has_tilted(moment.game) => "TILT".to_owned(),
        Some(message) => message.to_owned(),
        None => standing.message(bindings),
    };
    let mut keys = standing.keys(bindings, session.table().file.cabinet.is_some());
    if session.can_pause() && session.is_playing() {
        keys.insert(keys.len() - 1, ("P".to_owned(), "PAUSE".to_owned()));
    }
    if session.film().is_some() && (session.place().is_none() || !session.is_playing()) {
        keys.insert(keys.len() - 1, ("R".to_owned(), "LAST GAME AGAIN".to_owned()));
    }
    if session.place().is_none() {
        let more = more_keys(session);
        // What can be done about the game comes first, the way out last.
        let place = keys.len().min(1);
        keys.splice(place..place, more);
    }
    Words { message, keys, banner, sub_banner }
}

/// While the room stands still.
fn paused() -> Words {
    let word = "PAUSED".to_owned();
    Words { message: word.clone(), keys: keys(&[("ESC", "MENU")]), banner: word, sub_banner: String::new() }
}

/// What who has no place can do besides.
fn more_keys(session: &Session) -> Vec<(String, String)> {
    let actions = session.table().rules.crowd.as_ref().map_or(0, |crowd| crowd.actions.len());
    match session.mode() {
        Mode::Crowd if actions > 0 && session.is_playing() => vec![(format!("1 TO {actions}"), "VOTE".to_owned())],
        Mode::HeadToHead if session.board_count() > 1 => keys(&[("TAB", "OTHER TABLE")]),
        _ => Vec::new(),
    }
}

/// How the person at the window stands to the game.
#[derive(Debug, Clone, PartialEq, Eq)]
enum Standing {
    /// Nobody plays, or the bot. `has_title`: nothing is to be done meanwhile, so that the title may hide the table.
    Attract { has_title: bool },
    /// Others play. `can_join`: the game stands at its start, and a place is free.
    Watching { can_join: bool },
    /// In line, at that place.
    InLine(u16),
    /// The game is over. `has_place`: for the person too, who can begin another; else that is their place in the line.
    Over { outcome: Outcome, has_place: bool, line: Option<u16> },
    /// It is the person's turn, and the ball waits for the plunger.
    Plunger,
    /// It is the person's turn.
    Turn,
    /// It is that player's turn, or others play on.
    Waiting(String),
}

impl Standing {
    fn of(session: &Session, moment: &Moment<'_>) -> Self {
        let game = moment.game;
        let names = &session.roster().places;
        let line = session.line();
        let Some(place) = session.place() else {
            let is_attract = is_attract(session);
            if let Some(outcome) = session.outcome().filter(|outcome| !is_attract || outcome.own.is_some()) {
                return Self::Over { outcome, has_place: false, line };
            }
            if let Some(place) = line {
                return Self::InLine(place);
            }
            if is_attract {
                return Self::Attract { has_title: session.mode() != Mode::Crowd || !session.is_playing() };
            }
            let free = names.iter().take(session.places()).any(Option::is_none) && session.roster().line.is_empty();
            let is_open = if session.board_count() > 1 { !session.is_playing() } else { game.is_at_start() };
            return Self::Watching { can_join: free && is_open };
        };
        let (_, seat) = session.board_and_seat(place);
        match game.phase() {
            Phase::Play { seat: turn, .. } if turn == seat => {
                if is_on_plunger(game) {
                    Self::Plunger
                } else {
                    Self::Turn
                }
            }
            Phase::Idle | Phase::Over if !session.is_playing() => {
                let own = session.contestants().iter().find(|one| one.is_you).cloned();
                let nothing = Outcome { winner: None, own, next: None };
                let outcome = session.outcome().unwrap_or(nothing);
                Self::Over { outcome, has_place: true, line }
            }
            _ => {
                let other = session.contestants().iter().find(|one| one.has_turn);
                Self::Waiting(other.map_or_else(String::new, |one| one.name.clone()))
            }
        }
    }

    fn message(&self, bindings: &Bindings) -> String {
        match self {
            Self::Attract { .. } => "PRESS ENTER".to_owned(),
            Self::Watching { can_join: true } => "ENTER: JOIN".to_owned(),
            Self::Watching { can_join: false } => "WATCHING".to_owned(),
            Self::InLine(1) => "YOU ARE NEXT".to_owned(),
            Self::InLine(place) => format!("IN LINE: {place}"),
            Self::Over { outcome, .. } => headline(outcome),
            Self::Plunger => hold_plunger("HOLD ", bindings, ", LET GO"),
            Self::Turn => "SHOOT".to_owned(),
            Self::Waiting(name) if name.is_empty() => "WAIT".to_owned(),
            Self::Waiting(name) => format!("{name} PLAYS"),
        }
    }

    /// `can_nudge`: the table moves when it is nudged.
    fn keys(&self, bindings: &Bindings, can_nudge: bool) -> Vec<(String, String)> {
        match self {
            Self::Attract { .. } => {
                keys(&[("ENTER", "PLAY"), ("F4", "PHYSICS"), ("F11", "FULL SCREEN"), ("ESC", "MENU")])
            }
            Self::Watching { can_join: true } => {
                keys(&[("ENTER", "JOIN THE GAME"), ("F4", "PHYSICS"), ("ESC", "MENU")])
            }
            Self::Watching { can_join: false } => keys(&[("ENTER", "GET IN LINE"), ("F4", "PHYSICS"), ("ESC", "MENU")]),
            Self::InLine(_) => keys(&[("ESC", "MENU")]),
            Self::Over { has_place: true, .. } => keys(&[("ENTER", "PLAY AGAIN"), ("ESC", "MENU")]),
            Self::Over { line: Some(_), .. } => keys(&[("ESC", "MENU")]),
            Self::Over { .. } => keys(&[("ENTER", "GET IN LINE"), ("F4", "PHYSICS"), ("ESC", "MENU")]),
            Self::Plunger | Self::Turn => playing_keys(bindings, can_nudge),
            Self::Waiting(_) => keys(&[("ESC", "MENU")]),
        }
    }

    fn banner(&self, now: f64) -> (String, String) {
        let blinks = |text: &str| {
            let is_on = now % (BLINK.0 + BLINK.1) < BLINK.0;
            if is_on { text.to_owned() } else { " ".to_owned() }
        };
        match self {
            Self::Attract { has_title: true } if now % TITLE.1 < TITLE.0 => {
                ("STARBALL".to_owned(), blinks("PRESS ENTER TO PLAY"))
            }
            Self::Over { outcome, has_place, line } => {
                let lines = result_lines(outcome, *has_place, *line);
                // A cast saturates.
                let turn = (now / EACH_LINE) as usize % lines.len().max(1);
                (headline(outcome), lines.get(turn).cloned().unwrap_or_default())
            }
            _ => Default::default(),
        }
    }
}

/// The keys of whoever has the turn, as they are bound; what has no key is left out.
pub(crate) fn playing_keys(bindings: &Bindings, can_nudge: bool) -> Vec<(String, String)> {
    let first = |controls: &[Control]| {
        let labels = controls.iter().map(|&control| bindings.labels(control, 1));
        labels.filter(|label| !label.is_empty()).collect::<Vec<_>>().join(", ")
    };
    let nudges = [Control::NudgeLeft, Control::NudgeForward, Control::NudgeRight];
    let rows = [
        (bindings.labels(Control::LeftFlipper, 2), "LEFT"),
        (bindings.labels(Control::RightFlipper, 2), "RIGHT"),
        (first(&[Control::Plunger]), "PLUNGER"),
        (if can_nudge { first(&nudges) } else { String::new() }, "NUDGE"),
        ("ESC".to_owned(), "MENU"),
    ];
    let rows = rows.into_iter().filter(|(key, _)| !key.is_empty());
    rows.map(|(key, does)| (key, does.to_owned())).collect()
}

/// What to do with the plunger, around the label of its first key.
fn hold_plunger(before: &str, bindings: &Bindings, after: &str) -> String {
    match bindings.labels(Control::Plunger, 1) {
        label if label.is_empty() => "PULL THE PLUNGER".to_owned(),
        label => format!("{before}{label}{after}"),
    }
}

/// How it ended, in as few words as a banner holds.
fn headline(outcome: &Outcome) -> String {
    match (&outcome.winner, &outcome.own) {
        (Some(winner), _) if winner.is_you && winner.place.is_some() => "YOU WIN".to_owned(),
        (Some(winner), _) if winner.place.is_none() => "THE CROWD WINS".to_owned(),
        (Some(winner), _) => format!("{} WINS", winner.name),
        (None, _) => "GAME OVER".to_owned(),
    }
}

/// What there is to say about the end of a game, line by line: points, who stays, who comes up, what can be done.
fn result_lines(outcome: &Outcome, has_place: bool, line: Option<u16>) -> Vec<String> {
    let mut lines = Vec::new();
    let winner = outcome.winner.as_ref();
    if let Some(winner) = winner {
        lines.push(format!("{} POINTS", grouped(winner.points)));
    }
    if let Some(own) = outcome.own.as_ref().filter(|own| winner.is_none_or(|winner| winner.place != own.place)) {
        lines.push(format!("YOU: {} POINTS", grouped(own.points)));
    }
    if let Some(winner) = winner.filter(|winner| winner.wins > 0) {
        let games = if winner.wins == 1 { "1 WIN".to_owned() } else { format!("{} WINS IN A ROW", winner.wins) };
        lines.push(if winner.is_you {
            format!("YOU STAY: {games}")
        } else {
            format!("{} STAYS: {games}", winner.name)
        });
    }
    match (line, &outcome.next) {
        (Some(1), _) => lines.push("YOU ARE NEXT".to_owned()),
        (_, Some(next)) => lines.push(format!("{next} COMES UP")),
        (_, None) if has_place => lines.push("ENTER: PLAY AGAIN".to_owned()),
        (_, None) => {}
    }
    lines
}

/// Whether nobody plays but the bot, and nobody waits to.
pub(crate) fn is_attract(session: &Session) -> bool {
    session.place().is_none()
        && session.line().is_none()
        && session.roster().places.iter().flatten().all(|name| name == BOT)
}

/// Whether a game has tilted, and the ball is not lost yet.
pub(crate) fn has_tilted(game: &Game) -> bool {
    game.tilt().tilted && matches!(game.phase(), Phase::Play { serve_in: 0, .. })
}

/// Whether a ball lies where the plunger can launch it.
pub(crate) fn is_on_plunger(game: &Game) -> bool {
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
