//! Tests of the page in a browser.

use std::time::{Duration, Instant};

use serde_json::Value;

use super::common::Server;
use super::common::chromium::{Chromium, pictures};

const SWITCH: &str = "document.getElementById('laser_en').getAttribute('aria-checked')";
const NO_SIGNAL: &str = "!document.querySelector('#histogram .area.signal')";

#[test]
#[ignore = "long: ./check --full"]
fn what_is_pressed_acts_on_the_run_and_shows() {
    let server = Server::start(&[]);
    let mut browser = Chromium::open(&server.url, (1600, 1000), "light");
    browser.wait("!!document.querySelector('#histogram .area.signal')");
    browser.press("l");
    browser.wait(&format!("{SWITCH} === 'false' && {NO_SIGNAL}"));
    assert_eq!(server.state()["control"]["laser_en"], false);
    browser.wait("document.getElementById('notes').textContent.includes('firmware.laser_en')");
    // A second browser sees the same.
    let mut second = Chromium::open(&server.url, (1000, 900), "dark");
    assert_eq!(second.value(SWITCH), "false");
    second.value("document.getElementById('laser_en').click()");
    browser.wait(&format!("{SWITCH} === 'true' && !({NO_SIGNAL})"));
    browser.value(
        "(() => { const slider = document.getElementById('slider-target.distance_m'); \
         slider.value = 0.3; slider.dispatchEvent(new Event('input')); })()",
    );
    let near = "[...document.querySelectorAll('#depths tbody tr')].find(row => row.cells[0].textContent.startsWith('network'))?.cells[1].textContent.startsWith('0.30')";
    browser.wait(near);
    second.wait(near);
    // In Clear there is nothing to abandon: then once more.
    browser.press_until("r", "document.getElementById('time-abandoned').textContent !== '0'");
    browser.press(" ");
    browser.wait("document.getElementById('run-state').textContent === 'stopped'");
    browser.press("a");
    browser.wait("document.getElementById('ila-status').textContent.includes('is stopped')");
    // The first only ends the frame in which the run stopped, of which too little may be left for a window.
    browser.press_until(
        "n",
        "document.getElementById('ila-status').textContent.includes('has triggered')",
    );
    browser.wait("document.querySelectorAll('#ila-waves .name').length > 10");
    browser.press("w");
    browser.wait("document.querySelectorAll('#shot-waves .name').length > 10");
    browser.wait("document.getElementById('run-state').textContent === 'stopped'");
    for focused in ["slider-target.distance_m", "laser_freq"] {
        browser.value(&format!("document.getElementById('{focused}').focus()"));
        for (key, state) in [(" ", "running"), (" ", "stopped"), ("l", "stopped")] {
            browser.press(key);
            browser
                .wait(&format!("document.getElementById('run-state').textContent === '{state}'"));
        }
        let frames = "document.getElementById('time-frames').textContent";
        let before = browser.value(frames);
        browser.press("n");
        browser.wait(&format!("{frames} !== {before}"));
    }
    assert_eq!(browser.complaints, Vec::<String>::new());
    assert_eq!(second.complaints, Vec::<String>::new());
}

#[test]
#[ignore = "long: ./check --full"]
fn the_picture_of_a_shot_is_a_file_of_its_own() {
    let server = Server::small(&[]);
    server.frames(1);
    let mut browser = Chromium::open(&server.url, (1000, 900), "light");
    let folder = tempfile::tempdir().unwrap();
    browser.save_into(folder.path());
    browser.press("w");
    browser.wait("document.querySelectorAll('#shot-waves .name').length > 10");
    browser.wait("!document.getElementById('shot-svg').disabled");
    let signals = browser.value("document.querySelectorAll('#shot-waves .name').length");
    browser.value("document.getElementById('shot-svg').click()");
    let path = folder.path().join("shot.svg");
    let until = Instant::now() + Duration::from_secs(30);
    while !path.is_file() {
        assert!(Instant::now() < until, "nothing was saved; {:?}", browser.complaints);
        std::thread::sleep(Duration::from_millis(20));
    }
    let text = std::fs::read_to_string(path).unwrap();
    assert!(text.starts_with("<svg xmlns=\"http://www.w3.org/2000/svg\""), "{text:.80}");
    assert_eq!(text.matches("<title ").count() as u64, signals.as_u64().unwrap());
    // The colour of a bit, which the page has from its style sheet.
    assert!(
        text.contains("stroke=\"rgb(11, 107, 58)\"") && !text.contains("class="),
        "{text:.900}"
    );
    assert_eq!(browser.complaints, Vec::<String>::new());
}

