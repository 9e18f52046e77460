//! Inputs, seeded: the same ones in every run.

use shared::math::Rng;
use shared::table::Table;

/// Different inputs of one benchmark: too many for a branch predictor to learn by heart, few enough for the first
/// cache.
pub(crate) const INPUTS: usize = 256;

/// Tries after which a wanted input is taken not to exist.
const MOST_TRIES: u32 = 1_000_000;

/// Inputs in turn, again and again.
pub(crate) struct Round<T> {
    inputs: Vec<T>,
    next: usize,
}

impl<T> Round<T> {
    pub(crate) fn new(inputs: Vec<T>) -> Self {
        assert_eq!(inputs.len(), INPUTS);
        Self { inputs, next: 0 }
    }

    /// As many as it takes, of those that `draw` makes and `is_wanted` accepts.
    pub(crate) fn drawn(mut draw: impl FnMut(&mut Rng) -> T, is_wanted: impl Fn(&T) -> bool) -> Self {
        let mut rng = Rng::new(11);
        let mut inputs = Vec::with_capacity(INPUTS);
        for _ in 0..MOST_TRIES {
            let input = draw(&mut rng);
            if is_wanted(&input) {
                inputs.push(input);
            }
            if inputs.len() == INPUTS {
                return Self::new(inputs);
            }
        }
        panic!("only {} of {INPUTS} inputs are as wanted, in {MOST_TRIES} tries", inputs.len());
    }

    pub(crate) fn all(&self) -> &[T] {
        &self.inputs
    }

    #[inline]
    pub(crate) fn next(&mut self) -> &T {
        self.next = (self.next + 1) % INPUTS;
        &self.inputs[self.next]
    }
}

/// A table or scene in this text.
pub(crate) fn table(text: &str) -> Table {
    Table::parse("benchmark", text).unwrap_or_else(|error| panic!("{error}"))
}
