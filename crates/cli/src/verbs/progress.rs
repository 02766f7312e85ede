//! Progress of a long task: a bar on a terminal, and a line every ten seconds elsewhere.

use std::fmt::Write;
use std::io::{IsTerminal, stderr};
use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::mpsc::{RecvTimeoutError, Sender, channel};
use std::sync::{Arc, Mutex, PoisonError};
use std::thread::{self, JoinHandle};
use std::time::{Duration, Instant};

use indicatif::{ProgressBar, ProgressDrawTarget, ProgressState, ProgressStyle};

use tofsim::error::tell;

use crate::text::table::grouped;

use super::host::{HearProgress, host};

/// Time between two lines.
const EVERY: Duration = Duration::from_secs(10);
/// Time between two pictures of the bar.
const TICK: Duration = Duration::from_millis(200);

/// Display of a task's progress.
pub struct Progress {
    meter: Arc<Meter>,
    shown: Shown,
}

enum Shown {
    Nowhere,
    /// Callback of the program around the verb.
    Callback(HearProgress),
    Bar(ProgressBar),
    Lines(Ticker),
}

impl Progress {
    /// Over `count` of `things`, or in percent alone if they have no name.
    pub fn new(count: u64, things: &'static str, is_quiet: bool) -> Progress {
        Progress::of(Meter::new(count, things), is_quiet)
    }

    /// Creates a display over items that differ in length, without an estimate of the remaining time.
    pub fn uneven(count: u64, things: &'static str, is_quiet: bool) -> Progress {
        Progress::of(Meter { is_even: false, ..Meter::new(count, things) }, is_quiet)
    }

    fn of(meter: Meter, is_quiet: bool) -> Progress {
        let count = meter.all;
        let meter = Arc::new(meter);
        if let Some(host) = host() {
            return Progress { meter, shown: Shown::Callback(host.progress) };
        }
        let shown = match (is_quiet || count < 2, stderr().is_terminal()) {
            (true, _) => Shown::Nowhere,
            (_, true) => Shown::Bar(bar(&meter)),
            (_, false) => Shown::Lines(Ticker::new(&meter, EVERY, tell)),
        };
        Progress { meter, shown }
    }

    /// Adds finished items.
    pub fn inc(&self, more: u64) {
        self.meter.done.fetch_add(more, Ordering::Relaxed);
        self.draw();
    }

    /// Sets the number of finished items.
    pub fn set_position(&self, done: u64) {
        self.meter.done.store(done, Ordering::Relaxed);
        self.draw();
    }

    fn draw(&self) {
        let done = self.meter.done.load(Ordering::Relaxed);
        match &self.shown {
            Shown::Bar(bar) => bar.set_position(done),
            Shown::Callback(hear) => hear(done, self.meter.all),
            _ => {}
        }
    }

    /// Restarts the estimate of the remaining time.
    pub fn reset_eta(&self) {
        self.meter.begin();
    }

    /// Does something that prints.
    pub fn suspend(&self, print: impl FnOnce()) {
        match &self.shown {
            Shown::Bar(bar) => bar.suspend(print),
            _ => print(),
        }
    }

    /// Shows nothing more.
    pub fn finish_and_clear(&self) {
        match &self.shown {
            Shown::Nowhere | Shown::Callback(_) => {}
            Shown::Bar(bar) => bar.finish_and_clear(),
            Shown::Lines(ticker) => ticker.end(),
        }
    }
}

/// A bar as wide as the terminal lets it be.
fn bar(meter: &Arc<Meter>) -> ProgressBar {
    let bar = ProgressBar::with_draw_target(Some(meter.all), ProgressDrawTarget::stderr());
    let meter = Arc::clone(meter);
    let text = move |_: &ProgressState, out: &mut dyn Write| {
        // It is written into memory.
        let _ = out.write_str(&meter.text());
    };
    if let Ok(style) = ProgressStyle::with_template("{wide_bar} {text}") {
        bar.set_style(style.with_key("text", text));
    }
    bar.enable_steady_tick(TICK);
    bar
}

/// Finished items, and the time since they are counted.
struct Meter {
    all: u64,
    things: &'static str,
    done: AtomicU64,
    /// When it began, and how much was done then.
    begun: Mutex<(Instant, u64)>,
    /// Whether all items take about the same time, so that the remaining time can be estimated.
    is_even: bool,
}

