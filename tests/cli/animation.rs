//! `--animate`: pages that need nothing but themselves, and what they show.

use super::{fastbike, folder, json, number};
use serde_json::Value;
use std::fs;
use std::path::Path;
use std::process::Command;

/// Reads the data out of a page.
fn data(page: &str) -> Value {
    let (_, rest) = page.split_once("<script id=\"data\" type=\"application/json\">").expect("the data have an element");
    let (text, _) = rest.split_once("</script>").expect("the element ends");
    serde_json::from_str(text).expect("the data are JSON")
}

/// Numbers of 32 bits, little-endian, in base64.
fn numbers(value: &Value) -> Vec<f64> {
    const ALPHABET: &[u8] = b"ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    let text = value.as_str().expect("text").trim_end_matches('=');
    let digits = text.bytes().map(|c| ALPHABET.iter().position(|a| *a == c).expect("base64") as u32);
    let (mut bytes, mut bits, mut held) = (Vec::new(), 0_u32, 0);
    for digit in digits {
        (bits, held) = (bits << 6 | digit, held + 6);
        if held >= 8 {
            held -= 8;
            bytes.push((bits >> held) as u8);
        }
    }
    bytes.chunks_exact(4).map(|b| f64::from(f32::from_le_bytes([b[0], b[1], b[2], b[3]]))).collect()
}

/// Runs a command with `--animate` and returns the page and what was said about it.
fn page(name: &str, arguments: &[&str]) -> (String, String) {
    let path = folder(name).join("animation.html");
    let animate = ["--animate", path.to_str().expect("a path as text")];
    let answer = fastbike(&[arguments, &animate].concat());
    assert_eq!(answer.status, 0, "{arguments:?}\n{}", answer.stderr);
    (fs::read_to_string(&path).expect("the page was written"), answer.stderr)
}

fn is_self_contained(page: &str) {
    for way in ["http://", "https://", "src=", "href=", "@import", "url(", "fetch(", "XMLHttpRequest", "import("] {
        assert!(!page.contains(way), "the page reaches outside by `{way}`");
    }
    assert!(page.contains("default-src 'none'"), "the browser is not told to load nothing");
}

const TURN: [&str; 8] = ["run", "whipple", "--given", "chassis.roll_rate=0.3", "--duration", "2s", "--rate", "50Hz"];

/// The same run as JSON says where base, wheels and contacts are; the page must show them there.
#[test]
fn a_run_is_shown_where_it_was_computed() {
    let (page, said) = page("animation_run", &[&TURN[..], &["--record", "chassis.roll", "--record", "steer.angle"]].concat());
    assert!(said.contains("animation: `") && said.contains(" kB, opens in a browser"), "{said}");
    is_self_contained(&page);
    let data = data(&page);
    assert_eq!((data["kind"].as_str(), data["count"].as_u64()), (Some("run"), Some(101)));
    let report = json(&[&TURN[..], &["--format", "json"]].concat(), 0);
    let signal = |name: &str| report["signals"][name].as_array().expect("a signal").iter().map(number).collect::<Vec<_>>();
    let bodies: Vec<&str> = data["scene"]["bodies"].as_array().expect("bodies").iter().filter_map(|b| b["name"].as_str()).collect();
    let place = |name: &str| bodies.iter().position(|b| *b == name).expect("a body") - 1;
    let poses = numbers(&data["poses"]);
    let pose = |k: usize, body: usize| &poses[7 * (k * (bodies.len() - 1) + body)..][..7];
    let (time, plots) = (numbers(&data["time"]), data["plots"].as_array().expect("plots"));
    let names: Vec<_> = plots.iter().filter_map(|p| p["name"].as_str()).collect();
    assert_eq!((time.len(), names.as_slice()), (101, ["chassis.roll", "steer.angle"].as_slice()));
    let roll = numbers(&plots[0]["values"]);
    let (x, y, yaw, lean, pitch) =
        (signal("chassis.x"), signal("chassis.y"), signal("chassis.yaw"), signal("chassis.roll"), signal("chassis.pitch"));
    let contact = numbers(&data["contacts"]);
    let force = |direction: &str| signal(&format!("rear_contact.{direction}_force"));
    let (load, drive, side) = (force("normal"), force("longitudinal"), force("lateral"));
    for k in 0..time.len() {
        // 32 bits: 7 digits of 10 m
        assert!((time[k] - number(&report["time"][k])).abs() < 1e-6 && (roll[k] - lean[k].to_degrees()).abs() < 1e-5);
        let base = pose(k, place("chassis"));
        assert!((base[0] - x[k]).abs() < 1e-5 && (base[1] - y[k]).abs() < 1e-5, "at sample {k}");
        // the rear wheel stands 0.3 m along its own plane above the contact, which is the base point but for pitch
        let (s, c) = yaw[k].sin_cos();
        let wheel = pose(k, place("rear_wheel_rim"));
        let forward = 0.3 * pitch[k].sin();
        let left = -0.3 * pitch[k].cos() * lean[k].sin();
        let expected = [x[k] + c * forward - s * left, y[k] + s * forward + c * left];
        assert!((wheel[0] - expected[0]).abs() < 1e-5 && (wheel[1] - expected[1]).abs() < 1e-5, "at sample {k}");
        let rear = &contact[18 * k..18 * k + 9];
        assert!(rear[2].abs() < 1e-6, "the contact is on the ground");
        assert!((rear[5] - load[k]).abs() < 1e-6 * load[k], "at sample {k}");
        let friction = [rear[6] * c + rear[7] * s, rear[7] * c - rear[6] * s];
        // the contact heads as the leaning and pitched wheel does, which here is the heading
        assert!((friction[0] - drive[k]).abs() < 1e-2 && (friction[1] - side[k]).abs() < 1e-2, "at sample {k}");
    }
    let spun: f64 = 2.0 * 5.0 / 0.3;
    let first = signal("rear_wheel.angle");
    assert!((first[100] - first[0] - spun).abs() < 0.02 * spun, "the wheel has rolled the way");
}

