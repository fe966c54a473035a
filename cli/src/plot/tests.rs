//! Sample figures over the data shapes that occur; written to the target folder to be looked at.

use super::*;

fn grid(from: f64, to: f64, count: usize) -> Vec<f64> {
    (0..count).map(|k| from + (to - from) * k as f64 / (count - 1) as f64).collect()
}

fn map(title: &str, x: &[f64], y: &[f64], value: Axis, node: impl Fn(f64, f64) -> Node) -> Figure {
    let nodes = y.iter().flat_map(|&v| x.iter().map(|&a| node(a, v)).collect::<Vec<_>>()).collect();
    let x = (Axis::new("Lateral acceleration", "m/s^2"), x.to_vec());
    let y = (Axis::new("Speed", "m/s"), y.to_vec());
    Figure::Contour(Contour::new(title, x, y, value, nodes).expect("consistent grid"))
}

fn infeasible(name: &str) -> Node {
    Node::Infeasible(name.to_owned())
}

/// A steering torque of the right order with two limits.
fn torque(a: f64, v: f64) -> Node {
    if a * a / 100.0 + v * v / 6000.0 > 1.0 {
        infeasible("tire_saturated")
    } else if v > 62.0 - 1.5 * a.abs() {
        infeasible("engine_limit")
    } else {
        Node::Value(-3.0 * a + 0.09 * a * a * a.signum() * (v / 10.0) - 0.004 * a.powi(3))
    }
}

fn samples() -> Vec<(&'static str, Figure)> {
    let (a, v) = (grid(-10.0, 10.0, 41), grid(10.0, 60.0, 31));
    let right = grid(0.0, 10.0, 26);
    let nm = || Axis::new("Steering torque", "N m");
    vec![
        ("contour_signed", map("", &a, &v, nm(), torque)),
        (
            "contour_one_sided",
            map("Rear tire, ref11", &right, &v, Axis::new("Friction use", "-"), |a, v| match torque(a, v) {
                Node::Value(_) => Node::Value(0.02 + a / 11.0 + (v / 90.0).powi(4)),
                none => none,
            }),
        ),
        (
            "contour_large_range",
            map("", &right, &v, Axis::new("Stiffness", "N/m"), |a, v| Node::Value(1e4 * (a - 3.0) * (v - 20.0) * (v / 30.0))),
        ),
        (
            "contour_small_range",
            map("", &right, &v, Axis::new("Fork travel", "m"), |a, v| Node::Value(0.1 + 1e-5 * (a * 0.3 + (v / 20.0).sin()))),
        ),
        (
            "contour_outlier",
            map("", &right, &v, nm(), |a, v| Node::Value(a * 2.0 - v / 10.0 + if a > 9.7 && v > 55.0 { 900.0 } else { 0.0 })),
        ),
        ("contour_coarse", map("", &grid(0.0, 8.0, 5), &grid(10.0, 50.0, 4), nm(), |a, v| Node::Value(a * v / 20.0))),
        ("contour_constant", map("", &right, &v, nm(), |_, _| Node::Value(4.2))),
        ("contour_none", map("", &right, &v, nm(), |a, _| infeasible(if a < 5.0 { "wheel_lifted" } else { "not_converged" }))),
        (
            "contour_one_point",
            map("", &grid(0.0, 8.0, 5), &grid(10.0, 50.0, 5), nm(), |a, v| {
                if a == 4.0 && v == 30.0 { Node::Value(-7.25) } else { infeasible("suspension_stop") }
            }),
        ),
        ("contour_one_row", map("", &a, &[40.0], nm(), torque)),
        (
            "contour_many_limits",
            map("", &right, &v, nm(), |a, v| {
                if a > 7.0 && v > 40.0 {
                    infeasible("tire_saturated")
                } else if v > 50.0 {
                    infeasible("engine_limit")
                } else if a > 8.0 {
                    infeasible("suspension_stop")
                } else if v < 14.0 {
                    infeasible("wheel_lifted")
                } else {
                    Node::Value((a - 4.0).hypot((v - 30.0) / 5.0) - 2.0)
                }
            }),
        ),
        ("contour_known_limits", known_limits()),
        ("phasors", phasors(5)),
        ("phasors_crowded", phasors(14)),
        ("bars", bars()),
        ("lines_variants", variants()),
        ("lines_stacked", stacked()),
        ("lines_crowded", crowded()),
        ("lines_frequency", frequency()),
        (
            "lines_one_point",
            Figure::Lines(Lines {
                title: "One point".to_owned(),
                x: Axis::new("Speed", "m/s"),
                panels: vec![LinePanel { y: Axis::new("Lean angle", "deg"), curves: vec![Curve::new("lean", vec![(30.0, 42.0)])] }],
                bands: vec![],
                variants: vec![],
            }),
        ),
    ]
}

