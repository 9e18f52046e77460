//! `games`: the bot plays whole games on a table, and a report tells how the table plays: how long balls live, how points
//! spread, what is hit and what never, and whether a ball ever had to be rescued or never ended.

use std::fmt::Write;
use std::sync::Arc;

use serde_json::{Value, json};
use shared::game::{Game, GameEventKind, Phase, Rescue};
use shared::physics::EventKind;
use shared::table::{ElementFile, Table};

use crate::simulate::{Inputs, Player, Simulation};

/// World time after which a game is given up, seconds: half an hour. Its last ball never ended.
const LONGEST_GAME: f64 = 1800.0;

/// What happened in one game.
#[derive(Debug, Clone, PartialEq)]
struct Played {
    /// From serve to loss, seconds.
    ball_times: Vec<f64>,
    /// From start to end, seconds.
    time: f64,
    points: u64,
    /// Of each element: how often a ball met it, or passed it.
    hits: Vec<u32>,
    flips: u64,
    impacts: u64,
    /// Times that all kickers were fired for a stuck ball.
    kicked: u64,
    /// Stuck balls that were served again.
    rescued: u64,
    /// Balls that left the table and were served again.
    escaped: u64,
    /// Lost balls that were put into play again.
    saved: u64,
    /// Extra balls that were won.
    extra: u64,
    /// Of each of the table's messages: how often it was shown.
    messages: Vec<u32>,
    /// Of each light: whether it was ever lit.
    lit: u64,
    /// Whether it was given up.
    endless: bool,
}

/// What happened in all games, in the order of their seeds.
#[derive(Debug, Clone, PartialEq)]
pub struct Games {
    table: Arc<Table>,
    played: Vec<Played>,
}

