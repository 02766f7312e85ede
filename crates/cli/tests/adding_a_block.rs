//! The pages of docs/ that add something are enough to add it: their pieces are applied to a copy of the repository,
//! which is built once and run.

use std::collections::BTreeSet;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

const ROOT: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../..");

/// Pages whose pieces are applied, all to the same copy.
const PAGES: [&str; 6] = [
    "docs/adding-a-block.md",
    "docs/adding-a-column.md",
    "docs/adding-an-estimator.md",
    "docs/adding-a-key.md",
    "docs/adding-a-noise-source.md",
    "docs/adding-a-verb.md",
];

/// A piece of the example, and the file it goes into.
struct Piece<'a> {
    file: &'a str,
    place: Place<'a>,
    text: String,
}

/// Where in a file: all of a new one, or at the one line that reads so.
enum Place<'a> {
    New,
    Before(&'a str),
    After(&'a str),
    Instead(&'a str),
}

/// The pieces: each block of code with what the line before it says.
fn pieces(page: &str) -> Vec<Piece<'_>> {
    let mut pieces = Vec::new();
    let (mut lines, mut said) = (page.lines(), "");
    while let Some(line) = lines.next() {
        if line.starts_with("```") {
            let text = lines.by_ref().take_while(|line| *line != "```");
            let text = text.map(|line| format!("{line}\n")).collect();
            let words: Vec<_> = said.split('`').collect();
            let (file, place) = match words[..] {
                ["", file, ", a new file:"] => (file, Place::New),
                ["In ", file, ", before ", line, ":"] => (file, Place::Before(line)),
                ["In ", file, ", after ", line, ":"] => (file, Place::After(line)),
                ["In ", file, ", in place of ", line, ":"] => (file, Place::Instead(line)),
                _ => panic!("where does the code after this line go? {said}"),
            };
            pieces.push(Piece { file, place, text });
        } else if !line.is_empty() {
            said = line;
        }
    }
    pieces
}

impl Piece<'_> {
    fn apply(&self, root: &Path) {
        let path = root.join(self.file);
        let (Place::Before(line) | Place::After(line) | Place::Instead(line)) = self.place else {
            assert!(!path.exists(), "{} is there already", self.file);
            return fs::write(path, &self.text).unwrap();
        };
        let old = fs::read_to_string(&path).unwrap();
        let found = old.lines().filter(|other| other.trim() == line).count();
        assert_eq!(found, 1, "lines in {} that read {line}", self.file);
        let changed = |other: &str| match self.place {
            _ if other.trim() != line => format!("{other}\n"),
            Place::Before(_) => format!("{}{other}\n", self.text),
            Place::After(_) => format!("{other}\n{}", self.text),
            Place::Instead(_) | Place::New => self.text.clone(),
        };
        fs::write(path, old.lines().map(changed).collect::<String>()).unwrap();
    }
}

/// A copy of the files that git knows.
///
/// It has another version, or what is built of it would take the names of this repository's own libraries.
fn copy(to: &Path) {
    let listed = Command::new("git").args(["ls-files", "-z"]).current_dir(ROOT).output().unwrap();
    assert!(listed.status.success());
    for name in String::from_utf8(listed.stdout).unwrap().split_terminator('\0') {
        let path = to.join(name);
        fs::create_dir_all(path.parent().unwrap()).unwrap();
        fs::copy(Path::new(ROOT).join(name), path).unwrap();
    }
    let manifest = to.join("Cargo.toml");
    let text = fs::read_to_string(&manifest).unwrap();
    let version = concat!("version = \"", env!("CARGO_PKG_VERSION"), "\"");
    assert_eq!(text.matches(version).count(), 1);
    fs::write(manifest, text.replace(version, "version = \"0.0.0\"")).unwrap();
}

/// Runs a program that must succeed, and returns its output.
fn run(command: &mut Command) -> String {
    let output = command.output().unwrap();
    let errors = String::from_utf8_lossy(&output.stderr);
    let text = String::from_utf8_lossy(&output.stdout).into_owned();
    assert!(output.status.success(), "{command:?}\n{text}{errors}");
    text
}

/// The packages that the program consists of.
const OURS: [&str; 6] =
    ["tofsim", "tofsim-captures", "tofsim-rtl", "tofsim-learn", "tofsim-studies", "tofsim-cli"];

/// The tests that see a new block or effect: port tables, imports, documentation, and what the fast ways give.
const SEE_THEM: [&str; 6] = [
    "docs",
    "effects",
    "layers",
    "public_face",
    "fast_ways::nothing_reads",
    "fast_ways::clear_and",
];

