//! The effects of a setup that invalidate a method of simulation or estimation.

use crate::error::{Input, Result};
use crate::scenario::effects::{Effect, Method, Occurrence};

use super::Setup;

impl Setup {
    /// Returns the effects that invalidate a method, in the order of the table.
    pub fn obstacles(&self, method: Method) -> impl Iterator<Item = Occurrence> {
        // A file of conditions may have the same ones throughout.
        let is_there = |found: &Occurrence| {
            found.effect != Effect::ChangingConditions || self.course.is_some()
        };
        self.scenario.obstacles(method).filter(is_there)
    }

    /// Whether no effect invalidates a method.
    pub fn allows(&self, method: Method) -> bool {
        self.obstacles(method).next().is_none()
    }

    /// Returns why a method is invalid: the reason of the first effect that invalidates it.
    pub fn why_not(&self, method: Method) -> Option<&'static str> {
        self.obstacles(method).next().map(|found| found.effect.why())
    }

    /// Refuses a setup with an effect that invalidates a method, which `user` uses.
    ///
    /// # Errors
    /// When there is such an effect: its key, its value, what is expected for `user`, and why.
    pub fn require(&self, method: Method, user: &str) -> Result<()> {
        let Some(found) = self.obstacles(method).next() else { return Ok(()) };
        let expected = format!("expected {} for {user}: {}", found.expected(), found.effect.why());
        let source = format!("scenario {}", self.name);
        Err(Input::new(source, expected).field(found.key).value(found.value).into())
    }
}
