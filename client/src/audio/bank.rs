//! Every sound of the game, and how it is made. A pinball machine is heard as coils, switches, rubber and steel; chimes
//! count the points.

use super::synth::Waveform;

/// A sound.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Sound {
    /// A ball against rubber.
    Rubber,
    /// Against a metal rail.
    Metal,
    /// Against wood.
    Wood,
    /// Against plastic.
    Plastic,
    /// Against another ball.
    Clack,
    /// A bumper kicks.
    Bumper,
    /// A slingshot kicks.
    Slingshot,
    /// A flipper's coil pulls.
    FlipperUp,
    /// A flipper falls back on its stop.
    FlipperDown,
    /// A drop target falls.
    Drop,
    /// Drop targets are raised.
    Raise,
    /// A standing target is hit.
    Target,
    /// A switch in a lane.
    Rollover,
    /// A spinner turns half round.
    Spinner,
    /// A gate opens.
    Gate,
    /// A saucer catches a ball.
    Catch,
    /// A saucer throws a ball out.
    Eject,
    /// The plunger is drawn back.
    Pull,
    /// It is let go.
    Launch,
    /// A ball comes out of the trough.
    Serve,
    /// A ball is lost.
    Drain,
    /// A hand slaps the cabinet.
    Nudge,
    /// The plumb bob touched its ring.
    Warning,
    /// The game has tilted.
    Tilt,
    /// Points.
    Chime,
    /// The bonus multiplier rises.
    Multiplier,
    /// Something was achieved.
    Award,
    /// Something great was.
    Jackpot,
    /// Another ball is in play.
    Multiball,
    /// A game begins.
    Start,
    /// A game is over.
    Over,
    /// The crowd is about to do something.
    Alarm,
    /// All kickers fire for a stuck ball.
    Search,
    /// The knocker in the backbox: something was won.
    Knock,
}

impl Sound {
    /// All of them, in the order of their numbers.
    pub(super) const ALL: [Self; 34] = [
        Self::Rubber,
        Self::Metal,
        Self::Wood,
        Self::Plastic,
        Self::Clack,
        Self::Bumper,
        Self::Slingshot,
        Self::FlipperUp,
        Self::FlipperDown,
        Self::Drop,
        Self::Raise,
        Self::Target,
        Self::Rollover,
        Self::Spinner,
        Self::Gate,
        Self::Catch,
        Self::Eject,
        Self::Pull,
        Self::Launch,
        Self::Serve,
        Self::Drain,
        Self::Nudge,
        Self::Warning,
        Self::Tilt,
        Self::Chime,
        Self::Multiplier,
        Self::Award,
        Self::Jackpot,
        Self::Multiball,
        Self::Start,
        Self::Over,
        Self::Alarm,
        Self::Search,
        Self::Knock,
    ];

    /// How loud it is beside the others, 0 to 1.
    pub(super) fn level(self) -> f32 {
        match self {
            Self::Bumper | Self::Slingshot | Self::Nudge | Self::Knock => 1.0,
            Self::Tilt | Self::Raise | Self::Launch | Self::Eject | Self::Search => 0.9,
            Self::FlipperUp | Self::Drop | Self::Serve | Self::Jackpot | Self::Clack => 0.8,
            Self::Rubber | Self::Metal | Self::Wood | Self::Plastic | Self::Target | Self::Catch => 0.7,
            Self::Drain | Self::Award | Self::Multiball | Self::Start | Self::Over | Self::Multiplier => 0.6,
            Self::FlipperDown | Self::Gate | Self::Spinner | Self::Rollover | Self::Pull => 0.5,
            Self::Warning | Self::Alarm => 0.5,
            Self::Chime => 0.3,
        }
    }

