//! The laser: armed when that is asked for, and off in the end in any case.

use std::sync::atomic::AtomicBool;
use std::thread::sleep;
use std::time::{Duration, Instant};

use tofsim::error::Error;
use tofsim::firmware::registers::map::{DSP_RST, LASER_EN};
use tofsim_board::Board;

use crate::client::{open, registers, setup};
use crate::device::{Device, Faults, Registers};

/// A board whose laser is armed and enabled.
fn lit(device: &Device) -> Board {
    let setup = setup();
    let mut board = open(device, &setup, false).unwrap();
    board.prepare(&setup, true).unwrap();
    board.arm().unwrap();
    board
}

/// Waits until the device has done what it was told.
fn wait_for(device: &Device, holds: impl Fn(&Registers) -> bool) {
    let begun = Instant::now();
    while !holds(&device.state().registers) {
        assert!(begun.elapsed() < Duration::from_secs(5), "it never comes");
        sleep(Duration::from_millis(5));
    }
}

/// Whether the host has switched the laser off; the firmware by itself only disarms it.
fn is_off(now: &Registers) -> bool {
    !now.armed && now.control == DSP_RST.with(0, 1)
}

#[test]
fn a_board_that_is_dropped_is_left_with_the_laser_off() {
    let device = Device::on_terminal(registers(&setup()), Faults::default());
    let board = lit(&device);
    let on = device.state().registers.clone();
    assert!(on.armed && LASER_EN.of(on.control) == 1);
    drop(board);
    wait_for(&device, is_off);
}

#[test]
fn a_board_that_was_only_looked_at_is_left_as_it_was() {
    let setup = setup();
    let device = Device::on_terminal(registers(&setup), Faults::default());
    device.state().registers.control = 0x13;
    drop(open(&device, &setup, false).unwrap());
    sleep(Duration::from_millis(50));
    assert_eq!(device.state().registers.control, 0x13);
}

#[test]
fn an_interruption_ends_the_wait_for_a_frame() {
    let setup = setup();
    let device = Device::on_terminal(registers(&setup), Faults::default());
    let mut board = lit(&device);
    let before = board.begin_frames().unwrap();
    let stopped = AtomicBool::new(true);
    let error = board.next_frame(&setup, (0, before), Some(&stopped)).unwrap_err();
    assert!(matches!(error, Error::Interrupted));
    drop(board);
    wait_for(&device, is_off);
}

#[test]
fn a_laser_that_cannot_be_armed_says_why() {
    let setup = setup();
    let shut = Registers { interlock_open: true, ..registers(&setup) };
    let device = Device::on_terminal(shut, Faults::default());
    let mut board = open(&device, &setup, false).unwrap();
    let error = board.arm().unwrap_err().to_string();
    let expected = "arm = 0: expected 1 after arming (laser_faults: interlocked; status: locked, interlock_open)";
    assert_eq!(error, format!("{}: {expected}", device.port));
}

#[test]
fn a_board_whose_switch_selects_the_pins_is_not_controlled() {
    let setup = setup();
    let pins = Registers { pins_selected: true, ..registers(&setup) };
    let device = Device::on_terminal(pins, Faults::default());
    let mut board = open(&device, &setup, false).unwrap();
    let expected =
        format!("{}: status.pins_selected = 1: expected 0: the board's switch", device.port);
    let error = board.prepare(&setup, true).unwrap_err().to_string();
    assert!(error.starts_with(&expected), "{error}");
    let error = board.code_density(&setup, 10, None, &mut |_| {}).unwrap_err().to_string();
    assert!(error.starts_with(&expected), "{error}");
    assert_eq!(device.state().registers.control, DSP_RST.with(0, 1));
}

#[test]
fn a_host_that_is_silent_for_too_long_is_told_so_and_one_that_speaks_is_not() {
    let slow = Registers { host_timeout: Duration::from_millis(300), ..registers(&setup()) };
    let device = Device::on_terminal(slow, Faults::default());
    let mut board = lit(&device);
    for _ in 0..6 {
        sleep(Duration::from_millis(110));
        board.keep_alive().unwrap();
    }
    assert_eq!(board.check_armed().unwrap().faults(), [""; 0]);
    sleep(Duration::from_millis(450));
    let error = board.check_armed().unwrap_err().to_string();
    assert!(
        error.contains(
            "arm = 0: the laser went off while frames were taken (laser_faults: host_silent;"
        ),
        "{error}"
    );
}

#[test]
fn an_unplugged_port_is_named_and_the_firmware_switches_the_laser_off() {
    let setup = setup();
    let quick = Registers { host_timeout: Duration::from_millis(100), ..registers(&setup) };
    let device =
        Device::on_terminal(quick, Faults { unplugged_after: Some(14), ..Faults::default() });
    let mut board = open(&device, &setup, false).unwrap();
    board.prepare(&setup, true).unwrap();
    board.arm().unwrap();
    let before = board.begin_frames().unwrap();
    let error = board.next_frame(&setup, (0, before), None).unwrap_err().to_string();
    assert!(error.starts_with(&format!("{}: ", device.port)), "{error}");
    assert!(
        error.contains("the connection is lost") && error.contains("is the cable plugged in?"),
        "{error}"
    );
    drop(board);
    sleep(Duration::from_millis(150));
    device.state().registers.watch();
    assert!(!device.state().registers.armed);
}
