//! What the URDF reader understands, and every message it has.

use super::*;
use crate::description::finding::Severity;
use approx::assert_relative_eq;
use proptest::prelude::*;

const CRANE: &str = r#"<robot name="crane">
  <material name="steel"><color rgba="0.5 0.5 0.6 1"/></material>
  <link name="base"/>
  <link name="jib">
    <inertial><origin xyz="1 0 0" rpy="0 0 1.5707963267948966"/><mass value="40"/>
      <inertia ixx="1" ixy="0" ixz="0" iyy="20" iyz="0" izz="20.5"/></inertial>
    <visual><origin xyz="1 0 0"/><geometry><box size="2 0.1 0.1"/></geometry><material name="steel"/></visual>
    <visual><geometry><mesh filename="package://crane/jib.stl" scale="0.001 0.001 0.001"/></geometry></visual>
  </link>
  <link name="hook"><inertial><mass value="2"/><inertia ixx="0.1" ixy="0" ixz="0" iyy="0.1" iyz="0" izz="0.1"/></inertial></link>
  <link name="trolley"><inertial><mass value="5"/><inertia ixx="0.1" ixy="0" ixz="0" iyy="0.1" iyz="0" izz="0.1"/></inertial></link>
  <joint name="hang" type="spherical"><parent link="trolley"/><child link="hook"/></joint>
  <joint name="slew" type="revolute">
    <parent link="base"/><child link="jib"/><origin xyz="0 0 3"/><axis xyz="0 0 2"/>
    <limit lower="-3" upper="3" effort="100" velocity="1"/><dynamics damping="0.5" friction="0.1"/>
  </joint>
  <joint name="travel" type="prismatic">
    <parent link="jib"/><child link="trolley"/><axis xyz="1 0 0"/><limit lower="0" upper="2" velocity="1"/>
    <mimic joint="slew" multiplier="0.1"/>
  </joint>
</robot>
"#;

fn good(text: &str) -> Robot {
    match read("crane.urdf", text) {
        (Some(robot), findings) if !findings.has_errors() => robot,
        (_, findings) => panic!("{findings}"),
    }
}

/// The crane with one passage replaced, and what is then said: `code | place | message | hint`.
fn said(from: &str, to: &str) -> Vec<String> {
    assert!(CRANE.contains(from), "{from}");
    let (_, findings) = read("c", &CRANE.replacen(from, to, 1));
    let line = |f: &Finding| format!("{} | {} | {} | {}", f.code, f.place(), f.message, f.hint.clone().unwrap_or_default());
    findings.iter().map(line).collect()
}

#[test]
fn reads_a_tree_in_tree_order() {
    let robot = good(CRANE);
    assert_eq!(robot.root, "base");
    assert_eq!(robot.joints.iter().map(|j| j.name.as_str()).collect::<Vec<_>>(), ["slew", "travel", "hang"]);
    for (joint, link) in robot.joints.iter().zip(&robot.links[1..]) {
        assert_eq!(joint.child, link.name);
    }
    assert_eq!(robot.link("base").map(|l| l.mass), Some(None));
    let Some(slew) = robot.joint("slew") else { panic!("slew") };
    assert_eq!((slew.kind, slew.axis, slew.origin.p.z), (JointKind::Revolute, Vec3 { x: 0.0, y: 0.0, z: 1.0 }, 3.0));
    assert_eq!((slew.damping, slew.friction), (0.5, 0.1));
    assert_eq!(slew.limits, Some(Limits { lower: -3.0, upper: 3.0, effort: 100.0, velocity: 1.0 }));
    let mimic = Mimic { joint: "slew".to_string(), multiplier: 0.1, offset: 0.0 };
    assert_eq!(robot.joint("travel").and_then(|j| j.mimic.clone()), Some(mimic));
}

#[test]
fn turns_the_inertia_into_the_axes_of_the_link() {
    let robot = good(CRANE);
    let Some(mass) = robot.link("jib").and_then(|l| l.mass) else { panic!("jib") };
    assert_eq!((mass.mass, mass.center.x), (40.0, 1.0));
    // a quarter turn about z exchanges xx and yy
    for (entry, expected) in mass.inertia.iter().zip([20.0, 1.0, 20.5, 0.0, 0.0, 0.0]) {
        assert_relative_eq!(*entry, expected, epsilon = 1e-12);
    }
}

#[test]
fn keeps_what_is_to_be_drawn() {
    let robot = good(CRANE);
    let Some(jib) = robot.link("jib") else { panic!("jib") };
    assert_eq!(jib.visuals[0].shape, Shape::Box { size: [2.0, 0.1, 0.1] });
    assert_eq!(jib.visuals[0].color, Some([0.5, 0.5, 0.6, 1.0]));
    let mesh = Shape::Mesh { file: "package://crane/jib.stl".to_string(), scale: [0.001; 3] };
    assert_eq!((&jib.visuals[1].shape, jib.visuals[1].color), (&mesh, None));
}

