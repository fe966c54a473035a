//! Tables for readers: one point as a list of its signals, several points as one line each.

use super::axes::{self, Axes};
use super::number::{aligned, number};
use super::palette::{Palette, styled};
use super::report::{Beside, Point, Report};
use super::{Angles, Kind, Options, comfort, comparison, handling, history, linear, modes, responses, rider, setup, tire, versus};
use problem::Ending;
use std::io;

pub(super) const KIND: Kind = Kind {
    name: "table",
    about: "aligned text with units, angles in degrees",
    write,
    write_history: history::table::write,
    write_comparison: comparison::write_table,
    write_tire: tire::write_table,
    write_setup: setup::write_table,
};

/// What a table of several points shows of the signals that exist, where the user does not choose.
const PREFERRED: [&str; 10] = [
    "chassis.roll",
    "steer.angle",
    "steer.torque",
    "drive.torque",
    "front_tire.normal_force",
    "front_left_tire.normal_force",
    "front_right_tire.normal_force",
    "rear_tire.normal_force",
    "side_tire.normal_force",
    "rear_tire.friction_use",
];

fn write(report: &Report, options: &Options, out: &mut dyn io::Write) -> io::Result<()> {
    let Palette { heading, faint, .. } = options.palette;
    let count = match report.points.len() {
        1 => String::new(),
        n => format!(", {n} points"),
    };
    writeln!(out, "{}", styled(heading, &format!("{} {}{count}", report.command, report.model)))?;
    for line in report.axes.signs() {
        writeln!(out, "{}", styled(faint, line))?;
    }
    match &report.beside {
        Beside::Nothing => {}
        Beside::Linear(linear) => return linear::write_table(report, linear, options, out),
        Beside::Modes(modes) => return modes::write_table(report, modes, options, out),
        Beside::Responses(responses) => return responses::write_table(report, responses, options, out),
        Beside::Comfort(comfort) => return comfort::write_table(report, comfort, options, out),
        Beside::Rider(along) => return rider::write_table(report, along, options, out),
        Beside::Handling(along) => return handling::write_table(report, along, options, out),
    }
    match report.points.as_slice() {
        [] => {}
        [point] => write_one(report, point, options, out)?,
        points => write_several(report, points, options, out)?,
    }
    versus::write(report, options, out)
}

/// `20 m/s`, angles in the chosen unit.
pub(super) fn quantity(value: f64, unit: &str, angles: Angles) -> String {
    let shown = angles.show(unit);
    format!("{} {}", number(value * shown.factor), shown.unit).trim_end().to_owned()
}

/// `speed 20 m/s`: a name and its value.
pub(super) fn named_quantity(name: &str, value: f64, unit: &str, angles: Angles) -> String {
    format!("{name} {}", quantity(value, unit, angles))
}

/// `speed 20 m/s, lean 30 deg` of one point.
pub(super) fn prescribed(report: &Report, point: &Point, angles: Angles) -> String {
    let texts = report.given.iter().zip(&point.given).map(|(g, &v)| format!("{} {}", g.name, quantity(v, &g.unit, angles)));
    texts.collect::<Vec<_>>().join(", ")
}

/// `given: …` for the quantities with these indices; nothing where there are none.
pub(super) fn write_given(report: &Report, indices: &[usize], options: &Options, out: &mut dyn io::Write) -> io::Result<()> {
    let (Some(point), false) = (report.points.first(), indices.is_empty()) else { return Ok(()) };
    let texts = indices.iter().filter_map(|&k| {
        let given = &report.given[k];
        point.given.get(k).map(|&v| format!("{} {}", given.name, quantity(v, &given.unit, options.angles)))
    });
    writeln!(out, "given: {}", texts.collect::<Vec<_>>().join(", "))
}

/// A sentence on how a point ended, colored by its kind.
pub(super) fn describe(report: &Report, point: &Point, options: &Options) -> String {
    let palette = options.palette;
    match &point.ending {
        Ending::Reached => {
            let text = format!("reached in {} iterations, residual {:.1e}", point.effort.iterations, point.residual);
            styled(palette.good, &text)
        }
        Ending::Limit { name, signal, value, threshold } => {
            let unit = report.signals.iter().find(|s| s.name == *signal).map_or("", |s| &s.unit);
            let [value, threshold] = [value, threshold].map(|&v| quantity(v, unit, options.angles));
            styled(palette.caution, &format!("{name}: `{signal}` is {value}, the limit {threshold}"))
        }
        Ending::NotConverged { because } => styled(palette.bad, &format!("not_converged: {because}")),
    }
}

