//! One JSON object, SI units and radians, as the command line contract describes it.
//!
//! A value that is not finite is `null`; `signals` is empty where nothing was computed.

use super::report::{Beside, Point, Report};
use super::{Kind, Options, comfort, comparison, handling, history, linear, modes, responses, rider, setup, tire};
use problem::Ending;
use serde_json::{Map, Value, json};
use std::io;

pub(super) const KIND: Kind = Kind {
    name: "json",
    about: "one JSON object, SI units and radians",
    write,
    write_history: history::json::write,
    write_comparison: comparison::write_json,
    write_tire: tire::write_json,
    write_setup: setup::write_json,
};

fn write(report: &Report, _: &Options, out: &mut dyn io::Write) -> io::Result<()> {
    serde_json::to_writer_pretty(&mut *out, &object(report))?;
    writeln!(out)
}

/// The report as a JSON value.
pub(super) fn object(report: &Report) -> Value {
    let units: Map<String, Value> = report.signals.iter().map(|s| (s.name.clone(), json!(s.unit))).collect();
    let given_units: Map<String, Value> = report.given.iter().map(|g| (g.name.clone(), json!(g.unit))).collect();
    let mut object = json!({
        "fastbike": env!("CARGO_PKG_VERSION"),
        "command": report.command,
        "model": report.model,
        "axes": report.axes.name(),
        "given_units": given_units,
        "units": units,
        "points": report.points.iter().map(|p| point(report, p)).collect::<Vec<_>>(),
        "warnings": report.warnings,
    });
    match &report.beside {
        Beside::Nothing => {}
        Beside::Linear(linear) => linear::add_json(linear, &mut object),
        Beside::Modes(modes) => modes::add_json(modes, &report.given, &mut object),
        Beside::Responses(responses) => responses::add_json(responses, &mut object),
        Beside::Comfort(comfort) => comfort::add_json(comfort, &mut object),
        Beside::Rider(along) => rider::add_json(along, &mut object),
        Beside::Handling(along) => handling::add_json(along, &mut object),
    }
    if !report.limits.is_empty() {
        object["limits"] = report.limits.iter().map(|p| point(report, p)).collect::<Vec<_>>().into();
    }
    if !report.variants.is_empty() {
        let points = |v: &super::Variant| v.points.iter().map(|p| point(report, p)).collect::<Vec<_>>();
        let variants = report.variants.iter().map(|v| {
            let mut object = json!({ "variant": v.name, "points": points(v) });
            match &v.beside {
                Beside::Modes(modes) => modes::add_json(modes, &report.given, &mut object),
                Beside::Responses(responses) => responses::add_json(responses, &mut object),
                Beside::Comfort(comfort) => comfort::add_json(comfort, &mut object),
                _ => {}
            }
            object
        });
        object["versus"] = variants.collect::<Vec<_>>().into();
    }
    object
}

fn point(report: &Report, point: &Point) -> Value {
    let given: Map<String, Value> = report.given.iter().zip(&point.given).map(|(g, &v)| (g.name.clone(), json!(v))).collect();
    let signals: Map<String, Value> = report.signals.iter().zip(&point.values).map(|(s, &v)| (s.name.clone(), json!(v))).collect();
    let mut object = Map::new();
    object.insert("given".to_owned(), given.into());
    object.insert("ending".to_owned(), point.ending.name().into());
    match &point.ending {
        Ending::Reached => {}
        Ending::Limit { signal, value, threshold, .. } => {
            object.insert("limit".to_owned(), json!({ "signal": signal, "value": value, "threshold": threshold }));
        }
        Ending::NotConverged { because } => {
            object.insert("because".to_owned(), json!(because));
        }
    }
    object.insert("iterations".to_owned(), point.effort.iterations.into());
    object.insert("residual".to_owned(), json!(point.residual));
    object.insert("signals".to_owned(), signals.into());
    object.into()
}

#[cfg(test)]
mod tests {
    use super::super::sample;
    use super::*;

    fn text(report: &Report) -> String {
        let mut out = Vec::new();
        write(report, &Options::default(), &mut out).expect("memory takes everything");
        String::from_utf8(out).expect("text").replace(env!("CARGO_PKG_VERSION"), "VERSION")
    }

    #[test]
    fn sweep_is_one_object() {
        let expected = r#"{
  "fastbike": "VERSION",
  "command": "trim",
  "model": "ref11",
  "axes": "iso",
  "given_units": {
    "speed": "m/s",
    "lean": "rad"
  },
  "units": {
    "chassis.roll": "rad",
    "steer.torque": "N m",
    "rear_tire.normal_force": "N"
  },
  "points": [
    {
      "given": {
        "speed": 20.0,
        "lean": 0.6
      },
      "ending": "reached",
      "iterations": 4,
      "residual": 1e-12,
      "signals": {
        "chassis.roll": 0.6,
        "steer.torque": -7.125,
        "rear_tire.normal_force": 1623.4567
      }
    },
    {
      "given": {
        "speed": 30.0,
        "lean": 0.6
      },
      "ending": "tire_saturated",
      "limit": {
        "signal": "rear_tire.friction_use",
        "value": 1.02,
        "threshold": 1.0
      },
      "iterations": 17,
      "residual": 0.003,
      "signals": {
        "chassis.roll": 0.55,
        "steer.torque": 12.0,
        "rear_tire.normal_force": null
      }
    },
    {
      "given": {
        "speed": 40.0,
        "lean": 0.6
      },
      "ending": "not_converged",
      "because": "`steer.angle` and `chassis.roll` move together",
      "iterations": 60,
      "residual": null,
      "signals": {}
    }
  ],
  "warnings": [
    "front tire outside its fit"
  ]
}
"#;
        assert_eq!(text(&sample::sweep()), expected);
    }

    #[test]
    fn numbers_survive_the_way_through_text() {
        let read: Value = serde_json::from_str(&text(&sample::corner())).expect("valid JSON");
        assert_eq!(read["points"][0]["signals"]["chassis.yaw_rate"].as_f64(), Some(sample::YAW_RATE));
    }
}