/// Rows that end between the nodes, on the ellipse of the tire.
fn known_limits() -> Figure {
    let (a, v) = (grid(-10.0, 10.0, 11), grid(10.0, 60.0, 9));
    let node = |a: f64, v: f64| if a * a / 100.0 + v * v / 6000.0 > 1.0 { infeasible("tire_saturated") } else { Node::Value(a * v) };
    let nodes = v.iter().flat_map(|&v| a.iter().map(|&a| node(a, v)).collect::<Vec<_>>()).collect();
    let end = |v: f64| 10.0 * (1.0 - v * v / 6000.0).sqrt();
    let limits = v.iter().enumerate().flat_map(|(row, &v)| [-1.0, 1.0].map(|side| (row, side * end(v), side * end(v) * v))).collect();
    let (x, y) = ((Axis::new("Lateral acceleration", "m/s^2"), a), (Axis::new("Speed", "m/s"), v.clone()));
    Figure::Contour(Contour::new("", x, y, Axis::new("Value", "N m"), nodes).expect("consistent grid").with_limits(limits))
}

/// Three modes of so many signals, many of them in the same direction.
fn phasors(count: usize) -> Figure {
    let arrow = |k: usize, mode: f64| {
        let (angle, size) = (0.3 * (k as f64) * mode, 1.0 / (1.0 + 0.4 * k as f64));
        Phasor { name: format!("signal number {k}"), value: (size * angle.cos(), size * angle.sin()) }
    };
    let panel = |mode: f64| PhasorPanel {
        title: format!("mode {mode}, 2.89 Hz, damping ratio 0.194"),
        arrows: (0..count).map(|k| arrow(k, mode)).collect(),
    };
    Figure::Phasors(Phasors { title: "Shapes of the modes of ref11, speed 30 m/s".to_owned(), panels: [0.1, 1.0, 7.0].map(panel).to_vec() })
}

fn bars() -> Figure {
    let row = |k: usize| (format!("element.part.parameter_{k}"), vec![(k as f64).sin() / (1.0 + k as f64), 0.3 * (2.0 * k as f64).cos()]);
    let panel = |title: &str| BarPanel { title: title.to_owned(), rows: (0..10).map(row).collect() };
    Figure::Bars(Bars {
        title: "Sensitivity of the modes of ref11, speed 30 m/s".to_owned(),
        x: Axis::new("Change of the eigenvalue per 1 % of the parameter", "1/s"),
        series: ["real part (1/s)", "imaginary part (rad/s)"].map(str::to_owned).to_vec(),
        panels: vec![panel("wobble, 7.95 Hz, damping ratio 0.083"), panel("weave, 2.89 Hz, damping ratio 0.194")],
    })
}

fn variants() -> Figure {
    let speeds = grid(10.0, 60.0, 26);
    let curve = |name: &str, variant: usize| {
        let points = speeds.iter().map(|&v| (v, v * (1.0 + 0.2 * variant as f64) / if name == "weave" { 10.0 } else { 7.0 })).collect();
        Curve { name: name.to_owned(), points, markers: Markers::Never, variant }
    };
    let curves = [("weave", 0), ("wobble", 0), ("weave", 1), ("wobble", 1)].map(|(name, variant)| curve(name, variant)).to_vec();
    Figure::Lines(Lines {
        title: "Modes of ref11".to_owned(),
        x: Axis::new("Speed", "m/s"),
        panels: vec![LinePanel { y: Axis::new("Damped frequency", "Hz"), curves }],
        bands: vec![],
        variants: vec!["ref11".to_owned(), "steering_damper.coefficient=3".to_owned()],
    })
}

