//! Tests of speed and memory.

use std::time::Duration;

use super::common::Server;

#[test]
#[ignore = "long: ./check --full"]
fn ten_frames_a_second_by_shots_and_five_by_cycles() {
    for (fidelity, least) in [("shot", 10.0), ("cycle", 5.0)] {
        let server = Server::start(&["--fidelity", fidelity, "--rate", "1000"]);
        std::thread::sleep(Duration::from_secs(5));
        let found = server.state()["time"]["frames_per_s"].as_f64().unwrap();
        println!("{fidelity}: {found:.1} frames a second");
        assert!(found > least, "{fidelity}: {found}");
    }
}

/// Returns the memory of a process [kB].
fn resident_kb(id: u32) -> u64 {
    let status = std::fs::read_to_string(format!("/proc/{id}/status")).unwrap();
    let line = status.lines().find(|line| line.starts_with("VmRSS:")).unwrap();
    line.split_whitespace().nth(1).unwrap().parse().unwrap()
}

#[test]
#[ignore = "long: ./check --full"]
fn half_an_hour_of_use_does_not_grow() {
    // At 20 frames a second that is 36,000 frames: the same with fewer shots, as fast as may be.
    let small =
        ["--fidelity", "shot", "-s", "firmware.shots_per_frame=300", "--rate", "1000", "--stopped"];
    let server = Server::start(&small);
    // One browser that has fallen asleep, for which nothing is kept.
    let mut asleep = std::net::TcpStream::connect(server.host()).unwrap();
    let request =
        format!("GET {}events HTTP/1.1\r\nHost: {}\r\n\r\n", server.path(), server.host());
    std::io::Write::write_all(&mut asleep, request.as_bytes()).unwrap();
    let use_it = |rounds: u32| {
        for round in 0..rounds {
            server.frames(200);
            let distance_m = 0.1 + f64::from(round % 50) / 100.0;
            server.act("scene", &format!("{{\"target.distance_m\":{distance_m}}}"));
            server.act("control", &format!("{{\"laser_en\":{}}}", round % 2 == 0));
            server.act("ila", "{\"arm\":true,\"set_up\":\"fig_6_6\"}");
            server.get("shot.vcd?signals=view");
            server.get("ila.ila");
        }
    };
    // A leak shows in both halves; that a thread has taken memory of its own for the first time, in one of them.
    let kb = [40, 70, 70].map(|rounds| {
        use_it(rounds);
        resident_kb(server.id())
    });
    let frames = server.state()["time"]["frames"].as_u64().unwrap();
    println!("{kb:?} kB after 8,000, 22,000 and {frames} frames");
    let least = kb[1].saturating_sub(kb[0]).min(kb[2].saturating_sub(kb[1]));
    assert!(frames >= 36_000 && least < 350, "{kb:?} kB");
}