impl Games {
    /// Has the bot play `count` games, with the seeds from `seed` on, on that many threads. How many does not alter the outcome.
    ///
    /// # Panics
    /// If a thread does.
    pub fn play(table: &Arc<Table>, count: u32, seed: u64, threads: u32) -> Self {
        let (count, threads) = (u64::from(count), u64::from(threads.max(1)));
        let part = |thread: u64| {
            let places = count * thread / threads..count * (thread + 1) / threads;
            places.map(|place| play(table, seed.wrapping_add(place))).collect::<Vec<_>>()
        };
        let played = std::thread::scope(|scope| {
            let threads: Vec<_> = (0..threads).map(|thread| scope.spawn(move || part(thread))).collect();
            let join = |thread: std::thread::ScopedJoinHandle<'_, Vec<Played>>| {
                thread.join().unwrap_or_else(|panic| std::panic::resume_unwind(panic))
            };
            threads.into_iter().flat_map(join).collect()
        });
        Self { table: Arc::clone(table), played }
    }

    /// Each element that a ball can meet or pass, with how often a game it was, and in what share of the games.
    fn elements(&self) -> Vec<(&str, f64, f64)> {
        let count = self.played.len().max(1) as f64;
        let elements = self.table.file.elements.iter().enumerate();
        elements
            // A light is looked at only, and a drain is told by the balls that are lost.
            .filter(|(_, element)| !matches!(element, ElementFile::Light(_) | ElementFile::Drain(_)))
            .map(|(place, element)| {
                let hits = self.played.iter().map(|game| u64::from(game.hits[place])).sum::<u64>();
                let games = self.played.iter().filter(|game| game.hits[place] > 0).count();
                (element.name(), hits as f64 / count, games as f64 / count)
            })
            .collect()
    }

    /// What is said of an element that was never hit: the bot plays without a crowd that could raise what is down.
    fn why_never(&self, name: &str) -> &'static str {
        let is_down = |element: &ElementFile| matches!(element, ElementFile::DropTarget(target) if target.name == name && target.down);
        if self.table.file.elements.iter().any(is_down) { "  down until raised" } else { "  never hit" }
    }

    /// Each line that the rules put on the display, with how often a game it was, and in what share of the games. Rules with the
    /// same line are one.
    fn messages(&self) -> Vec<(&str, f64, f64)> {
        let count = self.played.len().max(1) as f64;
        let mut places: Vec<(&str, Vec<usize>)> = Vec::new();
        for (place, text) in self.table.rules.messages.iter().enumerate() {
            match places.iter_mut().find(|(known, _)| known == text) {
                Some((_, same)) => same.push(place),
                None => places.push((text, vec![place])),
            }
        }
        let told = |game: &Played, places: &[usize]| places.iter().map(|&place| game.messages[place]).sum::<u32>();
        let rows = places.into_iter().map(|(text, places)| {
            let times = self.played.iter().map(|game| u64::from(told(game, &places))).sum::<u64>();
            let games = self.played.iter().filter(|game| told(game, &places) > 0).count();
            (text, times as f64 / count, games as f64 / count)
        });
        rows.collect()
    }

    /// Each light, with the share of the games in which it was ever lit.
    fn lights(&self) -> Vec<(&str, f64)> {
        let count = self.played.len().max(1) as f64;
        let lights = self.table.lights.iter().enumerate();
        lights
            .map(|(place, &element)| {
                let games = self.played.iter().filter(|game| game.lit >> place & 1 == 1).count();
                (self.table.file.elements[usize::from(element)].name(), games as f64 / count)
            })
            .collect()
    }

    fn ball_times(&self) -> Spread {
        Spread::of(self.played.iter().flat_map(|game| game.ball_times.iter().copied()))
    }

    fn game_times(&self) -> Spread {
        Spread::of(self.played.iter().map(|game| game.time))
    }

    fn points(&self) -> Spread {
        Spread::of(self.played.iter().map(|game| game.points as f64))
    }

    fn sum(&self, of: impl Fn(&Played) -> u64) -> u64 {
        self.played.iter().map(of).sum()
    }

    fn a_second(&self, of: impl Fn(&Played) -> u64) -> f64 {
        let seconds: f64 = self.played.iter().map(|game| game.time).sum();
        if seconds > 0.0 { self.sum(of) as f64 / seconds } else { 0.0 }
    }

    /// One JSON object with everything.
    pub fn json(&self) -> Value {
        let elements: Vec<_> = self
            .elements()
            .into_iter()
            .map(|(name, hits, share)| json!({ "element": name, "hits_a_game": hits, "share_of_games": share }))
            .collect();
        let messages: Vec<_> = self
            .messages()
            .into_iter()
            .map(|(text, times, share)| json!({ "message": text, "times_a_game": times, "share_of_games": share }))
            .collect();
        let lights: Vec<_> =
            self.lights().into_iter().map(|(name, share)| json!({ "light": name, "share_of_games": share })).collect();
        json!({
            "table": self.table.name,
            "games": self.played.len(),
            "ball_seconds": self.ball_times().json(),
            "game_seconds": self.game_times().json(),
            "points": self.points().json(),
            "elements": elements,
            "messages": messages,
            "lights": lights,
            "balls_saved": self.sum(|game| game.saved),
            "extra_balls": self.sum(|game| game.extra),
            "kickers_fired": self.sum(|game| game.kicked),
            "rescued": self.sum(|game| game.rescued),
            "escaped": self.sum(|game| game.escaped),
            "endless": self.sum(|game| u64::from(game.endless)),
            "flips_a_second": self.a_second(|game| game.flips),
            "impacts_a_second": self.a_second(|game| game.impacts),
        })
    }

    /// A table for people.
    pub fn text(&self) -> String {
        let mut out = format!("{}: {} games of the bot's\n\n", self.table.name, self.played.len());
        let mut line = |text: std::fmt::Arguments<'_>| {
            // A string takes everything.
            let _ = writeln!(out, "{text}");
        };
        let heads = ["least", "quarter", "median", "quarter", "most", "mean"];
        let row = |cells: [f64; 6], digits: usize| cells.map(|cell| format!("{cell:>10.digits$}")).concat();
        line(format_args!("{:<16}{}", "", heads.map(|head| format!("{head:>10}")).concat()));
        line(format_args!("{:<16}{}", "ball, seconds", row(self.ball_times().cells(), 1)));
        line(format_args!("{:<16}{}", "game, seconds", row(self.game_times().cells(), 1)));
        line(format_args!("{:<16}{}", "points", row(self.points().cells(), 0)));
        line(format_args!(""));
        line(format_args!(
            "{:.2} flips and {:.2} impacts a second",
            self.a_second(|game| game.flips),
            self.a_second(|game| game.impacts)
        ));
        line(format_args!(
            "all kickers fired {} times, {} stuck balls served again, {} escaped, {} that had not ended after {LONGEST_GAME:.0} s of play",
            self.sum(|game| game.kicked),
            self.sum(|game| game.rescued),
            self.sum(|game| game.escaped),
            self.sum(|game| u64::from(game.endless)),
        ));
        line(format_args!(
            "{} lost balls saved, {} extra balls won",
            self.sum(|game| game.saved),
            self.sum(|game| game.extra)
        ));
        line(format_args!(""));
        line(format_args!("{:<24}{:>12}{:>12}", "element", "hits a game", "of games"));
        for (name, hits, share) in self.elements() {
            let never = if share > 0.0 { "" } else { self.why_never(name) };
            line(format_args!("{name:<24}{hits:>12.2}{:>10.1} %{never}", 100.0 * share));
        }
        line(format_args!(""));
        line(format_args!("{:<24}{:>12}{:>12}", "message", "a game", "of games"));
        for (text, times, share) in self.messages() {
            let never = if share > 0.0 { "" } else { "  never told" };
            line(format_args!("{text:<24}{times:>12.2}{:>10.1} %{never}", 100.0 * share));
        }
        line(format_args!(""));
        line(format_args!("{:<24}{:>12}{:>12}", "light", "", "lit in"));
        for (name, share) in self.lights() {
            let never = if share > 0.0 { "" } else { "  never lit" };
            line(format_args!("{name:<24}{:>12}{:>10.1} %{never}", "", 100.0 * share));
        }
        out
    }
}

