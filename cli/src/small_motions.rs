//! Small motions about the steady states of a run: linear models and modes at every point, modes followed from point to point.

use crate::Failure;
use crate::base::base_name;
use crate::output::linear::Linear;
use crate::output::modes::{Branch, Critical, ModesAlong, NamedMode, PointModes};
use crate::output::{Point, Progress};
use crate::plan::{Prescribed, Request, Turn};
use crate::steady::{self, Steady};
use analyses::linearize::{BoundInputs, Options};
use analyses::modes::critical::zero;
use analyses::modes::naming::Name;
use analyses::modes::tracking::{Edge, link_finely, names};
use analyses::{LinearModel, Modes, linearize};
use mbody::dynamics::{Formulation, System, TreePlant};
use motorcycle::handling::MODE_RULES;
use problem::{At, Dae, Signal, Unknown, UnknownKind};
use rayon::prelude::*;
use std::sync::Arc;

/// Real parts smaller than this are those of neutral modes: rounding decides on their sign, 1/s.
const NEUTRAL: f64 = 1e-6;

/// Width to which a change of stability is found, as a share of the step of the sweep.
const CRITICAL_WIDTH: f64 = 1e-10;

/// What every point of a run shares.
#[derive(Debug)]
pub struct SmallMotions<'a> {
    /// What the steady states were asked for.
    pub request: &'a Request,
    /// The system.
    pub system: &'a Arc<System>,
    /// Backend of the steady states.
    pub backend: &'a str,
    /// Largest scaled residual of a steady state.
    pub residual_tolerance: f64,
}

