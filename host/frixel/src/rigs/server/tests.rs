#![allow(clippy::unwrap_used, reason = "a test may fail")]

use std::io::Read;

use super::Server;

/// More than any pseudo-terminal holds.
const LEN: usize = 1 << 20;

/// A write that waits for its reader would hang here for ever.
#[test]
fn a_client_that_does_not_read_does_not_stop_the_board() {
    let folder = tempfile::tempdir().unwrap();
    let mut server = Server::open(folder.path(), 40_000, 40).unwrap();
    for _ in 0..3 {
        let mut bytes = vec![0x55; LEN];
        server.transmit(&mut bytes).unwrap();
        assert!(bytes.is_empty(), "what did not fit is dropped");
    }
    let mut bytes = vec![0; LEN];
    let read = server.client_end.read(&mut bytes).unwrap();
    assert!(read > 0 && bytes[..read].iter().all(|byte| *byte == 0x55), "what did fit is there, as it was written");
}
