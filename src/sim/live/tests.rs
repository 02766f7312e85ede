use super::*;

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
