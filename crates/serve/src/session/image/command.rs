//! The command that gives the images of the page.

use std::collections::BTreeMap;

use crate::options::{Fidelity, Options};
use crate::session::scene;
use crate::session::shell::quoted;

/// Formats the command that gives so many images of a run with such a scene.
pub fn of_images(
    options: &Options,
    scene: &BTreeMap<String, f64>,
    fidelity: Fidelity,
    images: u64,
) -> String {
    let mut words = vec![format!("tofsim image {}", quoted(&options.scenario))];
    let changes = scene::overrides(scene);
    words.extend(options.set.iter().chain(&changes).map(|set| format!("-s {}", quoted(set))));
    words.extend(options.seed.map(|seed| format!("--seed {seed}")));
    words.push(format!("--fidelity {} --images {images} -o out", fidelity.name()));
    words.join(" ")
}

#[cfg(test)]
mod tests {
    use clap::Parser;

    use super::*;

    #[test]
    fn it_has_what_the_page_was_started_with_and_the_scene_since() {
        let words = ["tofsim-serve", "my array.toml", "-s", "array.rows=4", "--seed", "7"];
        let options = Options::parse_from(words);
        let scene = BTreeMap::from([("target.distance_m".to_owned(), 0.3)]);
        assert_eq!(
            of_images(&options, &scene, Fidelity::Shot, 3),
            "tofsim image 'my array.toml' -s array.rows=4 -s target.distance_m=0.3 --seed 7 --fidelity shot \
             --images 3 -o out"
        );
    }
}
