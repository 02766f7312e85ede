//! The images of an array on the page.

use std::time::{Duration, Instant};

use serde::Serialize;
use serde_json::Value;

use tofsim::scenario;
use tofsim::sim::Stepping;
use tofsim::sim::image::{ImageFidelity, Pixel};
use tofsim::sim::setup::array::ArraySetup;

use super::common::Server;

/// An array that is neither square nor symmetric.
const SMALL: [&str; 3] = ["array.rows=4", "array.columns=3", "firmware.shots_per_frame=3000"];

const SHOT: ImageFidelity = ImageFidelity::Shots(Stepping::LeapShots);

fn server(arguments: &[&str]) -> Server {
    let small = SMALL.iter().flat_map(|set| ["-s", set]);
    Server::start(&[&small.collect::<Vec<_>>(), arguments, &["array"]].concat())
}

/// The pixels that the simulator gives.
fn pixels(further: &[&str], fidelity: ImageFidelity, images: u64) -> Vec<Pixel> {
    let set: Vec<_> = [&SMALL, further].concat().into_iter().map(str::to_owned).collect();
    let array = ArraySetup::new(scenario::load("array", &set).unwrap()).unwrap();
    array.images(fidelity, images, None, &|_| ()).unwrap()
}

/// Compares the last image with image `number` of some pixels, digit for digit.
fn assert_is(server: &Server, pixels: &[Pixel], number: usize) {
    let answer = server.get("image");
    assert_eq!(answer.status, 200, "{}", String::from_utf8_lossy(&answer.body));
    let image = answer.json();
    assert_eq!(image["number"], number);
    assert_eq!(image["rows"].as_u64().zip(image["columns"].as_u64()), Some(size(pixels)));
    let text = String::from_utf8(answer.body).unwrap();
    let frame = |pixel: &Pixel| pixel.frames[number];
    let has = |name: &str, values: String| {
        let list = format!("\"{name}\":{values}");
        assert!(text.contains(&list), "image {number}: {list} in {text}");
    };
    has("depth_m", each(pixels, |pixel| frame(pixel).radial_m));
    has("sigma_m", each(pixels, |pixel| frame(pixel).sigma_m));
    has("valid", each(pixels, |pixel| frame(pixel).valid));
    has("status", each(pixels, |pixel| frame(pixel).status));
    has("hits", each(pixels, |pixel| frame(pixel).hits));
    has("signal_hits", each(pixels, |pixel| pixel.expected.signal_hits));
    has("ambient_hits", each(pixels, |pixel| pixel.expected.ambient_hits));
    has("true_m", each(pixels, |pixel| pixel.expected.radial_m));
}

/// The rows and columns of an array of so many pixels.
fn size(pixels: &[Pixel]) -> (u64, u64) {
    if pixels.len() == 12 { (4, 3) } else { (8, 9) }
}

fn each<T: Serialize>(pixels: &[Pixel], value: impl Fn(&Pixel) -> T) -> String {
    serde_json::to_string(&pixels.iter().map(value).collect::<Vec<_>>()).unwrap()
}

fn images(server: &Server, count: u32) -> Value {
    server.act("run", &format!("{{\"frames\":{count}}}"))
}

#[test]
fn images_are_those_of_the_simulator_bit_for_bit_in_every_fidelity() {
    for (name, fidelity) in [
        ("histogram", ImageFidelity::Histograms),
        ("shot", SHOT),
        ("cycle", ImageFidelity::Shots(Stepping::SkipIdle)),
    ] {
        let server = server(&["--stopped", "--fidelity", name]);
        assert_eq!(server.state()["fidelity"], name);
        let expected = pixels(&[], fidelity, 3);
        for number in 0..2 {
            let state = images(&server, 1);
            assert_eq!(
                (&state["image"]["number"], &state["running"]),
                (&number.into(), &false.into())
            );
            assert_is(&server, &expected, number);
        }
        let valid = expected.iter().filter(|pixel| pixel.frames[2].valid).count();
        let state = images(&server, 1);
        assert_is(&server, &expected, 2);
        assert_eq!(state["image"]["valid_pixels"], valid);
        assert_eq!(state["image"]["fill_rate"], valid as f64 / 12.0);
        assert_eq!(state["time"]["images"], 3);
    }
}

#[test]
fn a_changed_scene_begins_again_with_its_image_0() {
    let server = server(&["--stopped", "--seed", "5", "--fidelity", "shot"]);
    let before = images(&server, 2);
    assert_eq!(before["scene_coming"], false);
    let near = server.act("scene", "{\"target.distance_m\":0.3}");
    assert_eq!((&near["scene_coming"], &near["image"]["number"]), (&true.into(), &1.into()));
    assert_eq!((&near["time"]["images"], &near["scene"][0]["value"]), (&0.into(), &0.3.into()));
    let after = images(&server, 1);
    assert_eq!((&after["scene_coming"], &after["image"]["number"]), (&false.into(), &0.into()));
    assert_ne!(after["image"]["hash"], before["image"]["hash"]);
    let set: Vec<_> =
        SMALL.into_iter().chain(["target.distance_m=0.3"]).map(str::to_owned).collect();
    let mut loaded = scenario::load("array", &set).unwrap();
    loaded.scenario.seed = 5;
    let array = ArraySetup::new(loaded).unwrap();
    assert_is(&server, &array.images(SHOT, 1, None, &|_| ()).unwrap(), 0);
    assert_eq!(
        after["image"]["command"],
        "tofsim image array -s array.rows=4 -s array.columns=3 -s firmware.shots_per_frame=3000 \
         -s target.distance_m=0.3 --seed 5 --fidelity shot --images 1 -o out"
    );
    let again = server.act("run", "{\"power_up\":true}");
    assert_eq!(again["image"], Value::Null);
    assert_eq!(images(&server, 1)["image"]["number"], 0);
}

