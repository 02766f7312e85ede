//! Which shot of a run is which, by its frame and its place in that.

/// Numbers the shots.
#[derive(Default)]
pub(super) struct Numbers {
    /// Shots of the frames before.
    before: u64,
    /// Shots of this frame.
    count: u64,
    /// Whether the capture shows the begin of this frame.
    whole: bool,
    /// Whether it shows the begin of any.
    pub(super) begun: bool,
    /// Shots of a frame, if it shows them.
    pub(super) per_frame: Option<u64>,
    /// Shots of a frame, where the capture does not show how many it has.
    usual: u64,
    /// Whether a window begins, so that it is not known what was before.
    pub(super) across: bool,
}

impl Numbers {
    /// Of frames that have `usual` shots, where the capture does not show how many.
    pub(super) fn new(usual: u64) -> Self {
        Numbers { usual, ..Numbers::default() }
    }

    /// Looks at the frame, of which so many shots are counted.
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

    /// The number of a shot that begins.
    pub(super) fn start(&mut self, counted: Option<u64>) -> u64 {
        let number = self.before + self.count;
        if counted.is_none() {
            self.count += 1;
        }
        number
    }
}
