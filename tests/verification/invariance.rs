//! What must not matter: which joint of a loop is cut and by what, and how bodies and joints are called.

use analyses::transient::evenly;
use fastbike::standard_kinds;
use mbody::assembly::assemble;
use mbody::description::Library;
use std::borrow::Cow;
use validation::agreement::{Agreement, absolute};
use validation::course::{By, Course};
use validation::evidence::Row;

/// Rows of the table.
pub const EVIDENCE: &[Row] = validation::evidence![
    the_cut_joint_of_a_loop_does_not_matter => (
        "a four-bar with unequal rods, a spring and a damper moves the same, whether it is cut between coupler and rocker by a point on a line, or between rocker and ground by a hinge; so do its accelerations",
        "the same mechanism as two trees",
        "1e-10 rad, rad/s, of 1 rad/s² over 2 s: tolerance 1e-12 of the integration"
    ),
    names_do_not_matter => (
        "the same with other names of bodies, joints and constraints",
        "identity",
        "exact: the same operations"
    ),
];

struct Texts {
    urdf: String,
    yaml: String,
}

impl Library for Texts {
    fn text(&self, name: &str) -> Option<Cow<'_, str>> {
        Some(Cow::Borrowed(if name.ends_with("urdf") { &self.urdf } else { &self.yaml }))
    }
}

/// A joint about −y and the rod behind it: parent, place, mass center along the rod, mass, moment of inertia.
fn rod(joint: &str, link: &str, parent: &str, place: [f64; 2], center: f64, mass: f64, inertia: f64) -> String {
    let [x, z] = place;
    format!(
        "<joint name=\"{joint}\" type=\"continuous\"><parent link=\"{parent}\"/><child link=\"{link}\"/><origin xyz=\"{x} 0 {z}\"/>\
         <axis xyz=\"0 -1 0\"/></joint><link name=\"{link}\"><inertial><origin xyz=\"{center} 0 0\"/><mass value=\"{mass}\"/>\
         <inertia ixx=\"0.01\" ixy=\"0\" ixz=\"0\" iyy=\"{inertia}\" iyz=\"0\" izz=\"{inertia}\"/></inertial></link>"
    )
}

/// Crank 0.4 m on (0, 0), coupler 1.1 m, rocker 0.8 m on (1.2, 0.1).
fn four_bar(rocker: &str, cut: &str) -> Texts {
    let urdf = format!(
        "<robot name=\"four_bar\"><link name=\"world\"/>{}{}{rocker}</robot>",
        rod("crank", "crank_rod", "world", [0.0, 0.0], 0.21, 0.7, 0.02),
        rod("coupler", "coupler_rod", "crank_rod", [0.4, 0.0], 0.5, 1.3, 0.15),
    );
    let yaml = format!(
        "fastbike: 1\nname: four_bar\nurdf: four_bar.urdf\nbase: fixed\ngravity: 9.81 m/s^2\n\
         start: {{ crank.angle: 70 deg, crank.rate: 3 rad/s }}\n\
         constraints: {{ pin: {cut} }}\n\
         elements: {{ spring: {{ spring_damper: {{ from: {{ link: world, at: [0.3, 0, 1.5] }}, to: {{ link: coupler_rod, at: [0.6, 0, 0.1] }}, \
         free_length: 0.7 m, spring: {{ stiffness: 60 N/m }}, damper: {{ coefficient: 0.4 N s/m }} }} }} }}\n"
    );
    Texts { urdf, yaml }
}

/// Cut between coupler and rocker: the rocker hangs on the ground.
fn cut_at_the_coupler() -> Texts {
    four_bar(
        &rod("rocker", "rocker_rod", "world", [1.2, 0.1], 0.35, 0.9, 0.05),
        "{ point_on_line: { point: { link: coupler_rod, at: [1.1, 0, 0] }, line: { link: rocker_rod, at: [0.8, 0, 0] }, direction: [0, 1, 0] } }",
    )
}

