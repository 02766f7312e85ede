//! `tofsim serve --board`, before a device in software on a pseudo-terminal.

#[path = "../../board/tests/device.rs"]
#[allow(dead_code, reason = "the client's own tests look at more of it")]
mod device;

use std::process::Command;
use std::time::{Duration, Instant};

use tofsim::firmware::registers::map::DSP_RST;
use tofsim::firmware::tof_top::slot::DepthM;
use tofsim::sim::estimates::digits;
use tofsim::sim::setup::Setup;
use tofsim_rtl::golden::parameters::hash::parameters_hash;

use super::common::Server;
use super::common::chromium::{Chromium, pictures};

use device::{Device, Faults, HeldFrame, Registers};

/// Bins of a hundred hits in which the device counts a pulse.
const PULSE: std::ops::Range<usize> = 80..84;

/// A device with the parameters of the default scenario.
fn registers() -> Registers {
    let setup = Setup::load("kc705", &[]).unwrap();
    let counts =
        (0..setup.params.histogram.bins).map(|bin| 3 + 97 * u32::from(PULSE.contains(&bin)));
    let histogram: Vec<_> = counts.collect();
    let words = setup.estimate_words(&histogram);
    let frame =
        HeldFrame { depth: words.depth.get(), valid: true, histogram, ..HeldFrame::default() };
    let host_timeout = Duration::from_secs(60);
    Registers { host_timeout, ..Registers::new(parameters_hash(&setup), vec![frame]) }
}

/// The depth of its frames.
fn depth() -> DepthM {
    DepthM::from_bits(registers().results[0].depth)
}

fn server(device: &Device, args: &[&str]) -> Server {
    Server::start(&[&["--board", &device.port], args].concat())
}

/// Ends a server by Ctrl-C, after which the laser is disarmed and frames are held back.
fn interrupt(server: Server, device: &Device) {
    let sent = Command::new("kill").args(["-INT", &server.id().to_string()]).status();
    assert!(sent.unwrap().success());
    assert_eq!(server.end().code(), Some(130));
    let until = Instant::now() + Duration::from_secs(10);
    loop {
        let registers = device.state().registers.clone();
        if !registers.armed && registers.control == DSP_RST.with(0, 1) {
            return;
        }
        assert!(Instant::now() < until, "{registers:?}");
        std::thread::sleep(Duration::from_millis(20));
    }
}

#[test]
fn frames_are_those_of_the_board_and_the_laser_is_off_until_it_is_switched_on() {
    let device = Device::on_terminal(registers(), Faults::default());
    let server = server(&device, &["--stopped"]);
    let before = server.state();
    assert_eq!(
        (&before["fidelity"], &before["control"]["laser_en"]),
        (&"board".into(), &false.into())
    );
    let frame = server.frames(3);
    assert_eq!((&frame["index"], &frame["depth_raw"]), (&2.into(), &digits(depth()).into()));
    assert_eq!(device.state().registers.lit, 0);

    let lit = server.act("control", "{\"laser_en\":true}");
    assert_eq!(lit["control"]["laser_en"], true);
    server.frames(2);
    assert!(device.state().registers.lit > 0);
    server.act("control", "{\"laser_freq\":1}");
    assert!(!device.state().registers.armed, "no frames are taken");
    let before = device.state().registers.lit;
    server.frames(1);
    assert!(device.state().registers.lit > before, "the switch is still on");
    let dark = server.act("run", "{\"running\":false}");
    assert_eq!(
        (&dark["control"]["laser_en"], &dark["control"]["laser_freq"]),
        (&false.into(), &1.into())
    );
    assert!(!device.state().registers.armed);
    for (path, body, why) in [
        ("scene", "{\"target.distance_m\":0.3}", "in front of the board"),
        ("ila", "{\"arm\":true}", "no logic analyser but Vivado's"),
    ] {
        let answer = server.post(path, body);
        assert_eq!(answer.status, 400, "{path}");
        assert!(answer.fault().contains(why), "{path}: {}", answer.fault());
    }
    server.act("run", "{\"running\":true}");
    server.act("control", "{\"laser_en\":true}");
    server.wait(|state| state["frame"]["laser_en"] == true);
    interrupt(server, &device);
}

#[test]
fn a_laser_that_goes_off_and_a_lost_board_stop_the_run_with_the_reason() {
    let device = Device::on_terminal(registers(), Faults::default());
    let shown = server(&device, &[]);
    shown.act("control", "{\"laser_en\":true}");
    shown.wait(|state| state["frame"]["laser_en"] == true);
    device.state().registers.interlock_open = true;
    let state = shown.wait(|state| state["fault"].is_string());
    assert!(state["fault"].as_str().unwrap().contains("the laser went off"), "{}", state["fault"]);
    assert_eq!((&state["running"], &state["control"]["laser_en"]), (&false.into(), &false.into()));

    let faults = Faults { unplugged_after: Some(40), ..Faults::default() };
    let device = Device::on_terminal(registers(), faults);
    let shown = server(&device, &[]);
    let state = shown.wait(|state| state["fault"].is_string());
    let fault = state["fault"].as_str().unwrap();
    assert!(fault.contains(&device.port) && fault.contains("the connection is lost"), "{fault}");
}

#[test]
#[ignore = "long: ./check --full"]
fn in_a_browser_a_boards_frames_go_by_and_its_laser_is_switched() {
    let device = Device::on_terminal(registers(), Faults::default());
    let server = server(&device, &[]);
    let mut browser = Chromium::open(&server.url, (1600, 1000), "light");
    let frames = "Number(document.getElementById('time-frames').textContent)";
    browser.wait(&format!("{frames} > 3"));
    let switch = "document.getElementById('laser_en').getAttribute('aria-checked')";
    assert_eq!(browser.value(switch), "false");
    let shown = browser.value("document.getElementById('about').textContent");
    assert_eq!(shown, format!("scenario kc705, board at {}", device.port));
    let analyser = "document.getElementById('ila-arm').checkVisibility()";
    assert_eq!(browser.value(analyser), false, "a board's analyser is Vivado's");
    browser.press("l");
    browser.wait(&format!("{switch} === 'true'"));
    server.wait(|state| state["frame"]["laser_en"] == true);
    assert!(device.state().registers.armed);
    let network = "[...document.querySelectorAll('#depths tbody tr')].find(row => row.cells[0].textContent.startsWith('network'))?.cells[1].textContent";
    browser.wait(&format!("{network}?.startsWith('{:.3}')", depth().to_num::<f64>()));
    if let Some(folder) = pictures() {
        browser.screenshot(&folder.join("board.png"));
    }
    browser.press(" ");
    browser.wait("document.getElementById('run-state').textContent === 'stopped'");
    browser.wait(&format!("{switch} === 'false'"));
    assert_eq!(browser.complaints, Vec::<String>::new());
    interrupt(server, &device);
}
