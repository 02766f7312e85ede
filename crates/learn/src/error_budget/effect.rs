//! The effects that a depth may be wrong by, and sets of them.

use tofsim::scenario::effects::{Effect as ScenarioEffect, Method};

/// Declares the effects, their list, keys, names, and those of the scenario's table that they are.
macro_rules! effects {
    ($($(#[$meta:meta])* $effect:ident: $key:literal, $name:literal $(, $own:expr)?;)*) => {
        /// An effect that can be switched off.
        #[derive(Clone, Copy, Debug, PartialEq, Eq)]
        pub enum Effect {
            $($(#[$meta])* $effect,)*
        }

        impl Effect {
            /// All effects, in the order in which a photon comes through them.
            pub const ALL: [Effect; [$($key),*].len()] = [$(Effect::$effect),*];

            /// Returns the effect's name for programs.
            pub fn key(self) -> &'static str {
                match self {
                    $(Effect::$effect => $key,)*
                }
            }

            /// Returns the effect's name for people.
            pub fn name(self) -> &'static str {
                match self {
                    $(Effect::$effect => $name,)*
                }
            }

            /// Returns the effect of the scenario's table that it is, if it is one; its keys switch it off.
            pub fn of_scenario(self) -> Option<ScenarioEffect> {
                let own: &[ScenarioEffect] = match self {
                    $(Effect::$effect => &[$($own)?],)*
                };
                own.first().copied()
            }
        }
    };
}

effects! {
    /// Counts scatter around what is to be expected.
    ShotNoise: "shot_noise", "shot noise";
    /// A shot counts its first avalanche and no other.
    PileUp: "pile_up", "pile-up";
    /// Avalanches of light that is not the laser's.
    Ambient: "ambient", "ambient light";
    /// Avalanches of no light at all.
    DarkCounts: "dark_counts", "dark counts";
    /// Light that a cover window sends back.
    Cover: "cover", "cover", ScenarioEffect::Cover;
    /// Light from a second surface.
    SecondTarget: "second_target", "second target", ScenarioEffect::SecondTarget;
    /// The pulse is longer than half a bin.
    PulseWidth: "pulse_width", "pulse width";
    /// The pulse has an exponential tail.
    PulseTail: "pulse_tail", "pulse tail", ScenarioEffect::PulseTail;
    /// Pulses leave the laser early or late.
    LaserTiming: "laser_timing", "laser timing", ScenarioEffect::LaserTiming;
    /// Pulses differ in energy.
    LaserEnergy: "laser_energy", "laser energy", ScenarioEffect::LaserEnergy;
    /// Avalanches of carriers that earlier ones left in traps.
    Afterpulses: "afterpulses", "afterpulses", ScenarioEffect::Afterpulses;
    /// The diode comes back by itself, after its dead time (MODE 1).
    DeadTime: "dead_time", "dead time", ScenarioEffect::FreeRunning;
    /// An avalanche sets off a neighbour.
    Crosstalk: "crosstalk", "crosstalk", ScenarioEffect::Crosstalk;
    /// Edges of the clocks are early or late.
    PllJitter: "pll_jitter", "PLL jitter", ScenarioEffect::ClockJitter;
    /// A code begins where a tap does, and not where a bin ought to.
    Taps: "taps", "tap width";
    /// Taps differ in width.
    UnevenTaps: "dnl", "DNL";
    /// The decoder's ROM does not hold the chain's own delays.
    Calibration: "calibration", "TDC calibration";
    /// Times are told apart by bins only.
    BinWidth: "bin_width", "bin width";
    /// The chain's delays have changed with temperature or supply since the calibration.
    Drift: "drift", "drift";
    /// The estimator computes with words of a few bits.
    FixedPoint: "fixed_point", "fixed point";
    /// The network's activation is looked up in a table.
    Table: "table", "tansig table";
}

impl Effect {
    /// Whether it makes shots depend on each other, so that histograms have no closed form. Crosstalk is never switched
    /// off.
    pub fn joins_shots(self) -> bool {
        let own = self.of_scenario().filter(|_| self != Effect::Crosstalk);
        own.is_some_and(|own| own.breaks(Method::IndependentShots))
    }
}

/// The effects that are on.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord)]
pub struct EffectSet(u32);

impl EffectSet {
    /// Returns the set of the given effects.
    pub fn of(effects: impl IntoIterator<Item = Effect>) -> Self {
        effects.into_iter().fold(EffectSet::default(), EffectSet::with)
    }

    /// Whether one is on.
    pub fn has(self, effect: Effect) -> bool {
        self.0 & 1 << effect as u32 != 0
    }

    /// With one more.
    pub fn with(self, effect: Effect) -> Self {
        EffectSet(self.0 | 1 << effect as u32)
    }

    /// Without one.
    pub fn without(self, effect: Effect) -> Self {
        EffectSet(self.0 & !(1 << effect as u32))
    }

    /// Returns the effects for which `keep` holds.
    pub fn filter(self, keep: impl Fn(Effect) -> bool) -> Self {
        EffectSet::of(Effect::ALL.into_iter().filter(|&effect| self.has(effect) && keep(effect)))
    }

    /// Whether one of them makes shots depend on each other.
    pub fn joins_shots(self) -> bool {
        Effect::ALL.into_iter().any(|effect| self.has(effect) && effect.joins_shots())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_effect_has_a_place_and_a_key_of_its_own() {
        let all = EffectSet::of(Effect::ALL);
        for effect in Effect::ALL {
            assert!(all.has(effect) && !all.without(effect).has(effect));
            assert_eq!(all.without(effect).with(effect), all);
            assert_eq!(Effect::ALL.iter().filter(|one| one.key() == effect.key()).count(), 1);
        }
        assert!(all.joins_shots() && !all.filter(|one| !one.joins_shots()).joins_shots());
    }
}