impl SmallMotions<'_> {
    /// The linear model at one steady state; `states` should be states where constraints leave a choice.
    ///
    /// # Errors
    /// Why there is none, in a sentence.
    pub fn linear(&self, point: &Point, states: &[String]) -> Result<LinearModel, String> {
        if point.values.is_empty() {
            return Err("there is no steady state".to_owned());
        }
        // corrections of the stabilized formulation stand behind the unknowns of the steady state, and are zero
        let mut plant = TreePlant::in_formulation(self.system.clone(), Formulation::Ggl);
        let (y, rest) = point.values.split_at(self.system.unknowns().len());
        let u = &rest[..self.system.inputs().len()];
        let padded = |values: &[f64]| {
            let mut values = values.to_vec();
            values.resize(plant.unknowns().len(), 0.0);
            values
        };
        let (y, yd) = (padded(y), padded(&point.rates));
        let options = Options {
            residual_tolerance: self.residual_tolerance,
            bound_inputs: BoundInputs::LeaveOut,
            independent: states.to_vec(),
            ..Options::default()
        };
        linearize(&mut plant, At { time: 0.0, y: &y, yd: &yd, u }, &options).map_err(|e| e.to_string())
    }

    /// Linear models at all points, with the same states where constraints leave a choice.
    pub fn linear_models(&self, steady: &Steady) -> Linear {
        let states = self.states(steady);
        Linear { points: steady.points.par_iter().map(|p| self.linear(p, &states)).collect() }
    }

    /// Names of the states at the first point that has some; none without constraints.
    pub(crate) fn states(&self, steady: &Steady) -> Vec<String> {
        if self.system.constraints().is_empty() {
            return Vec::new();
        }
        let first = steady.points.iter().find_map(|p| self.linear(p, &[]).ok());
        first.map_or_else(Vec::new, |model| model.states.iter().map(|s| s.signal.name.to_string()).collect())
    }

    fn modes(&self, point: &Point, states: &[String]) -> Result<Modes, String> {
        Modes::of(&self.linear(point, states)?).map_err(|e| e.to_string())
    }

    /// Modes at a steady state with other prescribed values.
    fn modes_at(&self, given: &[f64], states: &[String]) -> Option<Modes> {
        let mut request = self.request.clone();
        let mut values = given.iter();
        let turn = request.turn.as_mut().map(|t| &mut t.1);
        for prescribed in request.speed.iter_mut().chain(turn).chain(request.acceleration.as_mut()) {
            prescribed.values = vec![*values.next()?];
        }
        let found = steady::run(&request, self.system, self.backend, "between").ok()?;
        match found.points.as_slice() {
            [point] => self.modes(point, states).ok(),
            _ => None,
        }
    }

    /// Modes on the way from straight running at constant speed (0) to a point (1).
    fn modes_on_the_way(&self, given: &[f64], t: f64, states: &[String]) -> Option<Modes> {
        let mut request = self.request.clone();
        let mut values = given.iter();
        request.speed.as_mut()?.values = vec![*values.next()?];
        if let Some((turn, prescribed)) = &mut request.turn {
            let value = *values.next()?;
            prescribed.values = vec![if *turn == Turn::Radius { value / t } else { value * t }];
        }
        if let Some(acceleration) = &mut request.acceleration {
            acceleration.values = vec![*values.next()? * t];
        }
        if t == 0.0 {
            (request.turn, request.acceleration) = (None, None);
        }
        let found = steady::run(&request, self.system, self.backend, "on the way").ok()?;
        match found.points.as_slice() {
            [point] => self.modes(point, states).ok(),
            _ => None,
        }
    }

    /// Whether a point runs straight at constant speed, which is what the rules of names are made for.
    fn is_plain(&self, given: &[f64]) -> bool {
        let first = usize::from(self.request.speed.is_some());
        let turns_by_radius = matches!(self.request.turn, Some((Turn::Radius, _)));
        given.iter().skip(first).all(|v| *v == 0.0) && !turns_by_radius
    }

    /// Straight running at the speed of the middle one of the points, and how its modes become those of that point; none where the points
    /// have straight running among them, or none can be reached.
    fn straight(&self, steady: &Steady, points: &[Option<&Modes>], states: &[String]) -> Option<(Modes, Edge)> {
        let by_torque = matches!(self.request.turn, Some((Turn::SteerTorque, _)));
        let known: Vec<usize> = (0..points.len()).filter(|&k| points[k].is_some()).collect();
        if by_torque || known.iter().any(|&k| self.is_plain(&steady.points[k].given)) {
            return None;
        }
        let to = *known.get(known.len() / 2)?;
        let given = &steady.points[to].given;
        let straight = self.modes_on_the_way(given, 0.0, states)?;
        // labels of a corner are only as good as the way to it: never in one step
        let middle = self.modes_on_the_way(given, 0.5, states)?;
        let mut first_half = |t: f64| self.modes_on_the_way(given, 0.5 * t, states);
        let first = link_finely(&straight, &middle, &mut first_half)?;
        let mut second_half = |t: f64| self.modes_on_the_way(given, 0.5 + 0.5 * t, states);
        let link = first.then(&link_finely(&middle, points[to]?, &mut second_half)?);
        Some((straight, Edge { from: points.len(), to, link }))
    }

    /// All modes at all points: named, followed along the sweep, with the changes of stability between points.
    ///
    /// # Errors
    /// None of its own.
    pub fn along(&self, steady: &Steady, shapes: Shapes) -> Result<ModesAlong, Failure> {
        let states = self.states(steady);
        let progress = Progress::new("modes", steady.points.len());
        let found: Vec<Result<Modes, String>> = (steady.points.par_iter())
            .map(|point| {
                let modes = self.modes(point, &states);
                progress.advance();
                modes
            })
            .collect();
        let points: Vec<Option<&Modes>> = found.iter().map(|f| f.as_ref().ok()).collect();
        let neighbors = neighbors(steady, &points);
        let edges: Vec<(usize, Edge)> = (neighbors.par_iter())
            .filter_map(|&(along, from, to)| {
                let (a, b) = (points[from]?, points[to]?);
                let (start, end) = (&steady.points[from].given, &steady.points[to].given);
                let mut between = |t: f64| self.modes_at(&mix(start, end, t), &states);
                Some((along, Edge { from, to, link: link_finely(a, b, &mut between)? }))
            })
            .collect();
        let only_edges: Vec<Edge> = edges.iter().map(|(_, e)| e.clone()).collect();
        let straight = self.straight(steady, &points, &states);
        let mut all_points = points.clone();
        let mut plain: Vec<bool> = steady.points.iter().map(|p| self.is_plain(&p.given)).collect();
        let mut all_edges = only_edges;
        if let Some((modes, edge)) = &straight {
            all_points.push(Some(modes));
            plain.push(true);
            all_edges.push(edge.clone());
        }
        let named = names(&all_points, &plain, &all_edges, MODE_RULES);
        let critical: Vec<Vec<Critical>> =
            edges.par_iter().map(|(_, edge)| self.critical(steady, &points, edge, &named, &states)).collect();
        let along = swept(steady).first().copied();
        let first_edges: Vec<&Edge> = edges.iter().filter(|(k, _)| Some(*k) == along).map(|(_, e)| e).collect();
        let branches = along.map_or_else(Vec::new, |k| branches(steady, k, &points, &first_edges, &named));
        let shown = if shapes == Shapes::Shown { self.system.unknowns() } else { &[] };
        let shape_signals: Vec<Signal> = shown.iter().map(|u| u.signal.clone()).collect();
        // what turns or travels along without end belongs to a shape only where it is the pose of the whole
        let base = base_name(&TreePlant::new(self.system.clone())).map(|base| format!("{base}."));
        let poses = |u: &Unknown| !u.cyclic || base.as_ref().is_some_and(|base| u.signal.name.starts_with(base));
        let displaces = |u: &Unknown| matches!(u.kind, UnknownKind::Position | UnknownKind::State) && poses(u);
        let displacements = shown.iter().map(displaces).collect();
        let points = found.iter().zip(&named).map(|(modes, names)| match modes {
            Ok(modes) => Ok(named_modes(modes, names, &shape_signals)),
            Err(because) => Err(because.clone()),
        });
        let critical = critical.into_iter().flatten().collect();
        Ok(ModesAlong { points: points.collect(), critical, shape_signals, displacements, branches, along })
    }

    /// Changes of stability between two points.
    fn critical(&self, steady: &Steady, points: &[Option<&Modes>], edge: &Edge, named: &[Vec<Name>], states: &[String]) -> Vec<Critical> {
        let (Some(from), Some(to)) = (points[edge.from], points[edge.to]) else { return Vec::new() };
        let (start, end) = (&steady.points[edge.from].given, &steady.points[edge.to].given);
        let changes = from.list.iter().zip(&named[edge.from]).filter(|(mode, _)| {
            let beyond = to.spectrum.values[edge.link.to[mode.slot]];
            mode.value.re * beyond.re < 0.0 && mode.value.re.abs().min(beyond.re.abs()) > NEUTRAL
        });
        let found = changes.filter_map(|(mode, name)| {
            let beyond = to.spectrum.values[edge.link.to[mode.slot]];
            let mut at_zero = mode.value;
            let mut real_part = |t: f64| {
                let there = self.modes_at(&mix(start, end, t), states)?;
                let mut between = |s: f64| self.modes_at(&mix(start, end, s * t), states);
                let nearest = link_finely(from, &there, &mut between)?;
                at_zero = there.spectrum.values[nearest.to[mode.slot]];
                Some(at_zero.re)
            };
            let t = zero(&mut real_part, (0.0, mode.value.re), (1.0, beyond.re), CRITICAL_WIDTH)?;
            Some(Critical { name: name.name.clone(), given: mix(start, end, t), im: at_zero.im.abs(), becomes_stable: beyond.re < 0.0 })
        });
        found.collect()
    }
}

