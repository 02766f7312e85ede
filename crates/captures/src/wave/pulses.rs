//! Pulses and edges of a single bit.

/// Widths of the pulses of one level, each between two edges.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Pulses {
    /// Number of pulses.
    pub count: u64,
    /// Width of the shortest one, in units of the source.
    pub shortest: u64,
    /// Width of the longest one.
    pub longest: u64,
    /// Sum of all widths.
    pub total: u128,
}

impl Pulses {
    /// Returns the mean width, if there is a pulse; `unit` is the length of a unit of the source.
    pub fn mean(&self, unit: f64) -> Option<f64> {
        (self.count > 0).then(|| self.total as f64 * unit / self.count as f64)
    }

    fn add(&mut self, width: u64) {
        self.shortest = if self.count == 0 { width } else { self.shortest.min(width) };
        self.longest = self.longest.max(width);
        self.count += 1;
        self.total += u128::from(width);
    }
}

/// Edges of a single bit, from level to level: an unknown level between two levels is no edge.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) struct Edges {
    /// Pulses of both levels, low ones first.
    pub(super) pulses: [Pulses; 2],
    level: Option<bool>,
    /// Time of the edge to the present level.
    edge: Option<u64>,
    rises: u64,
    first_rise: u64,
    last_rise: u64,
    /// Whether the signal was unknown since its first rise.
    is_broken: bool,
}

impl Edges {
    /// Adds a change to a level, or to unknown.
    pub(super) fn change(&mut self, at: u64, level: Option<bool>) {
        let before = std::mem::replace(&mut self.level, level);
        let (Some(before), Some(level)) = (before, level) else {
            self.edge = None;
            self.is_broken |= self.rises > 0;
            return;
        };
        if before == level {
            return;
        }
        if let Some(edge) = self.edge.replace(at) {
            self.pulses[usize::from(before)].add(at - edge);
        }
        if level {
            self.first_rise = if self.rises == 0 { at } else { self.first_rise };
            self.last_rise = at;
            self.rises += 1;
        }
    }

    /// Returns the mean time from one rising edge to the next, if there are two and the signal was known throughout.
    pub(super) fn period(&self) -> Option<f64> {
        let span = (self.last_rise - self.first_rise) as f64;
        (self.rises > 1 && !self.is_broken).then(|| span / (self.rises - 1) as f64)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn edges(changes: &[(u64, Option<bool>)]) -> Edges {
        let mut edges = Edges::default();
        changes.iter().for_each(|&(at, level)| edges.change(at, level));
        edges
    }

    #[test]
    fn pulses_are_between_two_edges() {
        let (low, high) = (Some(false), Some(true));
        let found = edges(&[(0, low), (10, high), (13, low), (20, high), (30, low), (50, high)]);
        let [lows, highs] = found.pulses;
        assert_eq!(highs, Pulses { count: 2, shortest: 3, longest: 10, total: 13 });
        assert_eq!(lows, Pulses { count: 2, shortest: 7, longest: 20, total: 27 });
        assert_eq!((highs.mean(1.0), found.period()), (Some(6.5), Some(20.0)));
    }

    #[test]
    fn an_unknown_level_ends_a_pulse_without_a_width_and_the_frequency() {
        let (low, high) = (Some(false), Some(true));
        let found = edges(&[(0, low), (10, high), (13, None), (20, low), (30, high), (50, low)]);
        assert_eq!(found.pulses[1], Pulses { count: 1, shortest: 20, longest: 20, total: 20 });
        assert_eq!((found.pulses[0].mean(1.0), found.period()), (None, None));
        assert_eq!(edges(&[(0, high), (5, low), (9, high)]).period(), None);
    }
}