/// One point: a line per signal, grouped by element.
fn write_one(report: &Report, point: &Point, options: &Options, out: &mut dyn io::Write) -> io::Result<()> {
    write_given(report, &(0..report.given.len()).collect::<Vec<_>>(), options, out)?;
    writeln!(out, "ending: {}", describe(report, point, options))?;
    if point.values.is_empty() {
        return Ok(());
    }
    let chosen = if report.shown.is_empty() { (0..report.signals.len()).collect() } else { report.shown.clone() };
    let shown: Vec<_> = chosen.iter().map(|&k| options.angles.show(&report.signals[k].unit)).collect();
    let texts: Vec<String> = chosen.iter().zip(&shown).map(|(&k, s)| number(point.value(k) * s.factor)).collect();
    let values = aligned(&texts);
    let split = |k: usize| report.signals[k].name.rsplit_once('.').unwrap_or(("derived", &report.signals[k].name));
    let name_width = chosen.iter().map(|&k| split(k).1.chars().count()).max().unwrap_or(0);
    let unit_width = shown.iter().map(|s| s.unit.chars().count()).max().unwrap_or(0);
    let mut groups: Vec<&str> = Vec::new();
    for &k in &chosen {
        if !groups.contains(&split(k).0) {
            groups.push(split(k).0);
        }
    }
    for group in groups {
        writeln!(out, "\n{}", styled(options.palette.heading, group))?;
        for (row, &k) in chosen.iter().enumerate().filter(|(_, k)| split(**k).0 == group) {
            let signal = &report.signals[k];
            let turned = if report.axes == Axes::Sae && axes::factor(&signal.name) < 0.0 { "~ " } else { "" };
            let line = format!("  {:name_width$}  {}  {:unit_width$}", split(k).1, values[row], shown[row].unit);
            let about = format!("{turned}{}", signal.about);
            writeln!(out, "{line}  {}", styled(options.palette.faint, about.trim_end()))?;
        }
    }
    Ok(())
}

/// A column of a table: name, unit, cells.
pub(super) struct Column {
    pub(super) name: String,
    pub(super) unit: String,
    pub(super) cells: Vec<String>,
}

impl Column {
    pub(super) fn new(name: &str, unit: &str, values: impl Iterator<Item = f64>, angles: Angles) -> Self {
        let shown = angles.show(unit);
        let texts: Vec<String> = values.map(|v| number(v * shown.factor)).collect();
        Self { name: name.to_owned(), unit: shown.unit.to_owned(), cells: aligned(&texts) }
    }

    pub(super) fn width(&self) -> usize {
        self.cells.iter().chain([&self.name, &self.unit]).map(|text| text.chars().count()).max().unwrap_or(0)
    }
}

/// Several points: a line per point, then how many ended how.
fn write_several(report: &Report, points: &[Point], options: &Options, out: &mut dyn io::Write) -> io::Result<()> {
    let (fixed, mut columns) = prescribed_columns(report, points, options);
    write_given(report, &fixed, options, out)?;
    for k in chosen(report) {
        let signal = &report.signals[k];
        columns.push(Column::new(&signal.name, &signal.unit, points.iter().map(|p| p.value(k)), options.angles));
    }
    write_columns(&columns, points, options, out)?;
    write_summary(report, points, options, out)
}

/// Indices of the prescribed quantities that do not vary, and a column for each that does.
pub(super) fn prescribed_columns(report: &Report, points: &[Point], options: &Options) -> (Vec<usize>, Vec<Column>) {
    let given = |p: &Point, k: usize| p.given.get(k).copied().unwrap_or(f64::NAN);
    let (fixed, swept): (Vec<usize>, Vec<usize>) =
        (0..report.given.len()).partition(|&k| points.iter().all(|p| given(p, k) == given(&points[0], k)));
    let column = |&k: &usize| Column::new(&report.given[k].name, &report.given[k].unit, points.iter().map(|p| given(p, k)), options.angles);
    (fixed, swept.iter().map(column).collect())
}

/// Columns with a line per point, and how each point ended.
pub(super) fn write_columns(columns: &[Column], points: &[Point], options: &Options, out: &mut dyn io::Write) -> io::Result<()> {
    let palette = options.palette;
    writeln!(out, "\n{}", styled(palette.heading, &format!("{}  ending", line(columns, &|c| c.name.clone()))))?;
    writeln!(out, "{}", styled(palette.faint, line(columns, &|c| c.unit.clone()).trim_end()))?;
    for (row, point) in points.iter().enumerate() {
        let style = match point.ending {
            Ending::Reached => palette.good,
            Ending::Limit { .. } => palette.caution,
            Ending::NotConverged { .. } => palette.bad,
        };
        writeln!(out, "{}  {}", line(columns, &|c| c.cells[row].clone()), styled(style, point.ending.name()))?;
    }
    Ok(())
}

/// One line across columns.
pub(super) fn line(columns: &[Column], text: &dyn Fn(&Column) -> String) -> String {
    columns.iter().map(|c| format!("{:>width$}", text(c), width = c.width())).collect::<Vec<_>>().join("  ")
}

