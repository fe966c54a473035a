//! The written form of the tires: what it becomes, and what it says about mistakes.

use mbody::assembly::{Assembled, ElementDescription, Kinds, assemble};
use mbody::description::Library;
use mbody::description::finding::{Findings, Severity};
use motorcycle::tire::{ThinDiscLinearDescription, TireDescription};
use std::borrow::Cow;

/// A description with one element, the example tree, and the files that the element may name.
struct Files {
    description: String,
    tree: String,
}

impl Library for Files {
    fn text(&self, name: &str) -> Option<Cow<'_, str>> {
        Some(Cow::Borrowed(match name {
            "test.yaml" => &self.description,
            "test.urdf" => &self.tree,
            "sel04_120_70.yaml" => include_str!("../../models/tires/sel04_120_70.yaml"),
            "broken.yaml" => "magic_formula_motorcycle: { nominal_load: 1100, crown_radius: much }",
            "chained.yaml" => "file: sel04_120_70.yaml",
            _ => return None,
        }))
    }
}

fn with_tree(kind: &str, parameters: &str, tree: &str) -> (Option<Assembled>, Findings) {
    let description =
        format!("fastbike: 1\nname: test\nurdf: test.urdf\nbase: vehicle_base\nelements:\n  tire: {{ {kind}: {parameters} }}\n");
    assemble("test.yaml", &Files { description, tree: tree.into() }, &Kinds::standard().with(motorcycle::KINDS), &[])
}

fn build(parameters: &str) -> (Option<Assembled>, Findings) {
    with_tree(TireDescription::KIND, parameters, TireDescription::TREE)
}

/// A tire with some of its entries replaced.
fn tire(changes: &[(&str, &str)]) -> String {
    let mut entries = vec![
        ("wheel", WHEEL),
        ("radius", "0.3 m"),
        ("crown", "{ torus: { radius: 60 mm } }"),
        ("carcass", "{ deformable: { radial: { stiffness: 150 kN/m, damping: 300 }, lateral: { stiffness: 160 kN/m, damping: 100 } } }"),
        ("law", "{ file: sel04_120_70.yaml }"),
    ];
    for change in changes {
        entries.retain(|e| e.0 != change.0);
        entries.push(*change);
    }
    let entries: Vec<String> = entries.iter().map(|(key, value)| format!("{key}: {value}")).collect();
    format!("{{ {} }}", entries.join(", "))
}

/// The front wheel joint of the example tree.
const WHEEL: &str = "front_axle";

/// The only error, beside warnings: its code, path and message.
fn refused(parameters: &str) -> (&'static str, String, String) {
    only(build(parameters))
}

fn only((assembled, findings): (Option<Assembled>, Findings)) -> (&'static str, String, String) {
    assert!(assembled.is_none(), "accepted");
    let all: Vec<_> = findings.iter().filter(|f| f.severity == Severity::Error).collect();
    let [finding] = all[..] else { panic!("{findings:?}") };
    (finding.code, finding.path.clone(), finding.message.clone())
}

#[test]
fn the_examples_can_be_built() {
    for (kind, example, tree) in [
        (TireDescription::KIND, TireDescription::EXAMPLE, TireDescription::TREE),
        (ThinDiscLinearDescription::KIND, ThinDiscLinearDescription::EXAMPLE, ThinDiscLinearDescription::TREE),
    ] {
        let (assembled, findings) = with_tree(kind, example, tree);
        let assembled = assembled.unwrap_or_else(|| panic!("{kind}: {findings:?}"));
        assert!(assembled.system.outputs().iter().any(|o| o.name == "tire.normal_force"));
        assert!(assembled.system.inputs().iter().any(|i| i.signal.name.ends_with("_road.height") && i.rate.is_some()));
    }
}

/// A rigid tire on the front wheel of the example tree, held by a constraint.
fn rigid(constraint: &str, changes: &[(&str, &str)]) -> (Option<Assembled>, Findings) {
    let carcass = ("carcass", "{ rigid: { contact: held, relaxation: { force: { length: { constant: 0.25 m } } } } }");
    let parameters = tire(&[&[carcass][..], changes].concat());
    let description = format!(
        "fastbike: 1\nname: test\nurdf: test.urdf\nbase: vehicle_base\nconstraints:\n  held: {constraint}\nelements:\n  tire: {{ tire: {parameters} }}\n"
    );
    let files = Files { description, tree: TireDescription::TREE.into() };
    assemble("test.yaml", &files, &Kinds::standard().with(motorcycle::KINDS), &[])
}

