//! One frame from Rust: a scenario with overrides, its depth and the fullest bin.

use tofsim::scenario;
use tofsim::sim::Run;
use tofsim::sim::frames::Frame;
use tofsim::sim::run::Observers;
use tofsim::sim::setup::Setup;

fn main() -> tofsim::error::Result<()> {
    let overrides = ["target.distance_m=0.3".to_owned(), "seed=7".to_owned()];
    let setup = Setup::new(scenario::load("kc705", &overrides)?)?;
    let mut show = |frame: &Frame| {
        let fullest = frame.histogram.iter().enumerate().max_by_key(|(_, count)| **count);
        println!("{:.4} m, {} hits, fullest bin {fullest:?}", frame.depth_m(), frame.hits());
        Ok(())
    };
    let watch = Observers { frames: Some(&mut show), ..Observers::default() };
    let outcome = Run::new(&setup).frames(1, watch)?;
    println!("{} cycles of clk_125", outcome.cycles);
    Ok(())
}
