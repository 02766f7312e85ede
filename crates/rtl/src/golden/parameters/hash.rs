//! A hash of the firmware's parameters, by which a host knows that a board is the one it takes it for.
//!
//! It is the 64-bit FNV-1a hash of a text with a line for each parameter of `tof_top`, also where it is the default,
//! sorted by name: `Name = 7`; the words of a list side by side, `Name = 7 8 9`; and for a memory its lines and
//! the hash of its contents, `Name = 801 words 0123456789abcdef`. What only simulations have is left out.

use tofsim::files::digest::digest;
use tofsim::network::mem::Mem;
use tofsim::sim::setup::Setup;

use super::whole::tof_top_in_full;
use super::{Parameter, Parameters};

/// Parameters of models of the PLL and of the carry chain, which no bitstream has.
const SIMULATED: [&str; 2] = ["LockTime", "DelaysFile"];

/// Returns the hash of the parameters with which the firmware of a setup is built.
pub fn parameters_hash(setup: &Setup) -> u64 {
    digest(0, hashed_text(setup).as_bytes())
}

/// Returns the text that is hashed.
pub fn hashed_text(setup: &Setup) -> String {
    text(tof_top_in_full(setup))
}

fn text(parameters: Parameters) -> String {
    let built = parameters.iter().filter(|(name, _)| !SIMULATED.contains(name));
    let mut lines: Vec<_> =
        built.map(|(name, value)| format!("{name} = {}\n", words(value))).collect();
    lines.sort_unstable();
    lines.concat()
}

fn words(value: &Parameter) -> String {
    match value {
        Parameter::Number(number) => number.to_string(),
        Parameter::Words(words) => {
            words.iter().map(|word| word.to_string()).collect::<Vec<_>>().join(" ")
        }
        Parameter::Memory(memory) => contents(memory),
        Parameter::Flag(memories) => {
            let memories = memories.iter().map(|memory| " ".to_owned() + &contents(memory));
            "1".to_owned() + &memories.collect::<String>()
        }
    }
}

fn contents(memory: &Mem) -> String {
    let contents = digest(0, memory.text.as_bytes());
    format!("{} words {contents:016x}", memory.text.lines().count())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn hash(scenario: &str, set: &[&str]) -> u64 {
        parameters_hash(&Setup::load(scenario, set).unwrap())
    }

    #[test]
    fn the_text_names_each_parameter_once_in_order() {
        let memory = Mem::new("a.mem", "1\n2\n".to_owned());
        let parameters = vec![
            ("Order", Parameter::Words(vec![3, 1])),
            ("LockTime", Parameter::Number(5)),
            ("CalFile", Parameter::Memory(memory)),
            ("Bins", Parameter::Number(256)),
        ];
        let contents = digest(0, b"1\n2\n");
        let expected = format!("Bins = 256\nCalFile = 2 words {contents:016x}\nOrder = 3 1\n");
        assert_eq!(text(parameters), expected);
        let whole = hashed_text(&Setup::load("kc705", &[]).unwrap());
        for line in
            ["ShotsPerFrame = 30000\n", "Taps = 800\n", "W1File = 256 words ", "Estimator = 0\n"]
        {
            assert!(whole.contains(line), "{line}: {whole}");
        }
        assert!(!whole.contains("DelaysFile"), "{whole}");
    }

    #[test]
    fn it_is_the_same_for_every_scene() {
        let own = hash("kc705", &[]);
        for scene in ["target.distance_m=0.3", "ambient.irradiance_w_m2_nm=0.1", "seed=7"] {
            assert_eq!(hash("kc705", &[scene]), own, "{scene}");
        }
    }

    #[test]
    fn it_changes_with_numbers_memories_and_options() {
        let sets = [
            "firmware.shots_per_frame=3000",
            "estimator.kind=likelihood",
            "estimator.network=uniform-16",
            "tdc.profile=kintex7",
            "tdc.recalibrate_frames=4",
            "firmware.laser_periods=[25,13]",
            "firmware.count_bits=18",
        ];
        let mut hashes: Vec<_> = sets
            .iter()
            .map(|set| match *set {
                "firmware.laser_periods=[25,13]" => hash("kc705", &[set, "firmware.laser_freq=0"]),
                set => hash("kc705", &[set]),
            })
            .collect();
        hashes.push(hash("kc705", &[]));
        hashes.sort_unstable();
        hashes.dedup();
        assert_eq!(hashes.len(), sets.len() + 1);
    }
}
