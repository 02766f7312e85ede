//! Comparison of two waveforms at every time at which either changes.

use tofsim::error::{Input, Result};

use crate::source::{Axis, Cursor, Source, Tick};

use super::align::{self, Align};
use super::differences::{Differences, Spot};
use super::pair::Pair;
use super::plan::Plan;
use super::result::Comparison;

/// One side, in the common unit of time.
struct ChangeStream {
    cursor: Cursor,
    tick: Tick,
    coarse: Tick,
    /// Shift to subtract from its times, in the common unit.
    late: i128,
    /// End as the file states it, in ticks.
    end: Option<u64>,
    last: u64,
}

impl ChangeStream {
    /// Opens a side with its own and the common unit of time.
    fn open(
        plan: &Plan,
        side: usize,
        [tick, coarse]: [Tick; 2],
        late: i128,
    ) -> Result<ChangeStream> {
        let cursor = plan.sources[side].read(&plan.matching.slots[side].ids)?;
        Ok(ChangeStream { cursor, tick, coarse, late, end: plan.sources[side].end, last: 0 })
    }

    fn common(&self, at: u64) -> i128 {
        self.tick.convert(at, self.coarse) as i128 - self.late
    }

    fn peek(&mut self) -> Result<Option<i128>> {
        Ok(self.cursor.peek()?.map(|at| self.common(at)))
    }

    /// Reads all changes at a time.
    #[inline]
    fn take(&mut self, now: i128, mut touched: impl FnMut(usize)) -> Result<()> {
        while let Some(at) = self.cursor.peek()?
            && self.common(at) == now
        {
            self.last = at;
            self.cursor.take(&mut touched);
        }
        Ok(())
    }

    /// Returns the end, if it is known so far.
    fn end(&mut self) -> Result<Option<i128>> {
        let last = if self.cursor.peek()?.is_none() { Some(self.last) } else { None };
        Ok(self.end.map(|end| end.max(self.last)).or(last).map(|end| self.common(end)))
    }

    /// Returns the end in ticks; if the file does not state it, reads the remaining changes.
    fn whole(&mut self) -> Result<u64> {
        while self.end.is_none()
            && let Some(at) = self.cursor.peek()?
        {
            self.last = at;
            self.cursor.take(|_| ());
        }
        Ok(self.end.unwrap_or(0).max(self.last))
    }
}

/// Checks that no pair has a latency.
fn check_latencies(pairs: &[Pair]) -> Result<()> {
    let Some(pair) = pairs.iter().find(|pair| pair.latency != 0) else { return Ok(()) };
    let expected = "a latency is in samples; say which clock they are taken by with --clock";
    Err(Input::new("map", expected).field(&pair.name).into())
}

/// Compares until either side ends.
///
/// The last time of a side counts only if both have changes there: a simulator may stop before it has written the
/// changes of its last time step, and tofsim's files end without any.
pub(super) fn compare(
    plan: &Plan,
    align: &Align,
    differences: &mut Differences,
) -> Result<Comparison> {
    check_latencies(&plan.matching.pairs)?;
    let (late_fs, found) = align::shift(plan, align)?;
    let mut result = Comparison::new(plan.sources, "changes", found);
    let ticks = plan.sources.map(tick);
    let coarse = ticks[0].max(ticks[1]);
    let late = |side: usize| if side == 0 { 0 } else { signed(coarse, late_fs) };
    let open = |side: usize| ChangeStream::open(plan, side, [ticks[side], coarse], late(side));
    let mut sides = [open(0)?, open(1)?];
    let times = [plan.terms.after.fs() as u128, plan.terms.until_fs];
    let [from, until] = times.map(|fs| coarse.count_up(fs) as i128);
    let mut begun = from == 0;
    loop {
        let next = [sides[0].peek()?, sides[1].peek()?];
        let Some(now) = next.into_iter().flatten().min().filter(|&now| now < until) else { break };
        let ends = [sides[0].end()?, sides[1].end()?];
        let end = ends.into_iter().flatten().min().unwrap_or(i128::MAX);
        if now > end {
            break;
        }
        let mut changes = [false, false];
        for (side, cursor) in sides.iter_mut().enumerate() {
            cursor.take(now, |signal| {
                changes[side] = true;
                differences.touch(side, signal);
            })?;
        }
        if now < from || (now == end && changes != [true, true]) {
            let before = differences.take_touched();
            differences.end_events(&before);
            continue;
        }
        if !begun {
            begun = true;
            differences.touch_all();
        }
        let touched = differences.take_touched();
        if touched.is_empty() {
            continue;
        }
        let states = [&sides[0].cursor.state, &sides[1].cursor.state];
        let at = |side: usize| {
            let common = (now + late(side)).max(0) as u64;
            coarse.convert(common, ticks[side])
        };
        let spot = Spot { order: result.compared, window: 0, at: [at(0), at(1)] };
        if let Some(both) = &mut differences.both {
            both.at(Axis::Time(coarse), now.max(0) as u64)?;
        }
        differences.compare(&touched, spot, states)?;
        result.compared += 1;
    }
    compare_ends(&mut sides, until, &mut result)?;
    Ok(result)
}

/// Records a difference if the sides end at different times before `until`.
fn compare_ends(sides: &mut [ChangeStream; 2], until: i128, result: &mut Comparison) -> Result<()> {
    let [a, b] = [sides[0].whole()?, sides[1].whole()?];
    if sides[0].common(a).min(until) != sides[1].common(b).min(until) {
        let [a, b] = [result.sides[0].place(a), result.sides[1].place(b)];
        let text = format!("the first side ends at {a}, the second at {b} (--until ends earlier)");
        result.differences.push(text);
    }
    Ok(())
}

fn tick(source: &Source) -> Tick {
    source.axis.tick().unwrap_or(Tick::FEMTOSECOND)
}

/// Converts a time to units of `coarse`, rounded down.
fn signed(coarse: Tick, femtoseconds: i128) -> i128 {
    let size = coarse.count(femtoseconds.unsigned_abs()) as i128;
    if femtoseconds < 0 { -size } else { size }
}
