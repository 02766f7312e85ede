//! Depths of the firmware in sunlight, on dark and bright targets: how often one that is called valid is wrong.

use std::fmt::Write as _;
use std::fs;
use std::path::Path;

use rayon::prelude::*;

use tofsim::network::Histogram;
use tofsim::scenario;
use tofsim::scenario::glass::{GlassTemplate, HEADER};
use tofsim::sim::estimates::Estimate;
use tofsim::sim::fast::histogram::Histograms;
use tofsim::sim::setup::Setup;
use tofsim_learn::calibration::glass::GlassCalibration;
use tofsim_learn::estimation::Acquisition;

mod codes;

/// Illumination by the sun [klux].
const KLUX: [u32; 4] = [0, 25, 50, 100];
const REFLECTANCES: [f64; 2] = [0.1, 0.9];
const DISTANCES_M: [f64; 4] = [0.1, 0.3, 0.6, 0.8];
/// From the nearer of two targets to the other one [m].
const APART_M: f64 = 0.25;
const GLASS: [&str; 2] = ["cover.fraction=1.3e-4", "laser.delay_ps=600"];
/// Dirt makes the window's light two and a half times as strong.
const DIRT: &str = "cover.fraction=3.25e-4";

/// What the estimator looks at.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Scene {
    Target,
    BehindGlass,
    /// A target behind glass that has become dirty since its calibration.
    BehindDirt,
    /// A net before the target, with so many targets looked for.
    Net(u8),
    Nothing,
    GlassAlone,
}

use Scene::{BehindDirt, BehindGlass, GlassAlone, Net, Nothing, Target};

/// Frames of a kind of scene.
#[derive(Clone, Copy, Debug, Default)]
struct Tally {
    frames: usize,
    valid: usize,
    /// Valid and off by more than three of its sigmas, and by more than six.
    off: [usize; 2],
}

impl Tally {
    fn and(self, other: Tally) -> Tally {
        let Tally { frames, valid, off } = other;
        let off = [self.off[0] + off[0], self.off[1] + off[1]];
        Tally { frames: self.frames + frames, valid: self.valid + valid, off }
    }
}

fn setup(keys: &[String]) -> Setup {
    Setup::new(scenario::load("kc705", keys).unwrap()).unwrap()
}

fn histograms(setup: &Setup, frames: u64) -> Vec<Histogram> {
    let drawn = Histograms::new(setup).unwrap();
    (0..frames).map(|index| drawn.frame(index).histogram).collect()
}

/// Writes a template of the window, calibrated without a target and without sunlight.
fn calibrate(path: &Path) {
    let keys: Vec<_> =
        GLASS.iter().chain(&["target.reflectance=0"]).map(|key| key.to_string()).collect();
    let setup = setup(&keys);
    let bins = setup.known_bins();
    let shots = setup.params.frame_ctrl.shots_per_frame.into();
    let acquisition = Acquisition { glass: None, ..Acquisition::of(&setup, &bins, shots) };
    let name = |number| ("simulated".to_owned(), number);
    let found = GlassCalibration::new(&acquisition, &histograms(&setup, 500), name).unwrap();
    fs::write(path, text(&found.template)).unwrap();
}

fn text(template: &GlassTemplate) -> String {
    let mut text = HEADER.join(",") + "\n";
    for (code, bin) in template.bins().iter().enumerate() {
        let (from, until) = (bin.from_ps, bin.until_ps);
        writeln!(text, "{code},{from},{until},{},{}", bin.hazard, bin.hazard_se).unwrap();
    }
    text
}