    /// Its samples, the same on every call.
    pub(super) fn samples(self) -> Box<[f32]> {
        let new = |seconds| Waveform::new(seconds, 1 + self as u64);
        let wave =
            match self {
                Self::Rubber | Self::Metal | Self::Wood | Self::Plastic | Self::Clack => self.contact(),
                Self::Bumper => new(0.28)
                    .glide(0.0, (210.0, 68.0), 0.05, 0.06, 1.0)
                    .ring(0.0, 930.0, 0.02, 0.35)
                    .ring(0.018, 1480.0, 0.05, 0.12)
                    .noise(0.0, (1200.0, 7000.0), 0.006, 0.9)
                    .noise(0.03, (300.0, 2500.0), 0.012, 0.35),
                Self::Slingshot => new(0.22)
                    .glide(0.0, (310.0, 105.0), 0.03, 0.035, 1.0)
                    .ring(0.0, 1750.0, 0.012, 0.3)
                    .noise(0.0, (2200.0, 11_000.0), 0.008, 1.0)
                    .noise(0.022, (500.0, 3000.0), 0.01, 0.4),
                Self::FlipperUp => new(0.16)
                    .glide(0.0, (165.0, 62.0), 0.03, 0.03, 1.0)
                    .ring(0.009, 430.0, 0.014, 0.45)
                    .ring(0.009, 1270.0, 0.006, 0.25)
                    .noise(0.0, (800.0, 4500.0), 0.004, 0.5)
                    .noise(0.009, (900.0, 6000.0), 0.005, 0.6),
                Self::FlipperDown => new(0.12)
                    .glide(0.0, (130.0, 75.0), 0.02, 0.022, 0.8)
                    .ring(0.0, 335.0, 0.012, 0.5)
                    .noise(0.0, (400.0, 2600.0), 0.006, 0.6),
                Self::Drop => new(0.2)
                    .ring(0.0, 1250.0, 0.01, 0.7)
                    .noise(0.0, (1500.0, 8000.0), 0.004, 1.0)
                    .glide(0.045, (190.0, 110.0), 0.03, 0.03, 0.9)
                    .noise(0.045, (400.0, 3500.0), 0.008, 0.8),
                Self::Raise => new(0.3)
                    .glide(0.0, (150.0, 55.0), 0.05, 0.06, 1.0)
                    .noise(0.0, (500.0, 5000.0), 0.012, 0.9)
                    .ring(0.05, 1100.0, 0.01, 0.5)
                    .ring(0.068, 1240.0, 0.01, 0.45)
                    .ring(0.085, 1160.0, 0.01, 0.4)
                    .noise(0.05, (1200.0, 7000.0), 0.02, 0.5),
                Self::Target => new(0.14).ring(0.0, 690.0, 0.018, 0.8).ring(0.0, 1530.0, 0.025, 0.4).noise(
                    0.0,
                    (900.0, 6500.0),
                    0.005,
                    0.9,
                ),
                Self::Rollover => new(0.09)
                    .ring(0.0, 3150.0, 0.006, 0.7)
                    .noise(0.0, (2500.0, 9000.0), 0.002, 0.9)
                    .ring(0.034, 2700.0, 0.005, 0.4),
                Self::Spinner => new(0.07).ring(0.0, 1720.0, 0.009, 0.8).ring(0.0, 640.0, 0.008, 0.4).noise(
                    0.0,
                    (1800.0, 7000.0),
                    0.003,
                    0.8,
                ),
                Self::Gate => new(0.16)
                    .ring(0.0, 2150.0, 0.02, 0.6)
                    .ring(0.0, 3380.0, 0.014, 0.4)
                    .noise(0.0, (2000.0, 8000.0), 0.004, 0.6)
                    .ring(0.07, 1950.0, 0.015, 0.3),
                Self::Catch => new(0.26)
                    .glide(0.0, (170.0, 95.0), 0.04, 0.03, 1.0)
                    .noise(0.0, (300.0, 2800.0), 0.01, 0.7)
                    .glide(0.075, (150.0, 100.0), 0.03, 0.022, 0.5)
                    .ring(0.0, 2900.0, 0.01, 0.2),
                Self::Eject => new(0.26)
                    .glide(0.0, (240.0, 58.0), 0.06, 0.055, 1.0)
                    .ring(0.004, 1120.0, 0.018, 0.4)
                    .noise(0.0, (700.0, 6000.0), 0.009, 0.9),
                Self::Pull | Self::Launch => self.plunger(),
                Self::Serve => new(0.4)
                    .glide(0.0, (180.0, 60.0), 0.05, 0.05, 1.0)
                    .noise(0.0, (600.0, 4500.0), 0.008, 0.7)
                    .noise(0.06, (150.0, 900.0), 0.11, 0.7)
                    .ring(0.24, 2450.0, 0.02, 0.25)
                    .ring(0.24, 380.0, 0.015, 0.4),
                Self::Drain => new(0.75)
                    .noise(0.0, (90.0, 700.0), 0.16, 1.0)
                    .glide(0.05, (330.0, 98.0), 0.5, 0.3, 0.55)
                    .glide(0.05, (333.0, 97.0), 0.5, 0.3, 0.45)
                    .ring(0.4, 210.0, 0.03, 0.6),
                Self::Nudge => new(0.3)
                    .glide(0.0, (98.0, 44.0), 0.07, 0.07, 1.0)
                    .noise(0.0, (60.0, 700.0), 0.03, 1.2)
                    .noise(0.04, (1500.0, 6000.0), 0.05, 0.12),
                // A plunger of steel against a board of wood.
                Self::Knock => new(0.3)
                    .glide(0.0, (230.0, 120.0), 0.02, 0.045, 1.0)
                    .ring(0.0, 410.0, 0.03, 0.7)
                    .ring(0.0, 870.0, 0.018, 0.4)
                    .noise(0.0, (700.0, 7000.0), 0.006, 1.2),
                _ => self.tune(),
            };
        wave.finish()
    }

