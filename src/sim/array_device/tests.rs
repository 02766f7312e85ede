use crate::firmware::tof_top::Clocks;
use crate::scenario;
use crate::sim::Run;
use crate::sim::device::Off;

use super::trace::ArrayProbe;
use super::*;

/// A small array with bright pixels and short frames.
fn array(set: &[&str]) -> ArraySetup {
    let few = ["firmware.shots_per_frame=300", "array.rows=3", "array.columns=4"];
    let set: Vec<_> = few.iter().chain(set).map(|line| (*line).to_owned()).collect();
    ArraySetup::new(scenario::load("array", &set).unwrap()).unwrap()
}

/// Depths of so many images.
fn depths(setup: &ArraySetup, images: usize) -> (Vec<ImageDepth>, ArrayDevice) {
    let [rows, columns] = setup.size();
    let (mut device, mut depths) =
        (ArrayDevice::new(setup, &setup.firmware().unwrap()).unwrap(), Vec::new());
    device.power_up(&mut Off);
    while depths.len() < images * rows * columns {
        depths.extend(device.step(&mut Off));
    }
    (depths, device)
}

#[test]
fn the_firmware_of_an_array_has_the_depths_of_its_pixels_alone() {
    for set in [
        &["array.banks=1", "estimator.kind=network"][..],
        &["array.banks=2", "estimator.kind=centroid"],
        &["array.banks=2", "estimator.kind=likelihood"],
        &["array.banks=2", "estimator.kind=centroid", "spad.crosstalk_probability=0.3"],
    ] {
        let setup = array(set);
        let [rows, columns] = setup.size();
        let (found, _) = depths(&setup, 2);
        let mut distinct = Vec::new();
        for row in 0..rows {
            for column in 0..columns {
                let alone = Run::new(&setup.pixel(row, column)).frames(2).unwrap();
                for (image, frame) in alone.iter().enumerate() {
                    let depth = &found[(image * rows + row) * columns + column];
                    assert_eq!(depth.place, [row, column], "{set:?}");
                    assert_eq!(depth.words, frame.words, "{set:?} {row},{column} image {image}");
                    distinct.push(depth.words.depth.get());
                }
            }
        }
        distinct.sort_unstable();
        distinct.dedup();
        assert!(distinct.len() > rows * columns, "{set:?}: {distinct:?}");
    }
}

#[test]
fn each_column_converts_with_the_chain_that_its_pixels_have_alone() {
    let own = "array.chains_file=../chains/columns.csv";
    let (usual, setup) = (array(&["tdc.profile=kintex7"]), array(&["tdc.profile=kintex7", own]));
    let (found, device) = depths(&setup, 1);
    for (place, depth) in found.iter().enumerate() {
        let [row, column] = [place / 4, place % 4];
        let [pixel, same] = [&setup, &usual].map(|setup| setup.pixel(row, column));
        assert_eq!(pixel.bins() == same.bins(), column == 0, "{column}");
        assert_eq!(depth.words, Run::new(&pixel).frames(1).unwrap()[0].words, "{row},{column}");
    }
    let roms: Vec<_> = (0..4).map(|column| &device.params().tdc_of(column).decoder.cal).collect();
    assert!((1..4).all(|column| roms[..column].iter().all(|rom| *rom != roms[column])));
}

#[test]
fn a_single_pixel_is_an_array_of_one() {
    let setup =
        array(&["array.rows=1", "array.columns=1", "array.banks=1", "estimator.kind=network"]);
    let (found, _) = depths(&setup, 3);
    let alone = Run::new(&setup.pixel(0, 0)).frames(3).unwrap();
    let words: Vec<_> = alone.iter().map(|frame| frame.words).collect();
    assert_eq!(found.iter().map(|depth| depth.words).collect::<Vec<_>>(), words);
    let periods: Vec<_> = found.windows(2).map(|pair| pair[1].cycle - pair[0].cycle).collect();
    assert_eq!(periods, [alone[0].frame_cycles + 1; 2]);
}

/// What each rising edge of the clocks takes, and how often the wire has changed at the instant of one.
#[derive(Default)]
struct Edges {
    taken: Vec<(Time, Edge, bool, Clocks)>,
    ties: usize,
}

impl SignalProbe for Edges {
    const ON: bool = true;
    const EDGES: bool = true;

    fn sample(&mut self, now: Time, top: &TofTop) {
        let last = self.taken.last();
        let is_tie = |(at, _, stop, _): &(Time, Edge, bool, Clocks)| {
            *at == now && *stop != top.pins.tdc_stop
        };
        self.ties += usize::from(last.is_some_and(is_tie));
    }

    fn before_edge(&mut self, edge: Edge, now: Time, top: &TofTop) {
        self.taken.push((now, edge, top.pins.tdc_stop, top.clocks));
    }
}

#[test]
fn an_edge_takes_what_has_been_before_it() {
    // A photon of the list arrives with an edge of clk_laser.
    let setup = ArraySetup::new(scenario::load("tdc_validation", &[]).unwrap()).unwrap();
    let pixel = setup.pixel(0, 0);
    let (mut alone, mut own) = (Edges::default(), Edges::default());
    let mut device = pixel.device();
    device.power_up(&mut alone, &mut Off);
    let mut array = ArrayDevice::new(&setup, &setup.firmware().unwrap()).unwrap();
    array.power_up(&mut own);
    for _ in 0..1500 {
        device.step(&pixel.params, &mut alone, &mut Off);
        array.step(&mut own);
    }
    assert!(own.ties > 0);
    assert_eq!(own.taken.len(), 3000);
    assert_eq!(own.taken, alone.taken);
}

#[test]
fn a_row_that_the_control_signals_keep_from_ending_is_refused() {
    struct Never;
    impl SignalProbe for Never {
        const ON: bool = false;
        fn sample(&mut self, _: Time, _: &TofTop) {}
    }
    impl ArrayProbe for Never {
        fn begin(&mut self, _: &ArrayDevice) {}
        fn is_done(&self, _: &ArrayDevice) -> bool {
            false
        }
    }
    for (set, said) in [
        ("firmware.dsp_en=false", "firmware.dsp_en = false: expected true"),
        ("firmware.rst=true", "firmware.rst = true: expected false"),
    ] {
        let error = array(&[set]).traced(1, &mut Never, None).unwrap_err().to_string();
        assert!(error.contains(said), "{error}");
    }
    let end = array(&["array.banks=1"]).traced(2, &mut Never, None).unwrap();
    assert_eq!(end.shots, 2 * 3 * 300);
    // A row of the next image has been acquired meanwhile.
    let end = array(&["array.banks=2"]).traced(2, &mut Never, None).unwrap();
    assert_eq!(end.shots, (2 * 3 + 1) * 300);
}

#[test]
fn what_the_firmware_of_an_array_lacks_is_refused() {
    for (set, said) in [
        ("array.rows=41", "array.rows = 41: expected at most 40 for the firmware"),
        ("tdc.recalibrate_frames=3", "tdc.recalibrate_frames = 3: expected 0 with an array"),
        ("tdc.decoder=reordered", "tdc.decoder = reordered: expected ones or leading with array"),
    ] {
        let setup = array(&[set, "array.chains_file=../chains/columns.csv"]);
        let error = setup.firmware().unwrap_err().to_string();
        assert!(error.contains(said), "{error}");
    }
}