#[test]
fn every_mistake_has_its_message() {
    let cases: &[(&str, &str, &str)] = &[
        ("</robot>", "", "not_xml | c:1:1 | this is not XML: the root node was opened but never closed | "),
        (
            "<robot name=\"crane\">",
            "<robot name=\"crane\"><xacro:if/>",
            "not_xml | c:1:22 | this is not XML: an unknown namespace prefix 'xacro' | this looks like xacro; expand it to plain URDF first",
        ),
        (
            "<link name=\"base\"/>",
            "",
            "unknown_link | c:14:13 (joint.slew.parent.link) | joint `slew` has parent link `base`, which does not exist | known here: `jib`, `hook`, `trolley`",
        ),
        (
            "child link=\"jib\"",
            "child link=\"jbi\"",
            "unknown_link | c:14:33 (joint.slew.child.link) | joint `slew` has child link `jbi`, which does not exist | did you mean `jib`?",
        ),
        (
            "<link name=\"hook\">",
            "<link name=\"jib\">",
            "duplicate_name | c:10:3 (link.jib) | there are two links called `jib` | the first one stands on line 4",
        ),
        (
            "joint name=\"hang\"",
            "joint name=\"slew\"",
            "duplicate_name | c:13:3 (joint.slew) | there are two joints called `slew` | the first one stands on line 12",
        ),
        (
            "child link=\"hook\"",
            "child link=\"jib\"",
            "two_parents | c:14:33 (joint.slew.child.link) | link `jib` has two parents: joints `hang` and `slew` move it | URDF describes trees; close a loop with a constraint of the description",
        ),
        (
            "parent link=\"base\"",
            "parent link=\"hook\"",
            "kinematic_loop | c:4:3 (link.jib) | each of these links carries the next one, in a ring: `trolley`, `hook`, `jib` | URDF describes trees; close a loop with a constraint of the description",
        ),
        (
            "<link name=\"base\"/>",
            "<link name=\"base\"/><link name=\"alone\"/>",
            "two_roots | c:3:22 (link.alone) | 2 links are moved by no joint, expected one: `base`, `alone` | connect them by joints; `fixed` ones keep them together",
        ),
        ("xyz=\"0 0 2\"", "xyz=\"0 0 0\"", "zero_axis | c:14:72 (joint.slew.axis.xyz) | the axis of joint `slew` has no direction | "),
        (
            "xyz=\"0 0 2\"",
            "xyz=\"0 zero 2\"",
            "bad_number | c:14:72 (joint.slew.axis.xyz) | attribute `xyz` of `<axis>` in joint `slew`: `zero` is not a number | ",
        ),
        (
            "xyz=\"0 0 3\"",
            "xyz=\"0 0\"",
            "bad_number | c:14:53 (joint.slew.origin.xyz) | attribute `xyz` of `<origin>` in joint `slew`: expected 3 numbers, found 2 | ",
        ),
        (
            "value=\"40\"",
            "value=\"nan\"",
            "bad_number | c:5:71 (link.jib.inertial.mass.value) | attribute `value` of `<mass>` in link `jib`: `nan` is not a finite number | ",
        ),
        (
            "value=\"40\"",
            "value=\"-40\"",
            "negative_mass | c:5:71 (link.jib.inertial.mass.value) | link `jib` has a negative mass of -40 kg | ",
        ),
        (
            "ixx=\"1\"",
            "ixx=\"-1\"",
            "impossible_inertia | c:6:7 (link.jib.inertial.inertia) | link `jib` has principal moments of inertia of -1.000e0, 2.000e1, 2.050e1 kg m²: a moment of inertia cannot be negative | products of inertia are entered with their sign, `ixy` = −∫ x y dm",
        ),
        (
            "iyy=\"20\"",
            "iyy=\"2\"",
            "impossible_inertia | c:6:7 (link.jib.inertial.inertia) | link `jib` has principal moments of inertia of 1.000e0, 2.000e0, 2.050e1 kg m²: the largest exceeds the sum of the others, which no body can have | products of inertia are entered with their sign, `ixy` = −∫ x y dm",
        ),
        (
            "mimic joint=\"slew\"",
            "mimic joint=\"slow\"",
            "bad_mimic | c:19:12 (joint.travel.mimic.joint) | joint `travel` mimics joint `slow`, which does not exist | did you mean `slew`?",
        ),
        (
            "mimic joint=\"slew\"",
            "mimic joint=\"travel\"",
            "bad_mimic | c:19:12 (joint.travel.mimic.joint) | joint `travel` mimics itself | ",
        ),
        (
            "mimic joint=\"slew\"",
            "mimic joint=\"hang\"",
            "bad_mimic | c:19:12 (joint.travel.mimic.joint) | joint `travel` mimics `hang`, but `hang` has no single coordinate | ",
        ),
        (
            "<dynamics",
            "<mimic joint=\"travel\"/><dynamics",
            "bad_mimic | c:15:67 (joint.slew.mimic.joint) | joints mimic each other in a ring: `travel`, `slew` | ",
        ),
        (
            "<limit lower=\"-3\" upper=\"3\" effort=\"100\" velocity=\"1\"/>",
            "",
            "missing_limit | c:13:3 (joint.slew) | joint `slew` is revolute but has no `<limit>` | it is taken to be without stops; a rotation without stops is `continuous`",
        ),
        (
            "lower=\"-3\"",
            "lower=\"4\"",
            "bad_limit | c:15:5 (joint.slew.limit) | joint `slew` has a lower limit of 4 above its upper limit of 3 | ",
        ),
        (
            "type=\"spherical\"",
            "type=\"sperical\"",
            "unknown_kind | c:12:22 (joint.hang.type) | joint `hang` is of unknown type `sperical` | did you mean `spherical`?",
        ),
        (
            "<axis xyz=\"0 0 2\"/>",
            "<axes xyz=\"0 0 2\"/>",
            "unknown_element | c:14:66 (joint.slew.axes) | unknown element `<axes>` in joint `slew` | did you mean `axis`?",
        ),
        (
            "rpy=\"0 0 1.5",
            "rpj=\"0 0 1.5",
            "unknown_attribute | c:5:35 (link.jib.inertial.origin.rpj) | unknown attribute `rpj` of `<origin>` in link `jib` | did you mean `rpy`?",
        ),
        ("<mass value=\"40\"/>", "", "missing_element | c:5:5 (link.jib.inertial) | `<inertial>` in link `jib` has no `<mass>` | "),
        (
            "<mass value=\"40\"/>",
            "<mass/>",
            "missing_attribute | c:5:65 (link.jib.inertial.mass) | `<mass>` in link `jib` has no attribute `value` | ",
        ),
        (
            "<mass value=\"40\"/>",
            "<mass value=\"40\"/><mass value=\"4\"/>",
            "repeated_element | c:5:5 (link.jib.inertial) | `<inertial>` in link `jib` has 2 `<mass>`, expected one | ",
        ),
        (
            "<box size=\"2 0.1 0.1\"/>",
            "",
            "missing_element | c:7:34 (link.jib.visual.geometry) | `<geometry>` in link `jib` has 0 shapes, expected one of `<box>`, `<cylinder>`, `<capsule>`, `<sphere>`, `<mesh>` | ",
        ),
        (
            "<link name=\"base\"/>",
            "<link name=\"base\"/><gazebo/><gazebo/>",
            "foreign_element | c:3:22 | 2 `<gazebo>` are for other programs and not used | ",
        ),
    ];
    let mut wrong = Vec::new();
    for (from, to, expected) in cases {
        let found = said(from, to);
        if !found.iter().any(|line| line == expected) {
            wrong.push(format!("expected {expected}\nfound    {}", found.join("\n         ")));
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

#[test]
fn a_joint_must_move_some_mass() {
    let hook = "<inertial><mass value=\"2\"/><inertia ixx=\"0.1\" ixy=\"0\" ixz=\"0\" iyy=\"0.1\" iyz=\"0\" izz=\"0.1\"/></inertial>";
    let found = said(hook, "");
    let message = "massless_tip | c:10:3 (link.hook) | joint `hang` moves link `hook`, but neither `hook` nor anything behind it has mass";
    assert!(found[0].starts_with(message), "{found:#?}");
    // the joint in front of it moves the trolley
    assert_eq!(found.len(), 1);
    // mass behind it is enough
    let without_trolley =
        CRANE.replacen("<link name=\"trolley\"><inertial><mass value=\"5\"/>", "<link name=\"trolley\"><inertial><mass value=\"0\"/>", 1);
    good(&without_trolley);
}

#[test]
fn an_impossible_part_of_a_possible_whole_is_a_warning() {
    let sensor = "<link name=\"sensor\"><inertial><mass value=\"1e-6\"/><inertia ixx=\"1e-6\" ixy=\"1e-6\" ixz=\"1e-6\" \
                  iyy=\"1e-6\" iyz=\"1e-6\" izz=\"1e-6\"/></inertial></link>";
    let bolt = "<joint name=\"bolt\" type=\"fixed\"><parent link=\"jib\"/><child link=\"sensor\"/></joint>";
    let (robot, findings) = read("c", &CRANE.replacen("</robot>", &format!("{sensor}{bolt}</robot>"), 1));
    assert!(robot.is_some());
    assert_eq!(findings.iter().map(|f| (f.severity, f.code)).collect::<Vec<_>>(), [(Severity::Warning, "impossible_inertia")]);
}

#[test]
fn several_mistakes_are_reported_at_once() {
    let text = CRANE.replacen("value=\"40\"", "value=\"forty\"", 1).replacen("child link=\"jib\"", "child link=\"jbi\"", 1);
    let codes: Vec<_> = read("c", &text).1.iter().map(|f| f.code).collect();
    assert_eq!(codes, ["bad_number", "unknown_link"]);
}

#[test]
fn says_so_when_it_is_no_urdf() {
    let code = |text: &str| read("c", text).1.iter().map(|f| f.code).collect::<Vec<_>>();
    assert_eq!(code("<sdf/>"), ["not_urdf"]);
    assert_eq!(code("<robot name=\"r\"/>"), ["no_links"]);
    assert_eq!(code(""), ["not_xml"]);
    let deep = format!("<robot>{}{}</robot>", "<a>".repeat(500), "</a>".repeat(500));
    assert_eq!(code(&deep), ["not_urdf"]);
    let deeper = format!("<robot>{}{}</robot>", "<a>".repeat(200_000), "</a>".repeat(200_000));
    assert!(read("c", &deeper).1.has_errors());
}

#[test]
fn entries_can_be_set_by_path() {
    let mut robot = good(CRANE);
    let set = [
        ("link.jib.mass", 50.0),
        ("link.jib.com.x", 1.5),
        ("link.jib.inertia.ixx", 2.0),
        ("joint.slew.rpy.y", 0.1),
        ("joint.slew.axis.z", -3.0),
    ];
    for (path, value) in set {
        assert_eq!(robot.set(path, value), Ok(()), "{path}");
    }
    let mass = robot.link("jib").and_then(|l| l.mass).unwrap_or(MassProperties::NONE);
    assert_eq!((mass.mass, mass.center.x), (50.0, 1.5));
    // `ixx` is written in the axes of `<inertial>`, a quarter turn about z away
    assert_relative_eq!(mass.inertia[1], 2.0, max_relative = 1e-12);
    let Some(slew) = robot.joint("slew") else { panic!("slew") };
    assert_eq!(slew.axis.z, -1.0);
    assert_relative_eq!(slew.origin.R.columns[0].y, 0.1_f64.sin(), max_relative = 1e-12);
    assert!(robot.check().is_empty());
    assert_eq!(robot.set("link.jib.mass", -1.0), Ok(()));
    let check = robot.check();
    assert_eq!(check.iter().map(|f| (f.code, f.line)).collect::<Vec<_>>(), [("negative_mass", Some(5))]);
}

#[test]
fn every_settable_entry_is_listed_with_its_dimension() {
    let mut robot = good(CRANE);
    let all = robot.settable();
    assert_eq!(all.len(), 4 * 10 + 3 * 11);
    for entry in &all {
        assert_eq!(robot.dimension_of(&entry.path).ok(), Some(entry.dimension));
        assert_eq!(robot.set(&entry.path, entry.value + 1.0), Ok(()));
    }
    assert!(robot.settable().iter().zip(&all).all(|(after, before)| after.value == before.value + 1.0));
    let unit = |path: &str| robot.dimension_of(path).map(|d| d.unit).unwrap_or_default();
    assert_eq!((unit("joint.slew.damping"), unit("joint.travel.damping")), ("N m s/rad", "N s/m"));
}

#[test]
fn unknown_paths_name_the_nearest_known_one() {
    let mut robot = good(CRANE);
    let hint = |robot: &mut Robot, path: &str| robot.set(path, 1.0).err().and_then(|f| f.into_iter().next()?.hint);
    assert_eq!(hint(&mut robot, "link.jip.mass").as_deref(), Some("did you mean `link.jib.mass`?"));
    assert_eq!(hint(&mut robot, "link.jib.inertia.iyx").as_deref(), Some("did you mean `inertia.ixx`?"));
    assert_eq!(robot.set("link.jib.mass", f64::NAN).map_err(|f| f.summary()), Err("1 error".to_string()));
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 64, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn no_damaged_text_makes_it_panic(start in 0..CRANE.len(), length in 0_usize..40, insert in "[<>/=\"a-z0-9 .&;-]{0,12}") {
        let end = (start + length).min(CRANE.len());
        let text = format!("{}{insert}{}", &CRANE[..start], &CRANE[end..]);
        let (robot, findings) = read("c", &text);
        prop_assert!(robot.is_some() || findings.has_errors());
    }
}
