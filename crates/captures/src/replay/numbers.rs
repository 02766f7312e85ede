//! Numbering of shots by frame and position in the frame.

/// State of the numbering.
#[derive(Default)]
pub(super) struct Numbers {
    /// Number of shots in previous frames.
    before: u64,
    /// Number of shots in this frame.
    count: u64,
    /// Whether the capture shows the start of this frame.
    whole: bool,
    /// Whether the capture shows the start of any frame.
    pub(super) begun: bool,
    /// Shots per frame, if the capture shows it.
    pub(super) per_frame: Option<u64>,
    /// Shots per frame, if the capture does not show it.
    usual: u64,
    /// Whether a window begins, so that the previous state is unknown.
    pub(super) across: bool,
}

impl Numbers {
    /// Creates a numbering with `usual` shots per frame, unless the capture shows their number.
    pub(super) fn new(usual: u64) -> Self {
        Numbers { usual, ..Numbers::default() }
    }

    /// Processes the state of the frame, with its shot count.
    pub(super) fn frame(&mut self, counted: Option<u64>, acquires: bool, acquired: bool) {
        let starts_anew = counted.is_some_and(|counted| counted < self.count);
        if acquired && !acquires && (self.whole || counted.is_some()) {
            self.per_frame = counted.or(Some(self.count)).filter(|&count| count > 0);
        }
        if starts_anew && !self.across {
            self.per_frame = self.per_frame.or(Some(self.count));
        }
        if starts_anew || (counted.is_none() && acquires && !acquired) {
            let whole = self.per_frame.unwrap_or(self.usual);
            let shots = if self.across { whole } else { self.count };
            (self.before, self.count) = (self.before + shots, 0);
            (self.whole, self.begun) = (acquires && !acquired, true);
        }
        if acquires && !acquired {
            (self.whole, self.begun) = (true, true);
        }
        self.count = counted.unwrap_or(self.count);
        self.across = false;
    }

    /// Returns the number of a shot that begins.
    pub(super) fn start(&mut self, counted: Option<u64>) -> u64 {
        let number = self.before + self.count;
        if counted.is_none() {
            self.count += 1;
        }
        number
    }
}
