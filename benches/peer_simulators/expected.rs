//! Photons from tofsim, and the results expected of a peer.

use std::fmt::Write as _;
use std::fs;
use std::path::Path;

use tofsim::sim::Run;
use tofsim::sim::frames::Frame;
use tofsim::sim::run::Observers;
use tofsim::sim::setup::Setup;
use tofsim::sim::shot_recorder::Shot;

use crate::Result;
use crate::run::PeerFrame;

/// Expected result of a frame, which repeats.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Expected {
    /// Depth word of the estimator, 36 bits.
    pub depth: u64,
    /// Number of shots per frame.
    pub shots: u64,
    /// Cycles between the ends of two frames [cycles of clk_sys].
    pub period: u64,
}

impl Expected {
    /// Runs a frame and writes its photons: one line per shot, the time from the laser edge or -1 [fs].
    pub fn of(setup: &Setup, photons: &Path) -> Result<Self> {
        let mut list = String::new();
        let mut frames = Vec::new();
        let mut take_shot = |shot: &Shot| {
            // Writing to a string cannot fail.
            let _ = writeln!(list, "{}", shot.arrival_fs.unwrap_or(-1));
            Ok(())
        };
        let mut take_frame = |frame: &Frame| {
            frames.push(frame.clone());
            Ok(())
        };
        let watch = Observers {
            shots: Some(&mut take_shot),
            frames: Some(&mut take_frame),
            ..Observers::default()
        };
        Run::new(setup).observe(1, watch)?;
        let frame = frames.first().ok_or("tofsim gave no frame")?;
        if list.lines().count() as u64 != frame.shots {
            return Err("tofsim gave another number of shots than the frame has".into());
        }
        fs::write(photons, &list)?;
        let (depth, shots) = (frame.words.depth.bits(), frame.shots);
        Ok(Expected { depth, shots, period: frame.frame_cycles + 1 })
    }

    /// Checks a peer's frames, from the first after power-up.
    pub fn check(&self, frames: &[PeerFrame]) -> Result<()> {
        if frames.is_empty() {
            return Err("no frame came".into());
        }
        for (index, frame) in frames.iter().enumerate() {
            let ends = (index as u64 + 1) * self.period;
            for (what, got, due) in [
                ("depth", frame.depth, self.depth),
                ("shots", frame.shots, self.shots),
                ("edge of its end", frame.edge, ends),
            ] {
                if got != due {
                    return Err(format!("frame {index}: {what} {got:#x}, not {due:#x}").into());
                }
            }
        }
        Ok(())
    }
}
