//! One frame, from photons to a depth.

use tofsim::{Run, Setup};

fn main() -> tofsim::Result<()> {
    let setup = Setup::load("kc705", &["target.distance_m=0.3", "seed=7"])?;
    for frame in Run::new(&setup).frames(1)? {
        let fullest = frame.histogram.iter().enumerate().max_by_key(|(_, hits)| **hits);
        println!("{:.4} m, {} hits, fullest bin {fullest:?}", frame.depth_m(), frame.hits());
        println!("{} cycles of clk_sys", frame.frame_cycles);
    }
    Ok(())
}