/// Plays one game to its end, or up to [`LONGEST_GAME`].
fn play(table: &Arc<Table>, seed: u64) -> Played {
    let simulation = Simulation { seconds: LONGEST_GAME, player: Player::Bot, seed };
    let dt = table.scene.tick_seconds;
    let (mut game, mut player, mut inputs) = (Game::new(Arc::clone(table)), Inputs::new(&simulation), Vec::new());
    let mut played = Played {
        ball_times: Vec::new(),
        time: LONGEST_GAME,
        points: 0,
        hits: vec![0; table.file.elements.len()],
        flips: 0,
        impacts: 0,
        kicked: 0,
        rescued: 0,
        escaped: 0,
        saved: 0,
        extra: 0,
        messages: vec![0; table.rules.messages.len()],
        lit: 0,
        endless: true,
    };
    let mut served = None;
    for tick in 0..simulation.ticks(table) {
        player.choose(&game, &mut inputs);
        for event in game.step(&inputs) {
            match event.kind {
                GameEventKind::Points { points, .. } => played.points = played.points.saturating_add(points),
                GameEventKind::Flipped { .. } => played.flips += 1,
                GameEventKind::Rescued { by: Rescue::Kickers } => played.kicked += 1,
                GameEventKind::Rescued { by: Rescue::Relaunch } => played.rescued += 1,
                GameEventKind::Saved { .. } => played.saved += 1,
                GameEventKind::ExtraBall { .. } => played.extra += 1,
                GameEventKind::Message { place } => played.messages[usize::from(place)] += 1,
                GameEventKind::Served { .. } => served = Some(tick),
                GameEventKind::Lost { .. } => {
                    played.ball_times.extend(served.take().map(|served| (tick - served) as f64 * dt));
                }
                _ => {}
            }
        }
        for event in game.world().events() {
            match event.kind {
                EventKind::Touched { element, .. }
                | EventKind::Kicked { element, .. }
                | EventKind::Struck { element, .. }
                | EventKind::Felled { element, .. } => {
                    played.hits[usize::from(element)] += 1;
                    played.impacts += 1;
                }
                EventKind::Passed { element } | EventKind::Spun { element } | EventKind::Held { element } => {
                    played.hits[usize::from(element)] += 1;
                }
                EventKind::Met { .. } => played.impacts += 1,
                EventKind::Escaped => played.escaped += 1,
                EventKind::Ejected { .. } | EventKind::Stalled { .. } | EventKind::Drained => {}
            }
        }
        played.lit |= game.lights();
        if matches!(game.phase(), Phase::Over) {
            (played.time, played.endless) = ((tick + 1) as f64 * dt, false);
            break;
        }
    }
    // An escaped ball is served again like a stuck one.
    played.rescued = played.rescued.saturating_sub(played.escaped);
    played
}

