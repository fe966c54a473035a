//! Which elements and attributes URDF has, and what stands in them.

use super::place::{Places, Spot};
use crate::description::finding::{Finding, Findings, suggestion};
use roxmltree::{Attribute, Document, Node};
use std::collections::BTreeMap;

/// What stands in an attribute.
#[derive(Clone, Copy)]
enum Content {
    Text,
    /// Finite numbers, so many of them.
    Numbers(usize),
    /// A number that may be infinite.
    Limit,
}

/// How often an element occurs within its parent.
#[derive(Clone, Copy, PartialEq)]
enum Times {
    Once,
    AtMostOnce,
    Any,
}

struct Element {
    name: &'static str,
    times: Times,
    /// Name, content, whether it must be there.
    attributes: &'static [(&'static str, Content, bool)],
    children: &'static [Element],
    /// Elements that other programs read.
    foreign: &'static [&'static str],
    /// Of these exactly one is needed.
    choice: bool,
}

const REQUIRED: bool = true;
const OPTIONAL: bool = false;
use Content::{Limit, Numbers, Text};

const fn element(
    name: &'static str,
    times: Times,
    attributes: &'static [(&'static str, Content, bool)],
    children: &'static [Element],
) -> Element {
    Element { name, times, attributes, children, foreign: &[], choice: false }
}

const ORIGIN: Element = element(
    "origin",
    Times::AtMostOnce,
    &[("xyz", Numbers(3), OPTIONAL), ("rpy", Numbers(3), OPTIONAL), ("quat_xyzw", Numbers(4), OPTIONAL)],
    &[],
);

const GEOMETRY: Element = Element {
    name: "geometry",
    times: Times::Once,
    attributes: &[],
    children: &[
        element("box", Times::AtMostOnce, &[("size", Numbers(3), REQUIRED)], &[]),
        element("cylinder", Times::AtMostOnce, &[("radius", Numbers(1), REQUIRED), ("length", Numbers(1), REQUIRED)], &[]),
        element("capsule", Times::AtMostOnce, &[("radius", Numbers(1), REQUIRED), ("length", Numbers(1), REQUIRED)], &[]),
        element("sphere", Times::AtMostOnce, &[("radius", Numbers(1), REQUIRED)], &[]),
        element("mesh", Times::AtMostOnce, &[("filename", Text, REQUIRED), ("scale", Numbers(3), OPTIONAL)], &[]),
    ],
    foreign: &[],
    choice: true,
};

const MATERIAL: Element = element(
    "material",
    Times::AtMostOnce,
    &[("name", Text, REQUIRED)],
    &[
        element("color", Times::AtMostOnce, &[("rgba", Numbers(4), REQUIRED)], &[]),
        element("texture", Times::AtMostOnce, &[("filename", Text, REQUIRED)], &[]),
    ],
);

const INERTIAL: Element = element(
    "inertial",
    Times::AtMostOnce,
    &[],
    &[
        ORIGIN,
        element("mass", Times::Once, &[("value", Numbers(1), REQUIRED)], &[]),
        element(
            "inertia",
            Times::Once,
            &[
                ("ixx", Numbers(1), REQUIRED),
                ("ixy", Numbers(1), REQUIRED),
                ("ixz", Numbers(1), REQUIRED),
                ("iyy", Numbers(1), REQUIRED),
                ("iyz", Numbers(1), REQUIRED),
                ("izz", Numbers(1), REQUIRED),
            ],
            &[],
        ),
    ],
);

const LINK: Element = Element {
    name: "link",
    times: Times::Any,
    attributes: &[("name", Text, REQUIRED), ("type", Text, OPTIONAL)],
    children: &[
        INERTIAL,
        element("visual", Times::Any, &[("name", Text, OPTIONAL)], &[ORIGIN, GEOMETRY, MATERIAL]),
        Element {
            foreign: &["material", "verbose"],
            ..element("collision", Times::Any, &[("name", Text, OPTIONAL), ("group", Text, OPTIONAL)], &[ORIGIN, GEOMETRY])
        },
    ],
    foreign: &["contact", "collision_checking", "self_collision_checking", "audio_source"],
    choice: false,
};

