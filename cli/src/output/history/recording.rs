//! Signals over time in bounded memory.
//!
//! Samples stand in blocks of [`ROWS`] rows, column after column. What [`KEPT`] values do not hold goes to a temporary file without a name, which vanishes with the last view of the recording.
//! Readers take a column, or row after row. A recording is a view: it may leave columns out, and turn the sign of others.

use std::fs::File;
use std::io::{self, Read, Seek, SeekFrom, Write};
use std::ops::Range;
use std::sync::Arc;

/// Rows of a block.
const ROWS: usize = 1024;
/// Values that stay in memory: 64 MiB.
const KEPT: usize = 8 << 20;
/// Bytes of a value.
const BYTES: usize = size_of::<f64>();

/// Closed blocks, of [`ROWS`] rows each, and the open one.
#[derive(Debug, Default)]
struct Blocks {
    width: usize,
    time: Vec<f64>,
    kept: Vec<Vec<f64>>,
    spilled: Option<File>,
    /// Blocks in the file.
    written: usize,
    /// The last block; its columns are [`ROWS`] apart, full or not.
    open: Vec<f64>,
}

/// A recording under way.
#[derive(Debug)]
pub struct Tape {
    blocks: Blocks,
    most: usize,
}

impl Tape {
    /// For so many columns.
    pub fn new(width: usize) -> Self {
        Self::keeping(width, KEPT)
    }

    fn keeping(width: usize, most: usize) -> Self {
        Self { blocks: Blocks { width, open: vec![0.0; ROWS * width], ..Blocks::default() }, most }
    }

    /// Adds a sample, one value per column.
    ///
    /// # Errors
    /// The temporary file takes no more. The sample is kept nevertheless, but no further one may be added.
    pub fn push(&mut self, time: f64, values: impl Iterator<Item = f64>) -> io::Result<()> {
        let Blocks { width, time: times, kept, spilled, written, open } = &mut self.blocks;
        let row = times.len() % ROWS;
        for (column, value) in values.enumerate().take(*width) {
            open[column * ROWS + row] = value;
        }
        times.push(time);
        if row + 1 < ROWS || *width == 0 {
            return Ok(());
        }
        if (kept.len() + 1) * open.len() <= self.most {
            kept.push(std::mem::replace(open, vec![0.0; ROWS * *width]));
            return Ok(());
        }
        let file = match spilled {
            Some(file) => file,
            None => spilled.insert(tempfile::tempfile()?),
        };
        let bytes: Vec<u8> = open.iter().flat_map(|value| value.to_ne_bytes()).collect();
        file.write_all(&bytes)?;
        *written += 1;
        Ok(())
    }

    /// The recording of all columns.
    pub fn finish(self) -> Recording {
        let columns = (0..self.blocks.width).map(|k| Column { from: Source::Block(k), sign: 1.0 }).collect();
        Recording { blocks: Arc::new(self.blocks), columns }
    }
}

#[derive(Clone, Debug)]
enum Source {
    /// A column of the blocks.
    Block(usize),
    /// One that was computed afterwards.
    Beside(Arc<[f64]>),
}

#[derive(Clone, Debug)]
struct Column {
    from: Source,
    sign: f64,
}

/// Columns of doubles over time. Copies share what was recorded.
#[derive(Clone, Debug, Default)]
pub struct Recording {
    blocks: Arc<Blocks>,
    columns: Vec<Column>,
}

impl Recording {
    /// Sampling times, s.
    pub fn time(&self) -> &[f64] {
        &self.blocks.time
    }

    /// Number of samples.
    pub fn len(&self) -> usize {
        self.blocks.time.len()
    }

    /// Whether there is no sample.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// Some of its columns, in this order.
    #[must_use]
    pub fn pick(&self, columns: impl IntoIterator<Item = usize>) -> Self {
        Self { blocks: self.blocks.clone(), columns: columns.into_iter().map(|k| self.columns[k].clone()).collect() }
    }

    /// Inserts a column that was computed from others, one value per sample.
    pub fn insert(&mut self, at: usize, values: Vec<f64>) {
        self.columns.insert(at, Column { from: Source::Beside(values.into()), sign: 1.0 });
    }

    /// Multiplies a column with 1 or −1.
    pub fn turn(&mut self, column: usize, sign: f64) {
        self.columns[column].sign *= sign;
    }

    /// One value per sample.
    ///
    /// # Errors
    /// The temporary file cannot be read.
    pub fn column(&self, k: usize) -> io::Result<Vec<f64>> {
        self.part(k, 0..self.len())
    }