/// At 5 m/s the weave of the benchmark bicycle is published: −0.775 ± 4.465 j (Meijaard et al. 2007, table 2).
#[test]
fn modes_are_shown_with_their_shapes() {
    let (page, _) = page("animation_modes", &["modes", "whipple", "--speed", "5"]);
    is_self_contained(&page);
    let data = data(&page);
    assert_eq!(data["kind"].as_str(), Some("modes"));
    let modes = data["points"][0]["modes"].as_array().expect("modes");
    let weave = modes.iter().find(|m| m["name"] == "weave").expect("the weave");
    let (re, im) = (number(&weave["re"]), number(&weave["im"]));
    assert!((re + 0.775_341_882_195_85).abs() < 1e-6 && (im - 4.464_867_713_788_23).abs() < 1e-6, "{re} {im}");
    let bodies = data["scene"]["bodies"].as_array().expect("bodies");
    let twists = numbers(&weave["twists"]);
    assert_eq!(twists.len(), 12 * (bodies.len() - 1));
    let body = |name: &str| bodies.iter().position(|b| b["name"] == name).expect("a body") - 1;
    let of = |name: &str, k: usize| twists[12 * body(name) + k];
    let shapes = json(&["modes", "whipple", "--speed", "5", "--shapes", "--format", "json"], 0);
    let shaped = shapes["points"][0]["modes"].as_array().expect("modes").iter().find(|m| m["name"] == "weave").expect("the weave");
    let shape = |name: &str, part: &str| number(&shaped["shape"][name][part]);
    // roll turns the frame about x; steering turns the front frame relative to it about (−sin λ, 0, cos λ), λ = π/10
    let scale = of("chassis", 0) / shape("chassis.roll", "re");
    let close = |a: f64, b: f64| assert!((a - b).abs() < 1e-5, "{a} {b}");
    close(of("chassis", 6), scale * shape("chassis.roll", "im"));
    let tilt = std::f64::consts::PI / 10.0;
    for (part, first) in [("re", 0), ("im", 6)] {
        close(of("front_frame", first + 2) - of("chassis", first + 2), scale * tilt.cos() * shape("steer.angle", part));
        close(of("front_frame", first) - of("chassis", first), -scale * tilt.sin() * shape("steer.angle", part));
    }
    // heading and lateral displacement: s δψ = δr, s δy = δVy + V δψ
    let path = |k: usize| nalgebra::Complex::new(number(&weave["path"][k][0]), number(&weave["path"][k][1]));
    let deviation = |name: &str| nalgebra::Complex::new(shape(name, "re"), shape(name, "im")) * scale;
    let s = nalgebra::Complex::new(re, im);
    assert!((path(2) * s - deviation("chassis.yaw_rate")).norm() < 1e-6);
    assert!((path(1) * s - deviation("chassis.lateral_speed") - path(2) * 5.0).norm() < 1e-6);
    let without = json(&["modes", "whipple", "--speed", "5", "--format", "json"], 0);
    assert!(without["points"][0]["modes"][0].get("shape").is_none());
}