/// Returns the setup of a scene at an illumination, a reflectance and a distance, and the distances of its targets.
fn scene_setup(
    scene: Scene,
    [klux, reflectance, distance_m]: [f64; 3],
    template: &Path,
) -> (Setup, Vec<f64>) {
    let near_m = distance_m - APART_M;
    let mut keys = vec![
        "estimator.kind=likelihood".to_owned(),
        "ambient.spectrum=sun".to_owned(),
        format!("ambient.illuminance_klux={klux}"),
        format!("target.reflectance={reflectance}"),
        format!("target.distance_m={distance_m}"),
    ];
    let mut truths_m = vec![distance_m];
    if matches!(scene, BehindGlass | BehindDirt | GlassAlone) {
        keys.extend(GLASS.map(str::to_owned));
        keys.push(format!("estimator.glass_file={:?}", template.display().to_string()));
    }
    match scene {
        Nothing | GlassAlone => {
            keys.push("target.reflectance=0".to_owned());
            truths_m.clear();
        }
        Net(targets) => {
            truths_m.push(near_m);
            keys.push("target.second_share=0.3".to_owned());
            keys.push(format!("target.second_distance_m={near_m}"));
            keys.push(format!("target.second_reflectance={reflectance}"));
            keys.push(format!("estimator.targets={targets}"));
        }
        BehindDirt => keys.push(DIRT.to_owned()),
        Target | BehindGlass => {}
    }
    (setup(&keys), truths_m)
}

/// Returns by how many of its sigmas a depth is off the nearest target.
fn off(estimate: &Estimate, truths_m: &[f64]) -> f64 {
    let off_m = truths_m.iter().map(|truth_m| (estimate.depth_m.unwrap() - truth_m).abs());
    off_m.fold(f64::INFINITY, f64::min) / estimate.sigma_m.unwrap()
}

/// Counts the depths of a scene.
fn tally(scene: Scene, at: [f64; 3], template: &Path, frames: u64) -> Tally {
    let (setup, truths_m) = scene_setup(scene, at, template);
    let drawn = Histograms::new(&setup).unwrap();
    let count = |index| {
        let found = drawn.frame(index).estimate();
        let off = off(&found, &truths_m);
        let off = [3.0, 6.0].map(|most| usize::from(found.valid && off > most));
        Tally { frames: 1, valid: usize::from(found.valid), off }
    };
    (0..frames).into_par_iter().map(count).reduce(Tally::default, Tally::and)
}

/// Counts the depths of every kind of scene by illumination, with so many frames at each reflectance and distance.
fn all(frames: u64) -> Vec<(Scene, u32, Tally)> {
    let folder = tempfile::tempdir().unwrap();
    let template = folder.path().join("glass.csv");
    calibrate(&template);
    let mut rows = Vec::new();
    for scene in [Target, BehindGlass, Net(1), Net(2), Nothing, GlassAlone] {
        for klux in KLUX {
            let is_empty = matches!(scene, Nothing | GlassAlone);
            let grid =
                REFLECTANCES.iter().flat_map(|r| DISTANCES_M.map(|d| [f64::from(klux), *r, d]));
            let grid = grid.filter(|[.., d]| !matches!(scene, Net(_)) || *d > APART_M);
            let tallies: Vec<_> = if is_empty {
                vec![tally(scene, [f64::from(klux), 0.1, 0.5], &template, 8 * frames)]
            } else {
                grid.map(|at| tally(scene, at, &template, frames)).collect()
            };
            rows.push((scene, klux, tallies.into_iter().fold(Tally::default(), Tally::and)));
        }
    }
    rows
}

fn print(rows: &[(Scene, u32, Tally)]) -> Tally {
    for (scene, klux, Tally { frames, valid, off: [three, six] }) in rows {
        let valid = 100.0 * *valid as f64 / *frames as f64;
        println!("| {scene:?} | {klux} | {frames} | {valid:.1} | {three} | {six} |");
    }
    rows.iter().map(|(.., tally)| *tally).fold(Tally::default(), Tally::and)
}

#[test]
#[ignore = "prints a table of docs/accuracy.md"]
fn prints_depths_in_sunlight() {
    println!("{:?}", print(&all(1200)));
}

/// Measured with 211,200 frames in `docs/accuracy.md`.
#[test]
#[ignore = "long: ./check --full"]
fn a_valid_depth_in_sunlight_is_hardly_ever_wrong() {
    let all = print(&all(100));
    assert!(all.valid > all.frames / 3, "{all:?}");
    assert!(all.off[1] <= 6, "{all:?}");
}