const JOINT: Element = element(
    "joint",
    Times::Any,
    &[("name", Text, REQUIRED), ("type", Text, REQUIRED)],
    &[
        ORIGIN,
        element("parent", Times::Once, &[("link", Text, REQUIRED)], &[]),
        element("child", Times::Once, &[("link", Text, REQUIRED)], &[]),
        element("axis", Times::AtMostOnce, &[("xyz", Numbers(3), REQUIRED)], &[]),
        element(
            "limit",
            Times::AtMostOnce,
            &[
                ("lower", Limit, OPTIONAL),
                ("upper", Limit, OPTIONAL),
                ("effort", Limit, OPTIONAL),
                ("velocity", Limit, REQUIRED),
                ("acceleration", Limit, OPTIONAL),
                ("deceleration", Limit, OPTIONAL),
                ("jerk", Limit, OPTIONAL),
            ],
            &[],
        ),
        element("calibration", Times::AtMostOnce, &[("rising", Numbers(1), OPTIONAL), ("falling", Numbers(1), OPTIONAL)], &[]),
        element("dynamics", Times::AtMostOnce, &[("damping", Numbers(1), OPTIONAL), ("friction", Numbers(1), OPTIONAL)], &[]),
        element(
            "mimic",
            Times::AtMostOnce,
            &[("joint", Text, REQUIRED), ("multiplier", Numbers(1), OPTIONAL), ("offset", Numbers(1), OPTIONAL)],
            &[],
        ),
        element(
            "safety_controller",
            Times::AtMostOnce,
            &[
                ("soft_lower_limit", Limit, OPTIONAL),
                ("soft_upper_limit", Limit, OPTIONAL),
                ("k_position", Numbers(1), OPTIONAL),
                ("k_velocity", Numbers(1), REQUIRED),
            ],
            &[],
        ),
    ],
);

const ROBOT: Element = Element {
    name: "robot",
    times: Times::Once,
    attributes: &[("name", Text, OPTIONAL), ("version", Text, OPTIONAL)],
    children: &[LINK, JOINT, Element { times: Times::Any, ..MATERIAL }],
    foreign: &["gazebo", "transmission", "ros2_control", "sensor", "group", "group_state", "disable_collisions", "mujoco", "drake"],
    choice: false,
};

/// Everything in the text that URDF does not have, or that cannot be read; fills `places`.
pub(super) fn check(document: &Document, places: &mut Places) -> Findings {
    let mut checker = Checker { places, findings: Findings::new(), foreign: BTreeMap::new(), unknown: Vec::new() };
    let root = document.root_element();
    checker.attributes(root, &ROBOT, "robot");
    checker.children(root, &ROBOT, "");
    let Checker { places, mut findings, foreign, unknown } = checker;
    for (_, times, mut finding) in unknown {
        if times > 1 {
            finding.message.push_str(&format!(", and {} more like it", times - 1));
        }
        findings.push(finding);
    }
    for (name, (times, at)) in foreign {
        let what =
            if times == 1 { format!("`<{name}>` is for other programs") } else { format!("{times} `<{name}>` are for other programs") };
        findings.push(places.at(Finding::note("foreign_element", format!("{what} and not used")), at));
    }
    findings
}

struct Checker<'a> {
    places: &'a mut Places,
    findings: Findings,
    /// How often an element for other programs occurs, and where first.
    foreign: BTreeMap<String, (usize, Spot)>,
    /// Element and name of what is unknown, how often it occurs, what to say about the first one.
    unknown: Vec<((String, String), usize, Finding)>,
}

