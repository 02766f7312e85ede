//! Shortest edit script between two sequences (Myers 1986, greedy), in bounded memory.

/// Largest number of edits; the stored points take two bytes times its square.
pub(super) const MOST_EDITS: usize = 4096;
/// Value of a point outside of the sequences.
const NOWHERE: i32 = -1;

/// Condition for the end of a script.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum End {
    /// The end of both sequences.
    Both,
    /// The end of the first sequence; the rest of the second is not an edit.
    First,
    /// The end of either sequence.
    Either,
}

/// Equal items of two sequences, and the number of edits.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub(super) struct Script {
    /// Positions of equal items in both sequences, ascending.
    pub(super) same: Vec<(usize, usize)>,
    /// Number of items of each sequence that the script covers.
    pub(super) taken: [usize; 2],
    pub(super) edits: usize,
    /// Whether the script reached its end within the largest number of edits.
    pub(super) is_whole: bool,
}

/// Furthest points in the first sequence, for each number of edits and diagonal.
struct Points {
    /// Lengths of both sequences.
    lengths: [i64; 2],
    /// For each number of edits `d`, the points on the diagonals -d, 2 - d .. d.
    rows: Vec<Vec<i32>>,
}

impl Points {
    fn at(&self, d: i64, k: i64) -> Option<i64> {
        let inside = d >= 0 && k.abs() <= d;
        let x = inside.then(|| self.rows[d as usize][((k + d) / 2) as usize])?;
        (x != NOWHERE).then_some(x.into())
    }

    /// Returns the point at which the `d`-th edit enters diagonal `k`, and the diagonal from which it comes.
    fn entry(&self, d: i64, k: i64) -> Option<(i64, i64)> {
        if d == 0 {
            return Some((0, 0));
        }
        let [n, m] = self.lengths;
        let left = self.at(d - 1, k - 1).map(|x| x + 1).filter(|&x| x <= n);
        let up = self.at(d - 1, k + 1).filter(|x| x - k <= m);
        match (left, up) {
            (Some(left), Some(up)) if up > left => Some((up, k + 1)),
            (Some(left), _) => Some((left, k - 1)),
            (None, Some(up)) => Some((up, k + 1)),
            (None, None) => None,
        }
    }

    /// Traces a script back from the point of `d` edits on diagonal `k`.
    fn trace(&self, d: i64, k: i64, is_whole: bool) -> Script {
        let (mut same, mut on) = (Vec::new(), k);
        let last = self.at(d, k).unwrap_or(0);
        for edits in (0..=d).rev() {
            let Some((entered, from)) = self.entry(edits, on) else { break };
            let end = self.at(edits, on).unwrap_or(entered);
            same.extend((entered..end).rev().map(|x| (x as usize, (x - on) as usize)));
            on = from;
        }
        same.reverse();
        let taken = [last as usize, (last - k) as usize];
        Script { same, taken, edits: d as usize, is_whole }
    }
}

/// Computes the shortest script from `a` to `b`, or the part that [`MOST_EDITS`] edits cover.
pub(super) fn script(a: &[u32], b: &[u32], end: End) -> Script {
    let [n, m] = [a.len() as i64, b.len() as i64];
    let mut points = Points { lengths: [n, m], rows: Vec::new() };
    let mut furthest = (0, 0, 0);
    for d in 0..=MOST_EDITS as i64 {
        let mut row = Vec::with_capacity(d as usize + 1);
        let mut found = None;
        for k in (-d..=d).step_by(2) {
            let Some((mut x, _)) = points.entry(d, k) else {
                row.push(NOWHERE);
                continue;
            };
            while x < n && x - k < m && a[x as usize] == b[(x - k) as usize] {
                x += 1;
            }
            row.push(x as i32);
            let y = x - k;
            furthest = furthest.max((x + y, d, k));
            let ends = [x == n, y == m];
            let is_end = match end {
                End::Both => ends == [true, true],
                End::First => ends[0],
                End::Either => ends[0] || ends[1],
            };
            if is_end && found.is_none() {
                found = Some(k);
            }
        }
        points.rows.push(row);
        if let Some(k) = found {
            return points.trace(d, k, true);
        }
    }
    points.trace(furthest.1, furthest.2, false)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_shortest_script_keeps_what_both_have() {
        let found = script(&[1, 2, 3, 4, 5], &[1, 3, 4, 9, 5], End::Both);
        assert_eq!(found.same, [(0, 0), (2, 1), (3, 2), (4, 4)]);
        assert_eq!((found.edits, found.taken, found.is_whole), (2, [5, 5], true));
        assert_eq!(script(&[], &[], End::Both).edits, 0);
        assert_eq!(script(&[], &[1, 2], End::Both).edits, 2);
        assert_eq!(script(&[1, 2], &[], End::Both).taken, [2, 0]);
    }

    #[test]
    fn what_is_left_behind_an_end_that_is_free_is_no_edit() {
        let found = script(&[1, 2, 3], &[1, 3, 7, 8, 9], End::First);
        assert_eq!((found.same.len(), found.edits, found.taken), (2, 1, [3, 2]));
        let found = script(&[1, 2, 3, 4], &[1, 2], End::Either);
        assert_eq!((found.edits, found.taken), (0, [2, 2]));
    }

    #[test]
    fn too_many_edits_end_it_where_it_got_to() {
        let (a, b) = (vec![1; 3000], vec![2; 3000]);
        let found = script(&a, &b, End::Both);
        assert!(!found.is_whole && found.same.is_empty());
        assert_eq!(found.taken.iter().sum::<usize>(), MOST_EDITS);
    }

    #[test]
    fn random_edits_are_found_in_no_more_steps_than_were_made() {
        let mut seed = 1u64;
        let mut next = |below: u64| {
            seed = seed.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
            (seed >> 33) % below
        };
        for _ in 0..200 {
            let a: Vec<u32> = (0..next(60)).map(|_| next(8) as u32).collect();
            let mut b = a.clone();
            let edits = next(6);
            for _ in 0..edits {
                let place = next(b.len() as u64 + 1) as usize;
                match next(2) {
                    0 if place < b.len() => _ = b.remove(place),
                    _ => b.insert(place, next(8) as u32),
                }
            }
            let found = script(&a, &b, End::Both);
            assert!(found.edits as u64 <= edits, "{a:?} {b:?}");
            assert!(found.same.iter().all(|&(x, y)| a[x] == b[y]));
            assert!(found.same.windows(2).all(|w| w[0].0 < w[1].0 && w[0].1 < w[1].1));
            assert_eq!(a.len() + b.len() - 2 * found.same.len(), found.edits);
        }
    }
}
