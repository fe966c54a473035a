//! Where a command writes: to the terminal, or into memory for tests and for programs that embed the command.

use crate::Failure;
use crate::output::Palette;
use std::io::{self, BufWriter, ErrorKind, Write};
use std::sync::{Mutex, PoisonError};

/// What a command wrote and how it ended.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Captured {
    /// Exit status: 0 done, 1 the goal was not reached, 2 the input is wrong.
    pub status: u8,
    /// Standard output.
    pub stdout: String,
    /// Standard error.
    pub stderr: String,
}

/// A stream that remembers whether its reader has gone: writers of formats give errors of their own.
struct Pipe<W> {
    out: W,
    gone: bool,
}

impl<W: Write> Write for Pipe<W> {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        let written = self.out.write(bytes);
        self.gone |= written.as_ref().is_err_and(|e| e.kind() == ErrorKind::BrokenPipe);
        written
    }
    fn flush(&mut self) -> io::Result<()> {
        self.out.flush()
    }
}

/// The two streams of a command.
#[derive(Debug)]
pub struct Console {
    /// `None`: the streams of the process.
    memory: Option<Mutex<Captured>>,
}

impl Console {
    /// The streams of the process.
    pub fn standard() -> Self {
        Self { memory: None }
    }

    /// Streams that are kept; no color, no progress bar.
    pub fn memory() -> Self {
        Self { memory: Some(Mutex::default()) }
    }

    /// Whether the streams are kept instead of shown.
    pub fn is_memory(&self) -> bool {
        self.memory.is_some()
    }

    /// Colors for standard output.
    pub fn palette(&self) -> Palette {
        if self.is_memory() { Palette::plain() } else { Palette::for_stdout() }
    }

    /// Colors for standard error.
    pub fn error_palette(&self) -> Palette {
        if self.is_memory() { Palette::plain() } else { Palette::for_stderr() }
    }

    /// Writes to standard output; a reader that has gone (`| head`) is no failure.
    ///
    /// # Errors
    /// The stream does not take the text.
    pub fn print(&self, text: &[u8]) -> Result<(), Failure> {
        self.stream(|out| out.write_all(text))
    }

    /// Writes to standard output piece by piece; a reader that has gone is no failure.
    ///
    /// # Errors
    /// The stream does not take the text, or `write` fails.
    pub fn stream(&self, write: impl FnOnce(&mut dyn Write) -> io::Result<()>) -> Result<(), Failure> {
        let streamed = match &self.memory {
            Some(memory) => {
                let mut text = Vec::new();
                let written = write(&mut text);
                memory.lock().unwrap_or_else(PoisonError::into_inner).stdout.push_str(&String::from_utf8_lossy(&text));
                written
            }
            None => {
                let mut out = BufWriter::new(Pipe { out: io::stdout().lock(), gone: false });
                let streamed = write(&mut out).and_then(|()| out.flush());
                let (pipe, _) = out.into_parts();
                if pipe.gone { Ok(()) } else { streamed }
            }
        };
        streamed.map_err(|e| Failure::Write { path: "standard output".to_owned(), cause: e.to_string() })
    }

    /// Writes to standard error. Nothing can be said where that fails.
    pub fn complain(&self, text: &str) {
        match &self.memory {
            Some(memory) => memory.lock().unwrap_or_else(PoisonError::into_inner).stderr.push_str(text),
            None => drop(io::stderr().lock().write_all(text.as_bytes())),
        }
    }

    /// Writes warnings to standard error, one line each.
    pub fn warn(&self, warnings: &[String]) {
        warnings.iter().for_each(|w| self.complain(&format!("warning: {w}\n")));
    }

    /// What was written, with the exit status; nothing for the streams of the process.
    pub fn captured(self, status: u8) -> Captured {
        let kept = self.memory.map(|m| m.into_inner().unwrap_or_else(PoisonError::into_inner)).unwrap_or_default();
        Captured { status, ..kept }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn memory_keeps_both_streams_apart() {
        let console = Console::memory();
        assert!(console.print(b"result\n").is_ok());
        console.warn(&["odd".to_owned()]);
        let expected = Captured { status: 1, stdout: "result\n".to_owned(), stderr: "warning: odd\n".to_owned() };
        assert_eq!(console.captured(1), expected);
    }
}
