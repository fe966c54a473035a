//! Runs steady states over a grid of prescribed values, in parallel, and keeps every point with its cause.

use crate::arguments::unknown_name;
use crate::backend::AlgebraicBackend;
use crate::base::stands;
use crate::output::{Given, Point, Progress};
use crate::plan::{Drive, Plan, Prescribed, Request, Turn};
use crate::{Failure, backend, trust};
use analyses::trim::{Trim, TrimError, TrimPoint, TrimProblem, Walk};
use mbody::dynamics::{System, TreePlant};
use problem::{AlgebraicMethod, Effort, Ending, Plant, Signal};
use rayon::prelude::*;
use std::convert::Infallible;
use std::sync::Arc;

/// A grid of steady states.
#[derive(Debug)]
pub struct Steady {
    /// What was prescribed.
    pub given: Vec<Given>,
    /// All signals: unknowns, inputs, outputs.
    pub signals: Vec<Signal>,
    /// Points in the order of the grid, the last prescribed quantity running fastest.
    pub points: Vec<Point>,
    /// Last steady states before a limit, between the points of a grid of two quantities.
    pub limits: Vec<Point>,
    /// What the reader should know.
    pub warnings: Vec<String>,
}

/// The values of one grid point.
#[derive(Clone, Copy, Debug, Default)]
struct Goal {
    speed: Option<f64>,
    turn: Option<f64>,
    acceleration: Option<f64>,
}

/// All signals of a plant: unknowns, inputs, outputs.
pub fn signals(plant: &dyn Plant) -> Vec<Signal> {
    let unknowns = plant.unknowns().iter().map(|u| u.signal.clone());
    unknowns.chain(plant.inputs().iter().map(|i| i.signal.clone())).chain(plant.outputs().iter().cloned()).collect()
}

/// The point of a report: signals and rates where the equations hold.
fn to_point(given: Vec<f64>, p: TrimPoint) -> Point {
    let (values, rates) = match p.solved {
        true => (p.y.iter().chain(&p.u).chain(&p.outputs).copied().collect(), p.yd),
        false => (Vec::new(), Vec::new()),
    };
    Point { given, values, rates, ending: p.ending, effort: p.effort, residual: p.residual }
}

/// Runs a request. `what` names the job for the progress bar.
///
/// # Errors
/// The request as a whole is impossible; a point that cannot be reached is no error.
pub fn run(request: &Request, system: &Arc<System>, backend_name: &str, what: &str) -> Result<Steady, Failure> {
    let Some(backend) = backend::algebraic(backend_name) else {
        let known = backend::ALGEBRAIC.iter().map(|b| b.name);
        return Err(unknown_name("backend", backend_name, ("backend", backend_name), known).into());
    };
    let plant = TreePlant::new(system.clone());
    let prescribed: Vec<&Prescribed> =
        request.speed.iter().chain(request.turn.as_ref().map(|t| &t.1)).chain(request.acceleration.as_ref()).collect();
    let given = prescribed.iter().map(|p| Given::new(p.name, p.unit)).collect();
    let goals = grid(request);
    let job = Job { request, system, backend, rest: rest_pose(system, backend) };
    let progress = Progress::new(what, goals.len());
    // a line is what one task walks along: all turns and accelerations at one speed; lines are independent
    let line = goals.len() / request.speed.as_ref().map_or(1, |p| p.values.len()).max(1);
    let lines: Vec<Result<Line, Failure>> = goals.par_chunks(line.max(1)).map(|line| job.line(line, &progress)).collect();
    let (mut points, mut limits) = (Vec::new(), Vec::new());
    for line in lines {
        let line = line?;
        points.extend(line.points);
        limits.extend(line.limits);
    }
    let mut warnings = Vec::new();
    if request.acceleration.is_some() && request.turn.is_some() {
        warnings.push(
            "quasi-steady: shape, slips and curvature are held while the speed changes; the drift of the lean with speed is ignored"
                .to_owned(),
        );
    }
    let signals = signals(&plant);
    let values = |k: usize| Ok::<_, Infallible>(points.iter().map(move |p| p.values.get(k).copied().unwrap_or(f64::NAN)));
    let Ok(left) = trust::left(system, &signals, values);
    warnings.extend(left);
    Ok(Steady { given, signals, points, limits, warnings })
}

