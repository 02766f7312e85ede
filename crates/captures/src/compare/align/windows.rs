//! Alignment of each window of a capture alone, by best agreement.

use tofsim::error::{Input, Result};

use super::super::plan::Plan;
use super::super::selection::Piece;
use super::alignment::Alignment;
use super::correlation::{Search, decide, search};
use super::survey::survey;

/// An offset for each window, in the order of time.
pub(super) fn alignment(plan: &Plan, signals: &[String]) -> Result<Alignment> {
    let Some(side) = plan.capture() else {
        let expected = "windows: expected a capture on one side and a waveform on the other";
        return Err(Input::new("--align", expected).into());
    };
    let mut pieces = [Vec::new(), Vec::new()];
    let (mut found, mut from) = (Vec::new(), 0);
    for (k, window) in survey(plan.sources[side])?.windows.iter().enumerate() {
        let piece = Piece::Run(window.first, window.count);
        let look = Search { side, piece: piece.clone(), overhangs: false, from };
        let (best, text) = decide(&search(plan, signals, &look)?, side, &format!("window {k}"))?;
        found.push(format!("window {k}: {text}"));
        let begin = best.offset.unsigned_abs();
        from = begin + window.count.unwrap_or(1);
        pieces[side].push(piece);
        pieces[1 - side].push(Piece::Run(begin, window.count));
    }
    Ok(Alignment { pieces, found: found.join("\n"), offset: None, differences: Vec::new() })
}
