//! Consecutive frames, with or without the laser.

use std::sync::atomic::AtomicBool;

use tofsim::error::{Input, Result};
use tofsim::sim::frames::Frame;
use tofsim::sim::setup::Setup;
use tofsim::{Note, NoteCode};

use crate::board::Board;
use crate::control::LaserState;

/// Checks that the firmware alone can take the frames of a scenario.
///
/// # Errors
/// When they need control signals that change, or none would end.
pub fn check_frames(setup: &Setup) -> Result<()> {
    let firmware = &setup.scenario.firmware;
    let fault = |field: &str, value: String, expected: &str| {
        let fault = Input::new(format!("scenario {}", setup.name), expected);
        Err(fault.field(field).value(value).into())
    };
    if firmware.dark_frames {
        let expected = "expected false: a board does not alternate laser_en between its frames";
        return fault("firmware.dark_frames", true.to_string(), expected);
    }
    if !setup.scenario.control.is_empty() {
        let expected = "expected none: a board's control signals are constant during its frames";
        return fault("control", format!("{} changes", setup.scenario.control.len()), expected);
    }
    let held = [("dsp_en", firmware.dsp_en, true), ("dsp_rst", firmware.dsp_rst, false)];
    for (pin, value, needed) in held.into_iter().chain([("rst", firmware.rst, false)]) {
        if value != needed {
            let expected = format!("expected {needed}: no frame ends");
            return fault(&format!("firmware.{pin}"), value.to_string(), &expected);
        }
    }
    Ok(())
}

/// Returns the note that frames without the laser are dark; `option` is what arms it.
pub fn dark_note(option: &str, laser: bool) -> Option<Note> {
    let text = "the laser is not armed: frames are dark";
    (!laser).then(|| Note::new(NoteCode::NoLight, option, false, "true", text))
}

impl Board {
    /// Takes frames of a setup from 0 on, with the laser armed or not, and gives each to `take` with the state of the
    /// laser after it, until there are `count` or `take` fails. The laser is off afterwards.
    ///
    /// # Errors
    /// When the board does not answer, no shots are taken any more, or a frame has been missed; when `take` fails, and
    /// when `stop` is set.
    pub fn take_frames(
        &mut self,
        setup: &Setup,
        laser: bool,
        count: u64,
        stop: Option<&AtomicBool>,
        take: &mut dyn FnMut(&Frame, LaserState) -> Result<()>,
    ) -> Result<()> {
        let taken = self.start(setup, laser).and_then(|mut before| {
            (0..count).try_for_each(|index| {
                let frame = self.next_frame(setup, (index, before), stop)?;
                before = before.wrapping_add(1);
                let state = self.laser_state()?;
                take(&frame, state)?;
                self.keep_alive()
            })
        });
        let off = self.laser_off();
        taken.and(off)
    }

    /// Lets frames begin, and returns the number before the first one.
    fn start(&mut self, setup: &Setup, laser: bool) -> Result<u32> {
        self.prepare(setup, laser)?;
        let before = self.begin_frames()?;
        if laser {
            self.arm()?;
        }
        self.release()?;
        Ok(before)
    }
}
