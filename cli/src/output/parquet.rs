//! Recordings as Apache Parquet: `time` and one column of doubles per signal, in groups of rows, with units and origin as metadata.
//!
//! The file holds what the CSV holds, under the plain names of the signals. Its metadata are `unit.<column>` for every column, `fastbike` (the version), `model`, `axes` and `ending`. A value that is not finite stays one.
//!
//! Source: Apache Parquet format 2.x, written by the crate `parquet` (feature `parquet` of this package).

use super::History;
use parquet::basic::{Compression, Repetition, Type as Physical};
use parquet::data_type::DoubleType;
use parquet::errors::ParquetError;
use parquet::file::metadata::KeyValue;
use parquet::file::properties::WriterProperties;
use parquet::file::writer::SerializedFileWriter;
use parquet::schema::types::Type;
use std::io;
use std::sync::Arc;

/// Rows of a group: what a reader takes into memory at once.
const GROUP: usize = 65_536;

/// Writes a recording.
pub(crate) fn write(history: &History, out: &mut (dyn io::Write + Send)) -> io::Result<()> {
    encode(history, out).map_err(io::Error::other)
}

fn encode(history: &History, out: &mut (dyn io::Write + Send)) -> Result<(), ParquetError> {
    let recording = &history.recording;
    let named = std::iter::once(("time", "s"));
    let columns: Vec<(&str, &str)> = named.chain(history.signals.iter().map(|s| (s.name.as_str(), s.unit.as_ref()))).collect();
    let field = |(name, _): &(&str, &str)| {
        Type::primitive_type_builder(name, Physical::DOUBLE).with_repetition(Repetition::REQUIRED).build().map(Arc::new)
    };
    let fields = columns.iter().map(field).collect::<Result<Vec<_>, _>>()?;
    let schema = Arc::new(Type::group_type_builder("recording").with_fields(fields).build()?);
    let units = columns.iter().map(|(name, unit)| KeyValue::new(format!("unit.{name}"), (*unit).to_owned()));
    let origin = [
        ("fastbike", env!("CARGO_PKG_VERSION").to_owned()),
        ("model", history.model.clone()),
        ("axes", history.axes.name().to_owned()),
        ("ending", history.outcome.ending.clone()),
    ];
    let metadata = units.chain(origin.map(|(key, value)| KeyValue::new(key.to_owned(), value))).collect();
    // doubles of a motion seldom repeat: a dictionary of them would be larger than they are
    let properties = WriterProperties::builder()
        .set_compression(Compression::SNAPPY)
        .set_dictionary_enabled(false)
        .set_key_value_metadata(Some(metadata))
        .build();
    let mut file = SerializedFileWriter::new(out, schema, Arc::new(properties))?;
    for first in (0..recording.len()).step_by(GROUP) {
        let rows = first..(first + GROUP).min(recording.len());
        let mut group = file.next_row_group()?;
        let times = recording.time()[rows.clone()].to_vec();
        let signals = (0..history.signals.len()).map(|k| recording.part(k, rows.clone()));
        for values in std::iter::once(Ok(times)).chain(signals) {
            let Some(mut column) = group.next_column()? else { break };
            column.typed::<DoubleType>().write_batch(&values?, None, None)?;
            column.close()?;
        }
        group.close()?;
    }
    file.close().map(|_| ())
}

#[cfg(test)]
mod tests {
    use parquet::file::reader::{FileReader, SerializedFileReader};
    use parquet::record::RowAccessor;
    use std::fs::{self, File};

    /// The recording of a command, in more than a group of rows, against its CSV.
    #[test]
    fn the_file_holds_what_the_csv_holds() {
        let folder = std::env::temp_dir().join(format!("fastbike_parquet_{}", std::process::id()));
        let out = folder.display().to_string();
        let arguments = ["run", "pendulum", "--duration", "7s", "--rate", "10kHz", "--out", &out];
        assert_eq!(crate::run_captured(crate::standard_kinds(), arguments).status, 0);
        let text = fs::read_to_string(folder.join("results.csv")).expect("the CSV");
        let reader = SerializedFileReader::new(File::open(folder.join("results.parquet")).expect("a file")).expect("Parquet");
        let (file, mut lines) = (reader.metadata().file_metadata(), text.lines());
        let told = |key: &str| file.key_value_metadata().and_then(|all| all.iter().find(|k| k.key == key)?.value.clone());
        let columns: Vec<String> = file.schema_descr().columns().iter().map(|c| c.name().to_owned()).collect();
        let headed: Vec<String> =
            columns.iter().map(|name| format!("{name} [{}]", told(&format!("unit.{name}")).unwrap_or_default())).collect();
        assert_eq!(lines.next(), Some(headed.join(",").as_str()));
        assert_eq!((told("axes").as_deref(), told("ending").as_deref()), (Some("iso"), Some("reached")));
        assert!(reader.metadata().num_row_groups() == 2 && file.num_rows() == 70_001, "{} rows", file.num_rows());
        for (row, line) in reader.get_row_iter(None).expect("rows").zip(lines) {
            let row = row.expect("a row");
            for (c, cell) in line.split(',').enumerate() {
                assert_eq!(row.get_double(c).expect("a double"), cell.parse::<f64>().expect("a number"), "{}", columns[c]);
            }
        }
        fs::remove_dir_all(folder).expect("a folder of our own");
    }
}
