//! Setup of a vehicle: numbers by group, suspensions, components; the curves over travel as JSON and CSV.

use super::number::{aligned, number};
use super::palette::styled;
use super::{Angles, Axes, Kind, Options, Results, Writer, csv};
use motorcycle::setup::{Component, Quantity, Setup, Suspension};
use serde_json::{Map, Value, json};
use std::io;

/// The setup of a vehicle in a steady pose.
#[derive(Clone, Debug)]
pub struct SetupReport {
    /// Model.
    pub model: String,
    /// What was prescribed: name, SI unit, value.
    pub given: Vec<(String, String, f64)>,
    /// What was found.
    pub setup: Setup,
    /// Tensions of a chain and loads of tires in the pose: signal, unit, value.
    pub forces: Vec<(String, String, f64)>,
    /// What the reader should know.
    pub warnings: Vec<String>,
}

impl Results for SetupReport {
    /// Directions are in words (ahead of, above), so the axes of the reader change nothing.
    fn in_axes(self, _: Axes) -> Self {
        self
    }
    fn writer(kind: &Kind) -> Writer<Self> {
        kind.write_setup
    }
    fn warnings(&self) -> &[String] {
        &self.warnings
    }
    fn statistics(&self) -> Value {
        json!({ "points": self.setup.suspensions.iter().map(|s| s.curve.len()).sum::<usize>() })
    }
    fn reached(&self) -> bool {
        true
    }
}

/// Numbers of a suspension: name, unit, value, sentence.
pub fn numbers(suspension: &Suspension) -> Vec<(String, &'static str, f64, &'static str)> {
    let mut found = vec![
        ("sag".to_owned(), "m", suspension.sag.unwrap_or(f64::NAN), "travel of the wheel from full extension"),
        ("travel".to_owned(), "m", suspension.stop.unwrap_or(f64::NAN), "from full extension to the stop of the bump"),
        ("load".to_owned(), "N", suspension.here.force, "load that the suspension carries at this travel, with wheel and arm"),
        ("wheel_rate".to_owned(), "N/m", suspension.here.wheel_rate, "load by travel (reduced stiffness)"),
        ("damping_bump".to_owned(), "N s/m", suspension.damping[0], "reduced damping at a wheel speed of 0.1 m/s"),
        ("damping_rebound".to_owned(), "N s/m", suspension.damping[1], "reduced damping at a wheel speed of -0.1 m/s"),
    ];
    for ((name, turning), spring) in suspension.springs.iter().zip(&suspension.here.springs) {
        let (ratio, force) = if *turning { ("rad/m", "N m") } else { ("-", "N") };
        found.push((format!("{name}.motion_ratio"), ratio, spring.motion_ratio, "compression of the spring by travel of the wheel"));
        found.push((format!("{name}.force"), force, spring.force, "force of the spring"));
    }
    found
}

/// A name with its unit and value, as a line of a group.
type Line<'a> = (String, f64, String, &'a str);

fn line<'a>(name: &str, unit: &str, value: f64, about: &'a str, angles: Angles) -> Line<'a> {
    // lengths read best in millimeters where a workshop measures them
    let shown = angles.show(unit);
    let (factor, unit) = match unit {
        "m" => (1e3, "mm"),
        "N/m" => (1e-3, "kN/m"),
        _ => (shown.factor, shown.unit),
    };
    (name.replace('_', " "), value * factor, unit.to_owned(), about)
}

