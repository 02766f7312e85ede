//! The exported C functions. Each accepts any argument: invalid ones become an error of the handle, or of null if
//! there is none.
#![allow(unsafe_code, reason = "strings and vectors of C are read here")]

use std::ffi::{CStr, c_char, c_int, c_longlong, c_void};

use tofsim::sim::photons::Shown;

use crate::arguments::check_version;
use crate::checker::Checker;
use crate::objects::{ObjectKind, compared, delete, errors, make, with};
use crate::photons::Source;

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

/// Returns the version of this library, such as "0.1.0".
#[unsafe(no_mangle)]
pub extern "C" fn tofsim_version() -> *const c_char {
    concat!(env!("CARGO_PKG_VERSION"), "\0").as_ptr().cast()
}

/// Creates a block of the model at power-up, for `tofsim_step`. Returns null if that fails; `tofsim_get_error(null,
/// n)` then returns the reason. `version` is the version of the caller's header, `scenario` the name or path of a
/// scenario, followed by a line for each KEY=VALUE override, and `block` the name of a module of rtl_ref.
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
        Ok(ObjectKind::Checker(Box::new(Checker::new(scenario, block)?)))
    });
    handle as *mut c_void
}

/// Checks that a port of the design has the width of the block's port. Returns 1, or 0 with an error.
///
/// # Safety
/// The string is null or ends with a zero.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn tofsim_port(
    handle: *mut c_void,
    name: *const c_char,
    bits: c_int,
) -> c_int {
    with("tofsim_port", handle as usize, 0, |object| {
        // SAFETY: as of this function.
        let name = unsafe { text("name", name)? };
        object.checker()?.check_port(name, bits).map(|()| 1)
    })
}

/// Enables comparison from power-up on. By default, outputs are compared after the first reset or, for a block
/// without reset, once its registers have taken their first values.
#[unsafe(no_mangle)]
pub extern "C" fn tofsim_from_power_up(handle: *mut c_void) {
    with("tofsim_from_power_up", handle as usize, (), |object| {
        object.checker()?.block.settle();
        Ok(())
    });
}

/// Reports a change of `tdc_stop` to `level`. Time does not go back, here and in `tofsim_step` and `tofsim_outputs`.
#[unsafe(no_mangle)]
pub extern "C" fn tofsim_stop(handle: *mut c_void, time_fs: c_longlong, level: c_int) {
    with("tofsim_stop", handle as usize, (), |object| object.checker()?.stop(time_fs, level != 0));
}

/// Sets the mask of output bits of the next `tofsim_step` that are neither 0 nor 1, which differ from any value. A
/// two-state simulator need not call it.
///
/// # Safety
/// The vector is null or as long as the block's outputs.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn tofsim_unknown(handle: *mut c_void, bits: *const u32) {
    with("tofsim_unknown", handle as usize, (), |object| {
        let checker = object.checker()?;
        let [_, words] = checker.block.layouts().map(|layout| layout.words());
        // SAFETY: as of this function.
        checker.unknown = unsafe { vector("bits", bits, words)? }.to_vec();
        Ok(())
    });
}

/// Compares a block's outputs with those of the model just before an edge, and processes the edge. Returns 1 if they
/// agree, or 0 with an error for each output that differs. `what` is 0 for a comparison without an edge, 1 for an
/// edge of the block's clock (of both clocks, if it has two), 2 for an edge of clk_laser alone, and 3 for its falling
/// edge. `inputs` and `outputs` are the concatenation of all ports except clocks, in the order of the module, the
/// first in the highest bits.
///
/// # Safety
/// The vectors are null or as long as the block's ports.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn tofsim_step(
    handle: *mut c_void,
    what: c_int,
    time_fs: c_longlong,
    inputs: *const u32,
    outputs: *const u32,
) -> c_int {
    with("tofsim_step", handle as usize, 0, |object| {
        let [in_words, out_words] = object.checker()?.block.layouts().map(|layout| layout.words());
        // SAFETY: as of this function.
        let lines = unsafe {
            [vector("inputs", inputs, in_words)?, vector("outputs", outputs, out_words)?]
        };
        let found = object.checker()?.step(what, time_fs, lines)?;
        found.iter().for_each(|sentence| object.record(sentence));
        Ok(found.is_empty().into())
    })
}