fn grid(request: &Request) -> Vec<Goal> {
    let axis = |p: Option<&Prescribed>| p.map_or(vec![None], |p| p.values.iter().copied().map(Some).collect());
    let (speeds, turns) = (axis(request.speed.as_ref()), axis(request.turn.as_ref().map(|t| &t.1)));
    let accelerations = axis(request.acceleration.as_ref());
    let mut goals = Vec::with_capacity(speeds.len() * turns.len() * accelerations.len());
    for &speed in &speeds {
        for &turn in &turns {
            for &acceleration in &accelerations {
                goals.push(Goal { speed, turn, acceleration });
            }
        }
    }
    goals
}

/// What is found at one speed: points of the grid, and the last ones before limits.
#[derive(Default)]
struct Line {
    points: Vec<Point>,
    limits: Vec<Point>,
}

/// What was found of turns to one side.
#[derive(Default)]
struct Side {
    /// Turns within all limits.
    inside: Vec<(f64, TrimPoint)>,
    /// The smallest turn that is not.
    beyond: Option<f64>,
}

impl Side {
    fn saw(&mut self, turn: f64, found: &TrimPoint) {
        match found.ending {
            Ending::Reached => self.inside.push((turn, found.clone())),
            _ => self.beyond = self.beyond.filter(|b| b.abs() <= turn.abs()).or(Some(turn)),
        }
    }

    /// The largest turn within all limits before the smallest one that is not, and the latter.
    fn bracket(&self) -> Option<(&TrimPoint, f64)> {
        let beyond = self.beyond?;
        let within = self.inside.iter().filter(|(turn, _)| turn.abs() < beyond.abs());
        within.max_by(|a, b| a.0.abs().total_cmp(&b.0.abs())).map(|(_, last)| (last, beyond))
    }
}

/// Halvings of a step of the grid in which a limit is found.
const HALVINGS: usize = 7;

/// What every point of a run shares.
struct Job<'a> {
    request: &'a Request,
    system: &'a Arc<System>,
    backend: &'a AlgebraicBackend,
    /// Unknowns of the static pose: where the first guess of the shape comes from.
    rest: Vec<f64>,
}

/// The static pose without any wishes; the design pose where there is none.
fn rest_pose(system: &Arc<System>, backend: &AlgebraicBackend) -> Vec<f64> {
    let design = system.unknowns().iter().map(|u| u.design).collect();
    let mut plant = TreePlant::new(system.clone());
    let Ok(plan) = Request::default().at_rest(&plant) else { return design };
    match stand(&mut plant, plan, backend) {
        Ok(point) if point.solved => point.y,
        _ => design,
    }
}

/// The static pose: from tires pressed onto the road, else from the design pose.
fn stand(plant: &mut TreePlant, mut plan: Plan, backend: &AlgebraicBackend) -> Result<TrimPoint, TrimError> {
    let first = walk(plant, &plan, backend, &[])?;
    if first.solved {
        return Ok(first);
    }
    plan.start_at_design_height(plant);
    Ok(walk(plant, &plan, backend, &[]).ok().filter(|second| second.solved).unwrap_or(first))
}

