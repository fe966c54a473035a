//! Who carries whom: names, parents and children, before any number is looked at.

use super::JointKind;
use super::place::{Places, Spot};
use crate::description::finding::{Finding, Findings, suggestion};
use crate::description::nearest::names;
use roxmltree::{Document, Node};
use std::collections::HashMap;

/// Names of a robot in the order of its texts.
#[derive(Default)]
pub(super) struct Skeleton {
    pub links: Vec<SkeletonLink>,
    pub joints: Vec<SkeletonJoint>,
}

pub(super) struct SkeletonLink {
    pub name: String,
    pub has_inertial: bool,
    at: Spot,
}

pub(super) struct SkeletonJoint {
    pub name: String,
    pub kind: Option<JointKind>,
    type_name: String,
    pub parent: String,
    pub child: String,
    mimic: Option<String>,
    pub has_limit: bool,
    at: Spot,
}

/// Links and joints by their number in the text, in tree order: `joints[k]` moves `links[k + 1]`.
pub(super) struct TreeOrder {
    pub links: Vec<usize>,
    pub joints: Vec<usize>,
}

/// Values of the attribute `type`.
const KINDS: [(&str, JointKind); 7] = [
    ("fixed", JointKind::Fixed),
    ("revolute", JointKind::Revolute),
    ("continuous", JointKind::Continuous),
    ("prismatic", JointKind::Prismatic),
    ("planar", JointKind::Planar),
    ("floating", JointKind::Floating),
    ("spherical", JointKind::Spherical),
];

fn child<'a, 'i>(node: Node<'a, 'i>, name: &str) -> Option<Node<'a, 'i>> {
    node.children().find(|c| c.is_element() && c.tag_name().name() == name)
}

fn text(node: Option<Node>, attribute: &str) -> String {
    node.and_then(|n| n.attribute(attribute)).unwrap_or_default().to_string()
}

impl Skeleton {
    /// Adds the links and joints of another text.
    pub fn add(&mut self, document: &Document, places: &mut Places) {
        let elements =
            |name: &'static str| document.root_element().children().filter(move |c| c.is_element() && c.tag_name().name() == name);
        for node in elements("link") {
            let (name, at) = (text(Some(node), "name"), places.of_node(node));
            places.insert(format!("link.{name}"), at);
            self.links.push(SkeletonLink { name, has_inertial: child(node, "inertial").is_some(), at });
        }
        self.joints.extend(elements("joint").map(|node| {
            let type_name = text(Some(node), "type");
            SkeletonJoint {
                name: text(Some(node), "name"),
                kind: KINDS.iter().find(|(name, _)| *name == type_name).map(|(_, kind)| *kind),
                type_name,
                parent: text(child(node, "parent"), "link"),
                child: text(child(node, "child"), "link"),
                mimic: child(node, "mimic").and_then(|m| m.attribute("joint")).map(str::to_string),
                has_limit: child(node, "limit").is_some(),
                at: places.of_node(node),
            }
        }));
    }

    /// Reports what is no tree; gives the order of the tree where it is one.
    pub fn check(&self, places: &Places, findings: &mut Findings) -> Option<TreeOrder> {
        let mut checker = Checker { skeleton: self, places, findings };
        checker.names();
        checker.kinds();
        checker.mimics();
        checker.tree()
    }
}

struct Checker<'a> {
    skeleton: &'a Skeleton,
    places: &'a Places,
    findings: &'a mut Findings,
}

impl<'a> Checker<'a> {
    fn report(&mut self, finding: Finding) {
        self.findings.push(self.places.located(finding));
    }

    /// Duplicates.
    fn names(&mut self) {
        let links = self.skeleton.links.iter().map(|l| (&l.name, l.at));
        let joints = self.skeleton.joints.iter().map(|j| (&j.name, j.at));
        for (noun, all) in [("link", links.collect::<Vec<_>>()), ("joint", joints.collect())] {
            let mut first: HashMap<&str, Spot> = HashMap::new();
            for (name, at) in all {
                if name.is_empty() {
                    continue;
                }
                if let Some(before) = first.get(name.as_str()) {
                    let finding = Finding::error("duplicate_name", format!("there are two {noun}s called `{name}`"))
                        .at_path(format!("{noun}.{name}"))
                        .with_hint(format!("the first one stands on {}", self.places.words(*before, at)));
                    self.findings.push(self.places.at(finding, at));
                } else {
                    first.insert(name, at);
                }
            }
        }
    }

