use super::*;

fn plan(text: &str) -> Result<Plan> {
    Plan::parse("t", "t.toml", text, Path::new(""), &[], None)
}

fn error(text: &str) -> String {
    plan(text).err().map_or(String::new(), |error| error.to_string())
}

fn settings(text: &str) -> Vec<String> {
    let plan = plan(text).unwrap();
    (0..plan.points.count()).map(|point| plan.points.settings(point).join(" ")).collect()
}

#[test]
fn the_plans_that_come_with_the_program_are_ones() {
    for (name, _) in builtin::PLANS {
        let plan = Plan::load(name, &[], None).unwrap();
        assert!(!plan.file.description.is_empty() && plan.file.plot.is_some(), "{name}");
    }
}

#[test]
fn the_last_axis_of_a_product_changes_fastest() {
    let text = "[[axis]]\nkey = \"target.distance_m\"\nrange = \"0.1..0.3:0.1\"\n\
                [[axis]]\nkey = \"tdc.profile\"\nvalues = [\"uniform\", \"ideal\"]\n";
    let points = settings(text);
    assert_eq!(points.len(), 6);
    assert_eq!(points[0], "target.distance_m=0.1 tdc.profile=\"uniform\"");
    assert_eq!(points[1], "target.distance_m=0.1 tdc.profile=\"ideal\"");
    assert_eq!(points[5], "target.distance_m=0.3 tdc.profile=\"ideal\"");
}

#[test]
fn zipped_axes_go_together() {
    let text = "combine = \"zip\"\n[[axis]]\nkey = \"target.distance_m\"\nvalues = [0.1, 0.2]\n\
                [[axis]]\nkey = \"laser.average_power_w\"\nfrom = 1e-3\nto = 4e-3\ncount = 2\n";
    let expected = [
        "target.distance_m=0.1 laser.average_power_w=0.001",
        "target.distance_m=0.2 laser.average_power_w=0.004",
    ];
    assert_eq!(settings(text), expected);
    let uneven = text.replace("count = 2", "count = 3");
    assert!(
        error(&uneven).starts_with(
            "t.toml:6:7: axis.1.key = \"laser.average_power_w\": it has 3 values, expected 2"
        ),
        "{}",
        error(&uneven)
    );
}

#[test]
fn ranges_rise_evenly_or_by_factors_and_whole_numbers_stay_whole() {
    let range = |key: &str, rest: &str| settings(&format!("[[axis]]\nkey = \"{key}\"\n{rest}"));
    assert_eq!(
        range("target.distance_m", "from = 0.1\nto = 0.7\ncount = 3"),
        ["target.distance_m=0.1", "target.distance_m=0.4", "target.distance_m=0.7"]
    );
    assert_eq!(
        range("laser.average_power_w", "from = 1e-4\nto = 1e-2\ncount = 3\nscale = \"log\""),
        [
            "laser.average_power_w=0.0001",
            "laser.average_power_w=0.001",
            "laser.average_power_w=0.01"
        ]
    );
    let shots =
        range("firmware.shots_per_frame", "from = 100\nto = 10000\ncount = 4\nscale = \"log\"");
    assert_eq!(shots[1], "firmware.shots_per_frame=464");
}

