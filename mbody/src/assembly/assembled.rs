//! From text to a system: everything that is wrong is said at once.

use super::blueprint::Blueprint;
use super::description::{BaseDescription, Description};
use super::{Kinds, Site, closing, tree};
use crate::constraint::Constraint;
use crate::description::Library;
use crate::description::document::Document;
use crate::description::finding::{Finding, Findings};
use crate::description::urdf::Robot;
use crate::dynamics::System;
use crate::force::Force;
use crate::model::{Model, ModelBuilder};
use crate::spatial::Vec3;
use crate::stage::Workspace;
use std::sync::Arc;

/// A system that was read from files.
#[derive(Debug)]
pub struct Assembled {
    /// Name for headings.
    pub name: String,
    /// A sentence or two.
    pub about: String,
    /// The system.
    pub system: Arc<System>,
    /// The tree as URDF describes it, with its looks.
    pub robot: Robot,
    /// Elements left out because their joint is locked: element, joint.
    pub left_out: Vec<(String, String)>,
    /// Kind of each element, in the order of the system.
    pub kinds: Vec<(String, String)>,
    /// Name and kind of each constraint.
    pub constraints: Vec<(String, String)>,
}

/// An override from outside the files: path and text, as in `--set rear_spring.stiffness=58kN/m`.
pub type Override = (String, String);

/// Reads a description and assembles it.
///
/// `file` is the name of the description in the library; names inside it are handed to the library as they stand. Errors and
/// warnings of all files come back together; the system is there where no error is among them.
pub fn assemble(file: &str, library: &dyn Library, kinds: &Kinds, overrides: &[Override]) -> (Option<Assembled>, Findings) {
    let (blueprint, mut findings) = Blueprint::read(file, library, kinds, overrides);
    let assembled = blueprint.and_then(|b| b.assemble(library, kinds, &mut findings));
    (assembled, findings.sorted())
}

/// A plain URDF as a system without elements, on a fixed, free or vehicle base.
pub fn assemble_urdf(file: &str, text: &str, base: BaseDescription, gravity: f64, overrides: &[Override]) -> (Option<Assembled>, Findings) {
    let (blueprint, mut findings) = Blueprint::read_urdf(file, text, (base, gravity), overrides);
    let assembled = blueprint.and_then(|b| bare(b.into_robot(), (base, gravity), &mut findings));
    (assembled.filter(|_| !findings.has_errors()), findings.sorted())
}

/// A tree without elements becomes a system.
pub(super) fn bare(robot: Robot, (base, gravity): (BaseDescription, f64), findings: &mut Findings) -> Option<Assembled> {
    let down = Vec3::new(0.0, 0.0, -gravity);
    let model = tree::model(&robot, base, &Default::default(), down, &|_, _| {}, findings)?;
    match System::new(model, Vec::new()) {
        Ok(system) => Some(Assembled {
            name: robot.name.clone(),
            about: String::new(),
            system: Arc::new(system),
            robot,
            left_out: Vec::new(),
            kinds: Vec::new(),
            constraints: Vec::new(),
        }),
        Err(error) => {
            findings.push(Finding::error("signal_clash", error.to_string()));
            None
        }
    }
}

/// Tree and elements become a system.
pub(super) fn join(
    description: Description,
    robot: Robot,
    library: &dyn Library,
    kinds: &Kinds,
    document: &Document,
    findings: &mut Findings,
) -> Option<Assembled> {
    let down = Vec3::new(0.0, 0.0, -description.gravity.map_or(9.81, |g| g.si()));
    let mut of_tree = Findings::new();
    let couple = |builder: &mut ModelBuilder, findings: &mut Findings| closing::couple(&description.constraints, kinds, builder, findings);
    let model = tree::model(&robot, description.base, &description.joints, down, &couple, &mut of_tree);
    findings.extend(of_tree.iter().map(|f| document.locate(f.clone())));
    let model = model?;
    let locked: Vec<String> = description.joints.iter().filter(|(_, o)| o.locked).map(|(name, _)| name.clone()).collect();
    let mut of_loops = Findings::new();
    let stated = closing::start_coordinates(&model, &description.start, &mut of_loops);
    let (constraints, tied) = constraints(&description, &model, &stated, &locked, (library, document), kinds, &mut of_loops);
    let closed = match of_loops.has_errors() {
        true => None,
        false => closing::close(&model, constraints, &stated, &mut of_loops),
    };
    findings.extend(of_loops.iter().map(|f| document.locate(f.clone())));
    let closed = closed?;
    let mut design = Workspace::new(&model);
    match &closed.q {
        Some(q) => design.to_coordinates(&model, q.iter().copied()),
        None => design.to_design(&model),
    }
    let (mut forces, mut left_out, mut named) = (Vec::new(), Vec::new(), Vec::new());
    let mut of_elements = Findings::new();
    for (name, value) in &description.elements {
        let Some((tag, parameters)) = closing::entry(value) else { continue };
        let Some(kind) = kinds.element(tag) else { continue };
        let path = format!("elements.{name}.{tag}");
        let mut site = Site {
            element: name,
            path,
            model: &model,
            design: &design.world,
            locked: &locked,
            constraints: &closed.constraints,
            library,
            document,
            findings: &mut of_elements,
            left_out: None,
        };
        let built: Option<Force> = (kind.build)(&mut site, parameters);
        match (built, site.left_out.take()) {
            (Some(force), _) => {
                named.push((name.clone(), tag.to_owned()));
                forces.push(force);
            }
            (None, Some(joint)) => left_out.push((name.clone(), joint)),
            (None, None) => {}
        }
    }
    let failed = of_elements.has_errors();
    findings.extend(of_elements.iter().map(|f| document.locate(f.clone())));
    if failed {
        return None;
    }
    match System::constrained(model, closed, forces) {
        Ok(mut system) => {
            let mut of_start = Findings::new();
            system.start(|unknowns| closing::start_values(unknowns, &description.start, &mut of_start));
            findings.extend(of_start.iter().map(|f| document.locate(f.clone())));
            Some(Assembled {
                name: description.name,
                about: description.about.unwrap_or_default(),
                system: Arc::new(system),
                robot,
                left_out,
                kinds: named,
                constraints: tied,
            })
        }
        Err(error) => {
            findings.push(document.locate(Finding::error("signal_clash", error.to_string()).at_path("elements")));
            None
        }
    }
}

/// Constraints in the pose before loops are closed, and name and kind of all of them.
fn constraints(
    description: &Description,
    model: &Model,
    stated: &[(usize, f64)],
    locked: &[String],
    (library, document): (&dyn Library, &Document),
    kinds: &Kinds,
    findings: &mut Findings,
) -> (Vec<Constraint>, Vec<(String, String)>) {
    let mut before = Workspace::new(model);
    let mut q = closing::reference(model);
    stated.iter().for_each(|&(i, x)| q[i] = x);
    before.to_coordinates(model, q.into_iter());
    let (mut built, mut named) = (Vec::new(), Vec::new());
    for (name, value) in &description.constraints {
        let Some((tag, parameters)) = closing::entry(value) else { continue };
        let Some(kind) = kinds.constraint(tag) else { continue };
        let path = format!("constraints.{name}.{tag}");
        let mut site = Site {
            element: name,
            path,
            model,
            design: &before.world,
            locked,
            constraints: &[],
            library,
            document,
            findings,
            left_out: None,
        };
        built.extend((kind.build)(&mut site, parameters));
        named.push((name.clone(), tag.to_owned()));
    }
    (built, named)
}
