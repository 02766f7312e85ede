//! The effects that a depth may be wrong by, and sets of them.

/// An effect, which can be off.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Effect {
    /// Counts scatter around what is to be expected.
    ShotNoise,
    /// A shot counts its first avalanche and no other.
    PileUp,
    /// Avalanches of light that is not the laser's.
    Ambient,
    /// Avalanches of no light at all.
    DarkCounts,
    /// The pulse is longer than half a bin.
    PulseWidth,
    /// The pulse has an exponential tail.
    PulseTail,
    /// Pulses leave the laser early or late.
    LaserTiming,
    /// Pulses differ in energy.
    LaserEnergy,
    /// Avalanches of carriers that earlier ones left in traps.
    Afterpulses,
    /// The diode comes back by itself, after its dead time (MODE 1).
    DeadTime,
    /// An avalanche sets off a neighbour.
    Crosstalk,
    /// Edges of the clocks are early or late.
    PllJitter,
    /// A code begins where a tap does, and not where a bin ought to.
    Taps,
    /// Taps differ in width.
    UnevenTaps,
    /// The decoder's ROM does not hold the chain's own delays.
    Calibration,
    /// Times are told apart by bins only.
    BinWidth,
    /// The chain's delays have changed with temperature or supply since the calibration.
    Drift,
    /// The estimator computes with words of a few bits.
    FixedPoint,
    /// The network's activation is looked up in a table.
    Table,
}

impl Effect {
    /// All of them, in the order of a photon's way.
    pub const ALL: [Effect; 19] = [
        Effect::ShotNoise,
        Effect::PileUp,
        Effect::Ambient,
        Effect::DarkCounts,
        Effect::PulseWidth,
        Effect::PulseTail,
        Effect::LaserTiming,
        Effect::LaserEnergy,
        Effect::Afterpulses,
        Effect::DeadTime,
        Effect::Crosstalk,
        Effect::PllJitter,
        Effect::Taps,
        Effect::UnevenTaps,
        Effect::Calibration,
        Effect::BinWidth,
        Effect::Drift,
        Effect::FixedPoint,
        Effect::Table,
    ];

    /// For programs.
    pub fn key(self) -> &'static str {
        match self {
            Effect::ShotNoise => "shot_noise",
            Effect::PileUp => "pile_up",
            Effect::Ambient => "ambient",
            Effect::DarkCounts => "dark_counts",
            Effect::PulseWidth => "pulse_width",
            Effect::PulseTail => "pulse_tail",
            Effect::LaserTiming => "laser_timing",
            Effect::LaserEnergy => "laser_energy",
            Effect::Afterpulses => "afterpulses",
            Effect::DeadTime => "dead_time",
            Effect::Crosstalk => "crosstalk",
            Effect::PllJitter => "pll_jitter",
            Effect::Taps => "taps",
            Effect::UnevenTaps => "dnl",
            Effect::Calibration => "calibration",
            Effect::BinWidth => "bin_width",
            Effect::Drift => "drift",
            Effect::FixedPoint => "fixed_point",
            Effect::Table => "table",
        }
    }

    /// For people.
    pub fn name(self) -> &'static str {
        match self {
            Effect::ShotNoise => "shot noise",
            Effect::PileUp => "pile-up",
            Effect::Ambient => "ambient light",
            Effect::DarkCounts => "dark counts",
            Effect::PulseWidth => "pulse width",
            Effect::PulseTail => "pulse tail",
            Effect::LaserTiming => "laser timing",
            Effect::LaserEnergy => "laser energy",
            Effect::Afterpulses => "afterpulses",
            Effect::DeadTime => "dead time",
            Effect::Crosstalk => "crosstalk",
            Effect::PllJitter => "PLL jitter",
            Effect::Taps => "tap width",
            Effect::UnevenTaps => "DNL",
            Effect::Calibration => "TDC calibration",
            Effect::BinWidth => "bin width",
            Effect::Drift => "drift",
            Effect::FixedPoint => "fixed point",
            Effect::Table => "tansig table",
        }
    }

    /// Whether it makes shots depend on each other, so that histograms have no closed form.
    pub fn joins_shots(self) -> bool {
        matches!(self, Effect::Afterpulses | Effect::DeadTime)
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
