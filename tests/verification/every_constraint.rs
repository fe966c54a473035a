//! Every kind of constraint, assembled from its own example: nothing is listed here, a new row of the table of kinds is held at once.

use mbody::assembly::{Assembled, ConstraintKind, EXAMPLE_TREE, assemble};
use mbody::description::Library;
use mbody::description::finding::{Findings, Severity};
use mbody::dynamics::{Formulation, TreePlant};
use problem::{At, Dae, Differentiable, EquationKind, Explicit, Matrix, Projection, Seeds, UnknownKind};
use std::borrow::Cow;
use validation::agreement::{Agreement, absolute};
use validation::evidence::Row;
use validation::numbers::Numbers;

/// Rows of the table.
pub const EVIDENCE: &[Row] = validation::evidence![
    the_schema_accepts_every_example_and_refuses_unknown_keys => (
        "the schema accepts the example of every kind of constraint, its loop closes, and an unknown key at any depth of it is refused",
        "the kinds themselves",
        "exact"
    ),
    derivatives_are_exact => (
        "derivatives of the residual of every kind of constraint along every y and ẏ are exact, in every formulation",
        "central differences, extrapolated (Richardson)",
        "1e-7 of the largest entry of a column and 1e-7: rounding of the differences"
    ),
    accelerations_keep_the_constraint => (
        "with the accelerations of the explicit form, coordinates half a millisecond on satisfy every kind of constraint to third order, and all formulations have the same motion",
        "Taylor's series",
        "error ratio of eight upon halving the step; residual 1e-9 of the weight"
    ),
    multipliers_do_no_work => (
        "multipliers of every kind of constraint do no work in motions that satisfy it; a drive does its effort times its speed",
        "principle of virtual work",
        "1e-12 of the largest force times the largest speed: double precision"
    ),
    evaluation_allocates_nothing => (
        "evaluation of the residual and its derivatives allocates nothing, for every kind of constraint in every formulation",
        "counting allocator",
        "exact"
    ),
];

const FORMULATIONS: [Formulation; 4] =
    [Formulation::Position, Formulation::Velocity, Formulation::Ggl, Formulation::Acceleration { decay: 3.0 }];

struct Texts(String);

impl Library for Texts {
    fn text(&self, name: &str) -> Option<Cow<'_, str>> {
        Some(if name == "tree.urdf" { Cow::Borrowed(EXAMPLE_TREE) } else { Cow::Borrowed(&self.0) })
    }
}

fn with(kind: &ConstraintKind, example: &str) -> (Option<Assembled>, Findings) {
    let text = format!(
        "fastbike: 1\nname: example\nurdf: tree.urdf\nbase: vehicle_base\nconstraints: {{ example: {{ {}: {example} }} }}\n",
        kind.name
    );
    assemble("example.yaml", &Texts(text), &fastbike::standard_kinds(), &[])
}

/// A plant in a state that satisfies its constraints, with accelerations and multipliers.
struct State {
    plant: TreePlant,
    y: Vec<f64>,
    yd: Vec<f64>,
    u: Vec<f64>,
}

impl State {
    fn at(&self) -> At<'_> {
        At { time: 0.0, y: &self.y, yd: &self.yd, u: &self.u }
    }

    fn residual(&mut self) -> Vec<f64> {
        let mut r = vec![0.0; self.plant.equations().len()];
        self.plant.residual(At { time: 0.0, y: &self.y, yd: &self.yd, u: &self.u }, &mut r).expect("finite");
        r
    }
}

/// Every kind that needs multipliers, in every formulation, in three states.
fn states(mut hold: impl FnMut(&str, Formulation, State)) {
    let mut numbers = Numbers(7);
    let mut kinds = 0;
    for kind in fastbike::standard_kinds().constraints() {
        let system = with(kind, kind.example).0.unwrap_or_else(|| panic!("{} does not assemble", kind.name)).system;
        if system.held_rows() == 0 {
            continue;
        }
        kinds += 1;
        for formulation in FORMULATIONS {
            for _ in 0..3 {
                let mut plant = TreePlant::in_formulation(system.clone(), formulation);
                let mut y: Vec<f64> = plant.unknowns().iter().map(|u| u.design).collect();
                for (y, unknown) in y.iter_mut().zip(plant.unknowns()) {
                    match unknown.kind {
                        UnknownKind::Position => *y += 0.1 * numbers.signed(),
                        UnknownKind::Velocity => *y = numbers.signed(),
                        _ => {}
                    }
                }
                let u: Vec<f64> = plant.inputs().iter().map(|_| 0.05 * numbers.signed()).collect();
                plant.project(0.0, &mut y, &u, &[]).unwrap_or_else(|e| panic!("{}: {e:?}", kind.name));
                let mut yd = vec![0.0; y.len()];
                plant.solve_rates(0.0, &mut y, &u, &mut yd).expect("accelerations");
                hold(&format!("{} {}", kind.name, formulation.name()), formulation, State { plant, y, yd, u });
            }
        }
    }
    assert!(kinds >= 8, "only {kinds} kinds with multipliers");
}

