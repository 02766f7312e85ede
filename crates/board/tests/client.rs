//! Identity, registers and frames.

use std::time::Duration;

use tofsim::error::Result;
use tofsim::firmware::registers::map::{CONTROL, IDENTITY, MODE, PARAMETERS_HASH, SCRATCH};
use tofsim::sim::setup::Setup;
use tofsim_board::names::{Setting, register};
use tofsim_board::{Board, PortOptions};
use tofsim_rtl::golden::parameters::hash::parameters_hash;

use crate::device::{Device, Faults, HeldFrame, Registers};

/// A setup with the likelihood estimator, which states sigma and status.
pub fn setup() -> Setup {
    Setup::load("kc705", &["estimator.kind=likelihood", "firmware.shots_per_frame=3000"]).unwrap()
}

/// Results of three frames: an echo in another bin each, and what the estimator makes of it.
pub fn results(setup: &Setup) -> Vec<HeldFrame> {
    let result = |bin: usize| {
        let mut histogram = vec![2; 256];
        (0..20).for_each(|k| histogram[bin + k] += 40 - (k as u32).abs_diff(10) * 4);
        let words = setup.estimate_words(&histogram);
        HeldFrame {
            depth: words.depth.get(),
            sigma: words.sigma.get(),
            status: words.status.get() as u32,
            valid: words.valid,
            code: words.code as u32,
            histogram,
        }
    };
    [60, 100, 140].map(result).into()
}

/// Registers of a board with the parameters of a setup.
pub fn registers(setup: &Setup) -> Registers {
    Registers::new(parameters_hash(setup), results(setup))
}

/// Opens a device on a pseudo-terminal.
pub fn open(device: &Device, setup: &Setup, any_parameters: bool) -> Result<Board> {
    let patience = Duration::from_millis(150);
    let options = PortOptions { patience, ..PortOptions::new(&device.port) };
    Board::open(&options, setup, any_parameters)
}

/// The error of opening a device with faults and changed registers.
fn refused(change: impl FnOnce(&mut Registers, &mut Faults)) -> (String, String) {
    let setup = setup();
    let (mut registers, mut faults) = (registers(&setup), Faults::default());
    change(&mut registers, &mut faults);
    let device = Device::on_terminal(registers, faults);
    let error = open(&device, &setup, false).err().unwrap().to_string();
    (
        error.strip_prefix(&device.port).unwrap_or_else(|| panic!("no port: {error}")).to_owned(),
        error,
    )
}

#[test]
fn a_board_is_opened_and_its_registers_have_names() {
    let setup = setup();
    let device = Device::on_terminal(registers(&setup), Faults::default());
    let mut board = open(&device, &setup, false).unwrap();
    let identity = *board.identity();
    assert_eq!((identity.map_version, identity.system_hz), (1, 125_000_000));
    assert_eq!(identity.host_timeout(), Duration::from_millis(500));
    assert_eq!(board.read(&PARAMETERS_HASH).unwrap(), parameters_hash(&setup));
    board.write_checked(&SCRATCH, 0x1234_5678).unwrap();
    assert_eq!(board.read(register("test", "scratch").unwrap()).unwrap(), 0x1234_5678);
    board.set_control(MODE, 1).unwrap();
    assert_eq!(MODE.of(board.read_word(&CONTROL).unwrap()), 1);
    let error = board.write_checked(&IDENTITY, 5).unwrap_err().to_string();
    assert_eq!(
        error,
        format!("{}: identity = 0x746f6673: expected 0x5, which was written", device.port)
    );
}

#[test]
fn names_that_do_not_exist_are_refused_with_those_that_do() {
    let error = register("test", "depht").unwrap_err().to_string();
    assert!(
        error.starts_with("test: depht: unknown register (`depth`?); expected one of identity"),
        "{error}"
    );
    let error = Setting::named("test", "depth").unwrap_err().to_string();
    assert!(
        error.starts_with("test: depth: read-only register; expected one of laser_en"),
        "{error}"
    );
    let rate = Setting::named("test", "laser_freq").unwrap();
    assert_eq!(rate.value("test", "0x5").unwrap(), 5);
    let error = rate.value("test", "8").unwrap_err().to_string();
    assert_eq!(error, "test: laser_freq = 8: expected a whole number from 0 to 7");
}

