use super::*;

/// Periods in which the slowest of these scenes forgets how it began.
const LONG: usize = 20_000;

fn scenes() -> [(FreeRunning, Echo); 4] {
    let free = |period_ns: f64, dead_ns: f64| FreeRunning {
        period_ps: period_ns * 1e3,
        dead_ps: dead_ns * 1e3,
        cycle_ps: 8000.0,
        tap_0_ps: 1200.0,
        chain_ps: 9000.0,
    };
    let echo = |signal: f64, background_per_ps: f64| Echo {
        arrival_ps: 3300.0,
        signal,
        background_per_ps,
    };
    [
        (free(48.0, 20.0), echo(0.5, 1e-5)),
        (free(48.0, 20.0), echo(4.0, 1.5e-3)),
        // The dead time is no multiple of a step, and longer than a period.
        (free(48.0, 130.007), echo(2.0, 4e-4)),
        (free(48.0, 0.02), echo(60.0, 1e-6)),
    ]
}

/// The same by stepping, one period after the other.
fn stepped(free: &FreeRunning, pulse: &Pulse, echo: &Echo) -> [Vec<f64>; 2] {
    let count = (free.period_ps / STEP_PS).ceil() as usize;
    let step_ps = free.period_ps / count as f64;
    let hazard = |k: usize| {
        let signal = if k == 0 { 0.0 } else { pulse.part(k as f64 * step_ps - echo.arrival_ps) };
        echo.background_per_ps * k as f64 * step_ps + echo.signal * signal
    };
    let dead = (free.dead_ps / step_ps).max(1.0);
    let (whole, part) = (dead as usize, dead.fract());
    let fires: Vec<_> = (0..count).map(|k| 1.0 - (hazard(k) - hazard(k + 1)).exp()).collect();
    let (mut fired, mut armed) = (vec![0.0; whole + 1], 1.0);
    let mut seen = [vec![0.0; count], vec![0.0; count]];
    for step in 0..LONG * count {
        let k = step % count;
        let place = step % (whole + 1);
        let next = (step + 1) % (whole + 1);
        let back = (1.0 - part) * fired[next] + part * fired[place];
        (seen[0][k], seen[1][k]) = (armed, back);
        fired[place] = armed * fires[k];
        armed += back - fired[place];
    }
    seen
}

#[test]
fn what_is_solved_for_is_what_stepping_comes_to() {
    let pulse = Pulse::tailed(150.0, 0.0);
    for (free, echo) in scenes() {
        let found = Steady::new(&free, &pulse, &echo);
        let expected = stepped(&free, &pulse, &echo);
        for (found, expected) in [found.armed, found.back].iter().zip(&expected) {
            let off = found.iter().zip(expected).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
            assert!(off < 1e-8, "{free:?} {echo:?}: {off}");
        }
    }
}