#[test]
#[ignore = "long: ./check --full"]
fn the_hint_of_a_new_scene_is_there_until_a_frame_of_it_is() {
    let server = Server::small(&[]);
    server.frames(1);
    let mut browser = Chromium::open(&server.url, (1000, 900), "light");
    let hint = "document.getElementById('scene-hint').textContent";
    assert_eq!(browser.value(hint), "");
    server.act("scene", "{\"target.distance_m\":0.3}");
    browser.wait(&format!("{hint} === 'The next frame is of the new scene.'"));
    server.frames(1);
    browser.wait(&format!("{hint} === ''"));
    assert_eq!(browser.complaints, Vec::<String>::new());
}

#[test]
#[ignore = "long: ./check --full"]
fn every_control_has_a_name_and_can_be_reached_by_keys() {
    let server = Server::small(&[]);
    let mut browser = Chromium::open(&server.url, (1600, 1000), "light");
    let unnamed = browser.value(
        "[...document.querySelectorAll('button, input, select, textarea, a')].filter(e => \
         !(e.textContent.trim() || e.labels?.length || e.getAttribute('aria-label'))).map(e => e.outerHTML)",
    );
    assert_eq!(unnamed, Value::Array(vec![]));
    let tabbed =
        browser.value("[...document.querySelectorAll('[tabindex]')].every(e => e.tabIndex <= 0)");
    assert_eq!(tabbed, true);
    browser.press("?");
    browser.wait("document.getElementById('help').open");
}

#[test]
#[ignore = "long: ./check --full"]
fn it_fits_a_phone_and_a_wide_screen_in_the_light_and_in_the_dark() {
    let server = Server::start(&["--rate", "50"]);
    server.wait(|state| state["time"]["frames"].as_u64() > Some(250));
    server.act("ila", "{\"arm\":true,\"set_up\":\"shot\"}");
    server.wait(|state| state["ila"]["status"] == "full");
    server.act("scene", "{\"target.distance_m\":0.3}");
    server.wait(|state| state["frame"]["true_m"] == 0.3);
    server.act("scene", "{\"target.distance_m\":0.65}");
    server.act("run", "{\"frames\":60}");
    for (width, scheme) in
        [(400, "light"), (400, "dark"), (1000, "light"), (1600, "light"), (1600, "dark")]
    {
        let mut browser = Chromium::open(&server.url, (width, 900), scheme);
        browser.press("w");
        browser.wait("document.querySelectorAll('#shot-waves .name').length > 10");
        browser.wait("document.querySelectorAll('#ila-waves .name').length > 1");
        let wide = browser.value("document.documentElement.scrollWidth");
        let over = browser.value(
            "[...document.querySelectorAll('body *')].filter(e => !e.closest('.unseen, .skip, pre, svg, .scroll') && \
             e.getBoundingClientRect().right > innerWidth + 1).map(e => e.tagName + '#' + e.id)",
        );
        if let Some(folder) = pictures() {
            browser.screenshot(&folder.join(format!("page-{width}-{scheme}.png")));
        }
        assert_eq!((wide.as_u64(), over), (Some(u64::from(width)), Value::Array(vec![])));
        assert_eq!(browser.complaints, Vec::<String>::new());
    }
}