#[test]
fn a_rigid_tire_takes_its_load_from_the_constraint_that_holds_it() {
    let held = "{ surface_contact: { link: front_roller, at: [0, 0, 0], axis: [0, 1, 0], radius: 0.3 m, crown_radius: 60 mm } }";
    let (assembled, findings) = rigid(held, &[]);
    let system = assembled.unwrap_or_else(|| panic!("{findings:?}")).system;
    assert!(system.unknowns().iter().any(|u| u.signal.name == "held.normal_force"));
    assert!(system.inputs().iter().all(|i| !i.signal.name.contains("height")), "it has no road of its own");

    let wrong = held.replace("front_roller", "rear_roller");
    let point = "{ distance: { from: { link: frame, at: [0.7, 0, 0.6] }, to: { link: front_roller, at: [0, 0, 0] } } }";
    let (road, other) = (("road", "front_road"), ("carcass", "{ rigid: { contact: hled } }"));
    let (key, small) = ("carcass.rigid.contact", ("radius", "0.29 m"));
    for (constraint, change, code, key, words) in [
        (wrong.as_str(), None, "wrong_constraint", key, "`held` does not hold the wheel `front_roller`"),
        (point, None, "wrong_constraint", key, "`held` does not hold the wheel"),
        (held, Some(other), "unknown_constraint", key, "constraint `hled` does not exist"),
        (held, Some(small), "contradictory_entries", key, "-10.0000 mm deep in the road"),
        (held, Some(road), "contradictory_entries", "road", "the road `front_road` has no height"),
    ] {
        let (found, path, message) = only(rigid(constraint, change.as_slice()));
        assert_eq!((found, path.as_str()), (code, format!("elements.tire.tire.{key}").as_str()), "{message}");
        assert!(message.contains(words), "{message}");
    }
}

#[test]
fn states_follow_the_carcass() {
    let spring = "{ stiffness: 160 kN/m, damping: 100 N s/m }";
    let vertical = |relaxation: &str| format!("{{ vertical: {{ stiffness: 150 kN/m, damping: 800 N s/m, relaxation: {relaxation} }} }}");
    for (carcass, expected) in [
        (format!("{{ deformable: {{ radial: {spring}, lateral: {spring} }} }}"), vec!["carcass_lateral"]),
        (
            format!("{{ deformable: {{ radial: {spring}, lateral: {spring}, longitudinal: {spring} }} }}"),
            vec!["carcass_lateral", "carcass_longitudinal"],
        ),
        ("{ vertical: { stiffness: 150 kN/m, stiffness_quadratic: 1e6, damping: 800 N s/m } }".into(), vec![]),
        (vertical("none"), vec![]),
        (vertical(&format!("{{ elastic: {spring} }}")), vec!["carcass_lateral"]),
        (vertical("{ slip: { length: { constant: 0.2 m } } }"), vec!["lagged_lateral_slip"]),
        (
            vertical(
                "{ slip: { length: { cornering_stiffness: [8.633e-6, 3.725e-8, 8.389e-10] }, longitudinal_length: { constant: 80 mm } } }",
            ),
            vec!["lagged_lateral_slip", "lagged_longitudinal_slip"],
        ),
        (vertical("{ force: { length: { load_polynomial: [0.1012, 1.297e-4, -3.267e-8] } } }"), vec!["lagged_lateral_force"]),
        (vertical("{ force_without_camber: { length: { constant: 0.244 m } } }"), vec!["lagged_lateral_force"]),
    ] {
        let (assembled, findings) = build(&tire(&[("carcass", &carcass)]));
        let assembled = assembled.unwrap_or_else(|| panic!("{carcass}: {findings:?}"));
        let names = assembled.system.unknowns().iter().filter_map(|u| u.signal.name.strip_prefix("tire.").map(str::to_owned));
        assert_eq!(names.collect::<Vec<_>>(), expected, "{carcass}");
    }
}