impl Job<'_> {
    /// The points at one speed. Turns without acceleration are walked from one to the next; the rest goes point by point.
    fn line(&self, goals: &[Goal], progress: &Progress) -> Result<Line, Failure> {
        let mut line = Line::default();
        let chained = match (goals, self.request.turn.as_ref().map(|t| t.0)) {
            ([first, _, ..], Some(turn)) if turn != Turn::SteerTorque && first.acceleration.is_none() => self.chain(goals)?,
            _ => None,
        };
        match chained {
            Some(chained) => {
                line = chained;
                goals.iter().for_each(|_| progress.advance());
            }
            None => {
                for goal in goals {
                    line.points.extend(self.point(*goal)?);
                    progress.advance();
                }
            }
        }
        Ok(line)
    }

    /// Walks from straight running through turns of growing size, to either side. Where a path ends, every turn beyond it has
    /// the same cause. `None` where straight running at this speed cannot be found directly.
    fn chain(&self, goals: &[Goal]) -> Result<Option<Line>, Failure> {
        let Some(speed) = goals.first().and_then(|g| g.speed) else { return Ok(None) };
        let mut plant = TreePlant::new(self.system.clone());
        let mut plan = self.request.moving(&plant, self.system, Drive::Engine, speed)?;
        plan.start_from(self.system, &self.rest, speed);
        let mut problem = TrimProblem::new(&mut plant, &plan.trim)?;
        let mut method = (self.backend.make)();
        let walk = Walk { largest_steps: plan.largest_steps.clone(), ..Walk::default() };
        let mut straight: Vec<f64> = problem.goals().into_iter().map(|(_, v)| v).collect();
        straight[..2].copy_from_slice(&[speed, 0.0]);
        let mut x = problem.guess().to_vec();
        if !walk.solve(&mut problem, method.as_mut(), &straight, &mut x).converged() {
            return Ok(None);
        }
        let anchor = (straight, x);
        let mut last = [anchor.clone(), anchor.clone()];
        let mut ended: [Option<(f64, Ending)>; 2] = [None, None];
        let mut sides = [Side::default(), Side::default()];
        let mut line = Line::default();
        for goal in goals {
            let turn = self.turn(*goal);
            let side = usize::from(turn < 0.0);
            let given = vec![speed, goal.turn.unwrap_or_default()];
            if let Some((_, ending)) = ended[side].as_ref().filter(|(end, _)| turn.abs() >= end.abs()) {
                line.points.push(Point {
                    given,
                    ending: ending.clone(),
                    effort: Effort::default(),
                    residual: f64::NAN,
                    values: Vec::new(),
                    rates: Vec::new(),
                });
                continue;
            }
            let from = if last[side].0[1].abs() <= turn.abs() { &last[side] } else { &anchor };
            let mut target = anchor.0.clone();
            target[1] = turn;
            let found = walk.reach(&mut problem, method.as_mut(), (&from.0, &from.1), &target)?;
            match found.solved {
                true => last[side] = (target, found.x.clone()),
                false => ended[side] = Some((turn, found.ending.clone())),
            }
            sides[side].saw(turn, &found);
            line.points.push(to_point(given, found));
        }
        for (last, beyond) in sides.iter().filter_map(Side::bracket).filter(|_| self.request.swept() == 2) {
            let found = limit(&walk, &mut problem, method.as_mut(), last, beyond)?;
            let at = found.goals[1].1;
            let radius = self.request.turn.as_ref().is_some_and(|t| t.0 == Turn::Radius);
            line.limits.push(to_point(vec![speed, if radius { 1.0 / at } else { at }], found));
        }
        Ok(Some(line))
    }

    /// The turn in the terms of the trim: a radius is an inverse curvature.
    fn turn(&self, goal: Goal) -> f64 {
        match (self.request.turn.as_ref().map(|t| t.0), goal.turn) {
            (Some(Turn::Radius), Some(radius)) => 1.0 / radius,
            (_, turn) => turn.unwrap_or(0.0),
        }
    }

    /// The steady states at one grid point: one, or for a given steering torque as many as there are.
    fn point(&self, goal: Goal) -> Result<Vec<Point>, Failure> {
        let request = self.request;
        let given: Vec<f64> = [goal.speed, goal.turn, goal.acceleration].into_iter().flatten().collect();
        let found = match (goal.speed, request.top_speed) {
            (None, false) => vec![self.at_rest()?],
            (speed, _) => {
                let speed = speed.unwrap_or(50.0);
                match request.turn.as_ref().map(|t| t.0) {
                    Some(Turn::SteerTorque) if !self.stands() => self.with_torque(speed, goal)?,
                    _ => vec![self.moving(speed, goal)?],
                }
            }
        };
        Ok(found.into_iter().map(|p| to_point(given.clone(), p)).collect())
    }

    /// A vehicle that stands on its wheels turns in one way with a given steering torque.
    fn stands(&self) -> bool {
        stands(&TreePlant::new(self.system.clone()))
    }

    fn at_rest(&self) -> Result<TrimPoint, Failure> {
        let mut plant = TreePlant::new(self.system.clone());
        let plan = self.request.at_rest(&plant)?;
        stand(&mut plant, plan, self.backend).map_err(Failure::Trim)
    }

    /// Walks from straight running at the same speed to the goal.
    fn moving(&self, speed: f64, goal: Goal) -> Result<TrimPoint, Failure> {
        let (request, system) = (self.request, self.system);
        let turn = self.turn(goal);
        let mut goals = if request.top_speed { vec![1.0, turn] } else { vec![speed, turn] };
        goals.extend(goal.acceleration);
        let with = |drive| -> Result<TrimPoint, Failure> {
            let mut plant = TreePlant::new(system.clone());
            let mut plan = request.moving(&plant, system, drive, speed)?;
            plan.start_from(self.system, &self.rest, speed);
            walk(&mut plant, &plan, self.backend, &goals).map_err(Failure::Trim)
        };
        if goal.acceleration.is_none_or(|a| a >= 0.0) {
            return with(Drive::Engine);
        }
        // less braking than drag and rolling resistance do by themselves still needs the engine
        let braked = with(Drive::Brakes)?;
        match braked.solved && torque_is_negative(&braked, system) {
            true => with(Drive::Engine),
            false => Ok(braked),
        }
    }
}

