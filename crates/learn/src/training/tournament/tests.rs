//! A training that is paused wherever it is.

use super::*;
use crate::dataset::HistogramSource;
use crate::training::checkpoint::{self, CheckpointOf};
use crate::training::data::TrainingScenes;
use std::sync::Mutex;
use tofsim::error::Error;
use tofsim::scenario;
use tofsim::sim::setup::Setup;

fn recipe() -> Recipe {
    let stage = |candidates, epochs, samples| Stage { candidates, epochs, samples };
    let quick = Recipe::quick();
    Recipe {
        checkpoint_epochs: 2,
        stages: vec![stage(3, 2, 402), stage(2, 2, 402)],
        finish: super::super::recipe::Finish { epochs: 2, samples: 402, ..quick.finish },
        ..quick
    }
}

#[test]
fn pauses_and_saved_states_move_nothing() {
    let setup = Setup::new(scenario::load("kc705", &[]).unwrap()).unwrap();
    let (source, recipe) = (HistogramSource::new(&setup).unwrap(), recipe());
    let scenes = TrainingScenes::thesis(&source);
    let done = Mutex::new(0);
    let count = |work| *done.lock().unwrap() += work;
    let watch = Watch { stop: None, done: &count, until: None };
    let mut whole = Tournament::new(&recipe, &scenes, 5, None);
    while !whole.is_over() {
        assert!(whole.advance(&watch).unwrap());
        assert!(!whole.is_between());
        assert_eq!(*done.lock().unwrap(), whole.progress().0);
    }
    assert_eq!(whole.progress().0, whole.progress().1);

    // Out of patience at once, so that each turn makes one epoch of a candidate or some more.
    let folder = tempfile::tempdir().unwrap();
    let (path, of) = (folder.path().join("checkpoint"), CheckpointOf::default());
    let (mut state, mut pauses, mut last) = (None, 0, 0);
    loop {
        let mut part = Tournament::new(&recipe, &scenes, 5, state.take());
        if part.is_over() {
            assert_eq!(part.state, whole.state);
            break;
        }
        let watch = Watch { until: Some(Instant::now()), ..watch };
        let arrived = part.advance(&watch).unwrap();
        assert_ne!(arrived, part.is_between());
        pauses += usize::from(!arrived);
        assert!(part.progress().0 > last, "it gets on");
        last = part.progress().0;
        checkpoint::save(&path, &of, &part.state).unwrap();
        state = Some(checkpoint::load(&path, &of, &recipe).unwrap());
    }
    assert!(pauses > 4, "{pauses}");
}

#[test]
fn without_blocks_the_best_of_the_last_stage_is_what_counts() {
    let setup = Setup::new(scenario::load("kc705", &[]).unwrap()).unwrap();
    let (source, mut recipe) = (HistogramSource::new(&setup).unwrap(), recipe());
    recipe.finish.blocks = 0;
    recipe.check().unwrap();
    let scenes = TrainingScenes::thesis(&source);
    let watch = Watch { stop: None, done: &|_| {}, until: None };
    let mut tournament = Tournament::new(&recipe, &scenes, 5, None);
    while !tournament.is_over() {
        tournament.advance(&watch).unwrap();
    }
    assert!(tournament.state.best.is_none() && tournament.state.stage == recipe.stages.len());
    assert_eq!(tournament.progress().0, tournament.progress().1);
    let costs = |stage| {
        let curve = tournament.state.curve.iter().filter(move |point| point.stage == stage);
        curve.map(|point| (point.start, point.cost)).collect::<std::collections::BTreeMap<_, _>>()
    };
    let (best, cost) = (tournament.state.candidates[0].start, costs(1));
    assert!(cost.len() == 2 && cost.values().all(|other| *other >= cost[&best]));
    let x = &tournament.state.candidates[0].lm.x;
    assert_eq!(tournament.result(), fold(x, recipe.neurons, &tournament.state.scaling));
}

#[test]
fn an_interruption_leaves_a_state_to_go_on_from() {
    let setup = Setup::new(scenario::load("kc705", &[]).unwrap()).unwrap();
    let (source, recipe) = (HistogramSource::new(&setup).unwrap(), recipe());
    let scenes = TrainingScenes::thesis(&source);
    let stop = AtomicBool::new(false);
    let interrupt = |_| stop.store(true, Ordering::Relaxed);
    let watch = Watch { stop: Some(&stop), done: &interrupt, until: None };
    let mut part = Tournament::new(&recipe, &scenes, 5, None);
    assert!(matches!(part.advance(&watch), Err(Error::Interrupted)));
    assert!(part.is_between());
    let free = Watch { stop: None, done: &|_| {}, until: None };
    let mut whole = Tournament::new(&recipe, &scenes, 5, None);
    whole.advance(&free).unwrap();
    part.advance(&free).unwrap();
    assert_eq!(part.state, whole.state);
}
