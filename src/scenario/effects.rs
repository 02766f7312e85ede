//! Effects of a scenario, and the methods that each of them invalidates.
//!
//! Whoever simulates or estimates by a shortcut asks [`Scenario::obstacles`] what stands in its way: the fast ways of a
//! run, the closed form of a histogram, second opinions, the notes of estimators, the error budget. The table has one
//! row for each effect.

mod key;
mod method;
mod occurrence;
mod table;

use super::model::Scenario;

pub use key::{Key, USUAL};
pub use method::Method;
pub use occurrence::Occurrence;
pub use table::Effect;

impl Effect {
    /// Returns the largest value of the effect's key that leaves a method valid, in the key's unit; `None` if the
    /// effect does not invalidate it at all.
    pub fn limit(self, method: Method) -> Option<f64> {
        let row = self.row();
        let own = || row.breaks.iter().any(|methods| methods.contains(&method)).then_some(0.0);
        let (limit, methods) = row.above;
        let above = || methods.contains(&method).then_some(limit);
        let below = || self.limit(method.foundation()?);
        own().or_else(above).or_else(below)
    }

    /// Whether the effect, if it is large enough, invalidates a method.
    pub fn breaks(self, method: Method) -> bool {
        self.limit(method).is_some()
    }

    /// Returns what the effect is, as a sentence.
    pub fn meaning(self) -> &'static str {
        self.row().meaning.trim_ascii()
    }

    /// Returns the keys that switch the effect on.
    pub fn keys(self) -> &'static [Key] {
        self.row().keys
    }

    /// Returns the reason why the effect invalidates methods, as a clause.
    pub fn why(self) -> &'static str {
        self.row().why
    }

    /// Returns settings of keys that show the effect, as of `-s`; a file is one that its reader has to lay there.
    pub fn example(self) -> &'static [&'static str] {
        self.row().example
    }

    /// Returns the first of the effect's keys that does not have its usual value, if the scenario has the effect.
    pub fn occurrence(self, scenario: &Scenario) -> Option<Occurrence> {
        let key = self.keys().iter().find(|key| !key.is_usual(scenario))?;
        (self.row().when)(scenario).then(|| Occurrence::new(self, key, scenario))
    }

    /// Sets the effect's keys to their usual values.
    pub fn switch_off(self, scenario: &mut Scenario) {
        self.keys().iter().for_each(|key| key.set_usual(scenario));
    }
}

impl Scenario {
    /// Returns the effects of the scenario that invalidate a method, in the table's order.
    pub fn obstacles(&self, method: Method) -> impl Iterator<Item = Occurrence> {
        Effect::ALL.into_iter().filter_map(move |effect| {
            let limit = effect.limit(method)?;
            if (effect.row().spares)(self).contains(&method) {
                return None;
            }
            Some(effect.occurrence(self)?.within(limit)).filter(Occurrence::is_beyond)
        })
    }

    /// Returns the effect by which the light of a shot is not one echo of the laser's pulse, if it is not.
    pub fn complex_scene(&self) -> Option<Occurrence> {
        let more = [Effect::SecondTarget, Effect::Cover];
        self.extended_scene().or_else(|| more.into_iter().find_map(|one| one.occurrence(self)))
    }

    /// Returns the effect by which light has other ways than along the axis, if it has.
    pub fn extended_scene(&self) -> Option<Occurrence> {
        [Effect::Target, Effect::Air].into_iter().find_map(|effect| effect.occurrence(self))
    }
}

#[cfg(test)]
mod tests;
