//! What connections say unasked: pings, and the floods of those that mean harm.

use shared::protocol::{ClientMessage, encode, framed};

use super::{Fleet, is_awaited};
use crate::connection::{Connection, Kind, Stage};
use crate::hostile::{Pace, costly};

/// Each spectator pings once in so many seconds: servers end sessions that are silent for 15.
const PING_SECONDS: f64 = 5.0;
/// Pings a second of a player, and of the connection that asks for the time.
const BOT_PINGS: f64 = 4.0;
const PROBE_PINGS: f64 = 20.0;
/// Messages a second of a connection that floods: servers end those that send more than 250.
const FLOOD_RATE: f64 = 200.0;

/// Of spectators, players, and the connection that asks for the time.
pub(super) fn ping_paces() -> [Pace; 3] {
    [1.0, BOT_PINGS, PROBE_PINGS].map(|rate| Pace::new(rate, 0))
}

/// Of so many floods together.
pub(super) fn flood_pace(floods: u32, now: u64) -> Pace {
    Pace::new(FLOOD_RATE * f64::from(floods), now)
}

impl Fleet {
    /// Everybody pings now and then: spectators in turn, one after the other.
    pub(super) fn ping_due(&mut self) {
        if self.shared.raw {
            return;
        }
        let now = self.now();
        let mut due: Vec<usize> = Vec::new();
        let [spectators, bots, probe] = &mut self.ping_pace;
        spectators.set_rate(self.connections.len() as f64 / PING_SECONDS);
        for _ in 0..spectators.due(now) {
            self.pinged = (self.pinged + 1) % self.connections.len().max(1);
            due.push(self.pinged);
        }
        let (bots, probe) = (bots.due(now) > 0, probe.due(now) > 0);
        due.extend(self.quick.iter().filter(|&&place| match &self.connections[place] {
            Some(Connection { kind: Kind::Bot { .. }, .. }) => bots,
            Some(_) => probe,
            None => false,
        }));
        for place in due {
            let Some(Some(connection)) = self.connections.get_mut(place) else { continue };
            if !matches!(connection.stage, Stage::In | Stage::Begun) || !is_awaited(&connection.kind) {
                continue;
            }
            // Whoever asks for the time writes down when; others have no use for that.
            let nonce = if matches!(connection.kind, Kind::Bot { .. } | Kind::Probe) { now } else { 0 };
            if let Err(end) = connection.send(&framed(&encode(&ClientMessage::Ping { nonce }))) {
                self.end(place, end);
            }
        }
    }

    /// Sends so many messages that are valid and costly, each connection in its turn.
    pub(super) fn flood(&mut self, due: u64) {
        for _ in 0..due {
            // Each goes through all kinds of them.
            let number = self.shared.counts.flooded;
            let Some(turns) = number.checked_div(self.floods.len() as u64) else { return };
            let place = self.floods[(number % self.floods.len() as u64) as usize];
            self.shared.counts.flooded += 1;
            let Some(Some(connection)) = self.connections.get_mut(place) else { continue };
            if let Err(end) = connection.send(&framed(&encode(&costly(turns)))) {
                self.end(place, end);
            }
        }
    }
}
