//! Photon lists: CSV files with the arrival times of explicit photons.
//!
//! Columns are `shot` (since power-up, from 0) and `arrival_ps` (from the laser edge, with up to three decimals), in
//! ascending order. Lines that begin with `#` are comments, which should state the seed and the origin of the list.

use crate::error::Result;
use crate::files::csv::CsvInput;
use crate::kernel::Time;

/// The photons of one run.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct PhotonList {
    rows: Vec<(u64, Time)>,
}

impl PhotonList {
    /// Parses a list. Errors name it as `source`.
    ///
    /// # Errors
    /// If a row is invalid or out of order.
    pub fn parse(source: &str, text: &str) -> Result<Self> {
        let mut input = CsvInput::new(source, text, &["shot", "arrival_ps"])?;
        let mut rows: Vec<(u64, Time)> = Vec::new();
        while input.advance()? {
            let Some(shot) = input.field::<u64>(0) else {
                return Err(input.fault(0, "expected a whole number from 0").into());
            };
            let arrival = match input.field::<f64>(1) {
                Some(ps) if (0.0..=MAX_PS).contains(&ps) => Time::from_ps_f64(ps),
                _ => return Err(input.fault(1, "expected a time from 0 to 1e9 [ps]").into()),
            };
            if rows.last().is_some_and(|last| last.0 > shot) {
                return Err(input.fault(0, "expected rows in order of shots").into());
            }
            if rows.last().is_some_and(|last| *last > (shot, arrival)) {
                let expected = "expected the photons of a shot in order of time";
                return Err(input.fault(1, expected).into());
            }
            rows.push((shot, arrival));
        }
        Ok(PhotonList { rows })
    }

    /// Returns the photons of a shot, with their times from its laser edge, in order.
    pub fn of_shot(&self, shot: u64) -> &[(u64, Time)] {
        let rows = self.from_shot(shot);
        &rows[..rows.partition_point(|row| row.0 <= shot)]
    }

    /// Returns the photons of a shot and of all later shots.
    pub fn from_shot(&self, shot: u64) -> &[(u64, Time)] {
        &self.rows[self.rows.partition_point(|row| row.0 < shot)..]
    }
}

/// Latest arrival, 1 ms [ps].
const MAX_PS: f64 = 1e9;

/// Photons of a list, played back during the run.
#[derive(Clone, Debug)]
pub struct Given {
    list: PhotonList,
    /// Number of shots that have begun.
    shots: u64,
    /// Outstanding photons of shots that have begun, latest first.
    pending: Vec<Time>,
}

impl Given {
    /// Creates the playback of a list.
    pub fn new(list: PhotonList) -> Self {
        Given { list, shots: 0, pending: Vec::new() }
    }

    /// Begins a shot at `now`, which adds its photons.
    pub fn begin_shot(&mut self, now: Time) {
        let photons = self.list.of_shot(self.shots).iter();
        self.pending.extend(photons.map(|(_, arrival)| now.saturating_add(*arrival)));
        self.pending.sort_by(|a, b| b.cmp(a));
        self.shots += 1;
    }

    /// Returns the time of the first photon at or after `now`, and discards earlier ones.
    pub fn next_photon(&mut self, now: Time) -> Time {
        while self.pending.last().is_some_and(|&photon| photon < now) {
            self.pending.pop();
        }
        self.pending.last().copied().unwrap_or(Time::NEVER)
    }

    /// Returns the number of photons in shots that have not begun.
    pub fn left(&self) -> usize {
        self.list.from_shot(self.shots).len()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn photons_are_found_by_shot() {
        let text = "# seed: 4\nshot,arrival_ps\n0,2000\n2,0.5\n2,3000\n";
        let list = PhotonList::parse("p.csv", text).unwrap();
        assert_eq!(list.of_shot(0), [(0, Time::from_ns(2))]);
        assert!(list.of_shot(1).is_empty());
        assert_eq!(list.of_shot(2), [(2, Time::from_fs(500)), (2, Time::from_ns(3))]);
    }

    #[test]
    fn photons_of_an_old_shot_may_come_after_those_of_the_new() {
        let list = PhotonList::parse("p", "shot,arrival_ps\n0,1000\n0,60000\n1,2000\n").unwrap();
        let mut given = Given::new(list);
        given.begin_shot(Time::from_ns(100));
        assert_eq!(given.next_photon(Time::from_ns(100)), Time::from_ns(101));
        assert_eq!(given.next_photon(Time::from_ns(102)), Time::from_ns(160));
        given.begin_shot(Time::from_ns(148));
        assert_eq!(given.next_photon(Time::from_ns(148)), Time::from_ns(150));
        assert_eq!(given.next_photon(Time::from_ns(151)), Time::from_ns(160));
        assert_eq!(given.next_photon(Time::from_ns(161)), Time::NEVER);
    }

    #[test]
    fn faults_name_line_column_and_field() {
        let error = |text: &str| PhotonList::parse("p.csv", text).unwrap_err().to_string();
        let rows = |rows: &str| error(&format!("shot,arrival_ps\n{rows}"));
        assert_eq!(rows("3,-1"), "p.csv:2:3: arrival_ps = -1: expected a time from 0 to 1e9 [ps]");
        assert!(rows("1,10\n0,10").starts_with("p.csv:3:1: shot = 0: expected rows in order"));
        assert!(rows("1,10\n1,9").contains("p.csv:3:3: arrival_ps = 9: expected the photons"));
        assert!(rows("x,10").contains("shot = x"));
        assert!(rows("1,NaN").contains("arrival_ps = NaN"));
        assert!(rows("1,2,3").contains("has 3 fields, expected 2"));
        assert!(error("shot;arrival\n").contains("expected the header"));
        assert!(error("# nothing\n").contains("empty"));
    }
}
