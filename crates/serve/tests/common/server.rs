//! The program `tofsim-serve`, and requests to it.

use std::io::{BufRead, BufReader, Read, Write};
use std::net::TcpStream;
use std::process::{Child, Command, Stdio};
use std::time::{Duration, Instant};

use serde_json::Value;

/// A server, which is stopped when dropped.
pub struct Server {
    process: Child,
    pub url: String,
}

/// A response: status, headers and body.
pub struct Answer {
    pub status: u16,
    pub head: String,
    pub body: Vec<u8>,
}

impl Answer {
    pub fn json(&self) -> Value {
        serde_json::from_slice(&self.body).unwrap_or_else(|error| {
            panic!("{error}: {} {}", self.status, String::from_utf8_lossy(&self.body))
        })
    }

    /// Returns the error text.
    pub fn fault(&self) -> String {
        self.json()["error"].as_str().unwrap_or_default().to_owned()
    }
}

impl Drop for Server {
    fn drop(&mut self) {
        let _ = self.process.kill();
        let _ = self.process.wait();
    }
}

impl Server {
    /// Starts a server with the given arguments.
    pub fn start(arguments: &[&str]) -> Self {
        let mut process = Command::new(env!("CARGO_BIN_EXE_tofsim-serve"))
            .arg("--quiet")
            .args(arguments)
            .stdout(Stdio::piped())
            .spawn()
            .unwrap();
        let mut url = String::new();
        BufReader::new(process.stdout.take().unwrap()).read_line(&mut url).unwrap();
        Server { process, url: url.trim().to_owned() }
    }

    /// Starts a stopped server with frames of 300 shots.
    pub fn small(arguments: &[&str]) -> Self {
        let small = ["--stopped", "-s", "firmware.shots_per_frame=300"];
        Server::start(&[&small, arguments].concat())
    }

    pub fn id(&self) -> u32 {
        self.process.id()
    }

    /// Waits for the server to end.
    pub fn end(mut self) -> std::process::ExitStatus {
        self.process.wait().unwrap()
    }

    /// Returns host and port.
    pub fn host(&self) -> &str {
        self.url["http://".len()..].split('/').next().unwrap()
    }

    /// Returns the path of the page, including its token.
    pub fn path(&self) -> &str {
        &self.url["http://".len() + self.host().len()..]
    }

    /// Sends a raw request.
    pub fn send(&self, request: &str) -> Answer {
        let mut stream = TcpStream::connect(self.host()).unwrap();
        stream.set_read_timeout(Some(Duration::from_secs(60))).unwrap();
        stream.write_all(request.as_bytes()).unwrap();
        let mut answer = Vec::new();
        stream.read_to_end(&mut answer).unwrap();
        let end = answer.windows(4).position(|four| four == b"\r\n\r\n").expect("a head");
        let head = String::from_utf8_lossy(&answer[..end]).into_owned();
        let status = head.split(' ').nth(1).unwrap().parse().unwrap();
        Answer { status, head, body: answer[end + 4..].to_vec() }
    }

    pub fn get(&self, path: &str) -> Answer {
        let (page, host) = (self.path(), self.host());
        self.send(&format!(
            "GET {page}{path} HTTP/1.1\r\nHost: {host}\r\nConnection: close\r\n\r\n"
        ))
    }

    pub fn post(&self, path: &str, body: &str) -> Answer {
        let (page, host, length) = (self.path(), self.host(), body.len());
        self.send(&format!(
            "POST {page}{path} HTTP/1.1\r\nHost: {host}\r\nConnection: close\r\n\
             Content-Length: {length}\r\n\r\n{body}"
        ))
    }

    /// Sends a request that must succeed, and returns the state after it.
    pub fn act(&self, path: &str, body: &str) -> Value {
        let answer = self.post(path, body);
        assert_eq!(answer.status, 200, "{path} {body}: {}", String::from_utf8_lossy(&answer.body));
        answer.json()
    }

    pub fn state(&self) -> Value {
        self.get("state").json()
    }

    /// Runs `count` frames, and returns the last one.
    pub fn frames(&self, count: u32) -> Value {
        self.act("run", &format!("{{\"frames\":{count}}}"))["frame"].clone()
    }

    /// Starts the run, and stops it within a frame's shots.
    pub fn stop_within_a_frame(&self) -> Value {
        loop {
            self.act("run", "{\"running\":true}");
            std::thread::sleep(Duration::from_millis(30));
            let state = self.act("run", "{\"running\":false}");
            if state["progress"]["shots"].as_u64() > Some(0) {
                return state;
            }
        }
    }

    /// Polls the state until it satisfies a predicate.
    pub fn wait(&self, wish: impl Fn(&Value) -> bool) -> Value {
        let until = Instant::now() + Duration::from_secs(60);
        loop {
            let state = self.state();
            if wish(&state) {
                return state;
            }
            assert!(Instant::now() < until, "the state never came to be as wished: {state}");
            std::thread::sleep(Duration::from_millis(20));
        }
    }
}
