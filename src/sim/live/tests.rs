use super::*;
use crate::Observers;
use crate::scenario::QuenchMode;

const SMALL: &str = "firmware.shots_per_frame=300";

fn setup(set: &[&str]) -> Arc<Setup> {
    Arc::new(Setup::load("kc705", &[&[SMALL], set].concat()).unwrap())
}

fn next(live: &mut Live) -> Frame {
    loop {
        match live.advance(10_007, &mut Off, None).unwrap() {
            Progress::Frame(frame, _) => return frame,
            Progress::Abandoned | Progress::Going => {}
        }
    }
}

#[test]
fn untouched_it_gives_the_frames_of_a_run() {
    let setup = setup(&[]);
    let frames = crate::Run::new(&setup).frames(3).unwrap();
    for stepping in [Stepping::EveryCycle, Stepping::SkipIdle, Stepping::LeapShots] {
        let mut live = Live::new(Arc::clone(&setup), stepping);
        frames.iter().for_each(|frame| assert_eq!(&next(&mut live), frame));
        assert_eq!((live.done(), live.abandoned()), (3, 0));
    }
}

#[test]
fn pauses_after_every_edge_change_nothing() {
    let setup = setup(&["firmware.shots_per_frame=20"]);
    let frames = crate::Run::new(&setup).frames(2).unwrap();
    let mut shots = Vec::new();
    let mut live = Live::new(setup, Stepping::EveryCycle);
    let mut found = Vec::new();
    while found.len() < 2 {
        let mut keep = |shot: &Shot| {
            shots.push((shot.frame, shot.shot));
            Ok(())
        };
        if let Progress::Frame(frame, _) = live.advance(1, &mut Off, Some(&mut keep)).unwrap() {
            found.push(frame);
        }
    }
    assert_eq!(found, frames);
    let all: Vec<_> = (0..2).flat_map(|frame| (0..20).map(move |shot| (frame, shot))).collect();
    assert_eq!(shots, all);
}

#[test]
fn a_change_on_the_way_is_a_change_of_the_scenario() {
    let no_light = "ambient.irradiance_w_m2_nm=0";
    let setup = setup(&[no_light]);
    let off = Control { laser_en: Some(false), ..Control::default() };
    let mut live = Live::new(Arc::clone(&setup), Stepping::LeapShots);
    next(&mut live);
    live.advance(1000, &mut Off, None).unwrap();
    let change = live.control(off, Time::ZERO);
    let found = [next(&mut live), next(&mut live)];
    let mut loaded = crate::scenario::load("kc705", &[SMALL, no_light].map(str::to_owned)).unwrap();
    loaded.scenario.control.push(change);
    let told = Setup::new(loaded).unwrap();
    assert_eq!(&crate::Run::new(&told).frames(3).unwrap()[1..], &found);
    let dark = found[1].hits();
    assert!(!found[1].laser_en && dark < 5, "{dark} hits");
}

#[test]
fn a_frame_is_of_one_scene() {
    let [near, far] = [setup(&["target.distance_m=0.2"]), setup(&["target.distance_m=0.6"])];
    let peak =
        |frame: &Frame| (0..256).max_by_key(|&bin| frame.histogram[bin]).unwrap_or_default() as i64;
    let mut live = Live::new(near, Stepping::SkipIdle);
    live.advance(1000, &mut Off, None).unwrap();
    assert!(live.change_scene(far));
    let [first, second] = [next(&mut live), next(&mut live)].map(|frame| peak(&frame));
    // 1.33 ns and 4 ns, in bins of 25 ps.
    assert!((first - 53).abs() < 8 && (second - 160).abs() < 12, "{first} {second}");
}

#[test]
fn dsp_rst_abandons_the_frame() {
    let mut live = Live::new(setup(&[]), Stepping::LeapShots);
    next(&mut live);
    live.advance(1000, &mut Off, None).unwrap();
    let level = |dsp_rst| Control { dsp_rst: Some(dsp_rst), ..Control::default() };
    live.control(level(true), Time::ZERO);
    let over = live.advance(10_000, &mut Off, None).unwrap();
    assert!(matches!(over, Progress::Abandoned), "{over:?}");
    assert!(matches!(live.advance(100_000, &mut Off, None), Ok(Progress::Going)));
    assert_eq!((live.done(), live.abandoned(), live.shots_of_frame()), (1, 1, 0));
    live.control(level(false), Time::from_ns(1000));
    assert_eq!(next(&mut live).shots, 300);
}

#[test]
fn a_change_comes_after_its_instant_and_after_the_one_before() {
    let mut live = Live::new(setup(&[]), Stepping::SkipIdle);
    live.advance(500, &mut Off, None).unwrap();
    let mut edge = live.now().fs();
    let mut last_ns = 0.0;
    for after in [3000, 0, 0, 7000].map(Time::from_ns) {
        let change = live
            .control(Control { mode: Some(QuenchMode::FreeRunning), ..Control::default() }, after);
        let at_ns = (change.at_us * 1e3).round();
        assert_eq!(Time::from_ps_f64(change.at_us * 1e6).fs() % 1_000_000, 0);
        assert!(at_ns * 1e6 > (edge + after.fs()) as f64, "not later than asked for");
        assert!(at_ns > last_ns, "{at_ns} ns does not come after {last_ns} ns");
        assert!(live.is_changing());
        (last_ns, edge) = (at_ns, live.now().fs());
    }
    live.advance(2000, &mut Off, None).unwrap();
    assert!(!live.is_changing());
}