fn stacked() -> Figure {
    let speeds = grid(10.0, 60.0, 26);
    let curve = |name: &str, f: &dyn Fn(f64) -> f64| Curve::new(name, speeds.iter().map(|&v| (v, f(v))).collect());
    Figure::Lines(Lines {
        title: "Straight running, ref11".to_owned(),
        x: Axis::new("Speed", "m/s"),
        panels: vec![
            LinePanel {
                y: Axis::new("Normal force", "N"),
                curves: vec![curve("front", &|v| 1300.0 - 0.12 * v * v), curve("rear", &|v| 1500.0 + 0.12 * v * v)],
            },
            LinePanel { y: Axis::new("Pitch", "deg"), curves: vec![curve("pitch", &|v| 0.3 - (v / 40.0).powi(2))] },
        ],
        bands: vec![Band { name: "engine_limit".to_owned(), range: (56.0, 60.0) }],
        variants: vec![],
    })
}

fn crowded() -> Figure {
    let a = grid(0.0, 10.0, 60);
    let curve = |k: i32| {
        let gap = |x: f64| if k == 2 && (4.0..5.0).contains(&x) { f64::NAN } else { x };
        Curve::new(
            format!("{} m/s", 10 + 10 * k),
            a.iter().map(|&x| (x, gap(x) * f64::from(k - 2) + 3.0 * (x + f64::from(k)).sin() * x)).collect(),
        )
    };
    Figure::Lines(Lines {
        title: String::new(),
        x: Axis::new("Lateral acceleration", "m/s^2"),
        panels: vec![LinePanel { y: Axis::new("Steering torque", "N m"), curves: (0..6).map(curve).collect() }],
        bands: vec![],
        variants: vec![],
    })
}

fn frequency() -> Figure {
    let f: Vec<f64> = (0..200).map(|k| 0.1 * 300f64.powf(f64::from(k) / 199.0)).collect();
    let gain = |f: f64| 1.0 / ((1.0 - (f / 3.0).powi(2)).powi(2) + (0.1 * f).powi(2)).sqrt();
    let phase = |f: f64| -(0.1 * f).atan2(1.0 - (f / 3.0).powi(2)).to_degrees();
    let panel = |y: Axis, g: &dyn Fn(f64) -> f64| LinePanel { y, curves: vec![Curve::new("", f.iter().map(|&f| (f, g(f))).collect())] };
    Figure::Lines(Lines {
        title: String::new(),
        x: Axis::new("Frequency", "Hz").logarithmic(),
        panels: vec![
            panel(Axis::new("Roll per torque", "rad/(N m)").logarithmic(), &gain),
            panel(Axis::new("Phase", "deg").between(-180.0, 0.0), &phase),
        ],
        bands: vec![],
        variants: vec![],
    })
}

#[test]
fn every_sample_is_a_readable_image() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../target/figures");
    std::fs::create_dir_all(&folder).expect("target folder is writable");
    for (name, figure) in samples() {
        let svg = figure.svg();
        assert!(!svg.contains("NaN") && !svg.contains("inf\""), "{name} holds a place that is no number");
        let png = figure.png(2.0).expect(name);
        assert!(png.starts_with(b"\x89PNG"), "{name}");
        std::fs::write(folder.join(name).with_extension("svg"), svg).expect("target folder is writable");
        std::fs::write(folder.join(name).with_extension("png"), png).expect("target folder is writable");
    }
}

#[test]
fn drawing_is_reproducible() {
    for ((name, first), (_, second)) in samples().into_iter().zip(samples()) {
        assert_eq!(first.svg(), second.svg(), "{name}");
    }
}

#[test]
fn legend_names_every_limit_and_labels_carry_units() {
    let (_, figure) = samples().swap_remove(0);
    let svg = figure.svg();
    for text in ["tire saturated", "engine limit", "Steering torque (N m)", "Speed (m/s)", "Lateral acceleration (m/s²)", "\u{2212}10"] {
        assert!(svg.contains(&format!(">{text}<")), "{text}");
    }
}

#[test]
fn extension_chooses_the_format() {
    assert_eq!(FileFormat::of(Path::new("a/map.SVG")), Ok(FileFormat::Svg));
    assert_eq!(FileFormat::of(Path::new("map.png")), Ok(FileFormat::Png));
    let refused = FileFormat::of(Path::new("map.pdf")).map_err(|e| e.to_string());
    assert_eq!(refused, Err("`map.pdf`: a figure is written as `.svg` or `.png`".to_owned()));
}

