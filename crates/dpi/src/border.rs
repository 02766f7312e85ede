//! The exported C functions. Each accepts any argument: invalid ones become an error of the handle, or of null if
//! there is none.
#![allow(unsafe_code, reason = "strings and vectors of C are read here")]

use std::ffi::{CStr, c_char, c_int, c_longlong, c_void};

use tofsim::sim::photons::Shown;

use crate::checker::Checker;
use crate::held::{What, delete, errors, make, with};
use crate::photons::Source;
use crate::told::{self, check_version};

/// Returns the text of a C string.
///
/// # Safety
/// The pointer is null, or the string ends with a zero.
unsafe fn text<'a>(what: &str, string: *const c_char) -> Result<&'a str, String> {
    if string.is_null() {
        return Err(format!("{what} is null"));
    }
    // SAFETY: see above.
    let string = unsafe { CStr::from_ptr(string) };
    string.to_str().map_err(|_| format!("{what} is not UTF-8: {}", string.to_string_lossy()))
}

/// Returns a bit vector, least significant word first.
///
/// # Safety
/// The pointer is null, or the vector has `count` words.
unsafe fn vector<'a>(what: &str, words: *const u32, count: usize) -> Result<&'a [u32], String> {
    match (count, words.is_null()) {
        (0, _) => Ok(&[]),
        (_, true) => Err(format!("{what} are null")),
        // SAFETY: see above.
        _ => Ok(unsafe { std::slice::from_raw_parts(words, count) }),
    }
}

/// The version of this library, such as "0.1.0".
#[unsafe(no_mangle)]
pub extern "C" fn tofsim_version() -> *const c_char {
    concat!(env!("CARGO_PKG_VERSION"), "\0").as_ptr().cast()
}

/// A block of the model at power-up, for `tofsim_step`; null if there is none, and `tofsim_get_error(null, n)` says why.
/// `version` is that of whoever calls, `scenario` the name or path of a scenario, with a line for each KEY=VALUE that
/// it is to have besides, and `block` the name of a module of rtl_ref.
///
/// # Safety
/// The strings are null or end with a zero.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn tofsim_new(
    version: *const c_char,
    scenario: *const c_char,
    block: *const c_char,
) -> *mut c_void {
    let handle = make("tofsim_new", || {
        // SAFETY: as of this function.
        let [version, scenario, block] = unsafe {
            [text("version", version)?, text("scenario", scenario)?, text("block", block)?]
        };
        check_version(version)?;
        Ok(What::Checker(Box::new(Checker::new(scenario, block)?)))
    });
    handle as *mut c_void
}

/// Whether a port of the bench's has as many bits as the block's; 1 or 0, and an error.
///
/// # Safety
/// The string is null or ends with a zero.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn tofsim_port(
    handle: *mut c_void,
    name: *const c_char,
    bits: c_int,
) -> c_int {
    with("tofsim_port", handle as usize, 0, |held| {
        // SAFETY: as of this function.
        let name = unsafe { text("name", name)? };
        held.checker()?.check_port(name, bits).map(|()| 1)
    })
}

/// Compares from power-up on. Without this, outputs are compared after the first reset, or where a block has none
/// once its registers have taken their first values.
#[unsafe(no_mangle)]
pub extern "C" fn tofsim_from_power_up(handle: *mut c_void) {
    with("tofsim_from_power_up", handle as usize, (), |held| {
        held.checker()?.block.settle();
        Ok(())
    });
}

/// `tdc_stop` has changed to `level`.
#[unsafe(no_mangle)]
pub extern "C" fn tofsim_stop(handle: *mut c_void, time_fs: c_longlong, level: c_int) {
    with("tofsim_stop", handle as usize, (), |held| {
        let now = told::instant(time_fs)?;
        held.checker()?.block.stop(now, level != 0);
        Ok(())
    });
}

/// Bits of the outputs of the coming `tofsim_step` that are neither 0 nor 1: they differ from any. A simulator that has
/// no others need not call it.
///
/// # Safety
/// The vector is null or as long as the block's outputs.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn tofsim_unknown(handle: *mut c_void, bits: *const u32) {
    with("tofsim_unknown", handle as usize, (), |held| {
        let checker = held.checker()?;
        let [_, words] = checker.block.layouts().map(|layout| layout.words());
        // SAFETY: as of this function.
        checker.unknown = unsafe { vector("bits", bits, words)? }.to_vec();
        Ok(())
    });
}

