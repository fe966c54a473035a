//! One line per point, SI units and radians.
//!
//! The first line names the columns: `given.<name>` for what was prescribed, `ending`, `iterations`, `residual`, then the signals under the
//! names that `units` lists in the JSON output. There is no line of units, so that every reader of CSV takes the columns as numbers.
//! A value that is not finite or was not computed is an empty cell. Modes have a line each, linear
//! models one for every entry that is not zero, frequency responses one for every frequency. With `--versus`, a first column `variant` tells the rows apart.

use super::report::{Beside, Report};
use super::{Kind, Options, comfort, comparison, handling, history, linear, modes, responses, rider, setup, tire};
use std::io;

pub(super) const KIND: Kind = Kind {
    name: "csv",
    about: "one line per point, SI units and radians",
    write,
    write_history: history::csv::write,
    write_comparison: comparison::write_csv,
    write_tire: tire::write_csv,
    write_setup: setup::write_csv,
};

fn write(report: &Report, _: &Options, out: &mut dyn io::Write) -> io::Result<()> {
    match &report.beside {
        Beside::Nothing => {}
        Beside::Linear(linear) => return linear::write_csv(report, linear, out),
        Beside::Modes(modes) => return modes::write_csv(report, modes, out),
        Beside::Responses(responses) => return responses::write_csv(report, responses, out),
        Beside::Comfort(comfort) => return comfort::write_csv(report, comfort, out),
        Beside::Rider(along) => return rider::write_csv(report, along, out),
        Beside::Handling(along) => return handling::write_csv(report, along, out),
    }
    let mut table = ::csv::Writer::from_writer(out);
    let given = report.given.iter().map(|g| format!("given.{}", g.name));
    let outcome = ["ending", "iterations", "residual"].map(str::to_owned);
    // a first column tells variants apart, where there are any
    let tagged = !report.variants.is_empty();
    let tag = |name: &str| tagged.then(|| name.to_owned()).into_iter();
    table.write_record(tag("variant").chain(given).chain(outcome).chain(report.signals.iter().map(|s| s.name.clone())))?;
    let variants = report.variants.iter().flat_map(|v| v.points.iter().map(move |p| (v.name.as_str(), p)));
    for (name, point) in report.points.iter().map(|p| ("base", p)).chain(variants) {
        let given = (0..report.given.len()).map(|k| cell(point.given.get(k).copied().unwrap_or(f64::NAN)));
        let outcome = [point.ending.name().to_owned(), point.effort.iterations.to_string(), cell(point.residual)];
        let values = (0..report.signals.len()).map(|k| cell(point.value(k)));
        table.write_record(tag(name).chain(given).chain(outcome).chain(values))?;
    }
    table.flush()
}

/// The shortest text that reads back as the same number.
pub(super) fn cell(value: f64) -> String {
    if value.is_finite() { format!("{value:?}") } else { String::new() }
}

#[cfg(test)]
mod tests {
    use super::super::sample;
    use super::*;

    #[test]
    fn sweep_is_a_plain_table() {
        let mut out = Vec::new();
        write(&sample::sweep(), &Options::default(), &mut out).expect("memory takes everything");
        let expected = "\
given.speed,given.lean,ending,iterations,residual,chassis.roll,steer.torque,rear_tire.normal_force
20.0,0.6,reached,4,1e-12,0.6,-7.125,1623.4567
30.0,0.6,tire_saturated,17,0.003,0.55,12.0,
40.0,0.6,not_converged,60,,,,
";
        assert_eq!(String::from_utf8(out).expect("text"), expected);
    }
}
