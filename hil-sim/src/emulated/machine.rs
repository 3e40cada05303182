//! Runs an image in the emulator.

use std::fs::{self, File};
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Stdio};

use frixel_exchange::layout;
use tempfile::TempDir;

use super::image::EMULATOR;
use super::memory::Memory;
use super::{EmulatorError, Image};

/// Directory in memory, if the system has one: the files here need no disk.
const MEMORY_DISK: &str = "/dev/shm";

/// A running emulator. Dropping this ends it.
#[derive(Debug)]
pub(super) struct Machine {
    process: Child,
    pub(super) memory: Memory,
    /// File with the emulator's output, so that the emulator never waits for a reader.
    output: PathBuf,
    _folder: TempDir,
}

impl Machine {
    /// Starts the image in one of [`layout`]'s modes, with additional arguments for the emulator.
    pub(super) fn start(image: &Image, mode: u32, arguments: &[&str]) -> Result<Self, EmulatorError> {
        let disk = Path::new(MEMORY_DISK);
        let folder = if disk.is_dir() { tempfile::tempdir_in(disk) } else { tempfile::tempdir() };
        let folder = folder.map_err(EmulatorError::system("making a temporary folder"))?;
        let shared = folder.path().join("psram");
        let memory = Memory::new(&shared)?;
        memory.set(layout::MODE, mode)?;
        memory.set(layout::SIMULATOR, layout::PRESENT)?;
        let output = folder.path().join("output");
        let file = File::create(&output).map_err(EmulatorError::system("making a file for the emulator's output"))?;
        let errors = file.try_clone().map_err(EmulatorError::system("sharing the emulator's output"))?;
        let size = layout::SHARED_LEN;
        let backend = format!("memory-backend-file,id=psram,size={size},mem-path={},share=on", shared.display());
        let machine = format!("{},memory-backend=psram", image.board().machine());
        let process = Command::new(EMULATOR)
            .args(["-M", &machine, "-object", &backend])
            .args(["-display", "none", "-monitor", "none", "-kernel"])
            .arg(image.path())
            .args(arguments)
            .stdin(Stdio::null())
            .stdout(file)
            .stderr(errors)
            .spawn()
            .map_err(EmulatorError::system("starting the emulator"))?;
        Ok(Self { process, memory, output, _folder: folder })
    }

    /// Returns the emulator's output so far.
    pub(super) fn output(&self) -> Result<String, EmulatorError> {
        fs::read_to_string(&self.output).map_err(EmulatorError::system("reading the emulator's output"))
    }

    /// Returns an error when the emulator has ended.
    pub(super) fn check(&mut self) -> Result<(), EmulatorError> {
        match self.process.try_wait().map_err(EmulatorError::system("checking on the emulator"))? {
            None => Ok(()),
            Some(_) => Err(EmulatorError::ended(self.output()?)),
        }
    }
}

impl Drop for Machine {
    fn drop(&mut self) {
        // It may have ended already.
        let _ = self.process.kill();
        let _ = self.process.wait();
    }
}