#[test]
fn a_latin_hypercube_has_one_point_in_each_part_of_each_axis() {
    let text = "combine = \"latin_hypercube\"\nsamples = 50\n\
                [[axis]]\nkey = \"target.distance_m\"\nfrom = 0.1\nto = 0.6\n\
                [[axis]]\nkey = \"spad.pdp\"\ndistribution = \"normal\"\nmean = 0.012\nsd = 0.001\n\
                [[axis]]\nkey = \"laser.average_power_w\"\ndistribution = \"log_uniform\"\nfrom = 1e-3\nto = 1e-1\n";
    let plan = plan(text).unwrap();
    let column = |k: usize| -> Vec<f64> {
        (0..50).map(|point| plan.points.values(point)[k].parse().unwrap()).collect()
    };
    let parts = |values: Vec<f64>, part: &dyn Fn(f64) -> f64| {
        let mut parts: Vec<_> =
            values.into_iter().map(|value| (50.0 * part(value)) as usize).collect();
        parts.sort_unstable();
        parts
    };
    let order = |k: usize| {
        let values = column(k);
        let mut order: Vec<_> = (0..50).collect();
        order.sort_by(|&a, &b| values[a].total_cmp(&values[b]));
        order
    };
    assert!(order(0) != order(1) && order(1) != order(2), "each axis has an order of its own");
    let all: Vec<_> = (0..50).collect();
    assert_eq!(parts(column(0), &|value| (value - 0.1) / 0.5), all);
    assert_eq!(
        parts(column(1), &|value| tofsim::kernel::pulse::normal_cdf((value - 0.012) / 0.001)),
        all
    );
    assert_eq!(parts(column(2), &|value| (value / 1e-3).log10() / 2.0), all);
    assert_ne!(
        plan.points.values(0),
        Plan::parse("t", "t", text, Path::new(""), &[], Some(2)).unwrap().points.values(0)
    );
}

#[test]
fn draws_of_a_distribution_are_as_many_as_asked_for_and_belong_to_the_seed() {
    let text = "[[axis]]\nkey = \"target.reflectance\"\ndistribution = \"triangular\"\nfrom = 0.08\nmode = 0.3\nto = 0.6\ncount = 400\n";
    let drawn = plan(text).unwrap();
    let values: Vec<f64> = (0..400).map(|k| drawn.points.values(k)[0].parse().unwrap()).collect();
    let mean = values.iter().sum::<f64>() / 400.0;
    assert!((mean - (0.08 + 0.3 + 0.6) / 3.0).abs() < 0.02, "{mean}");
    assert!(values.iter().all(|value| (0.08..=0.6).contains(value)));
    assert_eq!(settings(text), settings(text));
}

#[test]
fn what_no_plan_can_say_is_refused_with_its_place() {
    let axis = |rest: &str| format!("[[axis]]\n{rest}\n");
    let distance = |rest: &str| axis(&format!("key = \"target.distance_m\"\n{rest}"));
    for (text, expected) in [
        ("frame = 3".to_owned(), "t.toml:1:1: frame: unknown key; did you mean `frames`?"),
        (
            axis("key = \"target.distanse_m\"\nvalues = [1]"),
            "t.toml:2:7: axis.0.key = \"target.distanse_m\": target.distanse_m: unknown key; did you mean `distance_m`?",
        ),
        (distance("values = [0.1, -1]"), "expected a number from 0.001 to 1000.0 [m]"),
        (distance("values = []"), "t.toml:3:10: axis.0.values = []: expected 1 to"),
        (
            distance("from = 0.5\nto = 0.1\ncount = 3"),
            "t.toml:4:6: axis.0.to = 0.1: expected a number above from: the range is empty",
        ),
        (distance("from = 0.1\nto = 0.5"), "axis.0.count: expected count"),
        (distance("range = \"0.5..0.1:0.1\""), "t.toml:3:9: axis.0.range = \"0.5..0.1:0.1\": "),
        (
            distance("values = [1]\nrange = \"1..2:1\""),
            "expected one of values, range, from and to, or distribution",
        ),
        (
            distance("values = [0.1]") + &distance("values = [0.2]"),
            "axis.1.key = \"target.distance_m\": expected each key once",
        ),
        (axis("key = \"seed\"\nvalues = [1]"), "every point has random numbers of its own"),
        ("samples = 4".to_owned(), "expected samples with combine = \"latin_hypercube\""),
        ("estimators = [\"pek\"]".to_owned(), "no such estimator (`peak`?)"),
        ("outputs = [\"hits_per_fram\"]".to_owned(), "no such column (`hits_per_frame`?)"),
        (
            "set = [\"spad.pdpp=1\"]".to_owned(),
            "set.0 = \"spad.pdpp=1\": spad.pdpp: unknown key; did you mean `pdp`?",
        ),
        (
            "scenario = \"kc750\"".to_owned(),
            "scenario: kc750: no such file or built-in scenario (`kc705`?)",
        ),
        (
            "[plot]\ntitle = \"\"\nx = \"pont\"\ny = [\"hits_per_frame\"]".to_owned(),
            "plot.x = \"pont\": no such column (`point`?)",
        ),
        (distance("values = [0.1, \"a\"]"), "target.distance_m = \"a\": expected a number from"),
        (
            "[plot]\ntitle = \"\"\nx = \"target.distance_m\"\ny = []\n".to_owned()
                + &distance("values = [1]"),
            "plot.y = []: expected a column at least",
        ),
    ] {
        let found = error(&text);
        assert!(found.contains(expected), "{text}\n{found}");
    }
}

