//! Which samples a logic analyser stores, and where: its trigger, windows and qualification.

/// The shape of a capture.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Shape {
    /// Samples of a window, at least 1.
    pub depth: usize,
    /// Windows, at least 1.
    pub windows: usize,
    /// Samples of a window before the one that triggers, less than `depth`.
    pub position: usize,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum State {
    /// Stores what is to stand before a trigger, which is not looked for yet.
    Filling,
    /// Looks for a trigger.
    Waiting,
    /// Stores what stands behind the trigger.
    Triggered,
    /// All windows have their samples.
    Full,
}

/// Where a sample goes in the buffer.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Stored {
    /// Place, counted over all windows. It is the first free one or an older sample's.
    pub slot: usize,
    /// Whether this sample triggered.
    pub triggered: bool,
}

/// What the buffer holds of a window.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Window {
    /// Place of its first sample, if none were out of turn.
    pub begin: usize,
    /// Samples before the trigger, or all if there was none.
    pub before: usize,
    /// How far the samples before the trigger are out of turn: the oldest stands so many places
    /// after `begin`.
    pub turn: usize,
    /// Samples from the trigger on; 0 if there was none.
    pub after: usize,
}

/// Decides, sample by sample, what a logic analyser stores.
///
/// A window first fills with `position` samples, then waits for a trigger while it keeps the last
/// `position`, then stores until it has `depth`; the next begins with the very next sample. Only
/// samples that qualify are stored, and the one that triggers. Its memory does not grow but by a
/// word for each window.
#[derive(Clone, Debug)]
pub struct Storing {
    shape: Shape,
    state: State,
    /// Samples stored in the present window before its trigger.
    before: usize,
    /// Place of the next of them.
    next: usize,
    /// Samples stored from the trigger on.
    after: usize,
    /// Turn of each full window.
    full: Vec<usize>,
}

impl Storing {
    /// An empty buffer.
    pub fn new(shape: Shape) -> Self {
        let (state, full) = (State::Waiting, Vec::new());
        let mut storing = Storing { shape, state, before: 0, next: 0, after: 0, full };
        storing.begin();
        storing
    }

    fn begin(&mut self) {
        (self.before, self.next, self.after) = (0, 0, 0);
        self.state = match self.shape.position {
            _ if self.full.len() == self.shape.windows => State::Full,
            0 => State::Waiting,
            _ => State::Filling,
        };
    }

    /// Whether all windows have their samples.
    #[inline]
    pub fn is_full(&self) -> bool {
        self.state == State::Full
    }

    /// Whether a trigger, now or later, can still matter: not behind that of the last window.
    #[inline]
    pub fn looks_for_triggers(&self) -> bool {
        self.triggered() < self.shape.windows
    }

    /// Takes a sample; returns where it goes, if it is stored.
    #[inline]
    pub fn sample(&mut self, triggers: bool, qualifies: bool) -> Option<Stored> {
        match self.state {
            State::Waiting if triggers => Some(self.follow(true)),
            State::Triggered if qualifies => Some(self.follow(false)),
            State::Filling | State::Waiting if qualifies && self.shape.position > 0 => {
                Some(self.lead())
            }
            _ => None,
        }
    }

    /// Stores a sample before the trigger.
    #[inline]
    fn lead(&mut self) -> Stored {
        let slot = self.full.len() * self.shape.depth + self.next;
        self.next = if self.next + 1 == self.shape.position { 0 } else { self.next + 1 };
        if self.state == State::Filling {
            self.before += 1;
            if self.before == self.shape.position {
                self.state = State::Waiting;
            }
        }
        Stored { slot, triggered: false }
    }

    /// Stores the trigger's sample or one behind it.
    #[inline]
    fn follow(&mut self, triggered: bool) -> Stored {
        let Shape { depth, position, .. } = self.shape;
        let slot = self.full.len() * depth + position + self.after;
        self.state = State::Triggered;
        self.after += 1;
        if position + self.after == depth {
            self.full.push(self.next);
            self.begin();
        }
        Stored { slot, triggered }
    }

    /// What the buffer holds: the full windows, then the one under way if it has a sample. Stopped
    /// before its trigger, that one is what is there to stand before a trigger.
    pub fn windows(&self) -> Vec<Window> {
        let Shape { depth, position, .. } = self.shape;
        let full = self.full.iter().enumerate().map(|(window, &turn)| Window {
            begin: window * depth,
            before: position,
            turn,
            after: depth - position,
        });
        let turn = if self.state == State::Filling { 0 } else { self.next };
        let begin = self.full.len() * depth;
        let partial = Window { begin, before: self.before, turn, after: self.after };
        full.chain((self.before + self.after > 0).then_some(partial)).collect()
    }

    /// Windows that have triggered.
    pub fn triggered(&self) -> usize {
        self.full.len() + usize::from(self.after > 0)
    }
}