    fn kinds(&mut self) {
        for joint in &self.skeleton.joints {
            let path = format!("joint.{}", joint.name);
            match joint.kind {
                None if joint.type_name.is_empty() => {}
                None => self.report(
                    Finding::error("unknown_kind", format!("joint `{}` is of unknown type `{}`", joint.name, joint.type_name))
                        .at_path(format!("{path}.type"))
                        .with_hint_from(suggestion(&joint.type_name, KINDS.iter().map(|(name, _)| *name))),
                ),
                Some(JointKind::Revolute | JointKind::Prismatic) if !joint.has_limit => self.report(
                    Finding::warning("missing_limit", format!("joint `{}` is {} but has no `<limit>`", joint.name, joint.type_name))
                        .at_path(path)
                        .with_hint("it is taken to be without stops; a rotation without stops is `continuous`"),
                ),
                Some(_) => {}
            }
        }
    }

    fn mimics(&mut self) {
        let joints = &self.skeleton.joints;
        let single =
            |j: &SkeletonJoint| j.kind.is_none_or(|k| matches!(k, JointKind::Revolute | JointKind::Continuous | JointKind::Prismatic));
        let of: HashMap<&str, &SkeletonJoint> = joints.iter().rev().map(|j| (j.name.as_str(), j)).collect();
        for joint in joints {
            let Some(leader) = &joint.mimic else { continue };
            let path = format!("joint.{}.mimic.joint", joint.name);
            let error = |message: String| Finding::error("bad_mimic", message).at_path(&path);
            let finding = match of.get(leader.as_str()) {
                None => error(format!("joint `{}` mimics joint `{leader}`, which does not exist", joint.name))
                    .with_hint_from(suggestion(leader, joints.iter().filter(|j| single(j)).map(|j| j.name.as_str()))),
                Some(_) if *leader == joint.name => error(format!("joint `{leader}` mimics itself")),
                Some(_) if joint.kind == Some(JointKind::Fixed) => {
                    Finding::note("unused_mimic", format!("joint `{}` mimics `{leader}`, but it is fixed: this is not used", joint.name))
                        .at_path(&path)
                }
                Some(other) if !single(other) || !single(joint) => {
                    let many = if single(other) { &joint.name } else { leader };
                    error(format!("joint `{}` mimics `{leader}`, but `{many}` has no single coordinate", joint.name))
                }
                Some(_) => match loop_from(&joint.name, |name| of.get(name)?.mimic.as_deref()) {
                    // a loop is reported once, at the first of its joints
                    Some(ring) if joints.iter().find(|j| ring.contains(&j.name.as_str())).is_some_and(|j| j.name == joint.name) => {
                        error(format!("joints mimic each other in a ring: {}", names(&ring)))
                    }
                    _ => continue,
                },
            };
            self.report(finding);
        }
    }

    /// Parents, roots, loops.
    fn tree(&mut self) -> Option<TreeOrder> {
        let before = self.findings.len();
        let (links, joints) = (&self.skeleton.links, &self.skeleton.joints);
        if links.is_empty() {
            self.report(Finding::error("no_links", "there is no `<link>`"));
            return None;
        }
        let number: HashMap<&str, usize> = links.iter().enumerate().rev().map(|(k, l)| (l.name.as_str(), k)).collect();
        // joint that moves each link
        let mut carrier: Vec<Option<usize>> = vec![None; links.len()];
        for (k, joint) in joints.iter().enumerate() {
            for (side, link) in [("parent", &joint.parent), ("child", &joint.child)] {
                if !link.is_empty() && !number.contains_key(link.as_str()) {
                    let message = format!("joint `{}` has {side} link `{link}`, which does not exist", joint.name);
                    let finding = Finding::error("unknown_link", message)
                        .at_path(format!("joint.{}.{side}.link", joint.name))
                        .with_hint_from(self.looked_in())
                        .with_hint_from(suggestion(link, links.iter().map(|l| l.name.as_str())));
                    self.report(finding);
                }
            }
            let Some(&child) = number.get(joint.child.as_str()) else { continue };
            if let Some(first) = carrier[child] {
                let message =
                    format!("link `{}` has two parents: joints `{}` and `{}` move it", joint.child, joints[first].name, joint.name);
                let finding = Finding::error("two_parents", message).at_path(format!("joint.{}.child.link", joint.name));
                self.report(finding.with_hint("URDF describes trees; close a loop with a constraint of the description"));
            } else {
                carrier[child] = Some(k);
            }
        }
        // with a link or joint missing, roots and loops would be reported that are none
        if self.findings.len() > before || joints.iter().any(|j| j.parent.is_empty() || j.child.is_empty()) {
            return None;
        }
        let parent = |name: &str| Some(joints[carrier[*number.get(name)?]?].parent.as_str());
        self.loops(parent);
        // the second link of a name looks like another root
        if number.len() < links.len() {
            return None;
        }
        self.roots(&carrier);
        if self.findings.len() > before { None } else { Some(order(links, joints, &carrier, &number)) }
    }