#[test]
fn crowns_laws_and_options_are_read() {
    let table = "{ table: { inclination: [0, 15 deg, 30 deg, 45 deg, 60 deg], support: [300 mm, 291.8 mm, 267.8 mm, 229.7 mm, 180 mm] } }";
    let linear = "{ linear_normalized: { longitudinal_stiffness: 20, cornering_stiffness: 14, camber_stiffness: 0.9 } }";
    let sharp = "{ sharp_linear: { longitudinal_stiffness: 1e4, cornering_stiffness: [11174], camber_stiffness: [938.6] } }";
    for change in [
        ("crown", "disc"),
        ("crown", "{ ellipse: { radial: 45 mm, lateral: 65 mm } }"),
        ("crown", table),
        ("law", linear),
        ("law", sharp),
        ("contact", "bonded"),
        ("contact", "lifting"),
        ("rolling_resistance", "{ constant: 0.015 }"),
        ("rolling_resistance", "{ quadratic: { at_rest: 0.018, per_speed_squared: 6.8e-6 } }"),
        ("effective_radius_fraction", "0.4"),
        ("low_speed", "0.5 km/h"),
        ("pressure", "2.25 bar"),
    ] {
        let (assembled, findings) = build(&tire(&[change]));
        assert!(assembled.is_some(), "{change:?}: {findings:?}");
    }
}

#[test]
fn mistakes_are_named_where_they_are() {
    let law = "{ linear_normalized: { longitudinal_stiffness: 20, cornering_stiffness: -14, camber_stiffness: 0.9 } }";
    let table = "{ table: { inclination: [0, 0.3, 0.6, 0.9], support: [0.31, 0.3, 0.27, 0.23] } }";
    let empty = "{ vertical: { stiffness: 1e5, damping: 800, relaxation: { force: { length: { load_polynomial: [] } } } } }";
    for (change, code, key, words) in [
        (("wheel", "slider"), "wrong_joint", "wheel", "`slider` slides"),
        (("crown", "{ torus: { radius: 0.4 m } }"), "invalid_crown", "crown", "exceeds the radius"),
        (("crown", table), "contradictory_entries", "crown", "0.31 m on the middle plane, but `radius` is 0.3 m"),
        (("carcass", empty), "missing_entry", "carcass.vertical.relaxation", "needs coefficients"),
        (("law", law), "invalid_tire_data", "law", "`cornering_stiffness` must be positive, but is -14"),
        (("law", "{ file: missing.yaml }"), "missing_file", "law.file", "`missing.yaml` was not found"),
        (("rolling_resistance", "pressure"), "missing_entry", "rolling_resistance", "needs the entry `pressure`"),
    ] {
        let (found_code, path, message) = refused(&tire(&[change]));
        assert_eq!((found_code, path.as_str()), (code, format!("elements.tire.tire.{key}").as_str()), "{message}");
        assert!(message.contains(words), "{message}");
    }
}

#[test]
fn a_wheel_that_turns_the_other_way_is_refused() {
    let tree = TireDescription::TREE;
    let (first, rest) = tree.split_at(tree.find(&format!("<joint name=\"{WHEEL}\"")).expect("the joint"));
    for (axis, words) in [("0 -1 0", "points right"), ("0 0 1", "points neither left nor right")] {
        let turned = format!("{first}{}", rest.replacen("<axis xyz=\"0 1 0\"/>", &format!("<axis xyz=\"{axis}\"/>"), 1));
        let (code, path, message) = only(with_tree(TireDescription::KIND, &tire(&[]), &turned));
        assert_eq!((code, path.as_str()), ("wrong_axis", "elements.tire.tire.wheel"));
        assert!(message.contains(words) && message.contains("must point left"), "{message}");
    }
}

#[test]
fn mistakes_in_a_law_file_are_told_all_at_once_at_their_lines() {
    let (assembled, findings) = build(&tire(&[("law", "{ file: broken.yaml }")]));
    assert!(assembled.is_none());
    let told: Vec<_> = findings.iter().map(|f| (f.file.as_str(), f.line, f.code, f.path.as_str())).collect();
    assert!(told.contains(&("broken.yaml", Some(1), "wrong_type", "magic_formula_motorcycle.crown_radius")), "{told:?}");
    // and the three groups of coefficients
    assert_eq!(told.iter().filter(|t| t.2 == "missing_key").count(), 3, "{told:?}");
    let (code, path, message) = refused(&tire(&[("law", "{ file: chained.yaml }")]));
    assert_eq!((code, path.as_str()), ("invalid_tire_file", "file"));
    assert!(message.contains("holds the parameters themselves"), "{message}");
}