/// Cut between rocker and ground: the rocker hangs on the coupler, its x axis as before.
fn cut_at_the_ground() -> Texts {
    four_bar(
        &rod("rocker", "rocker_rod", "coupler_rod", [1.1, 0.0], 0.35 - 0.8, 0.9, 0.05),
        "{ cut_joint: { kind: revolute, parent: { link: rocker_rod, at: [-0.8, 0, 0] }, child: { link: world, at: [1.2, 0, 0.1] }, axis: [0, 1, 0] } }",
    )
}

fn course(texts: &Texts, start: &[(&'static str, f64)]) -> Course {
    let (assembled, findings) = assemble("four_bar.yaml", texts, &standard_kinds(), &[]);
    let system = assembled.unwrap_or_else(|| panic!("{findings}")).system;
    Course::along(system, start, &evenly(2.0, 41), By::Erk(1e-12, 1e-6))
}

#[test]
fn the_cut_joint_of_a_loop_does_not_matter() {
    let mut agreement = Agreement::on("four-bar cut at two places");
    let first = course(&cut_at_the_coupler(), &[]);
    // a start in the same branch: the rocker is counted from the coupler here
    let angle = |course: &Course, name: &str, k: usize| course.signal(name)[k];
    let start: Vec<(&'static str, f64)> = vec![
        ("crank.angle", angle(&first, "crank.angle", 0)),
        ("coupler.angle", angle(&first, "coupler.angle", 0)),
        ("rocker.angle", angle(&first, "rocker.angle", 0) - angle(&first, "crank.angle", 0) - angle(&first, "coupler.angle", 0)),
        ("crank.rate", 3.0),
    ];
    let second = course(&cut_at_the_ground(), &start);
    first.holds(&mut agreement, "cut at the coupler");
    second.holds(&mut agreement, "cut at the ground");
    let integrated = absolute(1e-10).because("tolerance of the integration");
    for k in 0..first.len() {
        for (quantity, name) in [("angle", "angles"), ("rate", "rates")] {
            let of = |course: &Course, joint: &str| angle(course, &format!("{joint}.{quantity}"), k);
            for joint in ["crank", "coupler"] {
                agreement.near(&format!("sample {k}: {name} of {joint}"), of(&second, joint), of(&first, joint), &integrated);
            }
            let rocker = of(&second, "rocker") + of(&second, "coupler") + of(&second, "crank");
            agreement.near(&format!("sample {k}: {name} of rocker"), rocker, of(&first, "rocker"), &integrated);
        }
    }
    // accelerations at the time reached, by name
    let acceleration = |course: &Course, name: &str| {
        let at = course.simulation.trajectory.signals.iter().position(|s| s.name == name).expect("a velocity");
        course.simulation.yd[at]
    };
    let names = ["crank.rate", "coupler.rate"];
    let [a, b] = [&first, &second].map(|course| names.map(|name| acceleration(course, name)));
    agreement.all_near("accelerations at the end", &b, &a, &absolute(1e-9).because("angles 1e-10 apart, stiffness over inertia below 1e3"));
    agreement.assert();
}

#[test]
fn names_do_not_matter() {
    let plain = cut_at_the_coupler();
    let renamed = |text: &str| {
        [("crank", "zeta"), ("coupler", "alpha"), ("rocker", "my_third"), ("pin", "bolt"), ("spring:", "b:")]
            .iter()
            .fold(text.to_owned(), |text, (from, to)| text.replace(from, to))
            .replace("b: { stiffness", "spring: { stiffness")
    };
    let other = Texts { urdf: renamed(&plain.urdf), yaml: renamed(&plain.yaml) };
    let (first, second) = (course(&plain, &[]), course(&other, &[]));
    let mut agreement = Agreement::on("four-bar under other names");
    for (ours, theirs) in [("crank", "zeta"), ("coupler", "alpha"), ("rocker", "my_third")] {
        for quantity in ["angle", "rate"] {
            let same = first.signal(&format!("{ours}.{quantity}")) == second.signal(&format!("{theirs}.{quantity}"));
            agreement.holds(&format!("{quantity} of {ours} is that of {theirs}"), same);
        }
    }
    agreement.assert();
}