/// The trim whose solution a point of a run is: roles as the run chose them, goals at the values of the point.
///
/// # Errors
/// See [`run`].
pub fn trim_at(request: &Request, system: &Arc<System>, point: &Point) -> Result<Trim, Failure> {
    let plant = TreePlant::new(system.clone());
    if request.speed.is_none() && !request.top_speed {
        return Ok(request.at_rest(&plant)?.trim);
    }
    let mut given = point.given.iter().copied();
    let speed = if request.top_speed { None } else { given.next() };
    let turn = match &request.turn {
        Some((Turn::Radius, _)) => given.next().map(|radius| 1.0 / radius),
        Some(_) => given.next(),
        None => None,
    };
    let braked = system.inputs().iter().zip(&point.values[system.unknowns().len()..]);
    let braked = braked.filter(|(i, _)| i.signal.name.ends_with("_brake.torque")).any(|(_, u)| *u != 0.0);
    let acceleration = request.acceleration.as_ref().and_then(|_| given.next());
    let drive = if braked && acceleration.is_some_and(|a| a < 0.0) { Drive::Brakes } else { Drive::Engine };
    let mut trim = request.moving(&plant, system, drive, speed.unwrap_or(50.0))?.trim;
    let goals = [Some(speed.unwrap_or(1.0)), Some(turn.unwrap_or(0.0)), acceleration];
    goals.into_iter().flatten().enumerate().for_each(|(goal, value)| trim.set_goal(goal, value));
    Ok(trim)
}

/// The last steady state within all limits on the way from one to a turn beyond, to a small part of the way.
fn limit(
    walk: &Walk,
    problem: &mut TrimProblem<'_>,
    method: &mut dyn AlgebraicMethod,
    inside: &TrimPoint,
    beyond: f64,
) -> Result<TrimPoint, TrimError> {
    let (mut last, mut beyond) = (inside.clone(), beyond);
    for _ in 0..HALVINGS {
        let goals: Vec<f64> = last.goals.iter().map(|(_, v)| *v).collect();
        let mut target = goals.clone();
        target[1] = 0.5 * (target[1] + beyond);
        let trial = walk.reach(problem, method, (&goals, &last.x), &target)?;
        match trial.ending == Ending::Reached {
            true => last = trial,
            false => beyond = target[1],
        }
    }
    Ok(last)
}

fn torque_is_negative(point: &TrimPoint, system: &System) -> bool {
    let brakes = system.inputs().iter().zip(&point.u).filter(|(i, _)| i.signal.name.ends_with("_brake.torque"));
    brakes.map(|(_, u)| *u).sum::<f64>() < 0.0
}

