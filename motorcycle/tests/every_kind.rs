//! Every kind of element: its example assembles without a finding, and what cannot be meant is refused at its place.

use mbody::assembly::{Assembled, Kinds, assemble};
use mbody::description::Library;
use mbody::description::finding::Findings;
use std::borrow::Cow;
use std::collections::BTreeMap;

struct Texts(BTreeMap<&'static str, String>);

impl Library for Texts {
    fn text(&self, name: &str) -> Option<Cow<'_, str>> {
        self.0.get(name).map(|text| Cow::Borrowed(text.as_str()))
    }
}

fn with_elements(elements: &str, base: &str) -> (Option<Assembled>, Findings) {
    let text = format!("fastbike: 1\nname: example\nurdf: tree.urdf\nbase: {base}\nelements: {elements}\n");
    let library = Texts([("model.yaml", text), ("tree.urdf", motorcycle::EXAMPLE_TREE.to_owned())].into());
    assemble("model.yaml", &library, &Kinds::standard().with(motorcycle::KINDS), &[])
}

fn elements(elements: &str) -> (Option<Assembled>, Findings) {
    with_elements(elements, "vehicle_base")
}

#[test]
fn every_example_assembles_without_a_finding() {
    for kind in motorcycle::KINDS.iter().filter(|k| k.tree == motorcycle::EXAMPLE_TREE) {
        let (assembled, findings) = elements(&format!("{{ example: {{ {}: {} }} }}", kind.name, kind.example));
        assert!(assembled.is_some() && findings.iter().next().is_none(), "{}: {findings:?}", kind.name);
    }
}

#[test]
fn all_examples_together_share_their_inputs() {
    // a vehicle has either of these or its counterpart: `chain`, `single_track`
    const COUNTERPARTS: [&str; 2] = ["shaft_drive", "multi_track"];
    let kinds = motorcycle::KINDS.iter().filter(|k| k.tree == motorcycle::EXAMPLE_TREE && !COUNTERPARTS.contains(&k.name));
    let list: Vec<String> = kinds.map(|k| format!("{0}_1: {{ {0}: {1} }}", k.name, k.example)).collect();
    let (assembled, findings) = elements(&format!("{{ steer: {{ joint_torque: {{ joint: steer }} }}, {} }}", list.join(", ")));
    let assembled = assembled.unwrap_or_else(|| panic!("{findings:?}"));
    let inputs: Vec<&str> = assembled.system.inputs().iter().map(|i| i.signal.name.as_str()).collect();
    for name in ["drive.torque", "steer.torque", "wind.lateral", "brake_1.torque"] {
        assert_eq!(inputs.iter().filter(|i| **i == name).count(), 1, "{name} in {inputs:?}");
    }
    let outputs: Vec<&str> = assembled.system.outputs().iter().map(|o| o.name.as_str()).collect();
    for name in ["lateral_acceleration", "curvature", "steer.torque_normalized", "wheelbase", "drivetrain.gear", "engine_1.throttle"] {
        assert!(outputs.contains(&name), "{name} in {outputs:?}");
    }
}