/// Whether shapes are wanted.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Shapes {
    /// With the modes.
    Shown,
    /// Not asked for.
    LeftOut,
}

/// Values between two points.
fn mix(start: &[f64], end: &[f64], t: f64) -> Vec<f64> {
    start.iter().zip(end).map(|(a, b)| a + t * (b - a)).collect()
}

/// Indices of the prescribed quantities that vary.
pub fn swept(steady: &Steady) -> Vec<usize> {
    let varies = |k: &usize| steady.points.windows(2).any(|w| w[0].given[*k] != w[1].given[*k]);
    (0..steady.given.len()).filter(varies).collect()
}

/// Neighbors along every swept quantity (its index, then the two points), points without modes left out.
fn neighbors(steady: &Steady, points: &[Option<&Modes>]) -> Vec<(usize, usize, usize)> {
    let mut neighbors = Vec::new();
    for along in swept(steady) {
        // points with the same other values; several states at one point keep their order
        let same = |a: usize, b: usize| {
            let (a, b) = (&steady.points[a].given, &steady.points[b].given);
            (0..a.len()).all(|k| k == along || a[k] == b[k])
        };
        let occurrence = |k: usize| (0..k).filter(|&i| steady.points[i].given == steady.points[k].given).count();
        for to in (0..points.len()).filter(|&k| points[k].is_some()) {
            let before = (0..to).rev().find(|&k| points[k].is_some() && same(k, to) && occurrence(k) == occurrence(to));
            neighbors.extend(before.filter(|&k| steady.points[k].given != steady.points[to].given).map(|from| (along, from, to)));
        }
    }
    neighbors
}