/// Joints of other kinds, a wheel alone, a spring.
#[test]
fn mechanisms_are_shown_too() {
    for (model, duration) in [("pendulum", "1s"), ("four_bar_diagonal_spring", "0.2s"), ("rolling_disc", "0.5s"), ("heavy_top", "0.2s")] {
        let (page, _) = page(&format!("animation_{model}"), &["run", model, "--duration", duration]);
        let data = data(&page);
        let bodies = data["scene"]["bodies"].as_array().expect("bodies");
        let shapes: usize = bodies.iter().filter_map(|b| b["shapes"].as_array()).map(Vec::len).sum();
        let contacts = data["scene"]["contacts"].as_array().expect("contacts").len();
        assert!(shapes + contacts > 1 && numbers(&data["poses"]).iter().all(|x| x.is_finite()), "{model}");
        let springs = data["scene"]["links"].as_array().expect("links").len();
        assert_eq!(springs, usize::from(model == "four_bar_diagonal_spring"), "{model}");
    }
}

/// A mechanism at rest has modes without anything cyclic; its only coordinate turns its only body.
#[test]
fn modes_of_a_mechanism_at_rest_are_shown() {
    let (page, _) = page("animation_pendulum_modes", &["modes", "pendulum"]);
    let data = data(&page);
    let mode = &data["points"][0]["modes"][0];
    let twists = numbers(&mode["twists"]);
    let turn = twists[..3].iter().map(|x| x * x).sum::<f64>().sqrt();
    assert!((turn - 1.0).abs() < 1e-6, "{twists:?}");
    assert_eq!((data["points"][0]["label"].as_str(), &mode["path"][1][0]), (Some("static pose"), &Value::from(0.0)));
}

#[test]
fn a_page_that_cannot_be_written_is_refused_before_the_run() {
    for (file, why) in
        [("no_such_folder/run.html", "the folder `no_such_folder` does not exist"), ("run.gif", "no animation of this format")]
    {
        for command in [&["run", "pendulum"][..], &["modes", "whipple", "--speed", "5"]] {
            let answer = fastbike(&[command, &["--animate", file]].concat());
            assert_eq!((answer.status, answer.stdout.as_str()), (2, ""), "{file}");
            assert!(answer.stderr.contains(why) && answer.stderr.contains("--animate"), "{}", answer.stderr);
        }
    }
}

/// Takes a picture of a page and returns what the page complained about.
fn picture(page: &Path, address: &str, to: &Path) -> String {
    let options =
        ["--headless", "--no-sandbox", "--use-angle=swiftshader", "--enable-unsafe-swiftshader", "--disable-background-networking"];
    let answer = Command::new("chromium")
        .args(options)
        .args(["--enable-logging=stderr", "--window-size=1360,800", "--virtual-time-budget=3000"])
        .arg(format!("--screenshot={}", to.display()))
        .arg(format!("file://{}#{address}", page.display()))
        .output()
        .expect("`chromium` is on the path");
    let said = String::from_utf8_lossy(&answer.stderr).into_owned();
    said.lines().filter(|l| l.contains("CONSOLE") && !l.contains("GPU stall due to ReadPixels")).collect::<Vec<_>>().join("\n")
}

/// Needs a browser: `cargo test -p validation --test cli animation -- --ignored` with `chromium` on the path.
#[test]
#[ignore = "needs chromium on the path"]
fn a_browser_shows_pages_without_a_complaint() {
    let cases = [
        ("animation_seen_run", &TURN[..], "time=1.2&theme=light"),
        ("animation_seen_modes", &["modes", "whipple", "--speed", "5"][..], "time=0.4&theme=dark&mode=weave"),
    ];
    for (name, arguments, address) in cases {
        page(name, arguments);
        let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join("cli").join(name);
        let (shown, seen) = (folder.join("animation.html"), folder.join("picture.png"));
        let complaints = picture(&shown, address, &seen);
        assert!(complaints.is_empty(), "{name}: {complaints}");
        // a blank page of this size compresses to less than 30 kB, one that lacks only the view to less than 45 kB
        let size = fs::metadata(&seen).expect("a picture").len();
        assert!(size > 60_000, "{name}: the picture of {size} bytes is nearly blank");
    }
}