#[test]
fn a_changed_scene_drops_the_image_that_is_being_simulated() {
    let server = server(&["--rate", "1000"]);
    for k in 0..6 {
        let key = format!("target.distance_m={}", 0.3 + 0.01 * f64::from(k));
        let (name, value) = key.split_once('=').unwrap();
        server.act("scene", &format!("{{\"{name}\":{value}}}"));
        let state =
            server.wait(|state| state["scene_coming"] == false && !state["image"].is_null());
        let set: Vec<_> = SMALL.into_iter().chain([&*key]).map(str::to_owned).collect();
        let array = ArraySetup::new(scenario::load("array", &set).unwrap()).unwrap();
        assert_eq!(state["image"]["hash"], array.common().hash(), "{key}");
    }
}

#[test]
fn an_image_that_is_stopped_goes_on_where_it_was() {
    let more = ["array.rows=8", "array.columns=9"];
    let server = server(&[
        "--stopped",
        "--fidelity",
        "cycle",
        "-s",
        more[0],
        "-s",
        more[1],
        "--rate",
        "1000",
    ]);
    let simulated = |state: &Value| state["progress"]["pixels"].as_u64().unwrap();
    let stopped = (0..200).map(|_| {
        server.act("run", "{\"running\":true}");
        std::thread::sleep(Duration::from_millis(20));
        simulated(&server.act("run", "{\"running\":false}"))
    });
    let pixels_done = stopped.into_iter().find(|done| (1..36).contains(done)).unwrap();
    std::thread::sleep(Duration::from_millis(500));
    let later = simulated(&server.state());
    assert!((pixels_done..72).contains(&later), "{pixels_done}, {later}");
    let number = images(&server, 1)["image"]["number"].as_u64().unwrap() as usize;
    let fidelity = ImageFidelity::Shots(Stepping::SkipIdle);
    assert_is(&server, &pixels(&more, fidelity, 1 + number as u64), number);
}

#[test]
fn requests_are_answered_while_an_image_is_simulated() {
    // Whole seconds for an image.
    let server = Server::start(&["--fidelity", "cycle", "array"]);
    let mut waits = Vec::new();
    for k in 0..20 {
        let asked = Instant::now();
        match k % 4 {
            0 => drop(server.act(
                "scene",
                &format!("{{\"target.reflectance\":{}}}", 0.3 + 0.01 * f64::from(k)),
            )),
            1 => drop(server.act("run", &format!("{{\"running\":{}}}", k % 8 == 1))),
            _ => drop(server.state()),
        }
        waits.push(asked.elapsed());
        std::thread::sleep(Duration::from_millis(30));
    }
    waits.sort_unstable();
    // Other tests have the same processors.
    assert!(
        waits[10] < Duration::from_millis(100) && waits[19] < Duration::from_secs(2),
        "{waits:?}"
    );
}

#[test]
fn what_arrays_do_not_have_is_refused_with_a_reason() {
    let server = server(&["--stopped"]);
    for (path, body, expected) in [
        ("control", "{\"laser_en\":false}", "control: expected a scenario of a single pixel"),
        ("ila", "{\"arm\":true,\"set_up\":\"shot\"}", "arrays have no logic analyser"),
        ("run", "{\"frames\":0}", "frames = 0: expected 1 to 1000"),
        ("scene", "{\"target.cells\":9}", "target.cells = 9: no such key of the scene"),
        ("scene", "{\"target.reflectance\":-1}", "target.reflectance = -1"),
    ] {
        let answer = server.post(path, body);
        assert_eq!(answer.status, 400, "{path} {body}");
        assert!(answer.fault().contains(expected), "{path} {body}: {}", answer.fault());
    }
    for (path, expected) in [
        ("image", "image: no image has ended yet"),
        ("ila.csv", "arrays have no logic analyser"),
        ("shot.vcd", "`tofsim image --waves` writes the waveform"),
        ("run.toml", "image.command"),
    ] {
        let answer = server.get(path);
        assert_eq!(answer.status, 400, "{path}");
        assert!(answer.fault().contains(expected), "{path}: {}", answer.fault());
    }
    assert_eq!(images(&server, 1)["image"]["number"], 0);
    let pixel = Server::small(&[]);
    let fault = pixel.get("image").fault();
    assert!(fault.contains("expected a scenario with several pixels (array.rows"), "{fault}");
}

#[test]
fn notes_are_those_of_the_pixels_and_of_the_estimator() {
    let server = server(&["--stopped"]);
    assert_eq!(server.state()["notes"], Value::Array(vec![]));
    let notes = images(&server, 1)["notes"].to_string();
    assert!(notes.contains("estimator-outside-model") && notes.contains("target.shape"), "{notes}");
    server.act("scene", "{\"target.reflectance\":0}");
    let notes = images(&server, 1)["notes"].to_string();
    assert!(notes.contains("target.reflectance = 0") && notes.contains("no-light"), "{notes}");
}
