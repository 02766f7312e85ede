//! Observes a run and calls back with its transactions.

use crate::error::Result;
use crate::firmware::tof_top::{HistogramSource, Params};
use crate::kernel::Time;
use crate::optics::hazard::Cause;
use crate::sim::callback::Callback;
use crate::sim::device::{AvalancheListener, Device};
use crate::sim::estimates::Estimate;
use crate::sim::frames::Frames;
use crate::sim::shot_recorder::ShotListener;

use super::conversions::Conversions;
use super::counts::Counts;
use super::edge::{BegunShots, EdgeState, Numbers};
use super::photons::Photons;
use super::{Content, Estimation, Origin, Stream, Transaction};

/// Follows a run from the laser edge to the depth.
#[derive(Clone, Debug, Default)]
struct TransactionRecorder {
    numbers: Numbers,
    shots: BegunShots,
    /// The shot whose window is open, and whether it has been seen so.
    shot: Option<(Transaction, bool)>,
    /// The driver's `enable`, as the coming shot takes it.
    laser_en: bool,
    photons: Photons,
    conversions: Conversions,
    counts: Counts,
    estimation: Option<BegunEstimation>,
    last_edge: Time,
    /// Transactions that have ended, in order.
    complete: Vec<Transaction>,
}

/// An estimation under way.
#[derive(Clone, Debug)]
struct BegunEstimation {
    id: u64,
    begin: Time,
    frame: u64,
    /// Numbers of the counts in its histogram.
    counts: Vec<u64>,
}

impl TransactionRecorder {
    /// Follows an edge.
    fn edge(&mut self, edge: &EdgeState, device: &Device) {
        let top = edge.top;
        while let Some(avalanche) = self.photons.coming.take_before(edge.now) {
            self.photons.begin(avalanche, edge.frame, self.shots.last(), &mut self.numbers);
        }
        self.follow_shot(edge);
        while let Some(avalanche) = self.photons.coming.take_at(edge.now) {
            self.photons.begin(avalanche, edge.frame, self.shots.last(), &mut self.numbers);
        }
        let wire = (&device.transitions, top.pins.tdc_stop);
        self.photons.end(edge.now, wire, &mut self.complete);
        let (numbers, complete) = (&mut self.numbers, &mut self.complete);
        let known = (&self.shots, &self.photons);
        self.counts.take(self.conversions.edge(edge, known, numbers, complete));
        self.counts.edge(edge, numbers, complete);
        self.follow_estimation(edge);
        if top.frame_ctrl.clear && top.frame_ctrl.clear_addr == 0 {
            self.begin_frame(edge.now);
        }
        self.last_edge = edge.now;
    }

    /// Begins and ends shots.
    fn follow_shot(&mut self, edge: &EdgeState) {
        let driver = &edge.top.vcsel_driver.registers;
        let window = edge.top.tdc.coarse_counter.window;
        if let Some((_, was_open)) = &mut self.shot {
            let closes = *was_open && !window;
            *was_open |= window;
            if closes {
                self.end_shot(edge.now);
            }
        }
        if driver.pre_start {
            self.laser_en = driver.enable;
        }
        if driver.start {
            self.end_shot(edge.now);
            let id = self.numbers.next();
            let shot = self.shots.begin(id, edge);
            let content = Content::Shot { laser_en: self.laser_en };
            let transaction = Transaction {
                id,
                begin: edge.now,
                end: edge.now,
                frame: edge.frame,
                shot: Some(shot.shot),
                origin: None,
                content,
            };
            self.shot = Some((transaction, false));
        }
    }

    fn end_shot(&mut self, end: Time) {
        if let Some((shot, _)) = self.shot.take() {
            self.complete.push(Transaction { end, ..shot });
        }
    }

    fn follow_estimation(&mut self, edge: &EdgeState) {
        let (top, p) = (edge.top, edge.p);
        if top.slot.algo_done
            && let Some(BegunEstimation { id, begin, frame, counts }) = self.estimation.take()
        {
            let hits = match &p.histogram_source {
                HistogramSource::Builder => counts.len() as u64,
                HistogramSource::Preload(rom) => rom.iter().map(|word| word.get()).sum(),
            };
            let estimate = Estimate::of_words(p.estimator, &top.slot.words);
            let origin = counts.first().map(|&id| Origin { stream: Stream::Count, id });
            let content = Content::Estimation(Box::new(Estimation { estimate, hits, counts }));
            let (end, shot) = (edge.now, None);
            self.complete.push(Transaction { id, begin, end, frame, shot, origin, content });
        }
        if top.frame_ctrl.algo_start {
            let (id, counts) = (self.numbers.next(), self.counts.take_histogram());
            let estimation = BegunEstimation { id, begin: edge.next, frame: edge.frame, counts };
            self.estimation = Some(estimation);
        }
    }

    /// Begins a frame, and gives up what is left of an abandoned one.
    fn begin_frame(&mut self, now: Time) {
        self.end_shot(now);
        self.conversions.finish(&mut self.complete);
        self.counts.take_histogram();
        self.shots = BegunShots::default();
    }

    /// Ends the run at `end`.
    fn finish(&mut self, end: Time) {
        self.begin_frame(end);
        self.photons.finish(end, &mut self.complete);
    }
}

/// Calls back with each transaction once it has ended.
pub(crate) struct TransactionRecording<'a> {
    recorder: TransactionRecorder,
    take: Callback<'a, Transaction>,
}

impl<'a> TransactionRecording<'a> {
    /// Calls `take` with every transaction from power-up on.
    pub(crate) fn new(take: Callback<'a, Transaction>) -> Self {
        TransactionRecording { recorder: TransactionRecorder::default(), take }
    }

    /// Hands on the transactions that have not ended by `end`, that of the run.
    ///
    /// # Errors
    /// When the callback fails.
    pub(crate) fn finish(mut self, end: Time) -> Result<()> {
        self.recorder.finish(end);
        self.hand_on()
    }

    fn hand_on(&mut self) -> Result<()> {
        self.recorder.complete.drain(..).try_for_each(|transaction| (self.take)(&transaction))
    }
}

impl AvalancheListener for TransactionRecording<'_> {
    const ON: bool = true;

    fn avalanche(&mut self, at: Time, cause: Option<Cause>) {
        self.recorder.photons.coming.push(at, cause);
    }
}

impl ShotListener for TransactionRecording<'_> {
    fn after_edge(&mut self, device: &mut Device, frames: &Frames, p: &Params) -> Result<()> {
        let ((cycle, now), next) = (device.last_edge(), device.next_edge());
        let (before, frame, top) = (self.recorder.last_edge, frames.done(), &device.top);
        let edge = EdgeState { cycle, now, before, next, frame, top, p };
        self.recorder.edge(&edge, device);
        self.hand_on()
    }
}