#[test]
fn the_schema_accepts_every_example_and_refuses_unknown_keys() {
    for kind in fastbike::standard_kinds().constraints() {
        let (assembled, findings) = with(kind, kind.example);
        let in_order = findings.iter().all(|f| f.severity == Severity::Note);
        assert!(assembled.is_some() && in_order, "{}: {findings}", kind.name);
        for (place, _) in kind.example.match_indices('{') {
            let (before, after) = kind.example.split_at(place + 1);
            let wrong = format!("{before} unknown_key: 1,{after}");
            let (assembled, findings) = with(kind, &wrong);
            assert!(assembled.is_none(), "{}: accepts {wrong}", kind.name);
            let told = findings.iter().any(|f| f.path.contains("unknown_key") || f.message.contains("unknown_key"));
            assert!(told, "{}: {wrong}\n{findings}", kind.name);
        }
        let system = assembled.map(|a| a.system).expect("assembled");
        for signal in system.unknowns().iter().map(|u| &u.signal).chain(system.inputs().iter().map(|i| &i.signal)) {
            assert!(!signal.unit.is_empty() && !signal.about.is_empty(), "{}: `{}` lacks unit or sentence", kind.name, signal.name);
        }
    }
}

#[test]
fn derivatives_are_exact() {
    const STEP: f64 = 1e-3;
    let mut agreement = Agreement::on("every constraint: derivatives of the residual");
    states(|name, _, mut state| {
        let n = state.y.len();
        let mut seeds = Seeds::zeros(n, state.u.len(), 2 * n);
        for i in 0..n {
            seeds.y[(i, i)] = 1.0;
            seeds.yd[(i, n + i)] = 1.0;
        }
        let (mut r, mut z) = (vec![0.0; n], vec![0.0; state.plant.system().outputs().len()]);
        let (mut dr, mut dz) = (Matrix::zeros(n, 2 * n), Matrix::zeros(z.len(), 2 * n));
        let at = At { time: 0.0, y: &state.y, yd: &state.yd, u: &state.u };
        state.plant.along(at, &seeds, (&mut r, &mut z), &mut dr, &mut dz).expect("finite");
        for column in 0..2 * n {
            let mut quotient = |h: f64| -> Vec<f64> {
                let mut at = |h: f64| {
                    let x = if column < n { &mut state.y[column] } else { &mut state.yd[column - n] };
                    let kept = std::mem::replace(x, *x + h);
                    let r = state.residual();
                    *(if column < n { &mut state.y[column] } else { &mut state.yd[column - n] }) = kept;
                    r
                };
                let (after, before) = (at(h), at(-h));
                after.iter().zip(&before).map(|(a, b)| (a - b) / (2.0 * h)).collect()
            };
            let (coarse, fine) = (quotient(STEP), quotient(STEP / 2.0));
            let extrapolated: Vec<f64> = coarse.iter().zip(&fine).map(|(c, f)| (4.0 * f - c) / 3.0).collect();
            let largest = extrapolated.iter().fold(1.0, |m: f64, x| m.max(x.abs()));
            let rounding =
                absolute(1e-7 * largest.max(r.iter().fold(1.0, |m: f64, x| m.max(x.abs())))).because("rounding of the differences");
            agreement.all_near(&format!("{name}, column {column}"), dr.column(column), &extrapolated, &rounding);
        }
    });
    agreement.assert();
}

