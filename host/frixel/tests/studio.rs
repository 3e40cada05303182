//! `frixel studio`: who gets the page, who gets the bridge, and what the bridge carries.
#![cfg(unix)]
#![allow(clippy::unwrap_used, clippy::panic, reason = "a test fails by a panic")]

use std::fs;
use std::io::{BufRead, BufReader, Read, Write};
use std::net::TcpStream;
use std::os::unix::fs::PermissionsExt;
use std::process::{Command, Stdio};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::thread::{self, JoinHandle};
use std::time::{Duration, Instant};

use frixel::studio::Studio;
use frixel_hil_sim::PseudoTerminal;
use tungstenite::client::IntoClientRequest;
use tungstenite::{Error, Message, WebSocket, client};

const PAGE: &[u8] = b"<!doctype html><title>the page</title>";

/// A studio that runs until it is dropped.
struct Running {
    host: String,
    token: String,
    is_over: Arc<AtomicBool>,
    thread: Option<JoinHandle<()>>,
}

impl Running {
    fn new(serial_port: Option<&str>) -> Self {
        let studio = Studio::open(0, PAGE.to_vec(), serial_port.map(str::to_owned)).unwrap();
        let url = studio.url();
        let (host, fragment) = url.strip_prefix("http://").unwrap().split_once('/').unwrap();
        let token = fragment.strip_prefix("#bridge=").unwrap_or_default().to_owned();
        let is_over = Arc::new(AtomicBool::new(false));
        let over = Arc::clone(&is_over);
        let thread = thread::spawn(move || studio.run(&|| over.load(Ordering::Relaxed)).unwrap());
        Self { host: host.to_owned(), token, is_over, thread: Some(thread) }
    }

    /// The answer to a request with this line and these headers.
    fn answer(&self, line: &str, headers: &[String]) -> String {
        let mut stream = TcpStream::connect(&self.host).unwrap();
        stream.set_read_timeout(Some(Duration::from_secs(5))).unwrap();
        write!(
            stream,
            "{line} HTTP/1.1\r\n{}\r\n",
            headers.iter().flat_map(|header| [header.as_str(), "\r\n"]).collect::<String>()
        )
        .unwrap();
        let mut answer = String::new();
        stream.read_to_string(&mut answer).unwrap();
        answer
    }

    /// Asks for the bridge as the page does, with other headers in place of those of the same name.
    fn bridge(&self, origin: &str, token: &str) -> Result<WebSocket<TcpStream>, u16> {
        let url = format!("ws://{}/serial?token={token}", self.host);
        let mut request = url.into_client_request().unwrap();
        request.headers_mut().insert("Origin", origin.parse().unwrap());
        let stream = TcpStream::connect(&self.host).unwrap();
        match client(request, stream) {
            Ok((socket, _)) => {
                // Only now: a signal of another test ends a read that has a timeout, which the handshake reports as an
                // error.
                socket.get_ref().set_read_timeout(Some(Duration::from_secs(5))).unwrap();
                Ok(socket)
            }
            Err(tungstenite::HandshakeError::Failure(Error::Http(response))) => Err(response.status().as_u16()),
            Err(error) => panic!("{error}"),
        }
    }

    fn origin(&self) -> String {
        format!("http://{}", self.host)
    }
}

impl Drop for Running {
    fn drop(&mut self) {
        self.is_over.store(true, Ordering::Relaxed);
        let ended = self.thread.take().map(JoinHandle::join);
        assert!(thread::panicking() || ended.unwrap().is_ok());
    }
}

/// A thread for each of them would be there until its request times out.
#[test]
fn idle_connections_have_a_limit() {
    let studio = Running::new(None);
    let is_served = || {
        let mut answer = Vec::new();
        let asked = TcpStream::connect(&studio.host).and_then(|mut stream| {
            write!(stream, "GET / HTTP/1.1\r\nHost: {}\r\n\r\n", studio.host)?;
            stream.read_to_end(&mut answer)
        });
        asked.is_ok() && answer.starts_with(b"HTTP/1.1 200")
    };
    // On a busy machine, the first of them may be over before the last one is there.
    let is_refused = || {
        let idle: Vec<TcpStream> = (0..100).map(|_| TcpStream::connect(&studio.host).unwrap()).collect();
        let is_refused = !is_served();
        drop(idle);
        is_refused
    };
    assert!((0..10).any(|_| is_refused()));
    while !is_served() {
        thread::sleep(Duration::from_millis(10));
    }
}

fn status(answer: &str) -> &str {
    answer.split(' ').nth(1).unwrap_or_default()
}

