//! Raw samples from a pipe.

use std::io::{self, Read};
use std::sync::mpsc::{Receiver, SyncSender, TryRecvError, sync_channel};
use std::thread;

/// Bytes per read.
const PIECE_LEN: usize = 1024;
/// Pieces in the queue. When it is full, the process that writes to the pipe blocks.
const PIECES: usize = 4;

/// A pipe that a separate thread reads, since a read may block while the host must keep sending to the board.
pub(super) struct Pipe {
    pieces: Receiver<io::Result<Vec<u8>>>,
    /// The first byte of a sample whose second byte has not arrived yet.
    half: Option<u8>,
    waits: bool,
    ended: bool,
}

impl Pipe {
    pub(super) fn open(input: impl Read + Send + 'static, waits: bool) -> io::Result<Self> {
        let (sender, pieces) = sync_channel(PIECES);
        thread::Builder::new().name("frixel-samples".into()).spawn(move || read(input, &sender))?;
        Ok(Self { pieces, half: None, waits, ended: false })
    }

    /// Appends samples until there are `len` of them or the pipe is empty; returns false at the end of the pipe. Half a
    /// sample at the end is dropped.
    pub(super) fn fetch(&mut self, samples: &mut Vec<u16>, len: usize) -> io::Result<bool> {
        while samples.len() < len && !self.ended {
            let piece = if self.waits {
                self.pieces.recv().map_err(|_| TryRecvError::Disconnected)
            } else {
                self.pieces.try_recv()
            };
            match piece {
                Ok(bytes) => self.take(&bytes?, samples),
                Err(TryRecvError::Empty) => return Ok(true),
                Err(TryRecvError::Disconnected) => self.ended = true,
            }
        }
        Ok(!self.ended)
    }

    fn take(&mut self, bytes: &[u8], samples: &mut Vec<u16>) {
        for byte in bytes {
            match self.half.take() {
                None => self.half = Some(*byte),
                Some(low) => samples.push(u16::from_le_bytes([low, *byte])),
            }
        }
    }
}

fn read(mut input: impl Read, sender: &SyncSender<io::Result<Vec<u8>>>) {
    loop {
        let mut piece = vec![0; PIECE_LEN];
        let read = match input.read(&mut piece) {
            Ok(0) => return,
            Ok(len) => {
                piece.truncate(len);
                Ok(piece)
            }
            Err(error) if error.kind() == io::ErrorKind::Interrupted => continue,
            Err(error) => Err(error),
        };
        let failed = read.is_err();
        if sender.send(read).is_err() || failed {
            return;
        }
    }
}