/// Compares a block's outputs with those of the model just before an edge, and takes the edge; 1 if they agree, or 0,
/// and an error for each that does not. `what` is 0 for a look without an edge, 1 for an edge of the block's clock
/// (of both clocks, where it has two), 2 for one of clk_laser alone, and 3 for its fall. `inputs` and `outputs` are all
/// ports but the clocks, in the order of the module, the first in the highest bits.
///
/// # Safety
/// The vectors are null or as long as the block's.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn tofsim_step(
    handle: *mut c_void,
    what: c_int,
    time_fs: c_longlong,
    inputs: *const u32,
    outputs: *const u32,
) -> c_int {
    with("tofsim_step", handle as usize, 0, |held| {
        let [in_words, out_words] = held.checker()?.block.layouts().map(|layout| layout.words());
        // SAFETY: as of this function.
        let lines = unsafe {
            [vector("inputs", inputs, in_words)?, vector("outputs", outputs, out_words)?]
        };
        let found = held.checker()?.step(what, time_fs, lines)?;
        found.iter().for_each(|sentence| held.say(sentence));
        Ok(found.is_empty().into())
    })
}

/// The outputs that the model has with those inputs, before an edge; 1, or 0 and an error.
///
/// # Safety
/// As of `tofsim_step`.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn tofsim_outputs(
    handle: *mut c_void,
    time_fs: c_longlong,
    inputs: *const u32,
    outputs: *mut u32,
) -> c_int {
    with("tofsim_outputs", handle as usize, 0, |held| {
        let block = &mut held.checker()?.block;
        let [in_words, out_words] = block.layouts().map(|layout| layout.words());
        // SAFETY: as of this function.
        let inputs = unsafe { vector("inputs", inputs, in_words)? };
        let now = told::instant(time_fs)?;
        let words = block.outputs(now, inputs).map_err(|error| error.to_string())?;
        if outputs.is_null() {
            return Err("outputs are null".to_owned());
        }
        // SAFETY: as of this function.
        unsafe { std::ptr::copy_nonoverlapping(words.as_ptr(), outputs, out_words) };
        Ok(1)
    })
}

/// Errors of a handle since the last `tofsim_clear_errors`; of null those of what could not be made.
#[unsafe(no_mangle)]
pub extern "C" fn tofsim_get_num_errors(handle: *mut c_void) -> c_int {
    errors(handle as usize, |errors| c_int::try_from(errors.len()).unwrap_or(c_int::MAX))
}

/// One of them, from 0 on; empty if there are not so many. It is there until they are cleared.
#[unsafe(no_mangle)]
pub extern "C" fn tofsim_get_error(handle: *mut c_void, number: c_int) -> *const c_char {
    errors(handle as usize, |errors| {
        let found = usize::try_from(number).ok().and_then(|number| errors.get(number));
        found.map_or(c"".as_ptr(), |error| error.as_ptr())
    })
}

/// Forgets the errors of a handle.
#[unsafe(no_mangle)]
pub extern "C" fn tofsim_clear_errors(handle: *mut c_void) {
    errors(handle as usize, Vec::clear);
}

/// Takes a block or a source of photons back.
#[unsafe(no_mangle)]
pub extern "C" fn tofsim_delete(handle: *mut c_void) {
    delete(handle as usize);
}

/// The light of a scenario and its detector, from power-up; null if there is none, as `tofsim_new`.
///
/// # Safety
/// As of `tofsim_new`.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn tofsim_photons_new(
    version: *const c_char,
    scenario: *const c_char,
) -> *mut c_void {
    let handle = make("tofsim_photons_new", || {
        // SAFETY: as of this function.
        let [version, scenario] =
            unsafe { [text("version", version)?, text("scenario", scenario)?] };
        check_version(version)?;
        Ok(What::Photons(Box::new(Source::new(scenario)?)))
    });
    handle as *mut c_void
}

/// An edge of clk_sys, and what the firmware shows after it: a shot begins, the laser has been switched on by it, the
/// SPAD is held, MODE, tdc_stop is to come from the ring oscillator, a frame has ended.
#[unsafe(no_mangle)]
pub extern "C" fn tofsim_photons_edge(
    handle: *mut c_void,
    time_fs: c_longlong,
    start: c_int,
    laser: c_int,
    spad_rst: c_int,
    mode: c_int,
    ring_on: c_int,
    frame_done: c_int,
) {
    let [start, laser, spad_rst, mode, ring_on, frame_done] =
        [start, laser, spad_rst, mode, ring_on, frame_done].map(|level| level != 0);
    with("tofsim_photons_edge", handle as usize, (), |held| {
        let shown = Shown { start, laser, spad_rst, mode, ring_on, frame_done };
        held.photons()?.edge(time_fs, shown)
    });
}

/// When `tdc_stop` changes next before the coming edge or on it [fs], or -1; it has its new level then.
#[unsafe(no_mangle)]
pub extern "C" fn tofsim_photons_next(handle: *mut c_void) -> c_longlong {
    with("tofsim_photons_next", handle as usize, -1, |held| Ok(held.photons()?.next_change()))
}

/// The level of `tdc_stop`.
#[unsafe(no_mangle)]
pub extern "C" fn tofsim_photons_level(handle: *mut c_void) -> c_int {
    with("tofsim_photons_level", handle as usize, 0, |held| Ok(held.photons()?.level().into()))
}