    /// A ball against what does nothing: short, the harder the brighter.
    fn contact(self) -> Waveform {
        let new = |seconds| Waveform::new(seconds, 1 + self as u64);
        match self {
            Self::Rubber => new(0.08).glide(0.0, (260.0, 170.0), 0.02, 0.014, 1.0).ring(0.0, 520.0, 0.006, 0.4).noise(
                0.0,
                (250.0, 1800.0),
                0.005,
                0.7,
            ),
            Self::Metal => new(0.16)
                .ring(0.0, 2380.0, 0.03, 0.5)
                .ring(0.0, 3710.0, 0.022, 0.4)
                .ring(0.0, 5260.0, 0.014, 0.3)
                .ring(0.0, 480.0, 0.008, 0.5)
                .noise(0.0, (2500.0, 10_000.0), 0.002, 0.8),
            Self::Wood => new(0.09)
                .ring(0.0, 315.0, 0.013, 0.9)
                .ring(0.0, 590.0, 0.009, 0.5)
                .ring(0.0, 1340.0, 0.004, 0.3)
                .noise(0.0, (400.0, 3200.0), 0.003, 0.8),
            Self::Plastic => new(0.07).ring(0.0, 1130.0, 0.008, 0.7).ring(0.0, 1960.0, 0.006, 0.5).noise(
                0.0,
                (1400.0, 7000.0),
                0.002,
                0.9,
            ),
            // Steel on steel.
            _ => new(0.09)
                .ring(0.0, 4150.0, 0.012, 0.6)
                .ring(0.0, 6080.0, 0.009, 0.5)
                .ring(0.0, 7900.0, 0.005, 0.3)
                .ring(0.0, 1500.0, 0.003, 0.5)
                .noise(0.0, (4000.0, 14_000.0), 0.001, 0.7),
        }
    }

    /// The shooter's spring: drawn back coil by coil, and let go.
    fn plunger(self) -> Waveform {
        let mut wave = Waveform::new(0.5, 1 + self as u64);
        if self == Self::Launch {
            return wave
                .glide(0.0, (120.0, 60.0), 0.03, 0.04, 1.0)
                .noise(0.0, (900.0, 6000.0), 0.01, 0.9)
                .ring(0.0, 1870.0, 0.03, 0.3)
                .ring(0.0, 640.0, 0.09, 0.3)
                .ring(0.045, 655.0, 0.07, 0.25)
                .ring(0.09, 648.0, 0.06, 0.2)
                .noise(0.02, (200.0, 1200.0), 0.1, 0.3);
        }
        for coil in 0..14 {
            let (at, tension) = (coil as f32 * 0.03, coil as f32 / 14.0);
            wave = wave.ring(at, 620.0 + 260.0 * tension, 0.012, 0.3 + 0.3 * tension).noise(
                at,
                (1200.0, 5000.0),
                0.004,
                0.5,
            );
        }
        wave
    }

