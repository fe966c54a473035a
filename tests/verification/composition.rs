//! Descriptions of several texts, formulas, setups: what is composed is the same machine as what is written out.

use analyses::Sensitivity;
use fastbike::family::Vehicles;
use fastbike::library::Source;
use fastbike::{standard_kinds, steady};
use mbody::assembly::{Assembled, Blueprint, assemble};
use mbody::description::Library;
use mbody::description::finding::Findings;
use mbody::dynamics::TreePlant;
use problem::{At, Dae};
use std::borrow::Cow;
use std::collections::BTreeMap;
use validation::agreement::{Agreement, absolute};
use validation::evidence::Row;
use validation::vehicle::{State, Vehicle, leaning, running};

/// Rows of the table.
pub const EVIDENCE: &[Row] = validation::evidence![
    a_tree_of_parts_is_the_tree => (
        "`ref11` and `gsxr1000` with their URDF cut into two files at every joint, and with all elements in an included file",
        "the same models in one file",
        "every residual in general motion, bit for bit: the same numbers in the same order"
    ),
    formulas_are_the_numbers_they_give => (
        "`gsxr1000` with spring rate, preload, sprockets, yoke offset and steering damping changed by name",
        "the same model with each entry that follows overridden by a number that was worked out by hand",
        "1e-9 of each signal of a steady turn: both stop at a scaled residual of 1e-10"
    ),
    sensitivities_follow_formulas => (
        "`gsxr1000`: slopes of all eigenvalues and signals by a parameter",
        "chain rule over the entries that follow from it",
        "relative 1e-6: extrapolated differences on both sides"
    ),
];

/// Texts of a test, over a bundled model and what it may read.
struct Texts {
    source: Source,
    own: BTreeMap<&'static str, String>,
}