/// How numbers spread.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Spread {
    /// Least, lower quartile, median, upper quartile, most: each one of the numbers.
    five: [f64; 5],
    mean: f64,
}

impl Spread {
    /// Of nothing, all zeros.
    fn of(numbers: impl Iterator<Item = f64>) -> Self {
        let mut sorted: Vec<f64> = numbers.collect();
        sorted.sort_by(f64::total_cmp);
        let Some(last) = sorted.len().checked_sub(1) else { return Self { five: [0.0; 5], mean: 0.0 } };
        let five = [0, 1, 2, 3, 4].map(|quarter| sorted[last * quarter / 4]);
        Self { five, mean: sorted.iter().sum::<f64>() / sorted.len() as f64 }
    }

    fn cells(&self) -> [f64; 6] {
        let [least, lower, median, upper, most] = self.five;
        [least, lower, median, upper, most, self.mean]
    }

    fn json(&self) -> Value {
        let [least, lower, median, upper, most] = self.five;
        json!({ "least": least, "lower_quartile": lower, "median": median, "upper_quartile": upper, "most": most, "mean": self.mean })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::load_table;

    #[test]
    fn games_are_the_same_again_and_on_any_number_of_threads() {
        let table = load_table("classic").expect("it is shipped");
        let one = Games::play(&table, 3, 7, 1);
        for threads in [1, 2, 5] {
            let again = Games::play(&table, 3, 7, threads);
            assert_eq!((again.json(), again.text()), (one.json(), one.text()), "{threads} threads");
        }
        assert_ne!(Games::play(&table, 3, 8, 2).json(), one.json());
    }

    #[test]
    fn a_report_tells_of_balls_points_and_elements() {
        let table = load_table("classic").expect("it is shipped");
        let games = Games::play(&table, 4, 1, 2);
        let told = games.json();
        let number = |value: &Value| value.as_f64().expect("a number");
        assert_eq!((&told["games"], &told["endless"]), (&json!(4), &json!(0)));
        assert!(number(&told["points"]["least"]) > 0.0 && number(&told["ball_seconds"]["median"]) > 1.0, "{told}");
        assert!(number(&told["game_seconds"]["mean"]) >= 3.0 * number(&told["ball_seconds"]["mean"]), "{told}");
        let elements = told["elements"].as_array().expect("a list");
        let of = |name: &str| elements.iter().find(|element| element["element"] == name);
        assert!(of("bumper 1").is_some_and(|bumper| number(&bumper["hits_a_game"]) > 0.0), "{told}");
        assert!(of("drain").is_none() && of("lane 1 light").is_none(), "{told}");
        let rows = |what: &str| told[what].as_array().map(Vec::len);
        assert_eq!(rows("lights"), Some(table.lights.len()));
        let mut texts = table.rules.messages.clone();
        texts.sort();
        texts.dedup();
        assert_eq!(rows("messages"), Some(texts.len()), "each once");
        assert!(games.text().contains("bumper 1"));
    }

    #[test]
    fn a_spread_names_numbers_that_were_there() {
        let spread = Spread::of([4.0, 1.0, 3.0, 2.0, 10.0].into_iter());
        assert_eq!((spread.five, spread.mean), ([1.0, 2.0, 3.0, 4.0, 10.0], 4.0));
        assert_eq!(Spread::of([].into_iter()).five, [0.0; 5]);
    }
}