/// Number of points by ending, each cause with its first sentence.
pub(super) fn write_summary(report: &Report, points: &[Point], options: &Options, out: &mut dyn io::Write) -> io::Result<()> {
    let reached = points.iter().filter(|p| p.ending == Ending::Reached).count();
    writeln!(out, "\n{reached} of {} points reached", points.len())?;
    let mut names: Vec<&str> = Vec::new();
    for point in points.iter().filter(|p| p.ending != Ending::Reached) {
        if names.contains(&point.ending.name()) {
            continue;
        }
        names.push(point.ending.name());
        let count = points.iter().filter(|p| p.ending.name() == point.ending.name()).count();
        let first = if count > 1 { " (the first)" } else { "" };
        writeln!(out, "{count} × {}{first}", describe(report, point, options))?;
    }
    Ok(())
}

/// The signals of a table of several points.
pub(super) fn chosen(report: &Report) -> Vec<usize> {
    if !report.shown.is_empty() {
        return report.shown.clone();
    }
    let preferred: Vec<usize> = PREFERRED.iter().filter_map(|name| report.signals.iter().position(|s| s.name == *name)).collect();
    if preferred.is_empty() { (0..report.signals.len().min(PREFERRED.len())).collect() } else { preferred }
}

#[cfg(test)]
mod tests {
    use super::super::{Results, sample};
    use super::*;

    fn text(report: &Report, palette: Palette) -> String {
        let mut out = Vec::new();
        write(report, &Options { palette, ..Options::default() }, &mut out).expect("memory takes everything");
        String::from_utf8(out).expect("text")
    }

    #[test]
    fn one_point_lists_its_signals_by_element() {
        let expected = "\
trim ref11
ISO: x forward, y left, z up; lean > 0 to the right, pitch > 0 nose down
steer angle, steer torque, yaw rate, curvature, lateral acceleration and force > 0 to the left
given: speed 20 m/s, lean 34.3775 deg
ending: reached in 4 iterations, residual 1.0e-12

chassis
  roll            34.3775    deg    roll angle, positive to the right
  yaw_rate        -0.223145  rad/s  yaw rate, positive to the left

steer
  torque          -7.125     N m    torque on the handlebar, positive to the left

rear_tire
  normal_force  1623.46      N      load, positive up
  slip_angle       0         deg    slip angle, positive when it pushes to the left
  friction_use     0.71             share of the available friction

derived
  curvature       -0.011157  1/m    curvature of the path, positive to the left
";
        assert_eq!(text(&sample::corner(), Palette::plain()), expected);
    }

    #[test]
    fn sae_axes_turn_values_and_say_so() {
        let report = Report { shown: vec![0, 2], ..sample::corner() }.in_axes(Axes::Sae);
        let expected = "\
trim ref11
SAE: x forward, y right, z down; lean > 0 to the right, pitch > 0 nose up
steer angle, steer torque, yaw rate, curvature, lateral acceleration and force > 0 to the right; ~ opposite to the description
given: speed 20 m/s, lean 34.3775 deg
ending: reached in 4 iterations, residual 1.0e-12

chassis
  roll    34.3775  deg  roll angle, positive to the right

steer
  torque   7.125   N m  ~ torque on the handlebar, positive to the left
";
        assert_eq!(text(&report, Palette::plain()), expected);
        assert_eq!(report.clone().in_axes(Axes::Iso).points, sample::corner().points);
    }

    #[test]
    fn several_points_are_lines_with_their_endings() {
        let expected = "\
trim ref11, 3 points
ISO: x forward, y left, z up; lean > 0 to the right, pitch > 0 nose down
steer angle, steer torque, yaw rate, curvature, lateral acceleration and force > 0 to the left
given: lean 34.3775 deg

speed  chassis.roll  steer.torque  rear_tire.normal_force  ending
  m/s           deg           N m                       N
   20       34.3775        -7.125                 1623.46  reached
   30       31.5127        12                        -     tire_saturated
   40        -              -                        -     not_converged

1 of 3 points reached
1 × tire_saturated: `rear_tire.friction_use` is 1.02, the limit 1
1 × not_converged: `steer.angle` and `chassis.roll` move together
";
        assert_eq!(text(&sample::sweep(), Palette::plain()), expected);
    }

    #[test]
    fn colors_change_nothing_but_colors() {
        let colored = text(&sample::sweep(), Palette::colored());
        assert!(colored.contains("\u{1b}[33mtire_saturated\u{1b}[0m"));
        let stripped: String =
            colored.split('\u{1b}').enumerate().map(|(k, s)| if k == 0 { s } else { s.split_once('m').map_or("", |p| p.1) }).collect();
        assert_eq!(stripped, text(&sample::sweep(), Palette::plain()));
    }

    #[test]
    fn radians_on_request() {
        let mut out = Vec::new();
        let options = Options { angles: Angles::Radians, ..Options::default() };
        write(&sample::corner(), &options, &mut out).expect("memory takes everything");
        assert!(String::from_utf8(out).expect("text").contains("given: speed 20 m/s, lean 0.6 rad\n"));
    }
}
