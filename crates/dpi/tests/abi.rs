//! Tests of the functions, called as from C.
#![allow(unsafe_code, reason = "the functions take pointers")]

use std::ffi::{CStr, CString, c_void};
use std::ptr::{null, null_mut};

use tofsim_dpi::*;

const VERSION: &CStr =
    match CStr::from_bytes_with_nul(concat!(env!("CARGO_PKG_VERSION"), "\0").as_bytes()) {
        Ok(version) => version,
        Err(_) => unreachable!(),
    };

fn new(version: &CStr, scenario: &str, block: &str) -> *mut c_void {
    let [scenario, block] = [scenario, block].map(|text| CString::new(text).unwrap());
    unsafe { tofsim_new(version.as_ptr(), scenario.as_ptr(), block.as_ptr()) }
}

/// Returns the last error of a handle.
fn error(handle: *mut c_void) -> String {
    let last = tofsim_get_error(handle, tofsim_get_num_errors(handle) - 1);
    unsafe { CStr::from_ptr(last) }.to_str().unwrap().to_owned()
}

/// All errors of null are in one place, so that what leads to them comes one after the other.
#[test]
fn what_cannot_be_made_is_null_and_says_why() {
    assert!(new(c"9.9.9", "kc705", "tdc").is_null());
    assert!(
        error(null_mut())
            .contains("tofsim_new: the SystemVerilog is of tofsim 9.9.9, this library of")
    );
    assert!(new(VERSION, "kc705", "tdq").is_null());
    assert!(
        error(null_mut()).contains("scenario kc705: block = tdq: no such block (`tdc`?)"),
        "{}",
        error(null_mut())
    );
    assert!(new(VERSION, "kc705\nlaser.colour=green", "tdc").is_null());
    assert!(error(null_mut()).contains("laser.colour"), "{}", error(null_mut()));
    assert!(new(VERSION, "kc705", "code_preload").is_null());
    assert!(error(null_mut()).contains("stimulus.codes is not set"), "{}", error(null_mut()));
    assert!(new(VERSION, "kc705\ntdc.setup_window_ps=10", "tdc").is_null());
    assert!(
        error(null_mut()).contains("tdc.setup_window_ps = 10: expected 0"),
        "{}",
        error(null_mut())
    );
    assert!(unsafe { tofsim_new(VERSION.as_ptr(), null(), null()) }.is_null());
    assert_eq!(error(null_mut()), "tofsim_new: scenario is null");
    assert!(unsafe { tofsim_photons_new(VERSION.as_ptr(), c"\xff".as_ptr()) }.is_null());
    assert!(error(null_mut()).contains("scenario is not UTF-8"));

    assert_eq!(unsafe { tofsim_step(null_mut(), 1, 0, null(), null()) }, 0);
    assert!(
        error(null_mut()).starts_with("tofsim_step: the handle is null"),
        "{}",
        error(null_mut())
    );
    let handle = new(VERSION, "kc705", "spad_control");
    tofsim_delete(handle);
    assert_eq!(unsafe { tofsim_step(handle, 1, 0, null(), null()) }, 0);
    assert!(error(null_mut()).contains("no such handle"), "{}", error(null_mut()));
    (0..3000).for_each(|_| tofsim_stop(handle, 0, 1));
    assert_eq!(tofsim_get_num_errors(null_mut()), 1001);
    assert_eq!(error(null_mut()), "there are more than 1000 errors: call tofsim_clear_errors");
    tofsim_clear_errors(null_mut());
    assert_eq!(tofsim_get_num_errors(null_mut()), 0);
    assert_eq!(error(null_mut()), "");
}

#[test]
fn comparisons_are_counted_from_the_first_reset_on() {
    let compared = |block: &CStr| unsafe { tofsim_get_num_compared(block.as_ptr()) };
    let handle = new(VERSION, "kc705", "coarse_counter");
    for (edge, rst) in [0, 1, 0, 0].into_iter().enumerate() {
        assert_eq!(compared(c"coarse_counter"), edge.saturating_sub(2) as i64);
        let mut outputs = [0; 2];
        let (time, inputs) = (8_000_000 * (edge as i64 + 1), rst << 1);
        unsafe { tofsim_outputs(handle, time, &inputs, outputs.as_mut_ptr()) };
        unsafe { tofsim_step(handle, 1, time, &inputs, outputs.as_ptr()) };
    }
    assert_eq!([compared(c"coarse_counter"), compared(c"nothing")], [2, 0]);
    assert_eq!(unsafe { tofsim_get_num_compared(null()) }, 0);
}

