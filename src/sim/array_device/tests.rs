use crate::scenario;
use crate::sim::Run;
use crate::sim::device::Off;

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
