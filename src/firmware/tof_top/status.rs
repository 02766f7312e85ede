//! Status of an estimate: the reasons to reject a depth.

use std::fmt::{self, Display};

use serde::{Serialize, Serializer};

use crate::kernel::U;

/// Status word: each bit a reason to reject the depth (see [`Status`]).
pub type StatusBits = U<7>;

macro_rules! statuses {
    ($($(#[doc = $meaning:literal])+ $Name:ident = $word:literal,)+) => {
        /// A reason to reject a depth.
        #[derive(Clone, Copy, Debug, PartialEq, Eq)]
        pub enum Status {
            $($(#[doc = $meaning])+ $Name,)+
        }

        impl Status {
            /// Every reason, in the order of its bits.
            pub const ALL: &[Self] = &[$(Self::$Name),+];

            /// Returns its name in results and messages.
            pub fn word(self) -> &'static str {
                match self {
                    $(Self::$Name => $word,)+
                }
            }

            /// Returns its meaning.
            pub fn meaning(self) -> &'static str {
                match self {
                    $(Self::$Name => concat!($($meaning),+).trim_ascii(),)+
                }
            }
        }
    };
}

statuses! {
    /// Nothing stands out of the background, or not far enough.
    NoEcho = "no echo",
    /// The begin or the end of the window cuts the pulse.
    CutOff = "cut off by the window",
    /// No shots were left when the echo came.
    UsedUp = "shots used up",
    /// Something else stands out too.
    Another = "another echo",
    /// The last step of the iteration was a long one.
    NotSettled = "not settled",
    /// The histogram is not what the model makes.
    NoFit = "no fit",
    /// Some shots were not armed at the laser edge (MODE 1).
    Unarmed = "shots not armed",
    /// The histogram is empty.
    NoHits = "no hits",
    /// The histogram holds more hits than it can have.
    TooManyHits = "too many hits",
    /// Nothing stands out of the background.
    NoPeak = "no peak",
    /// Several peaks stand out, and nothing tells which is the echo.
    SeveralPeaks = "several peaks",
    /// There is no dark histogram to subtract.
    NoDarkFrame = "no dark frame",
    /// The iteration did not converge.
    NoConvergence = "no convergence",
    /// The estimator's model does not hold for the instrument.
    OutsideModel = "outside its model",
}

impl Status {
    /// Its bit; those of the firmware's status word are the first seven.
    pub const fn bit(self) -> u16 {
        1 << self as u16
    }
}

/// A set of reasons to reject a depth; empty if there is none.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub struct StatusSet(u16);

impl StatusSet {
    /// The reasons whose bits are set.
    pub const fn of_bits(bits: u16) -> Self {
        StatusSet(bits)
    }

    /// The reasons that hold.
    pub fn of(reasons: &[(bool, Status)]) -> Self {
        let holding = reasons.iter().filter(|(holds, _)| *holds);
        StatusSet(holding.map(|(_, status)| status.bit()).sum())
    }

    /// Their bits.
    pub const fn bits(self) -> u16 {
        self.0
    }

    /// Whether there is no reason.
    pub const fn is_empty(self) -> bool {
        self.0 == 0
    }

    /// Whether a reason is among them.
    pub const fn contains(self, status: Status) -> bool {
        self.0 & status.bit() != 0
    }

    /// These reasons and one more.
    pub const fn with(self, status: Status) -> Self {
        StatusSet(self.0 | status.bit())
    }

    /// These reasons but one.
    pub const fn without(self, status: Status) -> Self {
        StatusSet(self.0 & !status.bit())
    }

    /// The words of the reasons.
    pub fn words(self) -> Vec<&'static str> {
        let held = Status::ALL.iter().filter(|&&status| self.contains(status));
        held.map(|status| status.word()).collect()
    }
}

impl From<Status> for StatusSet {
    fn from(status: Status) -> Self {
        StatusSet(status.bit())
    }
}

impl From<StatusBits> for StatusSet {
    fn from(bits: StatusBits) -> Self {
        StatusSet(bits.get() as u16)
    }
}

impl Display for StatusSet {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        f.write_str(&self.words().join(", "))
    }
}

impl Serialize for StatusSet {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        self.words().serialize(serializer)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_bits_of_the_firmware_are_those_of_the_model() {
        let model = include_str!("../../../docs/model.md");
        let firmware = Status::ALL.iter().filter(|status| status.bit() < 1 << 7);
        assert_eq!(firmware.clone().count(), 7);
        for status in firmware {
            let row = format!("\n| {} {} | ", status.bit(), status.word());
            assert!(model.contains(&row), "{row}");
        }
    }

    #[test]
    fn every_status_has_a_bit_and_a_word_of_its_own() {
        let all = StatusSet::of(&Status::ALL.iter().map(|&one| (true, one)).collect::<Vec<_>>());
        let mut words = all.words();
        assert_eq!((words.len(), all.bits()), (14, (1 << 14) - 1));
        words.sort_unstable();
        words.dedup();
        assert_eq!(words.len(), 14);
        assert_eq!(StatusSet::from(Status::NoFit).to_string(), "no fit");
    }
}
