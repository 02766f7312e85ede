//! Proves a promise of the Verilog with Yosys, and tries to prove what is next to it.

use std::path::Path;

use tofsim::error::Result;
use tofsim::files::output::write_bytes;

use crate::verify::process::{Finished, Limits, YOSYS};
use crate::verify::rtl::Rtl;
use crate::verify::yosys;

use super::design::with_defines;
use super::promises::Promise;

/// Result of one run of Yosys.
enum Answer {
    /// The property is proven, by an induction of so many steps.
    Holds(u32),
    /// The property does not hold, for this reason.
    Fails(String),
    /// There is no answer.
    Stuck(String),
}

/// Proves `promise` of `rtl`, and that the numbers next to it cannot be proven; why it may not hold, or
/// `None` if it holds in every cycle and no number next to it does.
///
/// # Errors
/// When Yosys is missing, `folder` cannot be written, or the user stops.
pub fn prove(
    promise: &Promise,
    rtl: &Rtl,
    folder: &Path,
    limits: &Limits,
) -> Result<Option<String>> {
    let file = folder.join(promise.properties.module).with_extension("sv");
    write_bytes(
        &file,
        with_defines(promise.properties.module, &promise.defines, promise.properties.text),
    )?;
    let ask = |number, steps| ask(promise, (number, steps), rtl, folder, limits);
    let steps = match ask(promise.expected, promise.properties.steps)? {
        Answer::Holds(steps) => steps,
        Answer::Fails(why) | Answer::Stuck(why) => return Ok(Some(why)),
    };
    // A property that holds of any number needs no longer an induction; the longest takes seconds.
    let steps = promise.properties.steps.min(steps + 2);
    for mutant in promise.expected.checked_sub(1).into_iter().chain([promise.expected + 1]) {
        let why = match ask(mutant, steps)? {
            Answer::Fails(_) => continue,
            Answer::Holds(_) => {
                format!("vacuous: {mutant} is proven as well as {}", promise.expected)
            }
            Answer::Stuck(why) => format!("perhaps vacuous: for {mutant} in its place, {why}"),
        };
        return Ok(Some(why));
    }
    Ok(None)
}

/// Runs Yosys to prove the property with a number, by an induction of at most so many steps.
fn ask(
    promise: &Promise,
    (number, steps): (u64, u32),
    rtl: &Rtl,
    folder: &Path,
    limits: &Limits,
) -> Result<Answer> {
    let mut args = yosys::sources(rtl, promise.properties.text, folder, None)?;
    args.extend(["-p".into(), script(promise, number, steps).into()]);
    Ok(answer(promise, &YOSYS.run(folder, args, limits)?))
}

/// Commands for Yosys. A module that is left open is one that it does not know.
pub(super) fn script(promise: &Promise, number: u64, steps: u32) -> String {
    let Promise { properties, property, parameter, .. } = promise;
    let module = properties.module;
    let code = promise.code.map_or(String::new(), |code| format!("-chparam Code {code}"));
    let mut lines: Vec<_> = properties.open.iter().map(|open| format!("delete *{open}")).collect();
    lines.extend([
        format!("read_verilog -sv -formal -DHOLDS={property} {module}.sv"),
        format!("hierarchy -top {module} -chparam {parameter} {number} {code}"),
        format!("{}; flatten", properties.logic),
    ]);
    // Something has to drive each register.
    let driven = |register: &str| format!("select -assert-min 1 w:dut.{register} %ci* c:* %i");
    lines.extend(promise.registers().map(driven));
    let options = "-tempinduct -prove-asserts -set-assumes -ignore_unknown_cells -seq 1";
    lines.extend([
        format!("{}; opt_clean", properties.step),
        format!("sat {options} -maxsteps {steps} {module}"),
    ]);
    lines.join("\n")
}

fn answer(promise: &Promise, finished: &Finished) -> Answer {
    let says = |text| finished.output.contains(text);
    if let Some(why) = finished.end.killed() {
        Answer::Stuck(format!("Yosys {why}"))
    } else if says("Induction step proven: SUCCESS!") {
        Answer::Holds(finished.output.matches("[induction step ").count() as u32)
    } else if says("proof finished - model found for base case: FAIL!") {
        let steps = finished.output.matches("[base case ").count();
        Answer::Fails(format!("Yosys has a counterexample of {steps} steps"))
    } else if says("Reached maximum number of time steps") {
        Answer::Fails(format!(
            "an induction of {} steps does not prove it",
            promise.properties.steps
        ))
    } else if says("ERROR: Assertion failed: selection") {
        let registers: Vec<_> = promise.registers().collect();
        Answer::Stuck(format!("the proof needs the registers {}", registers.join(" and ")))
    } else {
        Answer::Stuck(format!("Yosys: {}", finished.error().unwrap_or("ended without an answer")))
    }
}
