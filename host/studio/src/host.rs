//! The host of a board: plays the scenes of requests on it and carries out control lines, over any byte stream.

use frixel_driver::{ByteStream, ControlLine, Device, DeviceError, PollingLink};
use frixel_play::{Player, Recorded};
use frixel_scene::Program;
use frixel_wire::hello::Hello;

use crate::host_error::HostError;
use crate::program::compiled;
use crate::request::Request;

/// The host of a board over a byte stream.
pub(crate) type Host<S> = Player<PollingLink<S>>;

/// Connects to a board, and disarms it. A board with a latched fault drives nothing; it stays as it is.
pub(crate) fn connect<S: ByteStream + Recorded>(stream: S) -> Result<Host<S>, DeviceError> {
    let mut host = Player::new(Device::connect(PollingLink::new(stream))?);
    host.stop()?;
    Ok(host)
}

/// The line to the board.
pub(crate) fn stream_mut<S: ByteStream + Recorded>(host: &mut Host<S>) -> &mut S {
    host.device_mut().link_mut().stream_mut()
}

/// Compiles a scene for the board and puts it there. A scene that plays is replaced between two ticks. If the scene has
/// mistakes or the board refuses it, the one before plays on.
pub(crate) fn load<S: ByteStream + Recorded>(host: &mut Host<S>, request: &Request) -> Result<(), HostError> {
    let Hello { limits, tick_hz, .. } = *host.device().hello();
    replace(host, compiled(request, &limits, tick_hz)?)
}

/// Puts a program on the board, as [`load`] does. Its layers are as its file sets them, as the page shows them.
pub(crate) fn replace<S: ByteStream + Recorded>(host: &mut Host<S>, program: Program) -> Result<(), HostError> {
    match host.replace_anew(program) {
        Ok(_) => Ok(()),
        Err(error) if error.is_refusal() => Err(HostError::Refused(error)),
        Err(error) => Err(error.into()),
    }
}

/// Carries out a control line: `layer` or `trigger`, in the words of [`ControlLine`]. Returns a sentence on what is
/// clamped from now on.
pub(crate) fn control<S: ByteStream + Recorded>(host: &mut Host<S>, line: &str) -> Result<Option<String>, HostError> {
    let change = match ControlLine::parse(line)? {
        None => return Ok(None),
        Some(ControlLine::Layer { layer, on, gain }) => host.change_layer(&layer, on, gain)?,
        Some(ControlLine::Trigger { layer, duration_s }) => host.trigger(&layer, duration_s)?,
        Some(_) => return Err(HostError::NotInPage { line: line.to_owned() }),
    };
    Ok(change.notice())
}

#[cfg(test)]
mod tests {
    use std::time::Duration;

    use frixel_driver::LinkClosed;
    use frixel_felt::recorder::Recorder;
    use frixel_hil_sim::{BoardMemory, RigConfig};
    use frixel_play::PlayError;
    use frixel_wire::fault::State;

    use super::*;
    use crate::pointer_stream::PointerStream;

    const BRICK: &[u8] = include_bytes!("../../../scenes/brick.toml");
    const LEATHER: &[u8] = include_bytes!("../../../scenes/leather.toml");

    /// The rig at the end of a line that may be cut.
    struct Line<'a> {
        rig: PointerStream<'a>,
        /// Bytes to the board until the line is dead, in both directions.
        left: usize,
        /// Times of what was written.
        written: Vec<Duration>,
    }

    impl ByteStream for Line<'_> {
        fn write(&mut self, bytes: &[u8]) -> Result<(), LinkClosed> {
            self.written.push(self.now());
            let passed = bytes.len().min(self.left);
            self.left -= passed;
            self.rig.write(&bytes[..passed])
        }

        fn read(&mut self, buffer: &mut Vec<u8>, wait: Duration) -> Result<(), LinkClosed> {
            let end = self.now() + wait;
            let len = buffer.len();
            self.rig.read(buffer, wait)?;
            if self.left == 0 {
                buffer.truncate(len);
                while self.now() < end {
                    self.rig.step();
                }
            }
            Ok(())
        }

        fn now(&self) -> Duration {
            self.rig.now()
        }

        fn name(&self) -> &str {
            self.rig.name()
        }
    }

    impl Recorded for Line<'_> {
        type Recorder = Recorder;

        fn recorder_mut(&mut self) -> &mut Recorder {
            self.rig.recorder_mut()
        }
    }

    fn host(memory: &mut BoardMemory) -> Host<Line<'_>> {
        let rig = PointerStream::new(memory, &RigConfig::default(), 1).unwrap();
        connect(Line { rig, left: usize::MAX, written: Vec::new() }).unwrap()
    }

    fn request(scene: &[u8]) -> Request {
        let files = [
            ("a.toml".to_owned(), scene.to_owned()),
            ("textures/brick.png".to_owned(), include_bytes!("../../../scenes/textures/brick.png").to_vec()),
            ("textures/leather.png".to_owned(), include_bytes!("../../../scenes/textures/leather.png").to_vec()),
        ];
        Request { entry: "a.toml".to_owned(), files: files.into(), ..Request::default() }
    }

    /// The pictures of both scenes do not fit on a board together that plays one of them. After they are replaced in
    /// part, no layer of a scene that is gone can be changed.
    #[test]
    fn an_upload_that_ends_while_the_empty_scene_plays_leaves_no_scene() {
        let mut memory = BoardMemory::new();
        let mut host = host(&mut memory);
        load(&mut host, &request(BRICK)).unwrap();
        host.arm_and_play().unwrap();
        stream_mut(&mut host).left = 20_000;
        assert!(load(&mut host, &request(LEATHER)).unwrap_err().is_link_lost());
        assert!(host.playing().is_none());
        let error = control(&mut host, "layer 1 off").unwrap_err();
        assert!(matches!(error, HostError::Play(PlayError::NothingPlays)), "{error}");
    }

    #[test]
    fn a_stop_that_does_not_arrive_ends_the_pings() {
        let mut memory = BoardMemory::new();
        let mut host = host(&mut memory);
        load(&mut host, &request(LEATHER)).unwrap();
        host.arm_and_play().unwrap();
        host.wait(Duration::from_millis(100)).unwrap();
        stream_mut(&mut host).left = 0;
        let begin = host.device().now();
        assert!(HostError::from(host.stop().unwrap_err()).is_link_lost());
        // Only the command and its repetitions, each 250 ms after the one before.
        let later = stream_mut(&mut host).written.iter().filter(|at| **at >= begin);
        assert!(later.count() <= 3);
        assert_eq!(stream_mut(&mut host).rig.state().0, State::Disarmed, "by the host timeout");
    }
}