/// Elements, the code of the finding they must cause, and the end of its path.
const REFUSED: &[(&str, &str, &str)] = &[
    ("{ f: { telescopic_fork: { joint: steer } } }", "wrong_joint", "joint"),
    ("{ f: { telescopic_fork: { joint: frok } } }", "unknown_joint", "joint"),
    ("{ b: { brake: { wheel: front_wheel, reaction: front_rim } } }", "wrong_link", "reaction"),
    (
        "{ e: { variator: { wheel: rear_wheel, lowest: 2, highest: 1, final: 7, shift_speed: 7000 rpm, efficiency: 0 } } }",
        "out_of_range",
        "efficiency",
    ),
    (
        "{ t: { multi_track: { base: front_upper, steer: steer, front_wheels: [{ joint: front_wheel, radius: 0.3 m }], \
         rear_wheels: [{ joint: rear_wheel, radius: 0.3 m }], balance: standing } } }",
        "wrong_link",
        "base",
    ),
    ("{ s: { swingarm_shock: { joint: fork, geometry: { table: { angle: [0, 0.1], length: [0.3, 0.27] } } } } }", "wrong_joint", "joint"),
    (
        "{ s: { swingarm_shock: { joint: swingarm, geometry: { table: { angle: [0.1, 0], length: [0.3, 0.27] } } } } }",
        "invalid_table",
        "geometry.table",
    ),
    (
        "{ s: { swingarm_shock: { joint: swingarm, geometry: { linkage: { rocker_pivot: [0.54, 0.2], rocker_to_rod: [0.46, 0.25], \
         rocker_to_shock: [0.45, 0.19], rod_on_arm: [0.38, 0.3], shock_on_frame: [0.49, 0.5] } } } } }",
        "impossible_linkage",
        "geometry.linkage",
    ),
    (
        "{ s: { swingarm_shock: { joint: steer, geometry: { linkage: { rocker_pivot: [0.54, 0.2], rocker_to_rod: [0.5, 0.17], \
         rocker_to_shock: [0.45, 0.19], rod_on_arm: [0.38, 0.3], shock_on_frame: [0.49, 0.5] } } } } }",
        "wrong_joint",
        "joint",
    ),
    (
        "{ s: { swingarm_shock: { joint: swingarm, geometry: { direct: { from: { link: arm, at: [0, 0, 0.1] }, \
         to: { link: arm, at: [-0.2, 0, 0] } } } } } }",
        "wrong_link",
        "geometry.direct.from.link",
    ),
    (
        "{ c: { chain: { wheel: rear_wheel, front_sprocket: { link: chassis, at: [0.1, 0, 0.32], radius: 40 mm }, rear_sprocket: { radius: 105 mm } } } }",
        "sprockets_overlap",
        "front_sprocket",
    ),
    (
        "{ c: { chain: { wheel: front_wheel, front_sprocket: { link: chassis, at: [0.64, 0, 0.42], radius: 40 mm }, rear_sprocket: { radius: 105 mm } } } }",
        "sprockets_reversed",
        "front_sprocket.at",
    ),
    ("{ d: { shaft_drive: { wheel: rear_wheel, reaction: rear_rim } } }", "wrong_link", "reaction"),
    ("{ e: { engine: { wheel: rear_wheel, gears: { ratios: [2, 1], final: 2.5 }, gear: 3 } } }", "out_of_range", "gear"),
    (
        "{ e: { engine: { wheel: rear_wheel, gears: { ratios: [2, 1], final: 2.5 }, \
         map: { throttle: [0, 1], speed: [100, 900], torque: [[-5, -9], [60, -10]] } } } }",
        "invalid_table",
        "map",
    ),
    ("{ r: { engine_rotor: { link: chassis, axis: [0, 0, 0], inertia: 0.02, ratio: 5, wheel: rear_wheel } } }", "no_direction", "axis"),
    (
        "{ t: { single_track: { base: arm, steer: steer, front_wheel: { joint: front_wheel, radius: 0.3 }, rear_wheel: { joint: rear_wheel, radius: 0.3 } } } }",
        "wrong_link",
        "base",
    ),
    (
        "{ t: { single_track: { base: chassis, steer: steer, front_wheel: { joint: front_wheel, radius: 0.3, crown_radius: 0.4 }, \
         rear_wheel: { joint: rear_wheel, radius: 0.3 } } } }",
        "invalid_profile",
        "front_wheel.crown_radius",
    ),
];

#[test]
fn what_cannot_be_meant_is_refused_at_its_place() {
    for (text, code, place) in REFUSED {
        let (assembled, findings) = elements(text);
        assert!(assembled.is_none(), "{text} was accepted");
        let at_place = |path: &str| path.ends_with(&format!(".{place}"));
        assert!(findings.iter().any(|f| f.code == *code && at_place(&f.path)), "{text}: {findings:?}");
    }
}

#[test]
fn a_single_track_needs_a_vehicle_base() {
    let kind = motorcycle::KINDS.iter().find(|k| k.name == "single_track").unwrap();
    let (assembled, findings) = with_elements(&format!("{{ t: {{ single_track: {} }} }}", kind.example), "free");
    assert!(assembled.is_none());
    assert!(findings.iter().any(|f| f.code == "wrong_link"), "{findings:?}");
}