    /// What a machine says with its chimes and buzzers.
    fn tune(self) -> Waveform {
        // Just intonation over A: 1, 9/8, 5/4, 3/2, 2 and so on.
        const A4: f32 = 440.0;
        let new = |seconds| Waveform::new(seconds, 1 + self as u64);
        let bells = |seconds, every: f32, decay, notes: &[f32]| {
            notes
                .iter()
                .zip(0_u8..)
                .fold(new(seconds), |wave, (note, place)| wave.bell(every * f32::from(place), A4 * note, decay, 1.0))
        };
        match self {
            Self::Chime => bells(0.45, 0.0, 0.12, &[1.0]),
            Self::Multiplier => bells(0.6, 0.09, 0.14, &[1.5, 2.25]),
            Self::Award => bells(0.75, 0.075, 0.14, &[1.25, 1.5, 2.0]),
            Self::Jackpot => bells(1.1, 0.07, 0.18, &[1.0, 1.25, 1.5, 2.0, 1.5, 2.0, 2.5, 3.0]),
            Self::Multiball => {
                bells(1.0, 0.11, 0.12, &[1.0, 1.5, 1.0, 1.5, 2.0, 3.0]).buzz(0.0, (110.0, 440.0), 0.6, 0.3)
            }
            Self::Start => bells(0.95, 0.12, 0.16, &[1.0, 1.25, 1.5, 2.0]),
            Self::Over => bells(1.1, 0.17, 0.2, &[2.0, 1.5, 1.25, 1.0, 0.75]),
            Self::Warning => new(0.3).buzz(0.0, (233.0, 233.0), 0.1, 1.0).buzz(0.15, (233.0, 233.0), 0.12, 1.0),
            Self::Tilt => new(1.0).buzz(0.0, (196.0, 46.0), 0.95, 1.0).buzz(0.0, (201.0, 45.0), 0.95, 0.8),
            Self::Alarm => new(0.5).buzz(0.0, (523.0, 523.0), 0.13, 1.0).buzz(0.16, (392.0, 392.0), 0.2, 1.0),
            // All coils, one after the other.
            _ => (0_u8..5).fold(new(0.5), |wave, coil| {
                let at = f32::from(coil) * 0.075;
                wave.glide(at, (230.0, 70.0), 0.04, 0.03, 1.0).noise(at, (900.0, 6000.0), 0.006, 0.8)
            }),
        }
    }
}

/// The sounds, made.
pub(super) struct Bank {
    sounds: Vec<Box<[f32]>>,
}

impl Bank {
    /// Makes all of them.
    pub(super) fn new() -> Self {
        Self { sounds: Sound::ALL.into_iter().map(Sound::samples).collect() }
    }

    /// The samples of one.
    pub(super) fn samples(&self, sound: Sound) -> &[f32] {
        self.sounds.get(sound as usize).map_or(&[], |samples| samples)
    }
}

#[cfg(test)]
mod tests {
    use super::super::synth::RATE;
    use super::*;

    #[test]
    fn every_sound_is_heard_short_and_the_same_each_time() {
        let (one, other) = (Bank::new(), Bank::new());
        let mut bytes = 0;
        for (place, sound) in Sound::ALL.into_iter().enumerate() {
            assert_eq!(sound as usize, place, "{sound:?}");
            let samples = one.samples(sound);
            assert_eq!(samples, other.samples(sound), "{sound:?}");
            let peak = samples.iter().fold(0.0_f32, |most, sample| most.max(sample.abs()));
            let square = samples.iter().map(|sample| sample * sample).sum::<f32>() / samples.len() as f32;
            assert!((0.8..1.0).contains(&peak), "{sound:?}: peak {peak}");
            assert!(square.sqrt() > 0.02, "{sound:?}: {}", square.sqrt());
            assert!(samples.iter().all(|sample| sample.is_finite()) && samples.len() < RATE as usize * 6 / 5);
            // A sound that sets in late would be one that comes late.
            let first = samples.iter().position(|sample| sample.abs() > 0.1 * peak).unwrap();
            assert!(first < RATE as usize / 200, "{sound:?} begins after {first} samples");
            bytes += size_of_val(samples);
        }
        assert!(bytes < 3_000_000, "{bytes} bytes of sounds");
    }
}
