//! Who plays against whom, for which points, and how it ended: the same form for every mode.
//!
//! A server makes room for the next as soon as a game is over; how it ended is remembered here until another one begins.

use shared::game::Phase;
use shared::protocol::Mode;

use super::Session;

/// Somebody who plays for points, or comes up for the next game.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub(crate) struct Contestant {
    /// `None` for the crowd.
    pub(crate) place: Option<u8>,
    pub(crate) name: String,
    pub(crate) points: u64,
    /// Whose turn it is.
    pub(crate) has_turn: bool,
    /// In the game that is on, or was the last.
    pub(crate) plays: bool,
    /// The person at this window, or one of them.
    pub(crate) is_you: bool,
    /// Games won in a row.
    pub(crate) wins: u32,
}

/// How a game ended.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct Outcome {
    /// Who won; `None` if somebody played alone.
    pub(crate) winner: Option<Contestant>,
    /// What the person at this window has.
    pub(crate) own: Option<Contestant>,
    /// Who comes up for the next game.
    pub(crate) next: Option<String>,
}

/// Those who play, and those of the last game.
#[derive(Debug, Default)]
pub(super) struct Contest {
    now: Vec<Contestant>,
    /// As they were last seen in a game.
    last: Vec<Contestant>,
}

impl Session {
    /// Who plays, as it is seen.
    pub(crate) fn contestants(&self) -> &[Contestant] {
        &self.contest.now
    }

    /// Whether a game is on, as it is seen.
    pub(crate) fn is_playing(&self) -> bool {
        (0..self.boards.len())
            .any(|board| self.moment(board).is_some_and(|moment| matches!(moment.game.phase(), Phase::Play { .. })))
    }

    /// How the last game ended; `None` while one is on, or nobody has seen one.
    pub(crate) fn outcome(&self) -> Option<Outcome> {
        let is_over = self.moment(self.main_board())?.game.phase() == Phase::Over;
        if self.is_playing() || !is_over {
            return None;
        }
        let Contest { now, last } = &self.contest;
        // Who still sits there has all points by now; of who made room, the last that were seen are known.
        let now_of = |one: &Contestant| {
            now.iter().find(|other| other.plays && (other.place, &other.name) == (one.place, &one.name))
        };
        let all: Vec<Contestant> = last.iter().map(|one| now_of(one).unwrap_or(one).clone()).collect();
        let most = || {
            let most = all.iter().map(|one| one.points).max();
            all.iter().find(|one| Some(one.points) == most)
        };
        let crowned = || all.iter().find(|one| one.wins > 0 && one.place.is_some());
        let winner = if self.mode == Mode::Crowd { most() } else { crowned().or_else(most) };
        let newcomer = now.iter().find(|one| !one.plays && one.place.is_some()).map(|one| &one.name);
        Some(Outcome {
            winner: winner.filter(|_| all.len() > 1).cloned(),
            own: all.iter().find(|one| one.is_you && one.place.is_some()).cloned(),
            next: newcomer.or(self.roster.line.first()).cloned(),
        })
    }

    /// Looks who plays.
    pub(super) fn update_contest(&mut self) {
        let now = self.count_contestants();
        if self.is_playing() || self.contest.last.is_empty() {
            self.contest.last = now.iter().filter(|one| one.plays).cloned().collect();
        }
        self.contest.now = now;
    }

    fn count_contestants(&self) -> Vec<Contestant> {
        let mut all = Vec::new();
        for (place, name) in (0..).zip(&self.roster.places) {
            let (board, seat) = self.board_and_seat(place);
            let Some(moment) = self.moment(board) else { continue };
            let Some(taken) = moment.game.seats().get(usize::from(seat)) else { continue };
            if name.is_none() && !taken.playing {
                continue;
            }
            all.push(Contestant {
                place: Some(place),
                name: name.clone().unwrap_or_else(|| format!("PLAYER {}", place + 1)),
                points: taken.score.points,
                has_turn: moment.game.phase().has_turn(seat),
                plays: taken.playing,
                is_you: self.place == Some(place),
                wins: self.roster.champion.filter(|(champion, _)| *champion == place).map_or(0, |(_, wins)| wins),
            });
        }
        let crowd = self.moment(0).and_then(|moment| moment.game.crowd().map(|crowd| crowd.points()));
        if let (Mode::Crowd, Some(points)) = (self.mode, crowd) {
            let name = "THE CROWD".to_owned();
            let plays = all.iter().any(|one| one.plays);
            all.push(Contestant { name, points, plays, is_you: self.place.is_none(), ..Contestant::default() });
        }
        all
    }
}
