//! Headless Chromium, driven over a pipe by the DevTools protocol.

use std::io::{BufRead, BufReader, Write};
use std::path::{Path, PathBuf};
use std::process::{Child, ChildStdin, ChildStdout, Command, Stdio};
use std::time::{Duration, Instant};

use serde_json::{Value, json};

/// Returns the folder for screenshots, if the environment sets one.
pub fn pictures() -> Option<PathBuf> {
    let folder = PathBuf::from(std::env::var_os("TOFSIM_SCREENSHOTS")?);
    std::fs::create_dir_all(&folder).unwrap();
    Some(folder)
}

/// A browser with one page.
pub struct Chromium {
    process: Child,
    input: ChildStdin,
    output: BufReader<ChildStdout>,
    session: String,
    next: u64,
    /// Errors that the page has reported.
    pub complaints: Vec<String>,
    _folder: tempfile::TempDir,
}

impl Drop for Chromium {
    fn drop(&mut self) {
        let _ = self.try_send("Browser.close", json!({}), false);
        let until = Instant::now() + Duration::from_secs(3);
        while Instant::now() < until && matches!(self.process.try_wait(), Ok(None)) {
            std::thread::sleep(Duration::from_millis(20));
        }
        let _ = self.process.kill();
        let _ = self.process.wait();
    }
}

impl Chromium {
    /// Opens a page of the given size; `scheme` is `light` or `dark`.
    pub fn open(url: &str, (width, height): (u32, u32), scheme: &str) -> Self {
        let folder = tempfile::tempdir().unwrap();
        // The protocol is on the descriptors 3 and 4.
        let command = "exec chromium --headless --no-sandbox --disable-gpu --hide-scrollbars \
            --disable-dev-shm-usage --no-first-run --remote-debugging-pipe --user-data-dir=\"$0\" about:blank 3<&0 4>&1 2>/dev/null";
        let mut process = Command::new("sh")
            .args(["-c", command])
            .arg(folder.path())
            .stdin(Stdio::piped())
            .stdout(Stdio::piped())
            .spawn()
            .unwrap();
        let (input, output) = (process.stdin.take().unwrap(), process.stdout.take().unwrap());
        let mut browser = Chromium {
            process,
            input,
            output: BufReader::new(output),
            session: String::new(),
            next: 0,
            complaints: Vec::new(),
            _folder: folder,
        };
        let target = browser.call("Target.createTarget", json!({ "url": "about:blank" }));
        let attach = json!({ "targetId": target["targetId"], "flatten": true });
        let session = browser.call("Target.attachToTarget", attach);
        browser.session = session["sessionId"].as_str().unwrap().to_owned();
        browser.call("Page.enable", json!({}));
        browser.call("Runtime.enable", json!({}));
        browser.call("Log.enable", json!({}));
        browser.resize(width, height);
        let features = json!([{ "name": "prefers-color-scheme", "value": scheme }]);
        browser.call("Emulation.setEmulatedMedia", json!({ "features": features }));
        browser.call("Page.navigate", json!({ "url": url }));
        browser.wait("document.documentElement?.dataset.version > 0");
        browser
    }

    pub fn resize(&mut self, width: u32, height: u32) {
        let size = json!({ "width": width, "height": height, "deviceScaleFactor": 1, "mobile": width < 500 });
        self.call("Emulation.setDeviceMetricsOverride", size);
    }

    /// Evaluates an expression in the page.
    pub fn value(&mut self, expression: &str) -> Value {
        let asked =
            json!({ "expression": expression, "returnByValue": true, "awaitPromise": true });
        let found = self.call("Runtime.evaluate", asked);
        assert!(found["exceptionDetails"].is_null(), "{expression}: {}", found["exceptionDetails"]);
        found["result"]["value"].clone()
    }

    /// Waits until an expression is true.
    pub fn wait(&mut self, expression: &str) {
        let until = Instant::now() + Duration::from_secs(60);
        while self.value(expression) != Value::Bool(true) {
            assert!(Instant::now() < until, "never true: {expression}; {:?}", self.complaints);
            std::thread::sleep(Duration::from_millis(20));
        }
    }

    /// Presses a key on the page.
    pub fn press(&mut self, key: &str) {
        let code = key.to_ascii_uppercase().bytes().next().unwrap_or_default();
        for kind in ["keyDown", "keyUp"] {
            let event = json!({ "type": kind, "key": key, "text": if kind == "keyDown" { key } else { "" }, "windowsVirtualKeyCode": code });
            self.call("Input.dispatchKeyEvent", event);
        }
    }

    /// Presses a key again each second until an expression is true.
    pub fn press_until(&mut self, key: &str, expression: &str) {
        for _ in 0..60 {
            self.press(key);
            let until = Instant::now() + Duration::from_secs(1);
            while Instant::now() < until {
                if self.value(expression) == Value::Bool(true) {
                    return;
                }
                std::thread::sleep(Duration::from_millis(20));
            }
        }
        panic!("{key} never makes it true: {expression}; {:?}", self.complaints);
    }

    /// Sets the folder for downloads.
    pub fn save_into(&mut self, folder: &Path) {
        let asked = json!({ "behavior": "allow", "downloadPath": folder });
        self.call("Page.setDownloadBehavior", asked);
    }

    /// Saves a screenshot of the whole page.
    pub fn screenshot(&mut self, path: &Path) {
        let asked = json!({ "format": "png", "captureBeyondViewport": true });
        let shot = self.call("Page.captureScreenshot", asked);
        let text = shot["data"].as_str().unwrap();
        std::fs::write(path, base64(text)).unwrap();
    }

    fn call(&mut self, method: &str, parameters: Value) -> Value {
        let id = self.try_send(method, parameters, true).unwrap();
        loop {
            let mut message = Vec::new();
            self.output.read_until(0, &mut message).unwrap();
            message.pop();
            let message: Value = serde_json::from_slice(&message).unwrap_or_else(|error| {
                panic!("{error}: is chromium there? apt-get install chromium")
            });
            match message["method"].as_str() {
                Some("Runtime.exceptionThrown") => {
                    self.complaints.push(message["params"]["exceptionDetails"].to_string());
                }
                Some("Log.entryAdded") => {
                    self.complaints.push(message["params"]["entry"]["text"].to_string());
                }
                _ => {}
            }
            if message["id"] == id {
                assert!(message["error"].is_null(), "{method}: {}", message["error"]);
                return message["result"].clone();
            }
        }
    }

    fn try_send(&mut self, method: &str, parameters: Value, in_page: bool) -> std::io::Result<u64> {
        self.next += 1;
        let mut message = json!({ "id": self.next, "method": method, "params": parameters });
        if in_page && !self.session.is_empty() {
            message["sessionId"] = self.session.as_str().into();
        }
        let mut bytes = message.to_string().into_bytes();
        bytes.push(0);
        self.input.write_all(&bytes)?;
        self.input.flush()?;
        Ok(self.next)
    }
}

fn base64(text: &str) -> Vec<u8> {
    let value = |c: u8| match c {
        b'A'..=b'Z' => c - b'A',
        b'a'..=b'z' => c - b'a' + 26,
        b'0'..=b'9' => c - b'0' + 52,
        b'+' => 62,
        _ => 63,
    };
    let digits: Vec<_> = text.bytes().filter(|c| *c != b'=').map(value).collect();
    let bytes = digits.chunks(4).flat_map(|four| {
        let word = four.iter().enumerate().map(|(k, d)| u32::from(*d) << (18 - 6 * k)).sum::<u32>();
        word.to_be_bytes()[1..four.len()].to_vec()
    });
    bytes.collect()
}
