//! A pause as a session hears of it.

use super::*;

impl Room {
    /// The room stands still for so many frames of the client; returns what was shown of the first board in each.
    fn stand(&mut self, frames: u32) -> Vec<f64> {
        self.send(ServerMessage::Paused(true));
        let mut shown = Vec::new();
        for _ in 0..frames {
            self.stood += 1.0 / 60.0;
            self.deliver();
            self.draw();
            shown.push(self.session.boards[0].shown);
        }
        self.send(ServerMessage::Paused(false));
        shown
    }

    /// The next frame of the client; returns what was shown of the first board, and how far behind the room's that was.
    fn next_frame(&mut self) -> (f64, f64) {
        self.step();
        while !STATE.is_due(self.games[0].tick(), DT) {
            self.step();
        }
        let shown = self.session.boards[0].shown;
        (shown, self.games[0].tick() as f64 - shown)
    }
}

#[test]
fn a_pause_leaves_no_mark_on_what_is_seen() {
    for place in [None, Some(0)] {
        let mut room = Room::new(Mode::HeadToHead, 2, StreamChoice::default(), Role::Watch);
        room.run(1.0);
        room.session.hear(room.now(), ServerMessage::You { client: 1, place, line: None }).unwrap();
        room.run(4.0);
        let (shown_before, behind_before) = room.next_frame();
        let shown = room.stand(600);
        assert!(room.session.is_paused() && !room.session.is_silent(room.now()));
        // The news take 20 ms; then nothing moves any more.
        assert!(shown[0] >= shown_before && shown[2..].iter().all(|at| *at == shown[2]), "{shown:?}");
        let mut last = shown[599];
        for frame in 0..180 {
            let (shown, behind) = room.next_frame();
            assert!((0.0..19.0).contains(&(shown - last)), "{place:?}, frame {frame}: from {last} to {shown}");
            assert!(frame < 3 || (behind - behind_before).abs() < 2.0, "{place:?}: {behind}, {behind_before} before");
            last = shown;
        }
        assert!(!room.session.is_paused());
        assert_eq!((room.session.counts().mismatches, room.asks()), (0, 0));
    }
}