impl Texts {
    fn over(model: &str, own: &[(&'static str, &str)]) -> Self {
        let source = Source::find(model).expect("a bundled model");
        Self { source, own: own.iter().map(|(name, text)| (*name, (*text).to_owned())).collect() }
    }

    fn assembled(&self, file: &str) -> Assembled {
        let (assembled, findings) = self.read(file);
        assembled.unwrap_or_else(|| panic!("{findings}"))
    }

    fn read(&self, file: &str) -> (Option<Assembled>, Findings) {
        assemble(file, self, &standard_kinds(), &[])
    }
}

impl Library for Texts {
    fn text(&self, name: &str) -> Option<Cow<'_, str>> {
        self.own.get(name).map(|text| Cow::Borrowed(text.as_str())).or_else(|| self.source.text(name))
    }

    fn resolve(&self, name: &str, within: &str) -> String {
        match self.own.contains_key(name) {
            true => name.to_owned(),
            false => self.source.resolve(name, within),
        }
    }
}

/// Residual in general motion.
fn residual(assembled: &Assembled) -> Vec<f64> {
    let mut plant = TreePlant::new(assembled.system.clone());
    let count = plant.unknowns().len();
    let at = |k: usize| 0.01 * ((7 * k + 3) % 11) as f64;
    let y: Vec<f64> = plant.unknowns().iter().enumerate().map(|(k, u)| u.design + at(k) * u.nominal.min(1.0)).collect();
    let (yd, u): (Vec<f64>, Vec<f64>) = ((0..count).map(|k| 3.0 * at(k + 5)).collect(), plant.inputs().iter().map(|i| i.default).collect());
    let mut r = vec![0.0; plant.equations().len()];
    plant.residual(At { time: 0.0, y: &y, yd: &yd, u: &u }, &mut r).expect("a state");
    r
}

#[test]
fn a_tree_of_parts_is_the_tree() {
    for name in ["ref11", "gsxr1000"] {
        let source = Source::find(name).expect("a bundled model");
        let whole = residual(&Texts::over(name, &[]).assembled(&source.file));
        let yaml = source.text(&source.file).expect("a description").into_owned();
        let (main, part) = (format!("urdf: {name}.urdf\n"), "urdf: { first: first.urdf, second: second.urdf }\n");
        let urdf = source.text(&format!("{name}.urdf")).expect("a tree").into_owned();
        let cuts: Vec<usize> = urdf.match_indices("\n  <joint").map(|(k, _)| k + 1).collect();
        assert!(yaml.contains(&main) && cuts.len() >= 5, "{name}");
        for cut in cuts {
            let first = format!("{}</robot>\n", &urdf[..cut]);
            let second = format!("<robot name=\"part\">\n{}", &urdf[cut..]);
            let texts = [("model.yaml", yaml.replace(&main, part)), ("first.urdf", first), ("second.urdf", second)];
            let texts = texts.each_ref().map(|(name, text)| (*name, text.as_str()));
            assert_eq!(residual(&Texts::over(name, &texts).assembled("model.yaml")), whole, "{name}, cut at {cut}");
        }
        // the elements in a part, the rest over it
        let (head, elements) = yaml.split_at(yaml.find("\nelements:").expect("elements") + 1);
        let texts = [("model.yaml", format!("{head}include: elements.yaml\n")), ("elements.yaml", elements.to_owned())];
        let texts = texts.each_ref().map(|(name, text)| (*name, text.as_str()));
        assert_eq!(residual(&Texts::over(name, &texts).assembled("model.yaml")), whole, "{name}, elements included");
    }
}

/// A frame and two front ends, each a description with its tree; the vehicle names one of them.
const FRAME: &str = "part: frame and rear wheel\nfastbike: 1\nname: modular\nurdf: { frame: frame.urdf }\nbase: vehicle_base\n";
const BODY: &str = "<inertial><mass value=\"3\"/><inertia ixx=\"0.1\" iyy=\"0.2\" izz=\"0.2\" ixy=\"0\" ixz=\"0\" iyz=\"0\"/></inertial>";
const SLIDING: &str = "part: telescopic\nurdf: { front: sliding.urdf }\nelements:\n  \
    strut: { telescopic_fork: { joint: fork, spring: { stiffness: 20 kN/m }, damper: { coefficient: 1 kN s/m } } }\n";
const SWINGING: &str = "part: leading link\nurdf: { front: swinging.urdf }\nelements:\n  \
    strut: { joint_torsion_spring: { joint: link, spring: { stiffness: 5 kN m/rad } } }\n";

fn tree(name: &str, joint: &str, kind: &str, (parent, child): (&str, &str)) -> String {
    let limit = "<limit lower=\"-1\" upper=\"1\" effort=\"1\" velocity=\"1\"/>";
    format!(
        "<robot name=\"{name}\"><link name=\"{child}\">{BODY}</link><joint name=\"{joint}\" type=\"{kind}\"><parent link=\"{parent}\"/>\
         <child link=\"{child}\"/><origin xyz=\"1 0 0.5\"/><axis xyz=\"0 0 1\"/>{limit}</joint></robot>"
    )
}

#[test]
fn a_front_end_is_replaced_by_one_line() {
    let frame = format!("<robot name=\"frame\"><link name=\"chassis\">{BODY}</link></robot>");
    let (sliding, swinging) = (tree("a", "fork", "prismatic", ("chassis", "lower")), tree("b", "link", "revolute", ("chassis", "arm")));
    let model = |front: &str| format!("include: [frame.yaml, {front}]\n");
    let (first, second) = (model("sliding.yaml"), model("swinging.yaml"));
    // a part over another one: the tree of the same part and the element of the same name give way
    let over = "include: first.yaml\nurdf: { front: swinging.urdf }\nelements:\n  \
                strut: { joint_torsion_spring: { joint: link, spring: { stiffness: 5 kN m/rad } } }\n";
    let texts = Texts::over(
        "ref11",
        &[
            ("frame.yaml", FRAME),
            ("frame.urdf", &frame),
            ("sliding.yaml", SLIDING),
            ("sliding.urdf", &sliding),
            ("swinging.yaml", SWINGING),
            ("swinging.urdf", &swinging),
            ("first.yaml", &first),
            ("second.yaml", &second),
            ("over.yaml", over),
        ],
    );
    let told = |file: &str| {
        let assembled = texts.assembled(file);
        let joints: Vec<String> = assembled.robot.joints.iter().map(|j| j.name.clone()).collect();
        (joints.join(" "), assembled.kinds)
    };
    let strut = |kind: &str| vec![("strut".to_owned(), kind.to_owned())];
    assert_eq!(told("first.yaml"), ("fork".to_owned(), strut("telescopic_fork")));
    assert_eq!(told("second.yaml"), ("link".to_owned(), strut("joint_torsion_spring")));
    assert_eq!(told("over.yaml"), told("second.yaml"));
}

/// A flexibility or a freedom of the rider, by one entry of a description that includes the model, or from outside.
#[test]
fn a_freedom_is_switched_by_one_entry() {
    let rigid = Vehicle::bundled("gsxr1000").system.degrees_of_freedom();
    for joint in ["rider_lean", "frame_torsion", "fork_bending", "fork_torsion", "swingarm_torsion"] {
        let text = format!("include: gsxr1000\njoints: {{ {joint}: {{ locked: false }} }}\n");
        let texts = Texts::over("gsxr1000", &[("model.yaml", &text)]);
        let assembled = texts.assembled("model.yaml");
        assert_eq!(assembled.system.degrees_of_freedom(), rigid + 1, "{joint}");
        let outside = Vehicle::with("gsxr1000", &[(&format!("joint.{joint}.locked"), "false")]);
        assert_eq!(outside.system.degrees_of_freedom(), rigid + 1, "{joint}");
        // what else is said of the joint stays
        assert_eq!(assembled.robot.joint("fork_bending").map(|j| j.origin.p.x), Some(0.026550260891477218), "{joint}");
    }
    let text = "include: gsxr1000\njoints: { rider_lean: null }\nlinks: { rider_upper: { mass: 50 kg, com: { z: 0.3 m } } }\n";
    let assembled = Texts::over("gsxr1000", &[("model.yaml", text)]).assembled("model.yaml");
    assert_eq!(assembled.system.degrees_of_freedom(), rigid + 1);
    let rider = assembled.robot.link("rider_upper").and_then(|l| l.mass).expect("a rider");
    assert_eq!((rider.mass, rider.center.z, rider.center.x), (50.0, 0.3, 0.051));
}

fn compare(agreement: &mut Agreement, what: &str, a: &State, b: &State) {
    let close = absolute(1e-9).or_relative(1e-9).because("both stop at a scaled residual of 1e-10");
    for (k, signal) in a.signals.iter().enumerate() {
        agreement.near(&format!("{what}: {}", signal.name), a.point.values[k], b.point.values[k], &close);
    }
}

#[test]
fn formulas_are_the_numbers_they_give() {
    let mut agreement = Agreement::on("formulas and numbers");
    // pitch circles p/(2 sin(π/z)) from those of the model with 17 and 42 teeth
    let radius = |known: f64, of: f64, teeth: f64| {
        let sine = |z: f64| (std::f64::consts::PI / z).sin();
        format!("{:?} m", known * sine(of) / sine(teeth))
    };
    let (front, rear, ratio) =
        (radius(0.0432, 17.0, 16.0), radius(0.10622, 42.0, 44.0), format!("{:?}", 2.471 * 44.0 / 42.0 * 17.0 / 16.0));
    type Changes<'a> = &'a [(&'a str, &'a str)];
    let by_hand: [(&str, Changes<'_>, Changes<'_>); 5] = [
        ("spring", &[("front_spring_rate", "28 kN/m")], &[("fork_strut.spring.stiffness", "28000")]),
        (
            "preload",
            &[("front_spring_rate", "28 N/mm"), ("front_preload", "3 mm")],
            &[("fork_strut.spring.stiffness", "28 kN/m"), ("fork_strut.spring.preload", "966.1265 N")],
        ),
        (
            "sprockets",
            &[("front_sprocket", "16"), ("rear_sprocket", "44")],
            &[("chain.front_sprocket.radius", &front), ("chain.rear_sprocket.radius", &rear), ("engine.gears.final", &ratio)],
        ),
        ("yokes", &[("fork_offset", "30 mm")], &[("joint.fork_bending.origin.x", "0.03")]),
        ("damper", &[("steering_damping", "9")], &[("steering_damper.coefficient", "9")]),
    ];
    for (what, by_name, by_number) in by_hand {
        let state = |changes| Vehicle::with("gsxr1000", changes).state(&leaning(&[25.0], &[0.5]));
        compare(&mut agreement, what, &state(by_name), &state(by_number));
    }
    agreement.assert();
}

#[test]
fn a_setup_is_the_values_in_it() {
    let mut agreement = Agreement::on("setup and values");
    let values = [
        ("front_preload", "4 mm"),
        ("rear_preload", "6 mm"),
        ("front_damping", "3"),
        ("rear_damping", "2"),
        ("steering_damping", "9"),
        ("fork_height", "0.005"),
        ("front_sprocket", "16"),
    ];
    let request = leaning(&[25.0], &[0.5]);
    let (setup, set) = (Vehicle::bundled("gsxr1000_track").state(&request), Vehicle::with("gsxr1000", &values).state(&request));
    compare(&mut agreement, "gsxr1000_track", &setup, &set);
    agreement.assert();
}

#[test]
fn sensitivities_follow_formulas() {
    let mut agreement = Agreement::on("sensitivities by parameters");
    let (source, kinds) = (Source::find("gsxr1000").expect("a bundled model"), standard_kinds());
    let blueprint = Blueprint::read(&source.file, &source, &kinds, &[]).0.expect("a description");
    let family = Vehicles::of(&blueprint, &source, &kinds, false);
    let (vehicle, request) = (Vehicle::bundled("gsxr1000"), running(&[30.0]));
    let state = vehicle.state(&request);
    let trim = steady::trim_at(&request, &vehicle.system, &state.point).unwrap_or_else(|failure| panic!("{failure}"));
    let sensitivity = state.at(|at| Sensitivity::at(&family, &trim, at, &[])).unwrap_or_else(|error| panic!("{error}"));
    let by = |path: &str| sensitivity.by(family.find(path).unwrap_or_else(|| panic!("no parameter `{path}`"))).expect("a slope");
    // parameter, entry that follows, slope of the entry by the parameter: at zero preload, `F₀ + x k` has ∂/∂x = k and ∂/∂k = 0
    for (parameter, entry, factor) in [
        ("rear_spring_rate", "rear_shock.spring.stiffness", 1.0),
        ("front_preload", "fork_strut.spring.preload", 25_000.0),
        ("fork_offset", "joint.fork_bending.origin.x", 1.0),
        ("steering_damping", "steering_damper.coefficient", 1.0),
    ] {
        let (a, b) = (by(parameter), by(entry));
        for (k, (a, b)) in a.eigenvalues.iter().zip(&b.eigenvalues).enumerate() {
            let (Some(a), Some(b)) = (a, b) else { continue };
            let slope = b.value * factor;
            let size = slope.norm() + factor * b.error + a.error;
            let close = absolute(1e-6 * size + 3.0 * (a.error + factor * b.error)).because("extrapolated differences on both sides");
            agreement.near(&format!("{parameter}, eigenvalue {k}, real"), a.value.re, slope.re, &close);
            agreement.near(&format!("{parameter}, eigenvalue {k}, imaginary"), a.value.im, slope.im, &close);
        }
        agreement.holds("many eigenvalues", a.eigenvalues.len() > 15);
    }
    agreement.assert();
}
