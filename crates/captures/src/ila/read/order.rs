//! Check of the sequence of samples: numbers, windows, triggers.

/// State of the sequence so far.
#[derive(Debug, Default)]
pub(super) struct Order {
    /// Number of the last sample in the buffer and in its window.
    last: Option<(u64, u64)>,
    /// Samples per window, once a complete window has been read.
    depth: Option<u64>,
    whole: bool,
    triggered: bool,
}

/// Index of the fixed column at fault, and what was expected.
pub(super) type OrderFault = (usize, String);

impl Order {
    /// Checks the next sample; returns true if a window begins with it.
    pub(super) fn check(
        &mut self,
        sample: u64,
        in_window: u64,
        trigger: bool,
    ) -> Result<bool, OrderFault> {
        let starts = match self.last {
            None => {
                self.whole = in_window == 0;
                if in_window > sample {
                    return Err((
                        1,
                        format!("expected {sample} at most, the sample in the buffer"),
                    ));
                }
                true
            }
            Some((before, place)) => {
                let (Some(next), Some(following)) = (before.checked_add(1), place.checked_add(1))
                else {
                    return Err((0, "expected no more samples".into()));
                };
                if sample != next {
                    return Err((0, format!("expected {next}, the sample after {before}")));
                }
                self.follow(following, in_window)?
            }
        };
        self.last = Some((sample, in_window));
        self.triggered &= !starts;
        if trigger && self.triggered {
            return Err((2, "a second trigger in this window".into()));
        }
        self.triggered |= trigger;
        Ok(starts)
    }

    /// Checks the number in the window, which should be `following` unless a window begins; returns true if one does.
    fn follow(&mut self, following: u64, in_window: u64) -> Result<bool, OrderFault> {
        let ends = self.depth == Some(following);
        let goes_on = in_window == following && !ends;
        let begins = in_window == 0 && (ends || self.depth.is_none());
        if begins {
            if self.whole {
                self.depth = Some(following);
            }
            self.whole = true;
        }
        match self.depth {
            _ if goes_on || begins => Ok(begins),
            None => Err((1, format!("expected {following}, or 0 where a window begins"))),
            Some(depth) => {
                let next = if ends { 0 } else { following };
                Err((1, format!("expected {next}: windows have {depth} samples here")))
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Checks rows given as number in window and trigger; numbers in the buffer count from 0.
    fn check(rows: &[(u64, bool)]) -> Result<Vec<bool>, (usize, OrderFault)> {
        let mut order = Order::default();
        let row = |(row, &(in_window, trigger)): (usize, &(u64, bool))| {
            order.check(row as u64, in_window, trigger).map_err(|fault| (row, fault))
        };
        rows.iter().enumerate().map(row).collect()
    }

    #[test]
    fn windows_of_equal_depth_pass_and_the_last_may_be_partial() {
        let rows = [(0, true), (1, false), (0, false), (1, true), (0, true)];
        assert_eq!(check(&rows), Ok(vec![true, false, true, false, true]));
        let single = [(0, true); 3];
        assert_eq!(check(&single), Ok(vec![true; 3]));
    }

    #[test]
    fn a_window_that_begins_early_or_late_is_a_fault() {
        let early = [0, 1, 2, 0, 1, 0].map(|place| (place, false));
        let fault = (5, (1, "expected 2: windows have 3 samples here".into()));
        assert_eq!(check(&early), Err(fault));
        let late = [0, 1, 0, 1, 2].map(|place| (place, false));
        assert_eq!(check(&late), Err((4, (1, "expected 0: windows have 2 samples here".into()))));
        let jump = [0, 2].map(|place| (place, false));
        assert_eq!(check(&jump), Err((1, (1, "expected 1, or 0 where a window begins".into()))));
    }

    #[test]
    fn a_second_trigger_in_a_window_is_a_fault() {
        let rows = [(0, true), (1, true)];
        assert_eq!(check(&rows), Err((1, (2, "a second trigger in this window".into()))));
    }

    #[test]
    fn samples_that_do_not_count_up_are_a_fault() {
        let mut order = Order::default();
        assert_eq!(order.check(4, 3, false), Ok(true));
        let fault = order.check(4, 4, false).unwrap_err();
        assert_eq!(fault, (0, "expected 5, the sample after 4".into()));
        let fault = Order::default().check(u64::MAX, 1, false);
        assert_eq!(fault, Ok(true));
        assert_eq!(Order::default().check(1, 2, false).unwrap_err().0, 1);
    }

    #[test]
    fn a_first_window_cut_off_in_front_tells_no_depth() {
        let mut order = Order::default();
        for (sample, in_window, starts) in
            [(6, 2, true), (7, 0, true), (8, 1, false), (9, 2, false)]
        {
            assert_eq!(order.check(sample, in_window, false), Ok(starts));
        }
    }
}
