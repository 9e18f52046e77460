//! Which stream a client asks for: what the person chose on the command line, and by role what they left open.

use shared::protocol::{Form, Role, Stream};

/// What the person chose.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub(crate) struct StreamChoice {
    /// What frames hold.
    pub(crate) form: Option<Form>,
    /// Frames a second.
    pub(crate) hz: Option<u8>,
}

impl StreamChoice {
    /// The stream for a role: what was chosen holds in both.
    pub(crate) fn stream(self, role: Role) -> Stream {
        let Stream { form, hz } = Stream::of(role);
        Stream { form: self.form.unwrap_or(form), hz: self.hz.unwrap_or(hz) }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_was_chosen_holds_in_both_roles() {
        let none = StreamChoice::default();
        assert_eq!((none.stream(Role::Play), none.stream(Role::Watch)), (Stream::PLAYER, Stream::SPECTATOR));
        let choice = StreamChoice { form: None, hz: Some(30) };
        assert_eq!(choice.stream(Role::Play), Stream { form: Form::State, hz: 30 });
        let choice = StreamChoice { form: Some(Form::Inputs), hz: None };
        assert_eq!(choice.stream(Role::Play), Stream { form: Form::Inputs, hz: 60 });
    }
}
