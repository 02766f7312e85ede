//! Status codes: what was in the scene, and how far the depths were off.

use std::path::Path;

use rayon::prelude::*;

use tofsim::firmware::tof_top::status_code::StatusCode;
use tofsim::sim::fast::histogram::Histograms;

use super::{
    APART_M, BehindDirt, BehindGlass, DISTANCES_M, GlassAlone, KLUX, Net, Nothing, REFLECTANCES,
    Scene, Target, calibrate, off, scene_setup,
};

/// A distance whose echo the end of the window cuts [m].
const CUT_OFF_M: f64 = 0.958;
const CODES: usize = StatusCode::ALL.len();

/// Frames of a code.
#[derive(Clone, Copy, Debug, Default)]
struct Coded {
    frames: usize,
    /// With no target, and with two.
    empty: usize,
    two: usize,
    /// With a target, and off by more than three of their sigmas, and by more than six.
    off: [usize; 2],
}

type ByCode = [Coded; CODES];

fn and(mut all: ByCode, other: ByCode) -> ByCode {
    for (one, other) in all.iter_mut().zip(other) {
        one.frames += other.frames;
        one.empty += other.empty;
        one.two += other.two;
        one.off[0] += other.off[0];
        one.off[1] += other.off[1];
    }
    all
}

/// Counts the frames of every kind of scene by their codes, with so many at each point of the grid.
fn by_code(frames: u64) -> ByCode {
    let folder = tempfile::tempdir().unwrap();
    let template = folder.path().join("glass.csv");
    calibrate(&template);
    let mut all = ByCode::default();
    for scene in [Target, BehindGlass, BehindDirt, Net(1), Net(2), Nothing, GlassAlone] {
        let is_empty = matches!(scene, Nothing | GlassAlone);
        let points = if is_empty { vec![[0.0, 0.1, 0.5]] } else { grid(scene) };
        let frames = if is_empty { 32 * frames } else { frames };
        let tallies = points.into_iter().map(|at| count(scene, at, &template, frames));
        all = tallies.fold(all, and);
    }
    all
}

/// Returns illumination, reflectance and distance of the points of a scene.
fn grid(scene: Scene) -> Vec<[f64; 3]> {
    let distances = DISTANCES_M.into_iter().chain((scene == Target).then_some(CUT_OFF_M));
    let distances = distances.filter(|m| !matches!(scene, Net(_)) || *m > APART_M);
    let lights = KLUX.iter().flat_map(|&klux| REFLECTANCES.map(|r| (f64::from(klux), r)));
    distances.flat_map(|m| lights.clone().map(move |(klux, r)| [klux, r, m])).collect()
}

fn count(scene: Scene, at: [f64; 3], template: &Path, frames: u64) -> ByCode {
    let (setup, truths_m) = scene_setup(scene, at, template);
    let drawn = Histograms::new(&setup).unwrap();
    let one = |index| {
        let found = drawn.frame(index).estimate();
        let off = off(&found, &truths_m);
        let mut codes = ByCode::default();
        codes[found.status_code as usize] = Coded {
            frames: 1,
            empty: usize::from(truths_m.is_empty()),
            two: usize::from(truths_m.len() == 2),
            off: [3.0, 6.0].map(|most| usize::from(!truths_m.is_empty() && off > most)),
        };
        codes
    };
    (0..frames).into_par_iter().map(one).reduce(ByCode::default, and)
}

fn print(codes: &ByCode) {
    for (code, Coded { frames, empty, two, off: [three, six] }) in StatusCode::ALL.iter().zip(codes)
    {
        println!("| {} | {frames} | {empty} | {two} | {three} | {six} |", code.word());
    }
}

#[test]
#[ignore = "prints a table of docs/accuracy.md"]
fn prints_status_codes() {
    print(&by_code(300));
}

/// Measured with 300 frames a point in `docs/accuracy.md`.
#[test]
#[ignore = "long: ./check --full"]
fn a_code_keeps_what_it_promises() {
    let codes = by_code(20);
    print(&codes);
    let of = |code: StatusCode| codes[code as usize];
    assert_eq!(of(StatusCode::Unstated).frames, 0);
    for valid in [StatusCode::Valid, StatusCode::ValidSecond] {
        let Coded { frames, empty, off, .. } = of(valid);
        assert!(frames > 200 && empty == 0 && off[1] <= frames / 5000, "{valid:?} {codes:?}");
    }
    assert_eq!(of(StatusCode::ValidSecond).two, of(StatusCode::ValidSecond).frames);
    for code in [StatusCode::NoTarget, StatusCode::CutOff, StatusCode::PedestalChanged] {
        assert!(of(code).frames > 20, "{code:?} {codes:?}");
    }
}