impl Checker<'_> {
    fn report(&mut self, finding: Finding, path: &str, at: Spot) {
        self.findings.push(self.places.at(finding.at_path(path), at));
    }

    fn children(&mut self, node: Node, known: &Element, path: &str) {
        for child in node.children().filter(Node::is_element) {
            let name = child.tag_name().name();
            match known.children.iter().find(|e| e.name == name) {
                Some(element) => {
                    let path = path_of(child, path);
                    self.places.insert(path.clone(), self.places.of_node(child));
                    self.attributes(child, element, &path);
                    self.children(child, element, &path);
                }
                None => self.unknown_element(child, known, path),
            }
        }
        self.multiplicity(node, known, path);
    }

    fn unknown_element(&mut self, child: Node, known: &Element, path: &str) {
        let name = child.tag_name().name();
        if known.foreign.contains(&name) || child.tag_name().namespace().is_some() {
            let count = self.foreign.entry(name.to_string()).or_insert((0, self.places.of_node(child)));
            count.0 += 1;
            return;
        }
        let finding = Finding::warning("unknown_element", format!("unknown element `<{name}>` in {}", owner(child)))
            .with_hint_from(suggestion(name, known.children.iter().map(|e| e.name)));
        self.report_unknown((known.name, name), finding, &path_of(child, path), self.places.of_node(child));
    }

    /// Of the same unknown thing in many places, one is reported.
    fn report_unknown(&mut self, (element, name): (&str, &str), finding: Finding, path: &str, at: Spot) {
        match self.unknown.iter_mut().find(|((e, n), ..)| e == element && n == name) {
            Some((_, times, _)) => *times += 1,
            None => {
                let finding = self.places.at(finding.at_path(path), at);
                self.unknown.push(((element.to_string(), name.to_string()), 1, finding));
            }
        }
    }

    /// What is missing, and what stands there twice.
    fn multiplicity(&mut self, node: Node, known: &Element, path: &str) {
        let count = |name: &str| node.children().filter(|c| c.is_element() && c.tag_name().name() == name).count();
        let at = self.places.of_node(node);
        for element in known.children {
            let (name, n) = (element.name, count(element.name));
            if n == 0 && element.times == Times::Once {
                self.report(Finding::error("missing_element", format!("{} has no `<{name}>`", this(node))), path, at);
            } else if n > 1 && element.times != Times::Any {
                self.report(Finding::error("repeated_element", format!("{} has {n} `<{name}>`, expected one", this(node))), path, at);
            }
        }
        let chosen: usize = known.children.iter().map(|e| count(e.name)).sum();
        if known.choice && chosen != 1 {
            let names: Vec<String> = known.children.iter().map(|e| format!("`<{}>`", e.name)).collect();
            let message = format!("{} has {chosen} shapes, expected one of {}", this(node), names.join(", "));
            self.report(Finding::error("missing_element", message), path, at);
        }
    }

    fn attributes(&mut self, node: Node, known: &Element, path: &str) {
        for (name, _, required) in known.attributes {
            if *required && node.attribute(*name).is_none() {
                let message = format!("{} has no attribute `{name}`", this(node));
                self.report(Finding::error("missing_attribute", message), path, self.places.of_node(node));
            }
        }
        for attribute in node.attributes().filter(|a| a.namespace().is_none()) {
            let (name, at) = (attribute.name(), self.places.of_attribute(attribute));
            let path = format!("{path}.{name}");
            self.places.insert(path.clone(), at);
            match known.attributes.iter().find(|(n, _, _)| *n == name) {
                Some((_, content, _)) => {
                    if let Some(problem) = unreadable(*content, attribute) {
                        let message = format!("attribute `{name}` of {}: {problem}", this(node));
                        self.report(Finding::error("bad_number", message), &path, at);
                    }
                }
                None => {
                    let finding = Finding::warning("unknown_attribute", format!("unknown attribute `{name}` of {}", this(node)))
                        .with_hint_from(suggestion(name, known.attributes.iter().map(|(n, _, _)| *n)));
                    self.report_unknown((known.name, name), finding, &path, at);
                }
            }
        }
    }
}

/// What is wrong with the numbers of an attribute.
fn unreadable(content: Content, attribute: Attribute) -> Option<String> {
    let (count, infinite) = match content {
        Text => return None,
        Limit => (1, true),
        Numbers(n) => (n, false),
    };
    let words: Vec<&str> = attribute.value().split_whitespace().collect();
    for word in &words {
        match word.parse::<f64>() {
            Ok(number) if number.is_finite() || (infinite && !number.is_nan()) => {}
            Ok(_) => return Some(format!("`{word}` is not a finite number")),
            Err(_) => return Some(format!("`{}` is not a number", word.chars().take(40).collect::<String>())),
        }
    }
    let noun = if count == 1 { "number" } else { "numbers" };
    (words.len() != count).then(|| format!("expected {count} {noun}, found {}", words.len()))
}

/// `joint.knee.axis`: elements with a name are entered by it where they are told apart by it.
fn path_of(node: Node, parent: &str) -> String {
    let tag = node.tag_name().name();
    let named = matches!(tag, "link" | "joint" | "material") && parent.is_empty();
    let step = match node.attribute("name").filter(|_| named) {
        Some(name) => format!("{tag}.{name}"),
        None => tag.to_string(),
    };
    if parent.is_empty() { step } else { format!("{parent}.{step}") }
}

/// `` `<axis>` in joint `knee` ``, or the link or joint itself.
fn this(node: Node) -> String {
    let tag = node.tag_name().name();
    if is_named(node) { own_name(node) } else { format!("`<{tag}>` in {}", owner(node)) }
}

/// The link, joint or robot that an element belongs to.
fn owner(node: Node) -> String {
    node.ancestors().skip(1).find(|a| is_named(*a)).map_or_else(|| "`<robot>`".to_string(), own_name)
}

fn is_named(node: Node) -> bool {
    let direct = node.parent_element().is_some_and(|p| p.parent_element().is_none());
    direct && matches!(node.tag_name().name(), "link" | "joint" | "material")
}

fn own_name(node: Node) -> String {
    let tag = node.tag_name().name();
    match node.attribute("name") {
        Some(name) => format!("{tag} `{name}`"),
        None => format!("a `<{tag}>` without a name"),
    }
}