/// Modes of a point with their names.
fn named_modes(modes: &Modes, names: &[Name], shape_signals: &[Signal]) -> PointModes {
    let named = modes.list.iter().zip(names).map(|(mode, name)| NamedMode {
        name: name.name.clone(),
        confidence: name.confidence,
        value: mode.value,
        damping_ratio: mode.damping_ratio(),
        participation: mode.participation.clone(),
        shape: mode.shape.iter().copied().take(shape_signals.len()).collect(),
        sensitivity: Vec::new(),
    });
    PointModes { signals: modes.signals.clone(), modes: named.collect() }
}

/// Paths of all eigenvalues along a swept quantity, cut where the name changes.
fn branches(steady: &Steady, along: usize, points: &[Option<&Modes>], edges: &[&Edge], named: &[Vec<Name>]) -> Vec<Branch> {
    let name_at = |point: usize, slot: usize| {
        let modes = points[point]?;
        let at = modes.list.iter().position(|m| m.slot == slot || (m.oscillates() && m.slot + 1 == slot))?;
        Some(named[point][at].name.clone())
    };
    let value = |point: usize, slot: usize| points[point].map(|m| m.spectrum.values[slot]);
    let mut branches = Vec::new();
    for first in (0..points.len()).filter(|&k| points[k].is_some() && edges.iter().all(|e| e.to != k)) {
        for slot in 0..points[first].map_or(0, |m| m.spectrum.values.len()) {
            let mut path = vec![(first, slot)];
            while let Some(edge) = path.last().and_then(|&(at, _)| edges.iter().find(|e| e.from == at)) {
                let slot = path.last().map_or(0, |&(_, slot)| edge.link.to[slot]);
                path.push((edge.to, slot));
            }
            cut(&path, &name_at, &value, &mut |name, pieces, begins| {
                let swept = pieces.iter().map(|&(point, _)| steady.points[point].given[along]).collect();
                let upper = |z: nalgebra::Complex<f64>| nalgebra::Complex::new(z.re, z.im.abs());
                let values = pieces.iter().filter_map(|&(point, slot)| value(point, slot).map(upper)).collect();
                let continues = pieces.first().is_some_and(|&(point, slot)| name_at(point, slot).as_ref() == Some(&name));
                branches.push(Branch { name, swept, values, begins, continues });
            });
        }
    }
    branches
}

type Place = (usize, usize);

/// Cuts a path where its name changes, and leaves out what is told by the conjugate eigenvalue already.
fn cut(
    path: &[Place],
    name: &dyn Fn(usize, usize) -> Option<String>,
    value: &dyn Fn(usize, usize) -> Option<nalgebra::Complex<f64>>,
    keep: &mut dyn FnMut(String, &[Place], bool),
) {
    let lower = |&(point, slot): &Place| value(point, slot).is_some_and(|z| z.im < 0.0);
    let name_at = |&(point, slot): &Place| name(point, slot).unwrap_or_default();
    if let [only] = path {
        if !lower(only) {
            keep(name_at(only), path, true);
        }
        return;
    }
    let mut start = 0;
    for end in 1..path.len() {
        // a step has the name of its end, and is told once
        let step_name = name_at(&path[end]);
        let hidden = |k: usize| lower(&path[k - 1]) && lower(&path[k]);
        let last = end + 1 == path.len();
        if last || name_at(&path[end + 1]) != step_name || hidden(end + 1) != hidden(end) {
            if !hidden(end) {
                keep(step_name, &path[start..=end], start == 0);
            }
            start = end;
        }
    }
}

/// A prescribed quantity that is not zero at some point.
pub fn accelerates(acceleration: Option<&Prescribed>) -> bool {
    acceleration.is_some_and(|a| a.values.iter().any(|v| *v != 0.0))
}

/// What a reader of linear models at accelerating points has to know.
pub const FROZEN: &str = "frozen time: the speed changes, so the point is no equilibrium; E and A are those of the instant, in the speeds of the \
                          vehicle's own frame and relative spins, and the eigenvalues belong to these coordinates";