#[test]
#[ignore = "long: ./check --full"]
fn the_block_of_the_page_passes_lockstep_and_is_in_waveform_vectors_and_port_table() {
    let folder = tempfile::tempdir().unwrap();
    let root = folder.path();
    copy(root);
    for page in PAGES {
        let page = fs::read_to_string(root.join(page)).unwrap();
        let pieces = pieces(&page);
        assert!(pieces.len() > 2);
        pieces.iter().for_each(|piece| piece.apply(root));
    }

    // Other people's libraries are where this test's own are; what is made of the copy is apart.
    let target = PathBuf::from(env!("CARGO_TARGET_TMPDIR")).join("adding_a_block");
    let libraries = Path::new(env!("CARGO_TARGET_TMPDIR")).parent().unwrap();
    let cargo = |args: &[&str]| {
        let mut cargo = Command::new(env!("CARGO"));
        cargo.args(args).current_dir(root).env("UPDATE_DOCS", "1");
        cargo.env("CARGO_TARGET_DIR", &target).env("CARGO_BUILD_BUILD_DIR", libraries);
        cargo.env("CARGO_INCREMENTAL", "0");
        run(&mut cargo);
    };
    cargo(&["fmt", "--check"]);
    // What is built once and runs for seconds is hardly optimised; the libraries are those that tests have.
    let slow = OURS.map(|package| {
        let level = if package == "tofsim" { 1 } else { 0 };
        format!("--config=profile.test.package.{package}.opt-level={level}")
    });
    let slow = slow.each_ref().map(String::as_str);
    let simulator = ["--offline", "--workspace", "--test", "simulator"];
    let program = ["--profile", "test", "--bin", "tofsim"];
    cargo(&[&["build"], &simulator[..], &program, &slow].concat());
    cargo(&[&["test"], &simulator[..], &slow, &["--"], &SEE_THEM].concat());
    let model = fs::read_to_string(root.join("docs/model.md")).unwrap();
    assert!(model.contains("`miss_counter`: counts the shots of a frame that end without a code."));
    assert!(model.contains("| `misses` | 16 | out | Shots without a code in this frame. |"));

    let lint = "verilator --lint-only -Wall --top-module tof_top rtl_ref/*.v";
    run(Command::new("sh").args(["-c", lint]).current_dir(root));
    let tofsim =
        |args: &[&str]| run(Command::new(target.join("debug/tofsim")).args(args).current_dir(root));
    for simulator in ["icarus", "verilator"] {
        tofsim(&["verify", "--block", "miss_counter", "--simulator", simulator]);
    }
    let far = ["-s", "target.distance_m=1.2", "--window", "shot:0..50"];
    tofsim(&[&["run", "-o", "out", "--signals", "miss_counter.*"], &far[..]].concat());
    let vcd = fs::read_to_string(root.join("out/kc705.vcd")).unwrap();
    for line in ["$scope module miss_counter $end", " clk_sys $end", " misses [15:0] $end"] {
        assert!(vcd.contains(line), "{line}");
    }
    tofsim(&["vectors", "miss_counter", "-o", "out"]);
    let ports = fs::read_to_string(root.join("out/miss_counter/ports.json")).unwrap();
    assert!(ports.contains(r#""meaning": "Shots without a code in this frame.""#));
    let plan = "outputs = [\"fullest_bin_hits\"]\nframes = 2\n";
    fs::write(root.join("plan.toml"), plan).unwrap();
    let table = tofsim(&["sweep", "plan.toml"]);
    assert!(table.contains("fullest_bin_hits") && table.contains("+-"), "{table}");

    let signal = |set: &str| {
        let found = tofsim(&["budget", "--json", "-s", set]);
        let found: serde_json::Value = serde_json::from_str(&found).unwrap();
        found["signal_per_shot"].as_f64().unwrap()
    };
    assert_eq!(signal("spad.microlens_gain=2"), 2.0 * signal("spad.microlens_gain=1"));
    let accuracy = fs::read_to_string(root.join("docs/accuracy.md")).unwrap();
    assert!(accuracy.contains("| `laser.misfire_probability` | "));
    let chance = "laser.misfire_probability=0.4";
    let shots = ["--waves", "none", "--fidelity", "shot", "--json", "-s", chance];
    let found = tofsim(&[&["run", "--estimator", "likelihood"], &shots[..]].concat());
    assert!(found.contains("pile-up differs from shot to shot"), "{found}");
    for simulator in ["icarus", "verilator"] {
        tofsim(&["verify", "--block", "argmax_estimator", "--simulator", simulator]);
    }
    let argmax = ["-s", "estimator.kind=argmax"];
    tofsim(&[&["verify", "--block", "tof_top"], &argmax[..]].concat());
    let shots = ["--waves", "none", "--fidelity", "shot", "--json", "--estimator", "argmax"];
    let found = tofsim(&[&["run"], &argmax[..], &shots].concat());
    let found: serde_json::Value = serde_json::from_str(&found).unwrap();
    let frame = &found["frames"][0];
    assert_eq!(frame["estimator"], "argmax");
    let depth_m = frame["depth_m"].as_f64().unwrap();
    assert!((depth_m - 0.5).abs() < 0.05, "{depth_m} m");
    assert_eq!(frame["estimates"][0]["depth_m"], frame["depth_m"]);

    let table = tofsim(&["rates"]);
    assert!(table.contains("rate [MHz]") && table.contains("20.833"), "{table}");
}

#[test]
fn every_piece_of_the_page_has_its_place_and_is_formatted() {
    let pages = PAGES.map(|page| fs::read_to_string(Path::new(ROOT).join(page)).unwrap());
    let folder = tempfile::tempdir().unwrap();
    let mut changed = BTreeSet::new();
    for piece in pages.iter().flat_map(|page| pieces(page)) {
        let path = folder.path().join(piece.file);
        fs::create_dir_all(path.parent().unwrap()).unwrap();
        let original = Path::new(ROOT).join(piece.file);
        if !path.exists() && original.exists() {
            fs::copy(original, &path).unwrap();
        }
        piece.apply(folder.path());
        changed.insert(path);
    }
    changed.retain(|path| path.extension().is_some_and(|extension| extension == "rs"));
    assert!(!changed.is_empty());
    for path in changed {
        // From its standard input, rustfmt does not look for a file's modules.
        let mut rustfmt = Command::new("rustfmt");
        rustfmt.args(["--check", "--edition", "2024", "--config-path", ROOT]);
        run(rustfmt.stdin(fs::File::open(path).unwrap()));
    }
}