    fn loops(&mut self, parent: impl Fn(&str) -> Option<&'a str>) {
        let links: &'a [SkeletonLink] = &self.skeleton.links;
        let mut reported: Vec<String> = Vec::new();
        for link in links {
            let Some(ring) = loop_from(&link.name, &parent) else { continue };
            if reported.contains(&link.name) {
                continue;
            }
            reported.extend(ring.iter().map(|s| (*s).to_string()));
            let finding =
                Finding::error("kinematic_loop", format!("each of these links carries the next one, in a ring: {}", names(&ring)))
                    .at_path(format!("link.{}", link.name))
                    .with_hint("URDF describes trees; close a loop with a constraint of the description");
            self.report(finding);
        }
    }

    /// Where several texts make the tree: which ones.
    fn looked_in(&self) -> Option<String> {
        let files = self.places.files();
        (!files.is_empty()).then(|| format!("looked in {}", names(&files)))
    }

    fn roots(&mut self, carrier: &[Option<usize>]) {
        let parts = !self.places.files().is_empty();
        let roots: Vec<&str> = self.skeleton.links.iter().zip(carrier).filter(|(_, c)| c.is_none()).map(|(l, _)| l.name.as_str()).collect();
        if roots.is_empty() {
            self.report(Finding::error("no_root", "every link is moved by a joint, none is the root"));
        } else if roots.len() > 1 {
            let finding =
                Finding::error("two_roots", format!("{} links are moved by no joint, expected one: {}", roots.len(), names(&roots)))
                    .at_path(format!("link.{}", roots[1]))
                    .with_hint("connect them by joints; `fixed` ones keep them together")
                    .with_hint_from(parts.then(|| "a joint of one part names the link of another part that carries it".to_owned()));
            self.report(finding);
        }
    }
}

/// The ring that contains `start`, following `next`; in the sense of `next` reversed.
fn loop_from<'a>(start: &'a str, next: impl Fn(&str) -> Option<&'a str>) -> Option<Vec<&'a str>> {
    let mut ring = vec![start];
    let (mut at, mut slow, mut step) = (start, start, 0_usize);
    loop {
        at = next(at)?;
        if at == start {
            ring.reverse();
            return Some(ring);
        }
        ring.push(at);
        // another ring further up is not the one of `start` (Brent)
        step += 1;
        if at == slow {
            return None;
        }
        if step.is_power_of_two() {
            slow = at;
        }
    }
}

/// Depth first, children in the order of the text.
fn order(links: &[SkeletonLink], joints: &[SkeletonJoint], carrier: &[Option<usize>], number: &HashMap<&str, usize>) -> TreeOrder {
    let mut moved: Vec<Vec<usize>> = vec![Vec::new(); links.len()];
    for (k, joint) in joints.iter().enumerate() {
        moved[number[joint.parent.as_str()]].push(k);
    }
    let root = carrier.iter().position(Option::is_none).unwrap_or(0);
    let mut order = TreeOrder { links: vec![root], joints: Vec::new() };
    let mut open: Vec<usize> = moved[root].iter().rev().copied().collect();
    while let Some(joint) = open.pop() {
        let child = number[joints[joint].child.as_str()];
        order.joints.push(joint);
        order.links.push(child);
        open.extend(moved[child].iter().rev());
    }
    order
}
