//! As much of HTTP as the studio needs: the head of a request, and an answer without keep-alive.

use std::io::{self, Read, Write};

/// Longest head of a request, bytes.
const HEAD_MAX_LEN: usize = 8_192;
/// Headers of a request at most.
const HEADERS_MAX: usize = 64;

/// What the page may do, whatever file is served as the page: run its own scripts and workers, and connect to this
/// server. The policy in the page's own head is narrower still, and names its one script.
const POLICY: &str = "default-src 'none'; script-src 'unsafe-inline' blob: data: 'wasm-unsafe-eval'; worker-src blob:; \
                      style-src 'unsafe-inline'; img-src blob: data:; connect-src 'self'; form-action 'none'; \
                      base-uri 'none'; frame-ancestors 'none'";

/// The head of a request.
pub(super) struct Head {
    pub(super) method: String,
    pub(super) target: String,
    headers: Vec<(String, String)>,
}

impl Head {
    /// Reads a head; `None` if it is none, or too long.
    pub(super) fn read(stream: &mut impl Read) -> io::Result<Option<Self>> {
        let mut bytes = Vec::new();
        while bytes.len() < HEAD_MAX_LEN {
            // Bytes behind the head belong to a WebSocket, which sends none before the answer.
            let mut byte = [0];
            if stream.read(&mut byte)? == 0 {
                return Ok(None);
            }
            bytes.extend(byte);
            if bytes.ends_with(b"\r\n\r\n") {
                return Ok(Self::parse(&bytes));
            }
        }
        Ok(None)
    }

    fn parse(bytes: &[u8]) -> Option<Self> {
        let mut headers = [httparse::EMPTY_HEADER; HEADERS_MAX];
        let mut request = httparse::Request::new(&mut headers);
        request.parse(bytes).ok().filter(httparse::Status::is_complete)?;
        let headers = request
            .headers
            .iter()
            .map(|header| (header.name.to_ascii_lowercase(), String::from_utf8_lossy(header.value).trim().to_owned()));
        Some(Self { method: request.method?.to_owned(), target: request.path?.to_owned(), headers: headers.collect() })
    }

    /// The value of the only header of this name, in lower case; `None` if there are several.
    pub(super) fn header(&self, name: &str) -> Option<&str> {
        let mut found = self.headers.iter().filter(|(other, _)| other == name);
        let (_, value) = found.next()?;
        found.next().is_none().then_some(value)
    }

    /// Whether the header of this name has this word, in any case.
    pub(super) fn header_has(&self, name: &str, word: &str) -> bool {
        self.header(name).is_some_and(|value| value.split(',').any(|part| part.trim().eq_ignore_ascii_case(word)))
    }
}

/// An answer, after which the connection is closed.
pub(super) struct Answer<'a> {
    status: u16,
    content_type: &'static str,
    content: &'a [u8],
}

impl<'a> Answer<'a> {
    pub(super) fn page(content: &'a [u8]) -> Self {
        Self { status: 200, content_type: "text/html; charset=utf-8", content }
    }

    /// Refuses a request with a sentence.
    pub(super) fn refusal(status: u16, sentence: &'a str) -> Self {
        Self { status, content_type: "text/plain; charset=utf-8", content: sentence.as_bytes() }
    }

    pub(super) fn write(&self, stream: &mut impl Write) -> io::Result<()> {
        let Self { status, content_type, content } = self;
        let reason = if *status == 200 { "OK" } else { "Refused" };
        write!(
            stream,
            "HTTP/1.1 {status} {reason}\r\nContent-Type: {content_type}\r\nContent-Length: {}\r\nCache-Control: no-store\r\n\
             X-Content-Type-Options: nosniff\r\nX-Frame-Options: DENY\r\nContent-Security-Policy: {POLICY}\r\nReferrer-Policy: no-referrer\r\nConnection: close\r\n\r\n",
            content.len()
        )?;
        stream.write_all(content)?;
        stream.flush()
    }
}
