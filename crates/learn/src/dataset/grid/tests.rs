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
