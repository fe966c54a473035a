//! `run`: formats, start values, backends, endings.

use super::{evidence, fastbike, folder, json, keys, number};
use serde_json::Value;
use std::fs;

const SQUEEZER: [&str; 6] = ["run", "andrews_squeezer", "--duration", "30ms", "--given", "motor.torque=0.033"];

fn with<'a>(base: &[&'a str], more: &[&'a str]) -> Vec<&'a str> {
    base.iter().chain(more).copied().collect()
}

fn column(report: &Value, name: &str) -> Vec<f64> {
    report["signals"][name].as_array().unwrap_or_else(|| panic!("`{name}` is missing")).iter().map(number).collect()
}

fn last(report: &Value, name: &str) -> f64 {
    column(report, name).last().copied().expect("samples")
}

#[test]
fn json_has_the_keys_of_the_contract() {
    let report = json(&with(&SQUEEZER, &["--format", "json"]), 0);
    for key in ["fastbike", "command", "model", "units", "ending", "time", "signals", "statistics", "drift", "limits", "warnings"] {
        assert!(report.get(key).is_some(), "`{key}` is missing");
    }
    assert_eq!((report["command"].as_str(), report["model"].as_str()), (Some("run"), Some("andrews_squeezer")));
    assert_eq!((report["ending"].as_str(), report.get("because")), (Some("reached"), None));
    assert_eq!((report["backend"].as_str(), report["formulation"].as_str()), (Some("ida"), Some("ggl")));
    assert_eq!(number(&report["given"]["motor.torque"]), 0.033);
    assert_eq!(keys(&report["signals"]), keys(&report["units"]));
    let time = report["time"].as_array().expect("times");
    assert_eq!((time.len(), number(&time[0]), number(&time[200])), (201, 0.0, 0.03));
    for name in keys(&report["signals"]) {
        assert_eq!(column(&report, name).len(), time.len(), "{name}");
        assert!(!name.ends_with("_correction"), "{name}");
    }
    for key in ["time", "steps", "rejected", "residuals", "jacobians", "wall_s"] {
        assert!(report["statistics"][key].is_number(), "`{key}` is missing");
    }
    assert!(column(&report, "motor.torque").iter().all(|&t| t == 0.033));
}

#[test]
fn csv_has_units_in_its_header_and_every_sample() {
    let record = ["--record", "beta.angle", "--record", "rate(beta.rate)", "--record", "system.energy"];
    let csv = fastbike(&with(&with(&SQUEEZER, &record), &["--format", "csv", "--rate", "1kHz"]));
    assert_eq!((csv.status, csv.stderr.as_str()), (0, ""));
    let mut lines = csv.stdout.lines();
    assert_eq!(lines.next(), Some("time [s],beta.angle [rad],rate(beta.rate) [rad/s²],system.energy [J]"));
    let rows: Vec<Vec<f64>> = lines.map(|l| l.split(',').map(|c| c.parse().expect("a number")).collect()).collect();
    assert_eq!((rows.len(), rows[0][1], rows[30][0]), (31, -0.061_713_890_014_276_45, 0.03));
    // published: a crank acceleration of 14222 rad/s² at the start
    assert!((rows[0][2] - 14222.4).abs() < 0.5, "{}", rows[0][2]);
}

#[test]
fn the_table_is_short_and_ends_with_the_last_sample() {
    let table = fastbike(&SQUEEZER);
    assert_eq!((table.status, table.stderr.as_str()), (0, ""));
    assert!(table.stdout.starts_with("run andrews_squeezer\nISO: x forward"), "{}", table.stdout);
    let rows: Vec<&str> =
        table.stdout.lines().skip_while(|l| !l.trim_start().starts_with("time")).skip(2).take_while(|l| !l.contains("samples")).collect();
    assert_eq!(rows.len(), 25, "{}", table.stdout);
    assert!(rows[0].trim_start().starts_with("0 ") && rows[24].starts_with("0.03 "), "{rows:?}");
    for part in ["given: motor.torque 0.033 N m", "ending: reached 0.03 s", "method: ida, ggl form", "constraints on coordinates: off by"] {
        assert!(table.stdout.contains(part), "`{part}` is missing\n{}", table.stdout);
    }
}

/// Different forms and methods follow the same motion, and the work of the motor is the gain of energy.
#[test]
fn every_backend_and_formulation_finds_the_same() {
    let reference = json(&with(&SQUEEZER, &["--format", "json", "--backend", "erk", "--rtol", "1e-11"]), 0);
    assert_eq!(reference["formulation"].as_str(), Some("explicit"));
    let angle = last(&reference, "beta.angle");
    let work = 0.033 * (angle - column(&reference, "beta.angle")[0]);
    let energy = last(&reference, "system.energy") - column(&reference, "system.energy")[0];
    // a tolerance of 1e-11 over some hundred steps, against an energy of some joules
    assert!((work - energy).abs() < 1e-8, "{work} {energy}");
    for formulation in ["ggl", "velocity", "acceleration"] {
        let report = json(&with(&SQUEEZER, &["--format", "json", "--formulation", formulation, "--rtol", "1e-8"]), 0);
        // 16 rad under a relative tolerance of 1e-8 per step, about 1000 steps; the mechanism amplifies errors
        assert!((last(&report, "beta.angle") - angle).abs() < 1e-3, "{formulation}: {} {angle}", last(&report, "beta.angle"));
    }
}

#[test]
fn a_formulation_means_nothing_to_the_explicit_form() {
    let answer = fastbike(&["run", "pendulum", "--duration", "0.1s", "--backend", "erk", "--formulation", "ggl"]);
    assert_eq!(answer.status, 0);
    assert!(answer.stderr.starts_with("warning: `erk` takes the explicit form"), "{}", answer.stderr);
}

/// What is given comes beside what is stated where both go together, else instead of it.
#[test]
fn given_values_are_held() {
    let bicycle = json(&["run", "whipple", "--given", "chassis.roll_rate=3deg/s", "--duration", "0.1s", "--format", "json"], 0);
    let start = |name: &str| column(&bicycle, name)[0];
    // stated as 5 m/s; held and projected onto rolling to rounding
    assert!((start("chassis.forward_speed") - 5.0).abs() < 1e-12 && (start("chassis.roll_rate") - 3f64.to_radians()).abs() < 1e-12);
    assert!((start("rear_wheel.spin_rate") - 5.0 / 0.3).abs() < 1e-9);
    let crank = ["run", "n_four_bar", "--given", "coupler_1.angle=-80deg", "--duration", "0.1s", "--format", "json"];
    let linkage = json(&crank, 0);
    assert!((column(&linkage, "coupler_1.angle")[0] - (-80f64).to_radians()).abs() < 1e-12);
    assert!(linkage["warnings"][0].as_str().is_some_and(|w| w.contains("it was left for `crank_0.angle`")), "{}", linkage["warnings"]);
}

#[test]
fn a_start_that_cannot_be_closed_is_wrong_input() {
    let both = ["--given", "crank_0.angle=90deg", "--given", "coupler_1.angle=-60deg"];
    let answer = fastbike(&with(&["run", "n_four_bar"], &both));
    assert_eq!((answer.status, answer.stdout.as_str()), (2, ""), "{}", answer.stderr);
    for part in ["error[open_start]", " mm", "held: `crank_0.angle` (--given), `coupler_1.angle` (--given)"] {
        assert!(answer.stderr.contains(part), "`{part}` is missing in\n{}", answer.stderr);
    }
}

#[test]
fn wrong_words_are_told_with_the_nearest_known_ones() {
    let cases: [(&[&str], &str); 13] = [
        (&["--until", "pendulum.angl>1"], "`pendulum.angle`"),
        (&["--until", "pendulum.angle=1"], "SIGNAL>VALUE"),
        (&["--until", "pendulum.angle>1 m"], "an angle (rad)"),
        (&["--signals", "nowhere.csv"], "nowhere.csv"),
        (&["--backend", "idaa"], "`ida`"),
        (&["--formulation", "glg"], "`ggl`"),
        (&["--record", "pendulum.angel"], "`pendulum.angle`"),
        (&["--record", "system.enrgy"], "`system.energy`"),
        (&["--given", "pendulum.angl=1"], "`pendulum.angle`"),
        (&["--given", "pendulum.angle=1 m"], "an angle (rad)"),
        (&["--given", "pendulum.angle"], "SIGNAL=VALUE"),
        (&["--duration", "5 m"], "a time (s)"),
        (&["--rtol", "0"], "--rtol 0"),
    ];
    for (arguments, expected) in cases {
        let answer = fastbike(&with(&["run", "pendulum"], arguments));
        assert_eq!((answer.status, answer.stdout.as_str()), (2, ""), "{arguments:?}");
        assert!(answer.stderr.contains(expected), "{arguments:?}\n{}", answer.stderr);
    }
}

#[test]
fn what_follows_from_the_others_has_no_start_value() {
    for name in ["pin_k3.force_z", "spring.length", "rate(beta.angle)"] {
        let answer = fastbike(&["run", "andrews_squeezer", "--given", &format!("{name}=1")]);
        assert_eq!(answer.status, 2, "{name}");
        assert!(answer.stderr.contains("error[wrong_role]"), "{}", answer.stderr);
    }
}

/// The bicycle falls over; lying flat, its wheels no longer roll on their edges.
#[test]
fn a_motion_that_ends_early_is_written_and_ends_with_one() {
    let folder = folder("run_ending");
    let out = folder.join("kept").display().to_string();
    let fall = ["run", "whipple", "--given", "chassis.roll=80deg", "--duration", "3s", "--format", "json", "--out", &out];
    let report = json(&fall, 1);
    assert_eq!(report["ending"].as_str(), Some("fallen"));
    assert!(report["because"].as_str().is_some_and(|b| b.contains("lies on its side: `chassis.roll` ")), "{}", report["because"]);
    let reached = number(&report["statistics"]["time"]);
    let time: Vec<f64> = report["time"].as_array().expect("times").iter().map(number).collect();
    assert!(time.len() > 100 && reached < 3.0 && time.last() == Some(&reached), "{reached} {time:?}");
    assert_eq!(column(&report, "chassis.roll").len(), time.len());
    let answer = fastbike(&fall);
    assert!(answer.stderr.contains("error: the motion ended at "), "{}", answer.stderr);
    let kept: Value = serde_json::from_str(&fs::read_to_string(folder.join("kept/run.json")).expect("run.json")).expect("JSON");
    assert!(kept["statistics"]["steps"].is_number());
    assert!(folder.join("kept/results.csv").exists());
}

#[test]
fn sae_axes_turn_samples_and_given_values() {
    let turn = ["run", "whipple", "--given", "steer.torque=0.1", "--duration", "0.1s", "--format", "json"];
    let (iso, sae) = (json(&turn, 0), json(&with(&turn, &["--axes", "sae"]), 0));
    assert_eq!(number(&sae["given"]["steer.torque"]), -0.1);
    assert_eq!(last(&sae, "steer.angle"), -last(&iso, "steer.angle"));
    assert_eq!(last(&sae, "chassis.roll"), last(&iso, "chassis.roll"));
}

#[test]
fn histories_are_drawn() {
    let folder = folder("run_figure");
    for (name, magic) in [("run.svg", &b"<svg"[..]), ("run.png", &b"\x89PNG\r\n\x1a\n"[..])] {
        let path = folder.join(name);
        let answer = fastbike(&with(&SQUEEZER, &["--plot", &path.display().to_string()]));
        assert_eq!(answer.status, 0, "{}", answer.stderr);
        assert!(fs::read(&path).is_ok_and(|bytes| bytes.starts_with(magic)), "{name}");
    }
}

/// A plain URDF starts in its reference pose.
#[test]
fn a_plain_urdf_falls() {
    let urdf = evidence("reference/mechanisms/double_pendulum_3d.urdf").display().to_string();
    let report = json(&["run", &urdf, "--given", "shoulder.angle=20deg", "--duration", "1s", "--format", "json"], 0);
    let energy = column(&report, "system.energy");
    // a tolerance of 1e-6 over some hundred steps
    let scale = energy.iter().fold(1.0_f64, |m, e| m.max(e.abs()));
    assert!(energy.iter().all(|e| (e - energy[0]).abs() < 1e-3 * scale), "{energy:?}");
}

#[test]
fn a_singular_position_on_the_way_is_told() {
    // all rods in line: the two four-bars may go on as parallelograms or fold
    let through = fastbike(&["run", "n_four_bar", "--duration", "1s"]);
    assert!(through.stderr.contains("near a singular position"), "{}", through.stderr);
    let past = fastbike(&["run", "bricard", "--duration", "1s"]);
    assert!(!past.stderr.contains("singular"), "{}", past.stderr);
}

const STRAIGHT: [&str; 8] = ["run", "gsxr1000", "--speed", "25", "--duration", "1s", "--format", "json"];

/// A vehicle starts from the steady state that `trim` finds, with the inputs that it needs there.
#[test]
fn a_speed_means_a_start_from_the_steady_state() {
    let turn = ["--speed", "25", "--lean", "20deg", "--format", "json"];
    let trim = json(&with(&["trim", "gsxr1000"], &turn), 0);
    let run = json(&with(&["run", "gsxr1000", "--duration", "0.5s"], &turn), 0);
    assert_eq!((number(&run["given"]["speed"]), run["ending"].as_str()), (25.0, Some("reached")));
    for name in ["chassis.roll", "steer.angle", "steer.torque", "drive.torque", "rear_tire.lateral_force", "chassis.yaw_rate"] {
        let steady = number(&trim["points"][0]["signals"][name]);
        let column = column(&run, name);
        assert!((column[0] - steady).abs() <= 1e-9 * steady.abs(), "{name}: {} {steady}", column[0]);
        // tolerance 1e-6 over some dozen steps
        assert!(column.iter().all(|v| (v - steady).abs() < 1e-4 * steady.abs()), "{name} {column:?}");
    }
    // what is given replaces what the steady state has
    let given = json(&with(&STRAIGHT, &["--given", "chassis.roll_rate=2deg/s", "--given", "steer.torque=0.5"]), 0);
    assert!((column(&given, "chassis.roll_rate")[0] - 2f64.to_radians()).abs() < 1e-12);
    assert!(column(&given, "steer.torque").iter().all(|&t| t == 0.5));
    let impossible = fastbike(&["run", "gsxr1000", "--speed", "25", "--lateral-acceleration", "30"]);
    assert_eq!(impossible.status, 1, "{}", impossible.stderr);
    assert!(impossible.stderr.contains("no steady state to start from"), "{}", impossible.stderr);
    let several = fastbike(&["run", "gsxr1000", "--speed", "20,25"]);
    assert!(several.status == 2 && several.stderr.contains("one steady state"), "{}", several.stderr);
}

#[test]
fn a_condition_ends_the_motion_where_it_is_met() {
    let braking = with(&STRAIGHT, &["--given", "front_brake.torque=200", "--until", "chassis.forward_speed<24"]);
    for backend in ["ida", "erk", "cvode", "cvode_adams"] {
        let report = json(&with(&braking, &["--backend", backend]), 0);
        assert_eq!((report["ending"].as_str(), report["condition"].as_str()), (Some("until"), Some("`chassis.forward_speed` < 24.000000")));
        assert!(report.get("because").is_none());
        // tolerance 1e-6
        assert!((last(&report, "chassis.forward_speed") - 24.0).abs() < 1e-4, "{backend} {}", last(&report, "chassis.forward_speed"));
        assert!(number(&report["statistics"]["time"]) < 1.0);
    }
    let table = fastbike(&["run", "pendulum", "--given", "pendulum.angle=60deg", "--until", "pendulum.angle<0deg"]);
    assert!(table.status == 0 && table.stdout.contains("ending: until `pendulum.angle` < "), "{}", table.stdout);
}

/// Inputs from a file act between its rows, with jumps where a time stands twice; a recorded run gives its inputs again.
#[test]
fn inputs_come_from_files() {
    let folder = folder("run_signals");
    let (pulse, again) = (folder.join("pulse.csv"), folder.join("again.csv"));
    fs::write(&pulse, "time,steer.torque [N m]\n0,0\n0.1,0\n0.1,5\n0.3,5\n0.3,0\n1,0\n").expect("a file");
    let file = pulse.display().to_string();
    let report = json(&with(&STRAIGHT, &["--signals", &file]), 0);
    let torque = column(&report, "steer.torque");
    let time: Vec<f64> = report["time"].as_array().expect("times").iter().map(number).collect();
    for (t, torque) in time.iter().zip(&torque) {
        let expected = if (0.0999..0.2999).contains(t) { 5.0 } else { 0.0 };
        assert_eq!(*torque, expected, "{t}");
    }
    assert!(last(&report, "chassis.roll").abs() > 1e-3);
    // drive stays as in the steady state
    assert!(column(&report, "drive.torque")[0] > 10.0);
    let csv = fastbike(&["run", "gsxr1000", "--speed", "25", "--duration", "1s", "--format", "csv", "--signals", &file]);
    fs::write(&again, csv.stdout).expect("a file");
    let repeated = json(&with(&STRAIGHT, &["--signals", &again.display().to_string()]), 0);
    // jumps became ramps of one sample
    assert!((last(&repeated, "chassis.roll") - last(&report, "chassis.roll")).abs() < 0.1 * last(&report, "chassis.roll").abs());
    for (text, expected) in [
        ("time,steer.torqe\n0,0\n", "`steer.torque`"),
        ("time,chassis.roll\n0,0\n", "no column is an input"),
        ("t,steer.torque\n0,0\n", "not `time`"),
        ("time,steer.torque\n1,0\n0,0\n", "must not decrease"),
        ("time,steer.torque\n0,a\n", "row 1, column `steer.torque`"),
        ("time,steer.torque [kg]\n0,0\n", "is in N m"),
    ] {
        fs::write(&pulse, text).expect("a file");
        let answer = fastbike(&with(&STRAIGHT, &["--signals", &file]));
        assert!(answer.status == 2 && answer.stderr.contains(expected), "{text}\n{}", answer.stderr);
    }
}

/// Hard braking lifts the rear wheel; it is told when, and the motion goes on.
#[test]
fn events_are_told_with_their_times() {
    let stoppie =
        ["run", "gsxr1000", "--speed", "30", "--duration", "1s", "--given", "front_brake.torque=900", "--given", "drive.torque=0"];
    let report = json(&with(&stoppie, &["--format", "json"]), 0);
    let events = report["events"].as_array().expect("events");
    let lifted = events.iter().find(|e| e["name"] == "wheel_lifted" && e["signal"] == "rear_tire.normal_force").expect("a lifted wheel");
    assert!(lifted["violated"] == true && number(&lifted["time"]) > 0.0, "{events:?}");
    let table = fastbike(&stoppie);
    assert!(table.stdout.contains("events: wheel_lifted of `rear_tire.normal_force` from 0."), "{}", table.stdout);
}

/// What the motor does is energy gained.
#[test]
fn powers_account_for_the_energy() {
    let report = json(&with(&SQUEEZER, &["--format", "json", "--rate", "100kHz", "--backend", "erk", "--rtol", "1e-10"]), 0);
    let (power, energy) = (column(&report, "system.power_in"), column(&report, "system.energy"));
    let heat = column(&report, "system.power_dissipated");
    let work: f64 = power.windows(2).zip(heat.windows(2)).map(|(p, h)| 0.5 * (p[0] + p[1] - h[0] - h[1]) * 1e-5).sum();
    let gained = energy.last().expect("samples") - energy[0];
    // trapezoids of 10 µs
    assert!((work - gained).abs() < 1e-4 * gained.abs(), "{work} {gained}");
}

/// Maneuvers by name and by path are the same, and `--change` reaches their entries.
#[test]
fn maneuvers_are_ridden_by_name_and_by_path() {
    let record = ["--record", "rider.path_error", "--record", "chassis.y", "--format", "json"];
    let named = json(&with(&["run", "ref11", "lane_change"], &record), 0);
    assert_eq!(named["ending"].as_str(), Some("end_of_path"));
    // 3.6 m to the left
    assert!((last(&named, "chassis.y") - 3.6).abs() < 0.1, "{}", last(&named, "chassis.y"));
    let file = folder("run_maneuver").join("mine.yaml");
    fs::copy(evidence("../models/maneuvers/lane_change.yaml"), &file).expect("a copy");
    let path = file.display().to_string();
    let of_file = json(&with(&["run", "ref11", &path], &record), 0);
    assert_eq!(column(&of_file, "chassis.y"), column(&named, "chassis.y"));
    let other =
        json(&with(&["run", "ref11", "lane_change", "--change", "path.1.lane_change.width=-2m", "--change", "speed=15"], &record), 0);
    assert!((last(&other, "chassis.y") + 2.0).abs() < 0.1, "{}", last(&other, "chassis.y"));
    // states of the rider are recorded with the rest
    let all = json(&["run", "ref11", "steering_impulse", "--duration", "0.5s", "--format", "json"], 0);
    assert!((last(&all, "rider.station") - 15.0).abs() < 0.1);
    assert!(column(&all, "steer.torque").iter().all(|t| t.abs() < 1e-3), "nothing happens before the impulse");
}

#[test]
fn wrong_maneuvers_are_told_with_what_is_meant() {
    for (arguments, expected) in [
        (&["run", "ref11", "lane_chnge"][..], "`lane_change`"),
        (&["run", "ref11", "nowhere.yaml"], "nowhere.yaml"),
        (&["run", "ref11", "lane_change", "--change", "speed"], "PATH=VALUE"),
        (&["run", "ref11", "lane_change", "--change", "sped=20"], "`speed`"),
        (&["run", "ref11", "lane_change", "--change", "path.1.lane_change.width=3 kg"], "expected a length"),
        (&["run", "ref11", "lane_change", "--speed", "20"], "--change speed=20"),
        (&["run", "pendulum", "lane_change"], "error"),
        (&["run", "ref11", "--figure", "path"], "MANEUVER"),
    ] {
        let answer = fastbike(arguments);
        assert_eq!((answer.status, answer.stdout.as_str()), (2, ""), "{arguments:?}: {}", answer.stderr);
        assert!(answer.stderr.contains(expected), "{arguments:?}: {}", answer.stderr);
    }
}

#[test]
fn rides_have_figures() {
    let folder = folder("run_figures");
    for (picture, word) in [("histories", "path error"), ("path", "asked for"), ("gg", "acceleration to the left")] {
        let path = folder.join(format!("{picture}.svg"));
        let answer = fastbike(&["run", "ref11", "lane_change", "--figure", picture, "--plot", &path.display().to_string()]);
        assert_eq!(answer.status, 0, "{}", answer.stderr);
        assert!(fs::read_to_string(&path).expect("the figure").contains(word), "{picture}");
    }
}

/// Ten minutes at 1 kHz with all signals and all files take no more memory than a fraction of the recording, which is a gigabyte.
#[test]
#[ignore = "minutes, and four gigabytes on the disk; see CONTRIBUTING"]
fn a_long_recording_stays_out_of_memory() {
    let folder = folder("long");
    let maneuver = folder.join("ten_minutes.yaml");
    std::fs::write(
        &maneuver,
        "maneuver: 1\nname: Ten minutes\nspeed: 30\npath:\n  - straight: { length: 18 km }\nroad: { iso_8608: { class: B, seed: 1 } }\n",
    )
    .expect("a file");
    let (maneuver, out) = (maneuver.display().to_string(), folder.join("out").display().to_string());
    let answer = fastbike(&["run", "gsxr1000", &maneuver, "--duration", "600s", "--rate", "1kHz", "--out", &out]);
    assert_eq!(answer.status, 0, "{}{}", answer.stdout, answer.stderr);
    let lines = std::io::BufReader::new(std::fs::File::open(folder.join("out/results.csv")).expect("the table"));
    assert_eq!(std::io::BufRead::lines(lines).count(), 600_002);
    // Linux tells the most memory that this process has had
    let status = std::fs::read_to_string("/proc/self/status").unwrap_or_default();
    if let Some(most) = status.lines().find_map(|l| l.strip_prefix("VmHWM:")?.trim().strip_suffix(" kB")?.parse::<f64>().ok()) {
        println!("at most {:.0} MB in memory", most / 1000.0);
        assert!(most < 400e3, "{most} kB");
    }
    std::fs::remove_dir_all(folder).expect("a folder of our own");
}
