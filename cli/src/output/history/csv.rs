//! One line per sample, SI units and radians: `time [s],crank.angle [rad],…`. A value that is not finite is an empty cell.

use super::History;
use crate::output::Options;
use crate::output::csv::cell;
use std::io;

pub(in crate::output) fn write(history: &History, _: &Options, out: &mut dyn io::Write) -> io::Result<()> {
    let mut table = ::csv::Writer::from_writer(out);
    let names = history.signals.iter().map(|s| format!("{} [{}]", s.name, s.unit));
    table.write_record(std::iter::once("time [s]".to_owned()).chain(names))?;
    history.recording.rows(|time, row| Ok(table.write_record(std::iter::once(cell(time)).chain(row.iter().map(|v| cell(*v))))?))?;
    table.flush()
}
