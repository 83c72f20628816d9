//! Values of the app's that a plugin holds: settings that were good, and what it changes for a while and gives back.

use bevy::prelude::*;
use rain_core::error::ConfigError;
use rain_ecs::prelude::*;

/// Keeps changed settings of an entity that validate, and names the fault of those that do not: the last good ones stay.
pub(crate) fn keep_good<T>(
    checked: Result<T, ConfigError>,
    last: &mut T,
    entity: Entity,
    errors: &mut MessageWriter<RainConfigError>,
) {
    match checked {
        Ok(good) => *last = good,
        Err(error) => {
            errors.write(RainConfigError { entity, error });
        }
    }
}

/// A value of the app's and what has been written in its place.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct Held<T> {
    own: T,
    written: Option<T>,
}

impl<T: Copy + PartialEq> Held<T> {
    /// The app's own value, where `now` is what is there.
    pub(crate) fn own(&self, now: T) -> T {
        if self.written == Some(now) { self.own } else { now }
    }

    /// What to write in place of `now`, if that is not there already: `of` the app's own value. What the app has written since
    /// is its own.
    pub(crate) fn write(&mut self, now: T, of: impl FnOnce(T) -> T) -> Option<T> {
        self.own = self.own(now);
        let new = of(self.own);
        self.written = Some(new);
        (new != now).then_some(new)
    }

    /// The app's own value, if another was written in its place and is still there; nothing is held any more.
    pub(crate) fn take_back(&mut self, now: T) -> Option<T> {
        (self.written.take() == Some(now) && self.own != now).then_some(self.own)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_the_app_sets_amid_a_change_is_its_own() {
        let mut held = Held::<f32>::default();
        assert_eq!(held.write(10.0, |own| own + 5.0), Some(15.0));
        assert_eq!(held.write(15.0, |own| own + 5.0), None, "there already");
        assert_eq!(held.write(15.0, |own| own + 2.0), Some(12.0));
        assert_eq!(held.take_back(12.0), Some(10.0));
        assert_eq!(held.take_back(12.0), None, "taken back once");
        assert_eq!(held.write(10.0, |own| 3.0 * own), Some(30.0));
        // The app sets another value.
        assert_eq!(held.write(40.0, |own| own + 3.0), Some(43.0));
        assert_eq!(held.take_back(43.0), Some(40.0));
        held.write(40.0, |own| own + 3.0);
        assert_eq!(held.take_back(7.0), None);
    }
}