impl Meter {
    fn new(all: u64, things: &'static str) -> Meter {
        let begun = Mutex::new((Instant::now(), 0));
        Meter { all, things, done: AtomicU64::new(0), begun, is_even: true }
    }

    fn begin(&self) {
        let now = (Instant::now(), self.done.load(Ordering::Relaxed));
        *self.begun.lock().unwrap_or_else(PoisonError::into_inner) = now;
    }

    /// Such as `12 %, 1,234 of 10,200 rows, 3 min to go`.
    fn text(&self) -> String {
        let (begun, before) = *self.begun.lock().unwrap_or_else(PoisonError::into_inner);
        let done = self.done.load(Ordering::Relaxed).min(self.all);
        let share = done as f64 / self.all.max(1) as f64;
        let mut text = match self.things {
            "" => format!("{:.1} %", 100.0 * share),
            things => format!(
                "{:.0} %, {} of {} {things}",
                100.0 * share,
                grouped(done),
                grouped(self.all)
            ),
        };
        if let Some(new) = done.checked_sub(before).filter(|new| self.is_even && *new > 0) {
            let left = begun.elapsed().as_secs_f64() * (self.all - done) as f64 / new as f64;
            text += &format!(", {} to go", rough(left));
        }
        text
    }
}

/// A time as people say it.
fn rough(seconds: f64) -> String {
    match seconds {
        ..90.0 => format!("{seconds:.0} s"),
        ..5400.0 => format!("{:.0} min", seconds / 60.0),
        ..172_800.0 => format!("{:.1} h", seconds / 3600.0),
        _ => format!("{:.0} days", seconds / 86_400.0),
    }
}

/// A thread that says how far it is, until it is told to end.
struct Ticker(Mutex<Option<(Sender<()>, JoinHandle<()>)>>);

impl Ticker {
    fn new(meter: &Arc<Meter>, every: Duration, say: impl Fn(String) + Send + 'static) -> Ticker {
        let (end, ended) = channel();
        let meter = Arc::clone(meter);
        let work = move || {
            while ended.recv_timeout(every) == Err(RecvTimeoutError::Timeout) {
                say(meter.text());
            }
        };
        Ticker(Mutex::new(Some((end, thread::spawn(work)))))
    }

    fn end(&self) {
        let thread = self.0.lock().unwrap_or_else(PoisonError::into_inner).take();
        if let Some((end, thread)) = thread {
            drop(end);
            drop(thread.join());
        }
    }
}

impl Drop for Ticker {
    fn drop(&mut self) {
        self.end();
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_meter_says_how_much_is_done_and_what_is_left() {
        let meter = Meter::new(2_000, "rows");
        assert_eq!(meter.text(), "0 %, 0 of 2,000 rows");
        meter.done.store(1_500, Ordering::Relaxed);
        assert_eq!(meter.text(), "75 %, 1,500 of 2,000 rows, 0 s to go");
        meter.begin();
        assert_eq!(meter.text(), "75 %, 1,500 of 2,000 rows");
        let uneven = Meter { is_even: false, ..Meter::new(64, "items") };
        uneven.done.store(16, Ordering::Relaxed);
        assert_eq!(uneven.text(), "25 %, 16 of 64 items");
        assert_eq!(Meter::new(138_240_000, "").text(), "0.0 %");
        let times = [4.0, 89.0, 600.0, 7_200.0, 1e6].map(rough);
        assert_eq!(times, ["4 s", "89 s", "10 min", "2.0 h", "12 days"]);
    }

    #[test]
    fn lines_come_at_their_time_until_it_ends() {
        let meter = Arc::new(Meter::new(1 << 40, "frames"));
        let (send, lines) = channel();
        let ticker =
            Ticker::new(&meter, Duration::from_millis(20), move |line| drop(send.send(line)));
        let first = lines.recv_timeout(Duration::from_secs(60)).unwrap();
        assert!(first.starts_with("0 %, 0 of 1,099,511,627,776 frames"), "{first}");
        lines.recv_timeout(Duration::from_secs(60)).unwrap();
        ticker.end();
        lines.try_iter().for_each(drop);
        assert!(lines.recv_timeout(Duration::from_millis(100)).is_err(), "it has ended");
    }
}
