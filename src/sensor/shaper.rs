//! Pulse shaper between the SPADs and `tdc_stop`: a monostable that turns each rising edge into a pulse of fixed
//! width.
//!
//! It is not retriggerable: rising edges within a pulse or within the gap after it are lost. It is in front of the
//! FPGA and independent of `spad_rst`, which clears the SPADs: a pulse ends by itself. Without a width the pulse
//! follows the SPADs' output, and only the gap applies.

use crate::kernel::Time;

/// Pulse width and gap.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Params {
    /// Width of the pulse; `None`: the pulse follows the SPADs' output.
    pub width: Option<Time>,
    /// Time after a pulse during which the output cannot rise again.
    pub gap: Time,
}

/// The monostable.
#[derive(Clone, Debug)]
pub struct Shaper {
    params: Params,
    /// Output of the SPADs.
    input: bool,
    level: bool,
    /// End of the present pulse.
    falls: Time,
    /// End of the gap after the last pulse.
    rests_until: Time,
}

impl Shaper {
    /// Creates an idle shaper.
    pub fn new(params: Params) -> Self {
        let (falls, rests_until) = (Time::NEVER, Time::ZERO);
        Shaper { params, input: false, level: false, falls, rests_until }
    }

    /// Returns the output.
    pub fn level(&self) -> bool {
        self.level
    }

    /// Returns the time at which the output falls by itself.
    pub fn next_event(&self) -> Time {
        self.falls
    }

    /// Processes the event at [`Shaper::next_event`].
    pub fn event(&mut self) {
        self.fall(self.falls);
    }

    /// Sets the SPADs' output from `now` on. A rising edge exactly at the end of the gap is not lost.
    pub fn follow(&mut self, input: bool, now: Time) {
        if self.falls <= now {
            self.event();
        }
        let before = std::mem::replace(&mut self.input, input);
        if input && !before && self.takes(now) {
            self.level = true;
            self.falls = self.params.width.map_or(Time::NEVER, |width| now.saturating_add(width));
        } else if !input && self.level && self.params.width.is_none() {
            self.fall(now);
        }
    }

    /// Returns whether a rising edge at `now` triggers a pulse.
    pub fn takes(&self, now: Time) -> bool {
        if self.level {
            self.falls.saturating_add(self.params.gap) <= now
        } else {
            self.rests_until <= now
        }
    }

    fn fall(&mut self, at: Time) {
        (self.level, self.falls) = (false, Time::NEVER);
        self.rests_until = at.saturating_add(self.params.gap);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn shaper(width_ns: Option<u64>, gap_ns: u64) -> Shaper {
        Shaper::new(Params { width: width_ns.map(Time::from_ns), gap: Time::from_ns(gap_ns) })
    }

    /// Returns the times at which the output changes if the SPADs' output changes at the given times [ns].
    fn changes(mut shaper: Shaper, inputs_ns: &[u64]) -> Vec<u64> {
        let mut inputs = inputs_ns.iter().map(|ns| Time::from_ns(*ns)).peekable();
        let (mut found, mut input) = (Vec::new(), false);
        loop {
            let next = inputs.peek().copied().unwrap_or(Time::NEVER);
            let now = next.min(shaper.next_event());
            if now == Time::NEVER {
                return found;
            }
            let level = shaper.level();
            if next == now {
                input = !input;
                assert!(!input || level || shaper.takes(now) == (now >= shaper.rests_until));
                shaper.follow(input, now);
                inputs.next();
            } else {
                shaper.event();
            }
            if shaper.level() != level {
                found.push(now.fs() / 1_000_000);
            }
        }
    }

    #[test]
    fn each_rise_gives_a_pulse_of_its_width_however_long_the_output_is_high() {
        assert_eq!(changes(shaper(Some(7), 0), &[10, 11, 100, 190]), [10, 17, 100, 107]);
    }

    #[test]
    fn a_rise_within_the_pulse_or_the_gap_is_lost_and_does_not_prolong_them() {
        let within = [10, 11, 12, 13, 20, 21];
        assert_eq!(
            changes(shaper(Some(7), 5), &within),
            [10, 17],
            "at 12 in the pulse, at 20 in the gap"
        );
        assert_eq!(changes(shaper(Some(7), 3), &within), [10, 17, 20, 27], "at the end of the gap");
        assert_eq!(changes(shaper(Some(7), 4), &[10, 11, 20, 60, 70, 80]), [10, 17, 70, 77]);
    }

    #[test]
    fn a_pulse_that_begins_as_the_last_one_ends_joins_it() {
        assert_eq!(changes(shaper(Some(7), 0), &[10, 11, 17, 18]), [10, 24]);
    }

    #[test]
    fn without_a_width_the_output_is_followed_and_only_the_gap_is_left() {
        let inputs = [10, 30, 33, 50, 55, 60];
        assert_eq!(changes(shaper(None, 5), &inputs), [10, 30, 55, 60]);
        assert_eq!(changes(shaper(None, 3), &inputs), inputs);
    }
}