#[test]
fn a_block_steps_and_what_differs_is_named() {
    let handle = new(VERSION, "kc705", "spad_control");
    let port = |name: &CStr, bits| unsafe { tofsim_port(handle, name.as_ptr(), bits) };
    assert_eq!([port(c"spad_sel", 40), port(c"spad_sel", 39), port(c"spad", 1)], [1, 0, 0]);
    assert_eq!(
        error(handle),
        "tofsim_port: spad_control.spad: no such port; there are clk_sys, rst, mode, pre_start, spad_rst, spad_sel"
    );
    assert_eq!(tofsim_get_num_errors(handle), 2);
    tofsim_clear_errors(handle);
    // rst, mode, pre_start; spad_rst, spad_sel.
    let mut outputs = [0u32; 2];
    let step = |time, inputs: u32, outputs: &[u32]| unsafe {
        tofsim_step(handle, 1, time, &inputs, outputs.as_ptr())
    };
    // Nothing is compared before the first reset.
    assert_eq!(step(8_000_000, 0b000, &[5, 5]), 1);
    assert_eq!(step(16_000_000, 0b100, &[5, 5]), 1);
    assert_eq!(unsafe { tofsim_outputs(handle, 24_000_000, &0, outputs.as_mut_ptr()) }, 1);
    assert_eq!(step(24_000_000, 0b000, &outputs), 1);
    outputs[0] ^= 2;
    assert_eq!(step(32_000_000, 0b000, &outputs), 0);
    assert_eq!(
        error(handle),
        "spad_control: cycle 3, time 32000 ps, spad_sel: expected 0000000001, got 0000000003"
    );
    // A bit that is unknown differs from any, and the next step's are known again.
    outputs[0] ^= 2;
    unsafe { tofsim_unknown(handle, [0x10, 0x100].as_ptr()) };
    assert_eq!(step(40_000_000, 0b000, &outputs), 0);
    let said = tofsim_get_num_errors(handle);
    let [spad_rst, spad_sel] = [2, 1].map(|back| unsafe {
        CStr::from_ptr(tofsim_get_error(handle, said - back)).to_str().unwrap()
    });
    assert_eq!(spad_rst, "spad_control: cycle 4, time 40000 ps, spad_rst: expected 0, got x");
    assert!(spad_sel.ends_with("spad_sel: expected 0000000001, got 00000000x1"), "{spad_sel}");
    assert_eq!(step(48_000_000, 0b000, &outputs), 1);
    assert_eq!(unsafe { tofsim_step(handle, 7, 0, &0, outputs.as_ptr()) }, 0);
    assert_eq!(
        error(handle),
        "tofsim_step: edge 7: expected 0 (none), 1 (rise), 2 (middle) or 3 (fall)"
    );
    assert_eq!(unsafe { tofsim_step(handle, 1, -1, &0, outputs.as_ptr()) }, 0);
    assert_eq!(unsafe { tofsim_step(handle, 1, 40_000_000, null(), outputs.as_ptr()) }, 0);
    assert_eq!(error(handle), "tofsim_step: inputs are null");
    assert_eq!(tofsim_photons_next(handle), -1);
    assert_eq!(error(handle), "tofsim_photons_next: this handle is of no photons");
    tofsim_delete(handle);
}

#[test]
fn time_that_goes_back_is_refused() {
    let handle = new(VERSION, "kc705", "tdc_latch");
    tofsim_stop(handle, 50_000_000, 1);
    let inputs = [0u32; 64];
    assert_eq!(unsafe { tofsim_step(handle, 1, 48_000_000, inputs.as_ptr(), inputs.as_ptr()) }, 0);
    assert_eq!(error(handle), "tofsim_step: time 48000000 fs: expected 50000000 fs or later");
    let mut outputs = [0u32; 64];
    let (now, words) = (49_000_000, outputs.as_mut_ptr());
    assert_eq!(unsafe { tofsim_outputs(handle, now, inputs.as_ptr(), words) }, 0);
    assert_eq!(error(handle), "tofsim_outputs: time 49000000 fs: expected 50000000 fs or later");
    assert_eq!(unsafe { tofsim_outputs(handle, 56_000_000, inputs.as_ptr(), words) }, 1);
    tofsim_stop(handle, 51_000_000, 0);
    assert_eq!(error(handle), "tofsim_stop: time 51000000 fs: expected 56000000 fs or later");
    tofsim_delete(handle);
    let photons = unsafe { tofsim_photons_new(VERSION.as_ptr(), c"kc705".as_ptr()) };
    for time in [1_016_000_000, 1_008_000_000] {
        tofsim_photons_edge(photons, time, 0, 0, 1, 0, 0, 0);
    }
    assert_eq!(
        error(photons),
        "tofsim_photons_edge: time 1008000000 fs: expected 1016000000 fs or later"
    );
    tofsim_delete(photons);
}

#[test]
fn photons_come_after_a_shot() {
    let handle =
        unsafe { tofsim_photons_new(VERSION.as_ptr(), c"kc705\ntarget.distance_m=0.3".as_ptr()) };
    while tofsim_photons_next(handle) >= 0 {}
    let edge = |time, start, held| tofsim_photons_edge(handle, time, start, start, held, 0, 0, 0);
    edge(1_008_000_000, 0, 1);
    edge(1_016_000_000, 1, 0);
    let at = tofsim_photons_next(handle);
    assert!(at > 1_016_000_000 && at <= 1_024_000_000 && tofsim_photons_level(handle) == 1, "{at}");
    tofsim_delete(handle);
}
