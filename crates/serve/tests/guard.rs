//! Tests of access control.

use std::io::{Read, Write};
use std::net::TcpStream;
use std::process::Command;
use std::time::Duration;

use super::common::Server;

#[test]
fn foreign_hosts_origins_and_tokens_are_refused() {
    let server = Server::small(&[]);
    let (own, path) = (server.host().to_owned(), server.path().to_owned());
    let port = own.rsplit(':').next().unwrap();
    let ask = |method: &str, path: &str, headers: &str| {
        let request = format!("{method} {path} HTTP/1.1\r\n{headers}Connection: close\r\n\r\n");
        server.send(&request).status
    };
    let host = format!("Host: {own}\r\n");
    assert_eq!(ask("GET", &format!("{path}state"), &host), 200);
    assert_eq!(ask("GET", &format!("{path}state"), &format!("Host: localhost:{port}\r\n")), 200);
    for headers in [
        format!("Host: evil.example:{port}\r\n"),
        "Host: 127.0.0.1\r\n".to_owned(),
        format!("{host}Origin: http://evil.example\r\n"),
        format!("{host}Origin: null\r\n"),
        format!("{host}Origin: http://127.0.0.1:1\r\n"),
    ] {
        for (method, place) in [("GET", ""), ("GET", "state"), ("GET", "events"), ("POST", "run")] {
            assert_eq!(ask(method, &format!("{path}{place}"), &headers), 403, "{place} {headers}");
        }
    }
    let other: String = path.chars().map(|c| if c == '0' { '1' } else { c }).rev().collect();
    for path in ["/", "/state", "//state", "/page/main.js", &other, &path[..10]] {
        assert_eq!(ask("GET", path, &host), 403, "{path}");
        assert_eq!(ask("POST", path, &host), 403, "{path}");
    }
    assert_eq!(server.state()["running"], false, "nothing has happened");
}

#[test]
fn connections_without_the_token_neither_lock_the_page_out_nor_stay() {
    let server = Server::small(&[]);
    let few = ["--pid", &server.id().to_string(), "--nofile=40"];
    assert!(Command::new("prlimit").args(few).status().unwrap().success());
    let host = server.host().to_owned();
    let silent: Vec<_> = (0..70).map(|_| TcpStream::connect(&host).unwrap()).collect();
    let begun = silent.iter().step_by(2).map(|mut stream| stream.write_all(b"GET / HTTP/1.1\r\n"));
    begun.for_each(drop);
    assert_eq!(server.frames(1)["index"], 0, "the page's requests are answered");
    let refused = TcpStream::connect(&host).unwrap();
    let request = format!("GET /state HTTP/1.1\r\nHost: {host}\r\n\r\n");
    (&refused).write_all(request.as_bytes()).unwrap();
    for mut stream in silent.into_iter().chain([refused]) {
        stream.set_read_timeout(Some(Duration::from_secs(20))).unwrap();
        let end = stream.read_to_end(&mut Vec::new()).map_err(|error| error.kind());
        assert!(end.is_ok() || end == Err(std::io::ErrorKind::ConnectionReset), "{end:?}");
    }
    assert_eq!(server.frames(1)["index"], 1);
}

#[test]
fn it_listens_on_this_computer_only() {
    let server = Server::small(&[]);
    let port: u16 = server.host().rsplit(':').next().unwrap().parse().unwrap();
    let table = std::fs::read_to_string("/proc/net/tcp").unwrap();
    let of_port = |line: &&str| {
        line.split_whitespace().nth(1).is_some_and(|local| local.ends_with(&format!(":{port:04X}")))
            && line.split_whitespace().nth(3) == Some("0A")
    };
    let listening: Vec<_> = table.lines().filter(of_port).collect();
    assert!(listening.len() == 1 && listening[0].contains("0100007F:"), "{listening:?}");
}

#[test]
fn each_start_has_a_token_of_its_own_and_each_answer_its_policy() {
    let [one, other] = [Server::small(&[]), Server::small(&[])];
    assert_ne!(one.path(), other.path());
    assert_eq!(one.path().len(), 34);
    for path in ["", "state", "page/main.js", "no-such-file"] {
        let head = one.get(path).head.to_lowercase();
        for header in [
            "content-security-policy: default-src 'none'; script-src 'self';",
            "x-content-type-options: nosniff",
            "referrer-policy: no-referrer",
            "cache-control: no-store",
        ] {
            assert!(head.contains(header), "{path}: {header}\n{head}");
        }
    }
}

#[test]
fn the_page_asks_for_nothing_from_elsewhere_and_has_no_script_of_its_own() {
    let server = Server::small(&[]);
    let page = server.get("");
    assert_eq!(page.status, 200);
    let page = String::from_utf8(page.body).unwrap();
    let handlers =
        [" onclick=", " onload=", " onchange=", " oninput=", " onkeydown=", "javascript:"];
    assert!(!page.contains("<script>") && !page.contains(" style="));
    assert!(!handlers.iter().any(|handler| page.contains(handler)));
    let mut files = vec!["icon.svg".to_owned(), "page.css".to_owned(), "main.js".to_owned()];
    let mut next = 0;
    while let Some(name) = files.get(next).cloned() {
        let answer = server.get(&format!("page/{name}"));
        assert_eq!(answer.status, 200, "{name}");
        let text = String::from_utf8(answer.body).unwrap();
        let foreign = text.replace("http://www.w3.org/2000/svg", "");
        assert!(!foreign.contains("http") || name == "server.js", "{name}");
        assert!(!foreign.contains("://") && !foreign.contains("innerHTML"), "{name}");
        for imported in text.split("from \"./").skip(1) {
            let imported = imported.split('"').next().unwrap().to_owned();
            if !files.contains(&imported) {
                files.push(imported);
            }
        }
        next += 1;
    }
    assert!(files.len() > 8, "{files:?}");
}