#[test]
fn the_page_is_served_to_its_own_address_only() {
    let studio = Running::new(None);
    let own = format!("Host: {}", studio.host);
    let answer = studio.answer("GET /", std::slice::from_ref(&own));
    assert_eq!(status(&answer), "200", "{answer}");
    assert_eq!(answer.split_once("\r\n\r\n").unwrap().1.as_bytes(), PAGE);
    for (line, headers, expected) in [
        ("GET /", vec!["Host: evil.example".to_owned()], "403"),
        ("GET /", vec![], "403"),
        ("GET /", vec![own.clone(), "Host: evil.example".to_owned()], "403"),
        ("POST /", vec![own.clone()], "405"),
        ("GET /../Cargo.toml", vec![own.clone()], "404"),
        ("rubbish", vec![], "400"),
    ] {
        let answer = studio.answer(line, &headers);
        assert_eq!(status(&answer), expected, "{line} {headers:?}: {answer}");
        assert!(!answer.contains("the page</title>"), "{answer}");
    }
}

#[test]
fn only_the_page_with_its_token_gets_the_bridge() {
    let terminal = PseudoTerminal::open().unwrap();
    let studio = Running::new(Some(terminal.path()));
    assert_eq!(studio.token.len(), 32);
    assert_ne!(Running::new(Some(terminal.path())).token, studio.token);
    assert_eq!(studio.bridge("http://evil.example", &studio.token).err(), Some(403));
    assert_eq!(studio.bridge("null", &studio.token).err(), Some(403));
    assert_eq!(studio.bridge(&studio.origin(), "").err(), Some(403));
    assert_eq!(studio.bridge(&studio.origin(), &"0".repeat(32)).err(), Some(403));
    let first = studio.bridge(&studio.origin(), &studio.token);
    assert!(first.is_ok());
    assert_eq!(studio.bridge(&studio.origin(), &studio.token).err(), Some(409), "one page at a time");
    let without_port = Running::new(None);
    assert_eq!(without_port.bridge(&without_port.origin(), &without_port.token).err(), Some(404));
}

/// The page connects again as soon as it has seen the bridge end.
#[test]
fn the_bridge_is_free_once_the_page_has_seen_it_end() {
    let terminal = PseudoTerminal::open().unwrap();
    let studio = Running::new(Some(terminal.path()));
    for _ in 0..20 {
        let mut socket = studio.bridge(&studio.origin(), &studio.token).unwrap();
        socket.close(None).unwrap();
        while socket.read().is_ok() {}
        let mut rest = Vec::new();
        // Until the connection itself has ended, which is the last that the server does.
        let _ = socket.get_mut().read_to_end(&mut rest);
    }
}

/// Port 80 is the one that a browser leaves out of an address.
#[test]
fn an_address_without_a_port_is_that_of_port_80() {
    // Where this user may not listen there, or somebody else does, there is nothing to check.
    let Ok(studio) = Studio::open(80, PAGE.to_vec(), None) else { return };
    assert_eq!(studio.url(), "http://127.0.0.1/");
}

#[test]
fn the_command_opens_its_address_in_a_browser_that_starts() {
    let folder = tempfile::tempdir().unwrap();
    let path = |name: &str| folder.path().join(name);
    let (page, opened) = (path("page.html"), path("opened"));
    fs::write(&page, PAGE).unwrap();
    let script = format!("#!/bin/sh\nprintf %s \"${{0##*/}} $*\" > {}.part\nmv {0}.part {0}\n", opened.display());
    // The second one is the desktop's.
    for browser in ["browser", "a browser", "xdg-open"] {
        fs::write(path(browser), &script).unwrap();
        fs::set_permissions(path(browser), fs::Permissions::from_mode(0o755)).unwrap();
    }
    let browser = path("browser").display().to_string();
    let search_path = format!("{}:{}", folder.path().display(), std::env::var("PATH").unwrap());
    let mut cases = vec![
        (browser.clone(), "browser URL"),
        (path("a browser").display().to_string(), "a browser URL"),
        (format!("frixel-knows-no-such-browser:{browser}"), "browser URL"),
        (format!("{browser} --new %s in-front"), "browser --new URL in-front"),
    ];
    if cfg!(target_os = "linux") {
        cases.push(("frixel-knows-no-such-browser %s".to_owned(), "xdg-open URL"));
        cases.push((String::new(), "xdg-open URL"));
    }
    for (variable, expected) in cases {
        let mut command = Command::new(env!("CARGO_BIN_EXE_frixel"));
        command.arg("studio").arg("--page").arg(&page).stdout(Stdio::piped());
        let mut studio = command.env("BROWSER", &variable).env("PATH", &search_path).spawn().unwrap();
        let mut printed = String::new();
        BufReader::new(studio.stdout.take().unwrap()).read_line(&mut printed).unwrap();
        let begin = Instant::now();
        while !opened.is_file() && begin.elapsed() < Duration::from_secs(10) {
            thread::sleep(Duration::from_millis(10));
        }
        studio.kill().unwrap();
        studio.wait().unwrap();
        let arguments = fs::read_to_string(&opened).unwrap_or_default();
        assert_eq!(arguments, expected.replace("URL", printed.trim()), "BROWSER={variable}");
        fs::remove_file(&opened).unwrap();
    }
}

