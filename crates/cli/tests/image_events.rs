//! Shots of the pixels of images.

use std::fs;
use std::path::Path;

use crate::common::{empty, refused, stdout};

const ARRAY: [&str; 8] = [
    "array",
    "-s",
    "array.rows=2",
    "-s",
    "array.columns=3",
    "-s",
    "firmware.shots_per_frame=200",
    "--seed=5",
];

fn image<'a>(options: &[&'a str]) -> Vec<&'a str> {
    [&["image", "-q"], &ARRAY[..], options].concat()
}

/// Returns the lines of a file below its record: the head, then a row for each shot.
fn lines(path: &Path) -> Vec<String> {
    let text = fs::read_to_string(path).unwrap();
    text.lines().filter(|line| !line.starts_with('#')).map(str::to_owned).collect()
}

#[test]
fn every_shot_has_a_row_by_pixel_and_image_and_is_that_of_the_pixel_alone() {
    let folder = empty();
    let folder = folder.path();
    let events = |name: &str, options: &[&str]| {
        let words = image(&[&["--images", "2", "--events", name], options].concat());
        stdout(folder, &words);
        lines(&folder.join(name))
    };
    let all = events("all.csv", &["--threads", "3", "-o", "out"]);
    assert_eq!(all[0], "row,column,image,shot,arrival_ps,cause,n,coarse,code,bin");
    let places: Vec<Vec<usize>> = all[1..]
        .iter()
        .map(|line| line.split(',').take(4).map(|number| number.parse().unwrap()).collect())
        .collect();
    let expected = (0..6 * 2 * 200).map(|n| vec![n / 1200, n / 400 % 3, n / 200 % 2, n % 200]);
    assert_eq!(places, expected.collect::<Vec<_>>());
    for options in [&["--threads", "1"][..], &["--fidelity", "cycle"]] {
        assert_eq!(events("other.csv", options), all, "{options:?}");
    }
    let run = ["--pixel", "1,2", "--frames", "2", "--events", "run.csv", "--waves", "none", "-q"];
    stdout(folder, &[&["run"], &ARRAY[..], &run].concat());
    let run: Vec<_> =
        lines(&folder.join("run.csv")).iter().map(|row| format!("1,2,{row}")).collect();
    let of_pixel: Vec<_> = all.iter().filter(|row| row.starts_with("1,2,")).cloned().collect();
    assert!(run[1..] == of_pixel && of_pixel.iter().any(|row| row.contains("signal")));
    assert_eq!(events("alone.csv", &["--pixel", "1,2"])[1..], of_pixel);
    // Events and pixels are of the same images.
    let hits = lines(&folder.join("out/pixels.csv"));
    let head = hits[0].split(',').position(|name| name == "hits").unwrap();
    let hits: u64 =
        hits[1..].iter().map(|row| row.split(',').nth(head).unwrap().parse::<u64>().unwrap()).sum();
    let codes = all[1..].iter().filter(|row| row.split(',').nth(8) != Some(""));
    assert_eq!(codes.count() as u64, hits);
    let again = stdout(folder, &["rerun", "all.csv"]);
    assert!(again.contains("the same"), "{again}");
}

#[test]
fn events_that_are_not_there_or_have_no_place_are_refused() {
    let folder = empty();
    for (options, said) in [
        (
            &["--fidelity", "histogram", "--events", "a.csv"][..],
            "expected --fidelity shot or cycle",
        ),
        (&["--events", "a.txt"], "--events: a.txt: expected a name that ends in .csv or .parquet"),
        (&["-o", "out", "--events", "out/pixels.csv"], "expected another name"),
    ] {
        let error = refused(folder.path(), &image(options));
        assert!(error.contains("--events: ") && error.contains(said), "{options:?}: {error}");
    }
    assert!(crate::common::files(folder.path()).is_empty());
}