#[test]
fn inconsistent_grids_are_refused() {
    let axis = |name: &str| Axis::new(name, "m");
    let make = |x: Vec<f64>, n: usize| Contour::new("", (axis("x"), x), (axis("y"), vec![0.0, 1.0]), axis("z"), vec![Node::Value(0.0); n]);
    assert_eq!(make(vec![0.0, 1.0], 3), Err(PlotError::Shape { columns: 2, rows: 2, given: 3 }));
    assert_eq!(make(vec![0.0, 0.0], 4), Err(PlotError::Order { axis: "x".to_owned() }));
    assert!(make(vec![1.0, 0.0], 4).is_ok());
}

#[test]
fn absurd_scale_is_refused() {
    let (_, figure) = samples().pop().expect("a sample");
    assert!(matches!(figure.png(1e9), Err(PlotError::Raster { .. })));
    assert!(matches!(figure.png(0.0), Err(PlotError::Raster { .. })));
}

/// A text on the canvas as a rectangle about `center`, turned by `turn` radians.
struct Lettered {
    text: String,
    center: (f64, f64),
    half: (f64, f64),
    turn: f64,
}

impl Lettered {
    /// Reads the line of an SVG that sets a text.
    fn read(line: &str) -> Option<Self> {
        let attribute = |name: &str| Some(line.split_once(&format!(" {name}=\""))?.1.split('"').next()?.to_owned());
        let number = |name: &str| attribute(name)?.parse::<f64>().ok();
        let text = line.strip_prefix("<text")?.split_once('>')?.1.split('<').next()?.to_owned();
        let (at, size) = ((number("x")?, number("y")?), number("font-size")?);
        let width = text::width(&text, size);
        let ahead = match attribute("text-anchor").as_deref() {
            Some("middle") => 0.0,
            Some("end") => -width / 2.0,
            _ => width / 2.0,
        };
        let turn = attribute("transform")
            .and_then(|t| t.strip_prefix("rotate(")?.split(' ').next()?.parse::<f64>().ok())
            .unwrap_or(0.0)
            .to_radians();
        let rise = canvas::CAP_HEIGHT / 2.0 * size;
        let center = (at.0 + ahead * turn.cos() + rise * turn.sin(), at.1 + ahead * turn.sin() - rise * turn.cos());
        Some(Self { text, center, half: (width / 2.0, rise), turn })
    }

    fn corners(&self) -> [(f64, f64); 4] {
        let (sin, cos) = self.turn.sin_cos();
        [(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)].map(|(a, b)| {
            let (x, y) = (a * self.half.0, b * self.half.1);
            (self.center.0 + x * cos - y * sin, self.center.1 + x * sin + y * cos)
        })
    }

    /// Whether no side of either rectangle separates the two.
    fn overlaps(&self, other: &Self) -> bool {
        let range = |corners: [(f64, f64); 4], (x, y): (f64, f64)| {
            corners.iter().map(|c| c.0 * x + c.1 * y).fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), d| (l.min(d), h.max(d)))
        };
        [self.turn, other.turn].into_iter().flat_map(|t| [(t.cos(), t.sin()), (-t.sin(), t.cos())]).all(|axis| {
            let (a, b) = (range(self.corners(), axis), range(other.corners(), axis));
            a.0 < b.1 && b.0 < a.1
        })
    }
}

#[test]
fn no_text_overlaps_another_or_leaves_the_canvas() {
    for (name, figure) in samples() {
        let svg = figure.svg();
        let size =
            |side: &str| svg.split_once(&format!(" {side}=\"")).and_then(|s| s.1.split('"').next()?.parse::<f64>().ok()).expect("a size");
        let (width, height) = (size("width"), size("height"));
        let texts: Vec<Lettered> = svg.lines().filter_map(Lettered::read).collect();
        assert!(texts.len() > 5, "{name} has labels");
        assert!(texts[0].overlaps(&texts[0]), "the test can fail");
        for (k, text) in texts.iter().enumerate() {
            let inside = |c: &(f64, f64)| (0.0..=width).contains(&c.0) && (0.0..=height).contains(&c.1);
            assert!(text.corners().iter().all(inside), "{name}: `{}` leaves the canvas", text.text);
            for other in &texts[..k] {
                assert!(!text.overlaps(other), "{name}: `{}` and `{}` overlap", text.text, other.text);
            }
        }
    }
}