#[test]
fn a_page_that_cannot_be_read_is_said_with_what_to_do() {
    let output =
        Command::new(env!("CARGO_BIN_EXE_frixel")).args(["studio", "--page", "nowhere.html"]).output().unwrap();
    let said = String::from_utf8(output.stderr).unwrap();
    assert!(output.status.code() == Some(1) && said.contains("nowhere.html cannot be read ("), "{said}");
    assert!(said.contains("give --page the file that `cargo xtask studio` prints"), "{said}");
}

/// Without a page, `cargo xtask studio` of the checkout builds one, wherever its artefacts are, and prints its path.
#[test]
fn a_checkout_without_a_page_builds_one() {
    let checkout = tempfile::tempdir().unwrap();
    let web = checkout.path().join("host/studio/web");
    fs::create_dir_all(&web).unwrap();
    fs::write(web.join("boot.js"), "").unwrap();
    let built = checkout.path().join("built.html");
    let cargo = checkout.path().join("cargo");
    let script = format!(
        "#!/bin/sh\n[ \"$*\" = \"xtask studio\" ] && cp page {} && echo progress && echo {0}\n",
        built.display()
    );
    fs::write(&cargo, script).unwrap();
    fs::set_permissions(&cargo, fs::Permissions::from_mode(0o755)).unwrap();
    let run = || {
        let mut command = Command::new(env!("CARGO_BIN_EXE_frixel"));
        command.args(["studio", "--no-browser"]).current_dir(&web).env("CARGO", &cargo);
        command
            .env("CARGO_TARGET_DIR", checkout.path().join("elsewhere"))
            .stdout(Stdio::piped())
            .stderr(Stdio::piped());
        let mut studio = command.spawn().unwrap();
        let mut printed = String::new();
        BufReader::new(studio.stdout.take().unwrap()).read_line(&mut printed).unwrap();
        if printed.is_empty() {
            return Err(String::from_utf8(studio.wait_with_output().unwrap().stderr).unwrap());
        }
        let host = printed.trim().trim_start_matches("http://").trim_end_matches('/').to_owned();
        let mut stream = TcpStream::connect(&host).unwrap();
        write!(stream, "GET / HTTP/1.1\r\nHost: {host}\r\n\r\n").unwrap();
        let mut answer = String::new();
        stream.read_to_string(&mut answer).unwrap();
        studio.kill().unwrap();
        studio.wait().unwrap();
        Ok(answer)
    };
    let failure = run().unwrap_err();
    assert!(failure.contains("`cargo xtask studio` failed"), "{failure}");
    fs::write(checkout.path().join("page"), PAGE).unwrap();
    assert!(run().unwrap().ends_with("the page</title>"));
}

#[test]
fn the_bridge_carries_bytes_both_ways_and_adds_none() {
    let mut terminal = PseudoTerminal::open().unwrap();
    let studio = Running::new(Some(terminal.path()));
    let mut socket = studio.bridge(&studio.origin(), &studio.token).unwrap();
    let sent: Vec<u8> = (0..=255).collect();
    socket.send(Message::binary(sent.clone())).unwrap();
    let mut arrived = Vec::new();
    let begin = Instant::now();
    while arrived.len() < sent.len() && begin.elapsed() < Duration::from_secs(5) {
        let mut buffer = [0; 512];
        let len = terminal.read(&mut buffer).unwrap();
        arrived.extend_from_slice(&buffer[..len]);
    }
    assert_eq!(arrived, sent);
    assert_eq!(terminal.write(&sent).unwrap(), sent.len());
    let mut returned = Vec::new();
    while returned.len() < sent.len() {
        returned.extend(socket.read().unwrap().into_data());
    }
    assert_eq!(returned, sent);
    // Silence stays silence: the bridge keeps no board alive.
    thread::sleep(Duration::from_millis(300));
    assert_eq!(terminal.read(&mut [0; 512]).unwrap(), 0);
}