    /// Those of some samples.
    ///
    /// # Errors
    /// The temporary file cannot be read.
    pub fn part(&self, k: usize, rows: Range<usize>) -> io::Result<Vec<f64>> {
        let Column { from, sign } = &self.columns[k];
        let mut values = Vec::with_capacity(rows.len());
        match from {
            Source::Beside(all) => values.extend_from_slice(&all[rows]),
            Source::Block(column) => {
                let mut buffer = [0; ROWS * BYTES];
                let mut at = rows.start;
                while at < rows.end {
                    let block = at / ROWS;
                    let until = rows.end.min((block + 1) * ROWS);
                    let within = column * ROWS + at % ROWS..column * ROWS + at % ROWS + (until - at);
                    self.blocks.read(block, within, &mut buffer, &mut values)?;
                    at = until;
                }
            }
        }
        values.iter_mut().for_each(|value| *value *= sign);
        Ok(values)
    }

    /// Hands out sample after sample: its time and one value per column.
    ///
    /// # Errors
    /// That of `take`, or the temporary file cannot be read.
    pub fn rows(&self, mut take: impl FnMut(f64, &[f64]) -> io::Result<()>) -> io::Result<()> {
        let mut row = vec![0.0; self.columns.len()];
        for first in (0..self.len()).step_by(ROWS) {
            let rows = first..self.len().min(first + ROWS);
            let block = (0..self.columns.len()).map(|k| self.part(k, rows.clone())).collect::<io::Result<Vec<_>>>()?;
            for (k, &time) in self.time()[rows].iter().enumerate() {
                row.iter_mut().zip(&block).for_each(|(value, column)| *value = column[k]);
                take(time, &row)?;
            }
        }
        Ok(())
    }
}

impl Blocks {
    /// Appends a range of the values of a block, which lies in one column.
    fn read(&self, block: usize, within: Range<usize>, buffer: &mut [u8], values: &mut Vec<f64>) -> io::Result<()> {
        let last = self.kept.len() + self.written;
        if let Some(kept) = if block == last { Some(&self.open) } else { self.kept.get(block) } {
            values.extend_from_slice(&kept[within]);
            return Ok(());
        }
        let Some(mut file) = self.spilled.as_ref() else { return Err(io::ErrorKind::NotFound.into()) };
        let before = (block - self.kept.len()) * ROWS * self.width + within.start;
        file.seek(SeekFrom::Start((before * BYTES) as u64))?;
        let bytes = &mut buffer[..within.len() * BYTES];
        file.read_exact(bytes)?;
        values.extend(bytes.chunks_exact(BYTES).map(|b| f64::from_ne_bytes(b.try_into().unwrap_or_default())));
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Everything comes back, from memory and from the file, whole, in parts and by rows.
    #[test]
    fn what_was_recorded_is_read() {
        let value = |k: usize, column: usize| (k * 10 + column) as f64 + 0.25;
        for (samples, most) in [(0, KEPT), (1, 0), (ROWS, 0), (ROWS + 1, 0), (5 * ROWS + 17, 2 * 3 * ROWS), (3 * ROWS, KEPT)] {
            let mut tape = Tape::keeping(3, most);
            for k in 0..samples {
                tape.push(0.5 * k as f64, (0..3).map(|column| value(k, column))).expect("room for a file");
            }
            assert_eq!(tape.blocks.spilled.is_some(), most < KEPT && samples >= ROWS * (most / (3 * ROWS) + 1));
            let mut recording = tape.finish().pick([2, 0]);
            recording.turn(1, -1.0);
            recording.insert(1, vec![7.0; samples]);
            assert_eq!(recording.len(), samples);
            let expected: Vec<f64> = (0..samples).map(|k| value(k, 2)).collect();
            assert_eq!(recording.column(0).expect("a column"), expected);
            let rows = samples / 3..samples - samples / 5;
            assert_eq!(recording.part(0, rows.clone()).expect("a part"), expected[rows]);
            let mut seen = 0;
            let read = recording.rows(|time, row| {
                assert_eq!((time, row), (0.5 * seen as f64, &[value(seen, 2), 7.0, -value(seen, 0)][..]));
                seen += 1;
                Ok(())
            });
            assert!(read.is_ok() && seen == samples);
        }
    }

    /// What was recorded until the file took no more is still there.
    #[test]
    fn a_full_disk_loses_nothing() {
        let mut tape = Tape::keeping(1, 2 * ROWS);
        // a file that cannot be written
        tape.blocks.spilled = Some(File::open("Cargo.toml").expect("a file of this package"));
        let full = (0..).find(|&k| tape.push(k as f64, std::iter::once(-(k as f64))).is_err());
        assert_eq!(full, Some(3 * ROWS - 1));
        let expected: Vec<f64> = (0..3 * ROWS).map(|k| -(k as f64)).collect();
        assert_eq!(tape.finish().column(0).expect("all in memory"), expected);
    }
}