#[test]
fn a_scene_comes_with_the_next_frame_or_at_once_in_clear() {
    let [near, far] = [setup(&["target.distance_m=0.2"]), setup(&["target.distance_m=0.6"])];
    let mut live = Live::new(Arc::clone(&near), Stepping::SkipIdle);
    live.advance(20, &mut Off, None).unwrap();
    assert!(live.is_clearing() && live.change_scene(Arc::clone(&far)));
    assert!(Arc::ptr_eq(live.setup(), &far), "in Clear it comes at once");
    live.advance(1000, &mut Off, None).unwrap();
    assert!(!live.is_clearing() && live.change_scene(Arc::clone(&near)));
    assert!(Arc::ptr_eq(live.setup(), &far), "a frame is of one scene");
    let ended = loop {
        match live.advance(10_000, &mut Off, None).unwrap() {
            Progress::Frame(_, setup) => break setup,
            Progress::Abandoned | Progress::Going => {}
        }
    };
    assert!(Arc::ptr_eq(&ended, &far), "the frame that has ended was of that scene");
    live.advance(1000, &mut Off, None).unwrap();
    assert!(Arc::ptr_eq(live.setup(), &near));
}

#[test]
fn scenes_and_signals_change_the_same_whichever_way_time_goes() {
    let [near, far] = [setup(&["target.distance_m=0.2"]), setup(&["target.distance_m=0.6"])];
    let frames = [Stepping::EveryCycle, Stepping::SkipIdle, Stepping::LeapShots].map(|stepping| {
        let mut live = Live::new(Arc::clone(&near), stepping);
        let mut frames = vec![next(&mut live)];
        for (scene, mode) in [
            (&far, QuenchMode::FreeRunning),
            (&near, QuenchMode::EachShot),
            (&far, QuenchMode::EachShot),
        ] {
            live.change_scene(Arc::clone(scene));
            live.control(Control { mode: Some(mode), ..Control::default() }, Time::from_ns(5000));
            frames.extend([next(&mut live), next(&mut live)]);
        }
        frames
    });
    assert_eq!(frames[0], frames[1]);
    assert_eq!(frames[0], frames[2]);
}

#[test]
fn given_photons_have_no_scene_to_change() {
    let given = |distance: &str| {
        Arc::new(Setup::load("tdc_validation", &[distance, "firmware.shots_per_frame=4"]).unwrap())
    };
    let own = given("target.distance_m=0.2");
    let mut live = Live::new(Arc::clone(&own), Stepping::SkipIdle);
    live.advance(20, &mut Off, None).unwrap();
    assert!(live.is_clearing() && !live.change_scene(given("target.distance_m=0.6")));
    assert!(Arc::ptr_eq(live.setup(), &own));
}

#[test]
fn its_shots_are_those_of_a_run_however_the_time_is_cut() {
    let setup = setup(&[]);
    let (mut expected, mut found) = (Vec::new(), Vec::new());
    let mut take = |shot: &Shot| {
        expected.push(*shot);
        Ok(())
    };
    let observers = Observers { shots: Some(&mut take), ..Default::default() };
    crate::Run::new(&setup).observe(2, observers).unwrap();
    let mut live = Live::new(Arc::clone(&setup), Stepping::SkipIdle);
    while live.done() < 2 {
        let mut take = |shot: &Shot| {
            found.push(*shot);
            Ok(())
        };
        live.advance(101, &mut Off, Some(&mut take)).unwrap();
    }
    assert_eq!(expected.len(), 600);
    assert_eq!(found, expected);
    // Of a frame that is abandoned, too, and at once.
    let shots = std::cell::Cell::new(0);
    let mut take = |_: &Shot| {
        shots.set(shots.get() + 1);
        Ok(())
    };
    live.advance(1000, &mut Off, Some(&mut take)).unwrap();
    assert!(shots.get() > 100, "each call hands on what is complete");
    live.control(Control { dsp_rst: Some(true), ..Control::default() }, Time::ZERO);
    let over = live.advance(10_000, &mut Off, Some(&mut take)).unwrap();
    assert!(matches!(over, Progress::Abandoned), "{over:?}");
    assert_eq!(shots.get(), live.shots() - 600);
}

#[test]
fn a_waveform_ends_with_the_frame() {
    let setup = setup(&[]);
    let folder = tempfile::tempdir().unwrap();
    let mut live = Live::new(Arc::clone(&setup), Stepping::SkipIdle);
    live.advance(1000, &mut Off, None).unwrap();
    let trace = |from: u64, cycles: u64| {
        let path = folder.path().join("shot.vcd");
        let waves = setup.waves(&path, crate::WaveFormat::Vcd, &["tdc_code"]).unwrap();
        let window = Window::Shots { from, to: from + 1 };
        live.clone().trace(waves, vec![window], cycles).map(|_| std::fs::read(path).unwrap())
    };
    assert!(!trace(299, 10_000).unwrap().is_empty());
    // The next frame's first shot, and one that comes after so many cycles.
    assert!(trace(300, 100_000).is_err());
    assert!(trace(299, 100).is_err());
}
