use super::*;

fn own(options: &[&str], purpose: GridPurpose) -> Result<Grid> {
    let axes = options.iter().map(|option| Axis::parse("--grid", option));
    let axes = axes.collect::<Result<Vec<_>>>()?;
    Grid::own(&axes, &Scenario::default(), purpose)
}

#[test]
fn the_grids_are_those_of_the_thesis() {
    assert_eq!(Grid::training().rows(), 479_385);
    assert_eq!(Grid::test().rows(), 121_635);
    for grid in [Grid::training(), Grid::test()] {
        let scene = |distance_m, reflectance, irradiance_w_m2_nm| Scene {
            distance_m,
            reflectance,
            irradiance_w_m2_nm,
            ..Scene::default()
        };
        assert_eq!(grid.scene(0), scene(0.1, 0.08, 0.0));
        assert_eq!(grid.scene(4), grid.scene(0));
        assert_eq!(grid.scene(5), scene(0.1, 0.09, 0.0));
        assert_eq!(grid.scene(53 * 5), scene(0.1, 0.08, 0.05));
        assert_eq!(grid.scene(grid.rows() - 1), scene(0.6, 0.6, 0.4));
    }
    assert_eq!(Grid::training().scene(53 * 9 * 5).distance_m, 0.1025);
    assert_eq!(Grid::test().scene(53 * 9 * 5).distance_m, 0.11);
}

#[test]
fn what_an_own_grid_does_not_have_is_the_scenario_s() {
    let grid = own(&["target.distance_m=0.2,0.7"], GridPurpose::Test).unwrap();
    let Scenario { target, ambient, .. } = Scenario::default();
    assert_eq!((grid.rows(), grid.settings()), (10, 1));
    let scene = Scene {
        distance_m: 0.7,
        reflectance: target.reflectance,
        irradiance_w_m2_nm: ambient.irradiance_w_m2_nm,
        ..Scene::default()
    };
    assert_eq!(grid.scene(9), scene);
    assert_eq!(grid.ranges()[0], ("target.distance_m", [0.2, 0.7]));
}

#[test]
fn settings_count_through_the_other_keys_the_last_one_fastest() {
    let keys = ["spad.pdp=0.01,0.02", "target.distance_m=0.3", "laser.pulse_sigma_ps=100,137,200"];
    let grid = own(&keys, GridPurpose::Training).unwrap();
    assert_eq!((grid.settings(), grid.lights(), grid.rows()), (6, 6, 30));
    let setting = |k| grid.setting(k).iter().map(|(_, value)| *value).collect::<Vec<_>>();
    assert_eq!(setting(0), [0.01, 100.0]);
    assert_eq!(setting(1), [0.01, 137.0]);
    assert_eq!(setting(5), [0.02, 200.0]);
    assert_eq!(grid.scene(29).setting, 5);
    assert_eq!(grid.scene(5).setting, 1);
}

#[test]
fn no_two_grids_share_a_row_number() {
    let of = |purpose| own(&["target.distance_m=0.2,0.7"], purpose).unwrap();
    let [training, test] = [GridPurpose::Training, GridPurpose::Test].map(of);
    let mut firsts = [&Grid::training(), &Grid::test(), &training, &test].map(|g| g.first_row);
    assert!(firsts.is_sorted_by(|a, b| b - a >= 2 * ROWS));
    firsts.iter_mut().for_each(|first| *first += 2 * ROWS);
    assert!(firsts[3] < 1 << 56, "beyond what a stream can hold");
}

#[test]
fn too_many_rows_are_refused() {
    let many = own(
        &["target.distance_m=0.1..0.6:0.00001", "target.reflectance=0.1..0.9:0.00001"],
        GridPurpose::Test,
    );
    assert!(many.unwrap_err().to_string().contains("scenes, expected 100000000 at most"));
    let settings = own(&["laser.pulse_sigma_ps=1..2000:0.1"], GridPurpose::Test);
    assert!(settings.unwrap_err().to_string().contains("19991 settings of other keys"));
    let few = own(&["target.distance_m=0.1,0.2"], GridPurpose::Test).unwrap();
    assert!(few.repeated(u64::MAX).unwrap_err().to_string().contains("histograms, expected"));
    let twice = own(&["spad.pdp=0.1", "spad.pdp=0.2"], GridPurpose::Test);
    assert!(twice.unwrap_err().to_string().contains("spad.pdp: expected each key once"));
}

/// The grid of an array of 2 x 3 pixels, with the depths of a tilted plane.
fn of_array(options: &[&str]) -> Result<Grid> {
    let keys = ["array.rows=2", "array.columns=3", "target.length_m=0.5", "target.width_m=0.5"];
    let keys = [&keys[..], &["target.tilt_deg=35"]].concat();
    let keys: Vec<_> = keys.into_iter().map(str::to_owned).collect();
    let loaded = tofsim::scenario::load("kc705", &keys).unwrap();
    let axes = options.iter().map(|option| Axis::parse("--grid", option));
    let axes = axes.collect::<Result<Vec<_>>>()?;
    let grid = Grid::own(&axes, &loaded.scenario, GridPurpose::Test)?;
    let array = tofsim::sim::setup::array::ArraySetup::new(loaded)?;
    let settings = (0..grid.settings()).map(|_| &array);
    let pixels = grid.array.clone().map(|pixels| pixels.with_depths(settings));
    Ok(Grid { array: pixels, ..grid })
}

#[test]
fn every_scene_of_an_array_has_all_pixels_with_repeats_of_each() {
    let options = ["laser.pulse_sigma_ps=100,137", "target.reflectance=0.2,0.4"];
    let grid = of_array(&options).unwrap().repeated(2).unwrap();
    assert_eq!((grid.rows(), grid.scenes(), grid.settings()), (48, 24, 2));
    for index in 0..48 {
        let scene = grid.scene(index);
        assert_eq!(scene.pixel as u64, index / 2 % 6);
        assert_eq!(scene.reflectance, [0.2, 0.4][(index / 12 % 2) as usize]);
        assert_eq!(scene.setting as u64, index / 24);
        let place = [scene.pixel / 3, scene.pixel % 3].map(|index| index as f64);
        assert_eq!(grid.values(&scene)[3..5], place);
    }
    // The plane is nearer from top to bottom.
    let depth_m = |pixel: u64| grid.scene(2 * pixel).distance_m;
    assert!((0..3).all(|pixel| depth_m(pixel) > depth_m(pixel + 3) + 0.01));
    let [near, far] = grid.array.as_ref().unwrap().range_m();
    assert_eq!(grid.ranges()[0], ("target.distance_m", [near, far]));
    assert!(near < 0.49 && far > 0.51, "{near} {far}");
}

#[test]
fn the_target_s_distance_is_a_key_like_others_for_an_array() {
    let grid = of_array(&["target.distance_m=0.3,0.4"]).unwrap();
    assert_eq!((grid.settings(), grid.scenes()), (2, 12));
    assert_eq!(grid.setting(1), [("target.distance_m", 0.4)]);
    let names: Vec<_> = grid.columns().iter().map(|column| column.name).collect();
    assert_eq!(names[3..], ["pixel_row", "pixel_column", "target.distance_m"]);
    assert_eq!(grid.columns()[0].key, None);
}

#[test]
fn the_size_of_an_array_is_no_key_of_a_grid() {
    for options in [["array.rows=2,3"], ["array.columns=1"]] {
        let error = own(&options, GridPurpose::Test).unwrap_err().to_string();
        assert!(error.contains("expected no axis"), "{error}");
    }
}
