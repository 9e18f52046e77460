//! What misbehaving connections send, and how often things are due.

use shared::game::Action;
use shared::math::Rng;
use shared::protocol::{ClientMessage, Form, Hello, Role, Stream, encode, encode_greeting, framed};

/// Makes so many things a second due.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Pace {
    rate: f64,
    since: u64,
    owed: f64,
}

impl Pace {
    /// From `now` on, in microseconds.
    pub(crate) fn new(rate: f64, now: u64) -> Self {
        Self { rate, since: now, owed: 0.0 }
    }

    /// From now on another rate. What is owed stays owed, or a rate that changes all the time would make nothing due.
    pub(crate) fn set_rate(&mut self, rate: f64) {
        self.rate = rate;
    }

    /// How many are due since the last time. What is more than a tenth of a second late is given up.
    pub(crate) fn due(&mut self, now: u64) -> u64 {
        self.owed += now.saturating_sub(self.since) as f64 * self.rate / 1e6;
        self.since = now;
        let due = self.owed as u64;
        self.owed -= due as f64;
        due.min((self.rate / 10.0) as u64 + 1)
    }
}

/// The greeting of a client.
pub(crate) fn hello(name: &str, role: Role, stream: Stream) -> Vec<u8> {
    framed(&encode_greeting(&Hello { name: name.to_owned(), role, stream }))
}

/// The `number`th of the messages that are valid and costly.
pub(crate) fn costly(number: u64) -> ClientMessage {
    match number % 5 {
        0 => ClientMessage::Stream(Stream { form: Form::State, hz: if number.is_multiple_of(4) { 30 } else { 60 } }),
        1 => ClientMessage::Differs { tick: number, digest: 0 },
        2 => ClientMessage::Play,
        3 => ClientMessage::Leave,
        _ => ClientMessage::Ping { nonce: number },
    }
}

/// Bytes that no server may take for a message, whether they come first or later.
pub(crate) fn malformed(rng: &mut Rng) -> Vec<u8> {
    let mut noise = |length: u64| -> Vec<u8> { (0..length).map(|_| rng.bits() as u8).collect() };
    let number = noise(1)[0];
    match number % 7 {
        // A message of a kind that there is none of.
        0 => {
            let mut bytes = noise(16 + u64::from(number));
            bytes[0] = 100 + number % 100;
            framed(&bytes)
        }
        // A length of two megabytes, and one that never ends.
        1 => [&[0xff, 0xff, 0x7f][..], &noise(40)].concat(),
        2 => vec![0xff; 8],
        // More than a message, and less than one.
        3 => framed(&[encode(&ClientMessage::Leave), noise(4)].concat()),
        4 => framed(&[]),
        // A control, from somebody without a seat that controls nothing.
        5 => framed(&encode(&ClientMessage::Act { tick: u64::MAX, action: Action::Sit })),
        // Another protocol.
        _ => format!("GET /{} HTTP/1.1\r\n\r\n", "a".repeat(400)).into_bytes(),
    }
}

#[cfg(test)]
mod tests {
    use shared::protocol::{Deframer, MOST_FROM_CLIENT, decode};

    use super::*;

    #[test]
    fn paces_keep_their_rate_and_forget_a_stall() {
        let mut pace = Pace::new(100.0, 5_000_000);
        let due: u64 = (1..=1000).map(|n| pace.due(5_000_000 + n * 1000)).sum();
        assert!((99..=100).contains(&due), "{due}");
        assert_eq!(pace.due(60_000_000), 11);
        assert_eq!(pace.due(60_000_000), 0);
    }

    /// It did not: thousands were not pinged while others joined, and the server ended them.
    #[test]
    fn a_rate_that_changes_all_the_time_is_kept_too() {
        let mut pace = Pace::new(0.0, 0);
        let due: u64 = (1..=1000)
            .map(|n| {
                pace.set_rate(100.0 + n as f64 / 1000.0);
                pace.due(n * 1000)
            })
            .sum();
        assert!((99..=101).contains(&due), "{due}");
    }

    #[test]
    fn what_is_malformed_is_no_message() {
        let mut rng = Rng::new(3);
        for _ in 0..2000 {
            let mut deframer = Deframer::new(MOST_FROM_CLIENT);
            deframer.space().extend(malformed(&mut rng));
            if let Ok(frame) = deframer.next_frame() {
                match decode(frame.expect("a whole frame: the server has nothing to wait for")) {
                    Err(_) | Ok(ClientMessage::Act { action: Action::Sit, .. }) => {}
                    Ok(message) => panic!("{message:?}"),
                }
            }
        }
    }
}
