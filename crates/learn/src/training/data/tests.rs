use super::*;
use crate::dataset::{Axis, GridPurpose};
use crate::training::basis;
use tofsim::scenario;
use tofsim::sim::setup::Setup;

fn scenes<'a>(source: &'a HistogramSource, option: &str) -> TrainingScenes<'a> {
    let axes = [Axis::parse("--grid", option).unwrap()];
    let grid = |purpose| Grid::own(&axes, source.scenario(), purpose).unwrap();
    let [training, test] = [GridPurpose::Training, GridPurpose::Test].map(grid);
    TrainingScenes::of_grids(source, training, test)
}

fn source() -> HistogramSource {
    let few = ["firmware.shots_per_frame=300".to_owned()];
    HistogramSource::new(&Setup::new(scenario::load("kc705", &few).unwrap()).unwrap()).unwrap()
}

#[test]
fn an_own_grid_is_trained_tested_and_chosen_on_with_draws_of_their_own() {
    let source = source();
    let scenes = scenes(&source, "target.distance_m=0.05..0.9:0.0025");
    assert_eq!((scenes.training.scenes(), scenes.test.scenes()), (341, 35));
    let recipe = Recipe::quick();
    let [test, choice, stage] = [Purpose::Test, Purpose::Choice, Purpose::Stage(0)]
        .map(|purpose| scenes.draw(&recipe, 1, purpose));
    assert_eq!((test.counts.len(), choice.counts.len(), stage.counts.len()), (35, 35, 603));
    assert_eq!((test.distances_m[0], test.distances_m[34]), (0.05, 0.9));
    assert!(test.distances_m.iter().all(|d| stage.distances_m.contains(d)));
    let shared = |a: &Samples, b: &Samples| a.counts.iter().any(|one| b.counts.contains(one));
    assert!(!shared(&test, &stage) && !shared(&test, &choice) && !shared(&choice, &stage));
    let knots = scenes.knots(&recipe);
    let beyond = |knots: &[f64]| knots.iter().filter(|k| (200.0..256.0).contains(*k)).count();
    assert!(beyond(&knots) > 2 * beyond(&basis::knots()), "{knots:?}");
    let fewer = Recipe { knots: Some(31), ..recipe };
    assert_eq!(scenes.knots(&fewer).len(), 31);
}

#[test]
fn the_thesis_s_grids_are_as_they_were() {
    let source = source();
    let thesis = TrainingScenes::thesis(&source);
    let of = TrainingScenes::of_grids(&source, Grid::training(), Grid::test());
    assert_eq!((of.training, of.test), (thesis.training.clone(), thesis.test.clone()));
    assert!(thesis.knots(&Recipe::default()).is_empty());
}

#[test]
fn too_few_distances_or_histograms_are_refused() {
    let source = source();
    let check = |option: &str, recipe: &Recipe| {
        scenes(&source, option).check(recipe).err().map(|error| error.to_string())
    };
    assert_eq!(check("target.distance_m=0.1..0.6:0.0025", &Recipe::quick()), None);
    let one = check("target.reflectance=0.1,0.2", &Recipe::quick()).unwrap();
    assert!(one.contains("target.distance_m: one value, expected two"), "{one}");
    let many = check("target.distance_m=0.1..0.9:0.001", &Recipe::quick()).unwrap();
    assert!(many.contains("stages[0].samples = 603: expected 801 or more"), "{many}");
}

#[test]
fn the_digest_sees_every_count_and_distance() {
    let samples = Samples { counts: vec![vec![7; 256]; 2], distances_m: vec![0.1, 0.2] };
    let mut other = samples.clone();
    other.counts[1][255] += 1;
    assert_ne!(samples.digest(), other.digest());
    let mut other = samples.clone();
    other.distances_m[0] = 0.1f64.next_up();
    assert_ne!(samples.digest(), other.digest());
    assert_eq!(samples.digest(), samples.clone().digest());
}