fn group(title: &str, lines: &[Line<'_>], options: &Options, out: &mut dyn io::Write) -> io::Result<()> {
    if lines.is_empty() {
        return Ok(());
    }
    writeln!(out, "\n{}", styled(options.palette.heading, title))?;
    let values = aligned(&lines.iter().map(|l| number(l.1)).collect::<Vec<_>>());
    let longest = |part: &dyn Fn(&Line<'_>) -> usize| lines.iter().map(part).max().unwrap_or(0);
    let (names, units) = (longest(&|l| l.0.chars().count()), longest(&|l| l.2.chars().count()));
    for ((name, _, unit, about), value) in lines.iter().zip(values) {
        writeln!(out, "  {name:<names$}  {value} {unit:<units$}  {}", styled(options.palette.faint, about))?;
    }
    Ok(())
}

pub(super) fn write_table(report: &SetupReport, options: &Options, out: &mut dyn io::Write) -> io::Result<()> {
    let setup = &report.setup;
    writeln!(out, "{}", styled(options.palette.heading, &format!("setup {}", report.model)))?;
    let given = report.given.iter().map(|(name, unit, value)| super::table::named_quantity(name, *value, unit, options.angles));
    let given: Vec<String> = given.collect();
    let pose = if given.is_empty() { "static pose".to_owned() } else { format!("given: {}", given.join(", ")) };
    writeln!(out, "{}", styled(options.palette.faint, &pose))?;
    let lines = |quantities: &'_ [Quantity]| -> Vec<Line<'static>> {
        quantities.iter().map(|q| line(q.name, q.unit, q.value, q.about, options.angles)).collect()
    };
    group("geometry", &lines(&setup.geometry), options, out)?;
    group("mass center and inertia", &lines(&setup.mass), options, out)?;
    for suspension in &setup.suspensions {
        let numbers = numbers(suspension);
        let lines: Vec<Line<'_>> =
            numbers.iter().map(|(name, unit, value, about)| line(name, unit, *value, about, options.angles)).collect();
        group(&format!("{} suspension", suspension.axle), &lines, options, out)?;
    }
    group("squat and dive", &lines(&setup.pull), options, out)?;
    let forces: Vec<Line<'_>> = report.forces.iter().map(|(name, unit, value)| line(name, unit, *value, "", options.angles)).collect();
    group("forces in this pose", &forces, options, out)?;
    components(&setup.components, options, out)?;
    for (what, because) in &setup.left_out {
        writeln!(out, "\n{what} left out: {because}")?;
    }
    Ok(())
}

fn components(components: &[Component], options: &Options, out: &mut dyn io::Write) -> io::Result<()> {
    writeln!(out, "\n{}", styled(options.palette.heading, "components"))?;
    writeln!(
        out,
        "{}",
        styled(
            options.palette.faint,
            "  center from the rear contact, forward and up; share of the inertia about the mass center of the whole"
        )
    )?;
    type Column = (&'static str, fn(&Component) -> f64);
    let columns: [Column; 6] = [
        ("kg", |c| c.mass.mass),
        ("forward m", |c| c.mass.center.x),
        ("up m", |c| c.mass.center.z),
        ("roll kg m²", |c| c.share[0]),
        ("pitch kg m²", |c| c.share[1]),
        ("yaw kg m²", |c| c.share[2]),
    ];
    let names = components.iter().map(|c| c.name.chars().count()).max().unwrap_or(0);
    let cells: Vec<Vec<String>> = columns
        .iter()
        .map(|(title, value)| {
            let values = aligned(&components.iter().map(|c| number(value(c))).collect::<Vec<_>>());
            let width = values.iter().map(|v| v.chars().count()).max().unwrap_or(0).max(title.chars().count());
            std::iter::once((*title).to_owned()).chain(values).map(|cell| format!("{cell:>width$}")).collect()
        })
        .collect();
    for row in 0..=components.len() {
        let name = if row == 0 { "" } else { &components[row - 1].name };
        let text = cells.iter().map(|column| column[row].as_str()).collect::<Vec<_>>().join("  ");
        writeln!(out, "  {name:<names$}  {text}")?;
    }
    Ok(())
}

fn named(quantities: &[Quantity]) -> Value {
    quantities.iter().map(|q| (q.name.to_owned(), json!(q.value))).collect::<Map<_, _>>().into()
}

fn of_suspension(suspension: &Suspension) -> Value {
    let mut object: Map<String, Value> = numbers(suspension).into_iter().map(|(name, _, value, _)| (name, json!(value))).collect();
    let of = |value: &dyn Fn(&motorcycle::setup::TravelPoint) -> f64| suspension.curve.iter().map(value).collect::<Vec<f64>>();
    let springs = suspension.springs.iter().enumerate().map(|(k, (name, _))| {
        let spring = json!({
            "compression": of(&|p| p.springs[k].compression), "force": of(&|p| p.springs[k].force),
            "motion_ratio": of(&|p| p.springs[k].motion_ratio),
        });
        (name.clone(), spring)
    });
    let springs: Map<String, Value> = springs.collect();
    object.insert(
        "curve".to_owned(),
        json!({ "travel": of(&|p| p.travel), "load": of(&|p| p.force), "wheel_rate": of(&|p| p.wheel_rate), "springs": springs }),
    );
    object.into()
}

pub(super) fn write_json(report: &SetupReport, _: &Options, out: &mut dyn io::Write) -> io::Result<()> {
    let setup = &report.setup;
    let all = setup.geometry.iter().chain(&setup.mass).chain(&setup.pull);
    let mut units: Map<String, Value> = all.map(|q| (q.name.to_owned(), json!(q.unit))).collect();
    for suspension in &setup.suspensions {
        units.extend(numbers(suspension).into_iter().map(|(name, unit, ..)| (name, json!(unit))));
    }
    let components: Vec<Value> = setup
        .components
        .iter()
        .map(|c| {
            let center = [c.mass.center.x, c.mass.center.y, c.mass.center.z];
            json!({ "link": c.name, "mass": c.mass.mass, "center": center, "inertia": c.mass.inertia, "share": c.share })
        })
        .collect();
    let left_out: Vec<Value> = setup.left_out.iter().map(|(what, because)| json!({ "what": what, "because": because })).collect();
    let object = json!({
        "fastbike": env!("CARGO_PKG_VERSION"), "command": "setup", "model": report.model,
        "given": report.given.iter().map(|(name, _, value)| (name.clone(), json!(value))).collect::<Map<_, _>>(),
        "units": units, "geometry": named(&setup.geometry), "mass": named(&setup.mass), "pull": named(&setup.pull),
        "suspensions": setup.suspensions.iter().map(|s| (s.axle.to_owned(), of_suspension(s))).collect::<Map<_, _>>(),
        "forces": report.forces.iter().map(|(name, _, value)| (name.clone(), json!(value))).collect::<Map<_, _>>(),
        "components": components, "left_out": left_out, "warnings": report.warnings,
    });
    serde_json::to_writer_pretty(&mut *out, &object)?;
    writeln!(out)
}

/// One line per number, then one per point of a curve: group, name, travel, unit, value.
pub(super) fn write_csv(report: &SetupReport, _: &Options, out: &mut dyn io::Write) -> io::Result<()> {
    let setup = &report.setup;
    let mut table = ::csv::Writer::from_writer(out);
    table.write_record(["group", "name", "travel", "unit", "value"])?;
    for (group, quantities) in [("geometry", &setup.geometry), ("mass", &setup.mass), ("pull", &setup.pull)] {
        for q in quantities {
            table.write_record([group, q.name, "", q.unit, &csv::cell(q.value)])?;
        }
    }
    for suspension in &setup.suspensions {
        for (name, unit, value, _) in numbers(suspension) {
            table.write_record([suspension.axle, &name, "", unit, &csv::cell(value)])?;
        }
        for point in &suspension.curve {
            let travel = csv::cell(point.travel);
            table.write_record([suspension.axle, "load", &travel, "N", &csv::cell(point.force)])?;
            table.write_record([suspension.axle, "wheel_rate", &travel, "N/m", &csv::cell(point.wheel_rate)])?;
            for ((name, turning), spring) in suspension.springs.iter().zip(&point.springs) {
                let unit = if *turning { "rad/m" } else { "-" };
                table.write_record([suspension.axle, &format!("{name}.motion_ratio"), &travel, unit, &csv::cell(spring.motion_ratio)])?;
            }
        }
    }
    for (name, unit, value) in &report.forces {
        table.write_record(["forces", name, "", unit, &csv::cell(*value)])?;
    }
    table.flush()
}