/// Returns how often the outputs of a block have been compared so far, by all its models that have not been deleted;
/// 0 for an unknown block. A bench prints it at its end: a checker that was never connected finds no fault.
///
/// # Safety
/// The string is null or ends with a zero.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn tofsim_get_num_compared(block: *const c_char) -> c_longlong {
    // SAFETY: as of this function.
    let count = unsafe { text("block", block) }.map_or(0, compared);
    c_longlong::try_from(count).unwrap_or(c_longlong::MAX)
}

/// Computes the model's outputs for the given inputs, before an edge. Returns 1, or 0 with an error.
///
/// # Safety
/// The vectors are null or as long as the block's ports.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn tofsim_outputs(
    handle: *mut c_void,
    time_fs: c_longlong,
    inputs: *const u32,
    outputs: *mut u32,
) -> c_int {
    with("tofsim_outputs", handle as usize, 0, |object| {
        let checker = object.checker()?;
        let [in_words, out_words] = checker.block.layouts().map(|layout| layout.words());
        // SAFETY: as of this function.
        let inputs = unsafe { vector("inputs", inputs, in_words)? };
        if outputs.is_null() {
            return Err("outputs are null".to_owned());
        }
        let words = checker.outputs(time_fs, inputs)?;
        // SAFETY: as of this function.
        unsafe { std::ptr::copy_nonoverlapping(words.as_ptr(), outputs, out_words) };
        Ok(1)
    })
}

/// Returns the number of errors of a handle since the last `tofsim_clear_errors`; for null, the number of errors in
/// creating objects. Of many errors the first 1000 are kept, and one that says so.
#[unsafe(no_mangle)]
pub extern "C" fn tofsim_get_num_errors(handle: *mut c_void) -> c_int {
    errors(handle as usize, |errors| c_int::try_from(errors.len()).unwrap_or(c_int::MAX))
}

/// Returns the text of an error, numbered from 0; empty if there are fewer errors. The text is valid until the errors
/// are cleared.
#[unsafe(no_mangle)]
pub extern "C" fn tofsim_get_error(handle: *mut c_void, number: c_int) -> *const c_char {
    errors(handle as usize, |errors| {
        let found = usize::try_from(number).ok().and_then(|number| errors.get(number));
        found.map_or(c"".as_ptr(), |error| error.as_ptr())
    })
}

/// Clears the errors of a handle.
#[unsafe(no_mangle)]
pub extern "C" fn tofsim_clear_errors(handle: *mut c_void) {
    errors(handle as usize, Vec::clear);
}

/// Deletes a block or a photon source.
#[unsafe(no_mangle)]
pub extern "C" fn tofsim_delete(handle: *mut c_void) {
    delete(handle as usize);
}

/// Creates the light and the detector of a scenario at power-up. Returns null if that fails, as `tofsim_new` does,
/// whose arguments it shares.
///
/// # Safety
/// The strings are null or end with a zero.
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
        Ok(ObjectKind::Photons(Box::new(Source::new(scenario)?)))
    });
    handle as *mut c_void
}

/// Processes an edge of clk_sys, with the state of the firmware after it: whether a shot begins, the laser was
/// enabled at that edge, `spad_rst` is high, MODE 1 is selected, the ring oscillator drives `tdc_stop`, and a frame
/// has ended.
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
    with("tofsim_photons_edge", handle as usize, (), |object| {
        let shown = Shown { start, laser, spad_rst, mode, ring_on, frame_done };
        object.photons()?.edge(time_fs, shown)
    });
}

/// Returns the next time at which `tdc_stop` changes before or at the next edge [fs], or -1. `tdc_stop` then has its
/// new level.
#[unsafe(no_mangle)]
pub extern "C" fn tofsim_photons_next(handle: *mut c_void) -> c_longlong {
    with("tofsim_photons_next", handle as usize, -1, |object| Ok(object.photons()?.next_change()))
}

/// Returns the level of `tdc_stop`.
#[unsafe(no_mangle)]
pub extern "C" fn tofsim_photons_level(handle: *mut c_void) -> c_int {
    with("tofsim_photons_level", handle as usize, 0, |object| Ok(object.photons()?.level().into()))
}