#[test]
fn accelerations_keep_the_constraint() {
    let mut agreement = Agreement::on("every constraint: motion");
    states(|name, formulation, mut state| {
        let weight = 2700.0;
        let residual = state.residual();
        let zeros = vec![0.0; residual.len()];
        agreement.all_near(name, &residual, &zeros, &absolute(1e-9 * weight).because("rounding of forces"));
        // coordinates by their Taylor series: q + q̇ h + ½ q̈ h², q̈ from the rates of the kinematic rows
        if formulation != Formulation::Position {
            return;
        }
        let (nq, nv) = (state.plant.system().model().layout().nq(), state.plant.system().model().layout().nv());
        let mut second = vec![0.0; nq];
        let mut seeds = Seeds::zeros(state.y.len(), state.u.len(), 1);
        seeds.y.column_mut(0)[..nq + nv].copy_from_slice(&state.yd[..nq + nv]);
        let n = state.y.len();
        let (mut r, mut z) = (vec![0.0; n], vec![0.0; state.plant.system().outputs().len()]);
        let (mut dr, mut dz) = (Matrix::zeros(n, 1), Matrix::zeros(z.len(), 1));
        let at = At { time: 0.0, y: &state.y, yd: &state.yd, u: &state.u };
        state.plant.along(at, &seeds, (&mut r, &mut z), &mut dr, &mut dz).expect("finite");
        second.iter_mut().enumerate().for_each(|(i, s)| *s = -dr[(i, 0)]);
        let start = state.y.clone();
        let mut error = |h: f64| -> f64 {
            for i in 0..nq {
                state.y[i] = start[i] + h * state.yd[i] + 0.5 * h * h * second[i];
            }
            // the constraint of a drive moves on with its inputs
            let r = {
                let mut r = vec![0.0; n];
                let u: Vec<f64> = match state.u.len() {
                    3 => vec![state.u[0] + h * state.u[1] + 0.5 * h * h * state.u[2], state.u[1] + h * state.u[2], state.u[2]],
                    _ => state.u.clone(),
                };
                state.plant.residual(At { time: h, y: &state.y, yd: &state.yd, u: &u }, &mut r).expect("finite");
                r
            };
            let rows = state.plant.equations().iter().zip(&r).filter(|(e, _)| e.kind == EquationKind::Constraint);
            rows.map(|(_, r)| r.abs()).fold(0.0, f64::max)
        };
        let (coarse, fine) = (error(1e-2), error(5e-3));
        // third order: a factor of eight, where there is anything beyond rounding
        assert!(fine < 1e-13 || (5.5..11.0).contains(&(coarse / fine)), "{name}: {coarse:e} and {fine:e}");
    });
    agreement.assert();
}

#[test]
fn multipliers_do_no_work() {
    states(|name, formulation, mut state| {
        if formulation != Formulation::Position {
            return;
        }
        let speeds = state.y.clone();
        let layout = state.plant.system().model().layout().clone();
        let velocities = layout.nq()..layout.nq() + layout.nv();
        let multipliers: Vec<usize> = (0..state.y.len()).filter(|&i| state.plant.unknowns()[i].kind == UnknownKind::Algebraic).collect();
        for &m in &multipliers {
            let with_force = state.residual();
            let force = std::mem::take(&mut state.y[m]);
            let without = state.residual();
            state.y[m] = force;
            // Jᵀ λ is what the rows of motion lose
            let forces = velocities.clone().map(|i| without[i] - with_force[i]);
            let largest = forces.clone().fold(1.0, |a: f64, f| a.max(f.abs()));
            let power: f64 = velocities.clone().zip(forces).map(|(i, f)| speeds[i] * f).sum();
            let drive = state.plant.unknowns()[m].signal.name.ends_with(".torque")
                || state.plant.unknowns()[m].signal.name == "example.force" && state.u.len() == 3;
            let given = if drive { force * (state.u[1] + prescribed_speed(name)) } else { 0.0 };
            assert!((power - given).abs() < 1e-12 * largest.max(1e3), "{name}: {power:e} W, given {given:e} W");
        }
    });
}

/// Speed that the example of a drive states.
fn prescribed_speed(name: &str) -> f64 {
    if name.starts_with("prescribed_slide") { 0.2 } else { 2.0 }
}

#[test]
fn evaluation_allocates_nothing() {
    states(|name, _, mut state| {
        let n = state.y.len();
        let mut r = vec![0.0; n];
        let seeds = Seeds::zeros(n, state.u.len(), 20);
        let mut z = vec![0.0; state.plant.system().outputs().len()];
        let (mut dr, mut dz) = (Matrix::zeros(n, 20), Matrix::zeros(z.len(), 20));
        let (y, yd, u) = (state.y.clone(), state.yd.clone(), state.u.clone());
        let at = At { time: 0.0, y: &y, yd: &yd, u: &u };
        let counted = allocation_counter::measure(|| {
            state.plant.residual(at, &mut r).expect("finite");
            state.plant.along(at, &seeds, (&mut r, &mut z), &mut dr, &mut dz).expect("finite");
        });
        assert_eq!(counted.count_total, 0, "{name}");
        let _at = state.at();
    });
}