#[test]
fn too_many_points_are_refused_with_their_number() {
    let axis =
        |key: &str| format!("[[axis]]\nkey = \"{key}\"\nfrom = 0.1\nto = 0.6\ncount = 10000\n");
    let text = axis("target.distance_m")
        + &axis("target.reflectance")
        + &axis("ambient.irradiance_w_m2_nm");
    assert!(
        error(&text).contains("the plan has 1,000,000,000,000 points, expected 10,000,000 at most"),
        "{}",
        error(&text)
    );
}

#[test]
fn a_search_has_to_make_sense() {
    let search = |rest: &str| {
        format!(
            "estimators = [\"peak\"]\n[search]\nkey = \"target.distance_m\"\nfind = \"largest\"\nfrom = 0.1\nto = 0.5\nresolution = 0.01\n{rest}"
        )
    };
    let meets = "meets = [\"peak.failure_rate < 0.1\"]\n";
    let meets_of = |limits: &str| {
        let plan = plan(&search(&format!("meets = [{limits}]\n"))).unwrap();
        plan.search.unwrap().meets.iter().map(|limit| limit.to_string()).collect::<Vec<_>>()
    };
    plan(&search(meets)).unwrap();
    let all = ["peak.sd_mm < 1", "peak.sd_mm <= 2", "peak.sd_mm > 3", "peak.sd_mm >= 4"];
    assert_eq!(meets_of(&format!("\"{}\"", all.join("\", \""))), all);
    for (text, expected) in [
        (search("meets = []"), "search.meets = []: expected a limit"),
        (
            search("meets = [\"peak.failure_rate\"]"),
            "expected a column, <, <=, > or >=, and a number",
        ),
        (
            search("meets = [\"peak.failure_rat < 1\"]"),
            "no column `peak.failure_rat` (`peak.failure_rate`?)",
        ),
        (
            search(meets) + "[[axis]]\nkey = \"target.distance_m\"\nvalues = [1]\n",
            "search.key = \"target.distance_m\": expected a key that no axis has",
        ),
        (
            search(meets) + "[[search.over]]\nkey = \"spad.pdp\"\nfrom = 0.1\nto = 0.2\n",
            "search.over.0.key = \"spad.pdp\": expected values, range, or from, to and count",
        ),
        (
            search(meets).replace("to = 0.5", "to = 0.1"),
            "search.to = 0.1: expected a number above from",
        ),
        (
            search(meets).replace("resolution = 0.01", "resolution = 0"),
            "search.resolution = 0: expected a number above 0",
        ),
    ] {
        let found = error(&text);
        assert!(found.contains(expected), "{text}\n{found}");
    }
}

#[test]
fn the_command_line_sets_what_the_plan_does_not_vary() {
    let text = "[[axis]]\nkey = \"target.distance_m\"\nvalues = [0.1]\n";
    let set =
        |over: &str| Plan::parse("t", "t.toml", text, Path::new(""), &[over.to_owned()], None);
    assert_eq!(set("spad.pdp=0.02").unwrap().base().unwrap().scenario.spad.pdp, 0.02);
    let error = set("target.distance_m=0.2").err().unwrap().to_string();
    assert!(error.starts_with("-s target.distance_m=0.2: the plan has the values"), "{error}");
}
