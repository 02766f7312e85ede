//! Shards of a sweep.

use std::fmt;
use std::str::FromStr;

/// Largest number of shards of a sweep.
const MOST: u64 = 1_000_000;

/// Every `count`-th point of a sweep, starting with the `index`-th.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Shard {
    /// Number of the shard, from 1.
    pub index: u64,
    /// Number of shards.
    pub count: u64,
}

impl Shard {
    /// The whole sweep.
    pub const WHOLE: Shard = Shard { index: 1, count: 1 };

    /// Returns the numbers of its points, for a sweep of `of` points.
    pub fn points(self, of: u64) -> impl Iterator<Item = u64> + Clone {
        (self.index - 1..of).step_by(self.count as usize)
    }

    /// Returns the number of its points, for a sweep of `of` points.
    pub fn size(self, of: u64) -> u64 {
        of.saturating_sub(self.index - 1).div_ceil(self.count)
    }

    /// Returns the stem of its file names.
    pub fn stem(self) -> String {
        match self {
            Shard::WHOLE => "sweep".to_owned(),
            Shard { index, count } => {
                let width = count.to_string().len();
                format!("shard-{index:0width$}-of-{count}")
            }
        }
    }
}

impl fmt::Display for Shard {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}/{}", self.index, self.count)
    }
}

impl FromStr for Shard {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let parts = text.split_once('/').and_then(|(index, count)| {
            Some(Shard { index: index.parse().ok()?, count: count.parse().ok()? })
        });
        let is_one =
            |shard: &Shard| shard.count <= MOST && (1..=shard.count).contains(&shard.index);
        parts.filter(is_one).ok_or_else(|| {
            format!("expected I/N with I from 1 to N and N up to {MOST}, such as 3/7")
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn shards_share_the_points_out() {
        let shard = |index| Shard { index, count: 3 };
        assert_eq!(shard(1).points(8).collect::<Vec<_>>(), [0, 3, 6]);
        assert_eq!(shard(3).points(8).collect::<Vec<_>>(), [2, 5]);
        for (shard, of) in
            [(shard(1), 8), (shard(2), 8), (shard(3), 8), (shard(3), 2), (Shard::WHOLE, 5)]
        {
            assert_eq!(shard.size(of), shard.points(of).count() as u64);
        }
    }

    #[test]
    fn a_shard_is_said_as_it_is_read() {
        let shard: Shard = "3/17".parse().unwrap();
        assert_eq!((shard.to_string().as_str(), shard.stem().as_str()), ("3/17", "shard-03-of-17"));
        for text in ["0/7", "8/7", "3", "a/b", "1/0", "1/10000000", "-1/7"] {
            assert!(text.parse::<Shard>().unwrap_err().contains("such as 3/7"), "{text}");
        }
    }
}