/// Solves at an easy start, then walks to the goals.
fn walk(plant: &mut TreePlant, plan: &Plan, backend: &AlgebraicBackend, goals: &[f64]) -> Result<TrimPoint, TrimError> {
    let mut problem = TrimProblem::new(plant, &plan.trim)?;
    let mut method = (backend.make)();
    let walk = Walk { largest_steps: plan.largest_steps.clone(), ..Walk::default() };
    // goals beyond ours were given by the user and keep their values
    let mut target: Vec<f64> = problem.goals().into_iter().map(|(_, v)| v).collect();
    target[..goals.len()].copy_from_slice(goals);
    let mut easy = target.clone();
    easy[..goals.len()].copy_from_slice(&(plan.easy)(goals));
    let mut x = problem.guess().to_vec();
    let outcome = walk.solve(&mut problem, method.as_mut(), &easy, &mut x);
    if !outcome.converged() {
        // walk there in speed from a slower start
        let mut slow = easy.clone();
        if let Some(first) = slow.first_mut().filter(|_| !goals.is_empty()) {
            *first = first.min(15.0);
        }
        x = problem.guess().to_vec();
        walk.solve(&mut problem, method.as_mut(), &slow, &mut x);
        return walk.reach(&mut problem, method.as_mut(), (&slow, &x), &target);
    }
    let mut point = walk.reach(&mut problem, method.as_mut(), (&easy, &x), &target)?;
    point.effort += outcome.effort;
    Ok(point)
}

impl Job<'_> {
    /// All leans at which the given steering torque holds: sign changes along a sweep of the lean, each then solved for.
    fn with_torque(&self, speed: f64, goal: Goal) -> Result<Vec<TrimPoint>, Failure> {
        let system = self.system;
        let torque = goal.turn.unwrap_or(0.0);
        let by_lean =
            Request { turn: Some((Turn::Lean, Prescribed { name: "lean", unit: "rad", values: vec![] })), ..self.request.clone() };
        let job = Job { request: &by_lean, rest: self.rest.clone(), ..*self };
        let step = 0.05;
        let mut found = Vec::new();
        let at = |system: &System, name: &str| system.inputs().iter().position(|i| i.signal.name == name);
        let Some(torque_at) = at(system, "steer.torque") else {
            return Err(Failure::Argument("this model has no input `steer.torque`".to_owned()));
        };
        for side in [1.0, -1.0] {
            let mut before: Option<(f64, f64)> = None;
            for k in 0..=20 {
                let lean = side * step * f64::from(k);
                let trial = job.moving(speed, Goal { turn: Some(lean), ..goal })?;
                if !trial.solved {
                    break;
                }
                let off = trial.u[torque_at] - torque;
                let crossing = before.is_some_and(|(_, b)| b * off < 0.0) || (k == 0 && off.abs() < 1e-9 && side > 0.0);
                if crossing {
                    let bracket = (before.unwrap_or((lean, off)), (lean, off));
                    found.push(job.refine((speed, torque), goal, bracket)?);
                }
                // a root at the very start is told once, and is no side of a bracket
                before = if off.abs() < 1e-9 { None } else { Some((lean, off)) };
            }
        }
        if found.is_empty() {
            let mut straight = job.moving(speed, Goal { turn: Some(0.0), ..goal })?;
            straight.solved = false;
            straight.ending =
                Ending::NotConverged { because: format!("no lean from -1 to 1 rad holds itself with a steering torque of {torque} N m") };
            found.push(straight);
        }
        found.sort_by(|a, b| a.goals[1].1.total_cmp(&b.goals[1].1));
        Ok(found)
    }

    /// Brent-free refinement: secant steps inside a bracket of the lean until the torque holds to 1e-10 N m.
    fn refine(&self, (speed, torque): (f64, f64), goal: Goal, mut bracket: ((f64, f64), (f64, f64))) -> Result<TrimPoint, Failure> {
        let torque_at = self.system.inputs().iter().position(|i| i.signal.name == "steer.torque").unwrap_or_default();
        let solve = |lean: f64| self.moving(speed, Goal { turn: Some(lean), ..goal });
        let mut point = solve(bracket.1.0)?;
        for round in 0..60 {
            let ((a, fa), (b, fb)) = bracket;
            let width = b - a;
            if (point.u[torque_at] - torque).abs() < 1e-10 || width.abs() < 1e-13 {
                break;
            }
            // Illinois-like: every third step halves the bracket
            let lean = if round % 3 == 2 { a + 0.5 * width } else { b - fb * width / (fb - fa) };
            point = solve(lean)?;
            let f = point.u[torque_at] - torque;
            bracket = if fa * f < 0.0 { ((a, fa), (lean, f)) } else { ((lean, f), (b, fb)) };
        }
        Ok(point)
    }
}