#[test]
fn another_device_another_map_and_other_parameters_are_refused() {
    let (fault, _) = refused(|registers, _| registers.identity = 0x1234);
    assert_eq!(
        fault,
        ": identity = 0x00001234: expected 0x746f6673, a board with tofsim's firmware"
    );
    let (fault, _) = refused(|registers, _| registers.map_version = 2);
    assert!(fault.starts_with(": map_version = 2: expected 1: build firmware"), "{fault}");
    let (fault, _) = refused(|registers, _| registers.parameters_hash = 0xabc);
    let own = parameters_hash(&setup());
    let expected = format!(
        ": parameters_hash = 0x0000000000000abc: expected {own:#018x}, that of scenario kc705 with "
    );
    assert!(fault.starts_with(&expected) && fault.contains("estimator.kind=likelihood"), "{fault}");
    let setup = setup();
    let other = Registers { parameters_hash: 0xabc, ..registers(&setup) };
    let device = Device::on_terminal(other, Faults::default());
    assert_eq!(open(&device, &setup, true).unwrap().identity().parameters_hash, 0xabc);
}

#[test]
fn silent_truncated_and_missing_devices_are_errors_with_port_and_register() {
    let (fault, _) = refused(|_, faults| faults.silent = true);
    assert!(
        fault.starts_with(": identity: no answer within 0.15 s, expected 24 bytes: check"),
        "{fault}"
    );
    let (fault, _) = refused(|_, faults| faults.truncated = u32::MAX);
    assert!(fault.starts_with(": identity = 23 bytes: expected 24 bytes within 0.15 s"), "{fault}");
    let (fault, _) = refused(|_, faults| faults.unplugged_after = Some(0));
    assert!(fault.starts_with(": identity: the connection is lost ("), "{fault}");
    let error = Board::connect(&PortOptions::new("/dev/nowhere")).err().unwrap().to_string();
    assert!(error.starts_with("/dev/nowhere: cannot open it: No such file"), "{error}");
}

#[test]
fn one_truncated_answer_and_bytes_of_somebody_else_do_no_harm() {
    let setup = setup();
    for faults in
        [Faults { truncated: 1, ..Faults::default() }, Faults { noise: 5, ..Faults::default() }]
    {
        let device = Device::on_terminal(registers(&setup), faults);
        let mut board =
            open(&device, &setup, false).unwrap_or_else(|error| panic!("{faults:?}: {error}"));
        assert_eq!(board.read(&PARAMETERS_HASH).unwrap(), parameters_hash(&setup), "{faults:?}");
    }
}

#[test]
fn consecutive_frames_are_those_of_the_board_word_for_word() {
    let setup = setup();
    let (device, link) = Device::on_socket(registers(&setup), Faults::default());
    let mut board = Board::over(Box::new(link), &PortOptions::new("socket")).unwrap();
    board.prepare(&setup, false).unwrap();
    let before = board.begin_frames().unwrap();
    board.release().unwrap();
    for index in 0..7 {
        let frame = board.next_frame(&setup, (index, before + index as u32), None).unwrap();
        let result = &results(&setup)[index as usize % 3];
        assert_eq!((frame.index, &frame.histogram), (index, &result.histogram));
        assert_eq!(frame.words, setup.estimate_words(&frame.histogram));
        assert!(frame.estimate().sigma_m.is_some() && !frame.laser_en);
    }
    drop(board);
    assert_eq!(device.state().registers.lit, 0);
}

#[test]
fn a_missed_frame_and_one_that_does_not_go_on_are_errors() {
    let setup = setup();
    let next = |change: &dyn Fn(&mut Registers)| {
        let mut registers = registers(&setup);
        change(&mut registers);
        let device = Device::on_terminal(registers, Faults::default());
        let mut board = open(&device, &setup, false).unwrap();
        board.prepare(&setup, false).unwrap();
        let before = board.begin_frames().unwrap();
        board.release().unwrap();
        let error = board.next_frame(&setup, (0, before), None).unwrap_err().to_string();
        error.strip_prefix(&device.port).unwrap().to_owned()
    };
    let missed = next(&|registers| registers.frames_at_once = 2);
    assert_eq!(missed, ": frame = 2: expected 1: a frame was missed, or the board was reset");
    let stalled = next(&|registers| registers.stalls = true);
    let expected =
        ": frame = 0: expected 1: for 0.15 s neither shots nor hits were counted (status: locked)";
    assert_eq!(stalled, expected);
}
