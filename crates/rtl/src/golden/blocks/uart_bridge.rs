//! Commands of a host, short ones, with words of the memory behind it; some stop in the middle, some have bytes without
//! a stop bit, no words, or codes that are none; there are spikes on the line, and resets.

use tofsim::firmware::uart_bridge::{In, Params, State};

use crate::golden::prelude::*;

mod host;

use host::{HostLine, Spoilt, complete};

/// Few cycles, so that there are many commands.
const PARAMS: Params = Params { bit_cycles: 4, timeout_cycles: 150 };
/// Lines, unless the setting has a number of its own: a command takes some 900.
const CYCLES: usize = 120_000;

pub(super) const SPEC: Spec = Spec {
    reset: Some("rst"),
    latency: &[
        // A byte of a bit each at least four cycles long.
        Latency { from: "uart_rx", to: "write_en", cycles: |_| 2 },
    ],
    ..Spec::new("uart_bridge", "uart_bridge", record)
};

fn record(spec: &'static Spec, setting: &Setting) -> Result<Vectors> {
    let mut setting = setting.clone();
    setting.setup.params.is_hosted = true;
    let mut commands = Cover::new("complete commands, code x 4 + words", complete());
    let mut spoilt = Cover::new("spoilt commands, kind x 16 + bytes before", Spoilt::cases());
    let mut resets = Cover::new("reset in state", 0..=State::Lost as u64);
    let mut line = HostLine::new(PARAMS);
    let mut run = Recorder::new(spec, &setting, In::list());
    for cycle in 0..setting.cycles.unwrap_or(CYCLES) {
        let uart_rx = line.level(&mut run.draw, &run.top.uart_bridge, &mut spoilt);
        let (state, _) = run.top.uart_bridge.under_way();
        // It reads for a few cycles only.
        let seldom = match state {
            State::Read => 40,
            State::Lost => 300,
            State::Length | State::Address => 800,
            _ => 5000,
        };
        let rst = cycle == FIRST_RESET || run.draw.one_in(seldom);
        resets.see_if(rst, state as u64);
        let i = In { rst, uart_rx, read_data: U::new(run.draw.bits()) };
        run.line(&i);
        run.top.uart_bridge.tick(&i, &PARAMS);
        if run.top.uart_bridge.heard
            && let Some(command) = line.complete()
        {
            commands.see(command);
        }
    }
    let vectors = run.vectors([commands, spoilt, resets]);
    Ok(vectors.with(vec![
        ("BitCycles", Parameter::Number(PARAMS.bit_cycles)),
        ("TimeoutCycles", Parameter::Number(PARAMS.timeout_cycles)),
    ]))
}
