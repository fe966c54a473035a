//! Every bundled model as a whole, in general motion: power, forces of constraints, derivatives in every formulation of the constraints.

use fastbike::library::bundled_models;
use mbody::dynamics::{Formulation, TreePlant};
use problem::{At, Dae, Differentiable, EquationKind, Explicit, Matrix, Outputs, Projection, Seeds, UnknownKind};
use validation::agreement::{Agreement, absolute};
use validation::course::system;
use validation::evidence::Row;
use validation::numbers::Numbers;

/// Rows of the table.
pub const EVIDENCE: &[Row] = validation::evidence![
    power_is_balanced_in_every_bundled_model => (
        "every bundled model, in general motion on its constraints: d/dt (kinetic + gravity + stored) = supplied − dissipated",
        "balance of power, stabilized form and accelerations",
        "1e-13 of the largest term: double precision"
    ),
    constraints_do_no_work => (
        "the forces of all constraints of every bundled model together do no work",
        "principle of d'Alembert",
        "1e-12 of the sum of the powers of each, and 1e-15 of forces times the speed of the whole, of the weight times the velocities where elements read those forces: double precision"
    ),
    derivatives_are_exact_in_every_formulation => (
        "∂F/∂y and ∂F/∂ẏ of every bundled model with constraints, in four formulations",
        "central differences, extrapolated (Ridders)",
        "1e-8 of the largest entry of the row in nominal units: rounding over the step"
    ),
    outputs_alone_are_those_of_the_residual => (
        "outputs without the residual are those with it, at first, after a motion and where only rates or inputs change, in every bundled model",
        "identity",
        "exact: the same operations"
    ),
];

/// States of each model.
const STATES: usize = 5;

/// A point of a plant with all its rates.
struct Point {
    plant: TreePlant,
    y: Vec<f64>,
    yd: Vec<f64>,
    u: Vec<f64>,
}

impl Point {
    /// A state in general position, on the constraints, with multipliers and rates that satisfy the equations.
    fn general(model: &str, formulation: Formulation, numbers: &mut Numbers) -> Self {
        let mut plant = TreePlant::in_formulation(system(model), formulation);
        let speed = 22.0 + 8.0 * numbers.signed();
        let mut y = Vec::new();
        for unknown in plant.unknowns() {
            let (owner, quantity) = unknown.signal.name.split_once('.').expect("owner and quantity");
            let start = unknown.start.unwrap_or(unknown.design);
            let spread = numbers.signed();
            y.push(match (quantity, unknown.kind) {
                ("forward_speed", _) => speed,
                ("rate" | "spin_rate", _) if owner.ends_with("wheel") => speed / 0.31 * (1.0 + 0.01 * spread),
                // pressed onto the road
                ("heave", _) => start - 0.01,
                ("roll", _) => start + 0.2 * spread,
                // a quaternion has unit length
                (_, UnknownKind::Position) if quantity.contains("quaternion") => start,
                (_, UnknownKind::Position) => start + 0.05 * spread * unknown.nominal.min(1.0),
                (_, UnknownKind::Velocity) => start + 0.3 * spread * unknown.nominal.min(1.0),
                (_, UnknownKind::State) => start + 0.3 * spread * unknown.nominal,
                (_, UnknownKind::Algebraic) => 0.0,
            });
        }
        let driven: Vec<bool> = (0..plant.inputs().len())
            .map(|i| plant.inputs()[i].rate.is_none() && !plant.inputs().iter().any(|other| other.rate == Some(i)))
            .collect();
        // torques of brakes are not negative; roads lie still
        let u: Vec<f64> = plant
            .inputs()
            .iter()
            .zip(driven)
            .map(|(i, d)| if d { i.nominal * (0.5 + 0.3 * numbers.signed()) } else { i.default })
            .collect();
        let mut yd = vec![0.0; y.len()];
        plant.project(0.0, &mut y, &u, &[]).unwrap_or_else(|error| panic!("{model}: {error:?}"));
        plant.solve_rates(0.0, &mut y, &u, &mut yd).unwrap_or_else(|error| panic!("{model}: {error:?}"));
        Self { plant, y, yd, u }
    }

    /// Power that comes into the elements less the heat they make, W.
    fn supplied(&mut self) -> f64 {
        let Self { plant, y, yd, u } = self;
        let elements = plant.account_at(At { time: 0.0, y, yd, u }).elements;
        elements.supplied - elements.dissipated
    }

    fn residual(&mut self) -> Vec<f64> {
        let mut r = vec![0.0; self.plant.equations().len()];
        let Self { plant, y, yd, u } = self;
        plant.residual(At { time: 0.0, y, yd, u }, &mut r).expect("finite");
        r
    }
}

/// Calls `look` with states of every bundled model.
fn everywhere(formulation: Formulation, mut look: impl FnMut(&str, Point)) {
    let mut numbers = Numbers(7);
    for model in bundled_models() {
        for k in 0..STATES {
            look(&format!("{model}, {}, state {k}", formulation.name()), Point::general(model, formulation, &mut numbers));
        }
    }
}

#[test]
fn power_is_balanced_in_every_bundled_model() {
    let mut agreement = Agreement::on("bundled models: balance of power");
    for formulation in [Formulation::Ggl, Formulation::Acceleration { decay: 0.0 }] {
        everywhere(formulation, |what, mut point| {
            let Point { plant, y, yd, u } = &mut point;
            let (rate, account) = plant.energy_rate_at(At { time: 0.0, y, yd, u });
            let (supplied, dissipated) = (account.elements.supplied, account.elements.dissipated);
            // powers of all equations of motion, each of which is zero only as a sum
            let kinds = plant.unknowns().iter().zip(yd.iter()).filter(|(k, _)| k.kind == UnknownKind::Velocity);
            let inertial: f64 = kinds.map(|(k, rate)| (rate * k.nominal).abs()).sum();
            let size = rate.abs() + supplied.abs() + dissipated.abs() + account.kinetic + inertial;
            let double = absolute(1e-13 * size).because("double precision of the largest term");
            agreement.near(what, rate, supplied - dissipated, &double);
        });
    }
    agreement.assert();
}

/// Forces of constraints in all rows: these are linear in the multipliers, so they are their derivatives along them.
fn along(point: &mut Point, constraint: &[usize]) -> Vec<f64> {
    let (nr, nz) = (point.plant.equations().len(), point.plant.outputs().len());
    let mut seeds = Seeds::zeros(point.y.len(), point.u.len(), 1);
    constraint.iter().for_each(|&i| seeds.y[(i, 0)] = point.y[i]);
    let (mut r, mut z) = (vec![0.0; nr], vec![0.0; nz]);
    let (mut dr, mut dz) = (Matrix::zeros(nr, 1), Matrix::zeros(nz, 1));
    let Point { plant, y, yd, u } = point;
    plant.along(At { time: 0.0, y, yd, u }, &seeds, (&mut r, &mut z), &mut dr, &mut dz).expect("finite");
    (0..nr).map(|i| dr[(i, 0)]).collect()
}

/// Forces of constraints with what elements that read them add, by leaving the multipliers out; and the power that those elements supply with them.
fn without(point: &mut Point, constraint: &[usize]) -> (Vec<f64>, f64) {
    let (with, supplied) = (point.residual(), point.supplied());
    let kept = point.y.clone();
    constraint.iter().for_each(|&i| point.y[i] = 0.0);
    let without = point.residual();
    let supplied = supplied - point.supplied();
    point.y = kept;
    (with.iter().zip(&without).map(|(with, without)| with - without).collect(), supplied)
}

#[test]
fn constraints_do_no_work() {
    let mut agreement = Agreement::on("bundled models: power of constraints");
    everywhere(Formulation::Ggl, |what, mut point| {
        let rows: Vec<usize> =
            (0..point.plant.equations().len()).filter(|&i| point.plant.equations()[i].kind == EquationKind::Dynamic).collect();
        let of_kind =
            |kind: UnknownKind| -> Vec<usize> { (0..point.y.len()).filter(|&i| point.plant.unknowns()[i].kind == kind).collect() };
        let velocities = of_kind(UnknownKind::Velocity);
        let multipliers = of_kind(UnknownKind::Algebraic);
        if point.plant.system().constraints().is_empty() {
            return;
        }
        let read = point.plant.system().elements().iter().any(|e| !e.force.declared().multipliers.is_empty());
        let constraint: Vec<usize> = multipliers.into_iter().filter(|&i| !point.plant.unknowns()[i].differential).collect();
        let (forces, supplied) = if read { without(&mut point, &constraint) } else { (along(&mut point, &constraint), 0.0) };
        let powers: Vec<f64> = rows.iter().zip(&velocities).map(|(&row, &v)| forces[row] * point.y[v]).collect();
        let size: f64 = powers.iter().map(|p| p.abs()).sum();
        // where elements read the forces of constraints, those carry the weight: its rounding is left when rows are subtracted
        let summed: f64 = rows.iter().zip(&velocities).map(|(&row, &v)| (point.plant.equations()[row].nominal * point.y[v]).abs()).sum();
        // forces on both ends of a constraint, each times the speed with which the model moves as a whole, cancel in a row
        let of_length = |&&v: &&usize| point.plant.unknowns()[v].signal.unit == "m/s";
        let fastest = velocities.iter().filter(of_length).map(|&v| point.y[v].abs()).fold(0.0, f64::max);
        let carried = fastest * constraint.iter().map(|&i| point.y[i].abs()).sum::<f64>();
        let rounding = if read { 1e-15 * summed } else { 1e-12 + 1e-15 * carried };
        let double =
            absolute(1e-12 * size + rounding).because("double precision of the powers of each velocity, and of the weight in them");
        // rows are inertia less forces
        agreement.near(what, powers.iter().sum::<f64>() + supplied, 0.0, &double);
    });
    agreement.assert();
}

/// The limit of central differences, each with half the step of the one before: of all extrapolations the one that says itself that it is the closest (C. J. F. Ridders,
/// Advances in Engineering Software 4 (1982) 75–76).
fn extrapolated(differences: [f64; 5]) -> f64 {
    let (mut best, mut error) = (differences[0], f64::INFINITY);
    let mut before: Vec<f64> = Vec::new();
    for difference in differences {
        let mut row = vec![difference];
        for (j, coarser) in before.iter().enumerate() {
            let (fine, factor) = (row[j], 4f64.powi(j as i32 + 1));
            let limit = fine + (fine - coarser) / (factor - 1.0);
            let apart = (limit - fine).abs().max((limit - coarser).abs());
            if apart < error {
                (best, error) = (limit, apart);
            }
            row.push(limit);
        }
        before = row;
    }
    best
}

#[test]
fn derivatives_are_exact_in_every_formulation() {
    let mut agreement = Agreement::on("bundled models: Jacobians in four formulations");
    let rule = absolute(1e-8).because("rounding over the step, in units of the largest entry of the row");
    for formulation in [Formulation::Position, Formulation::Velocity, Formulation::Ggl, Formulation::Acceleration { decay: 5.0 }] {
        let mut numbers = Numbers(11);
        for model in bundled_models() {
            if system(model).constraints().is_empty() {
                continue;
            }
            let mut point = Point::general(model, formulation, &mut numbers);
            // off the constraints, with corrections: nothing may vanish by chance
            for (y, unknown) in point.y.iter_mut().zip(point.plant.unknowns()) {
                *y += 1e-2 * unknown.nominal.min(1.0) * numbers.signed();
            }
            let (ny, nu) = (point.y.len(), point.u.len());
            let nominal: Vec<f64> = point.plant.unknowns().iter().map(|k| k.nominal).collect();
            let mut seeds = Seeds::zeros(ny, nu, 2 * ny);
            for i in 0..ny {
                seeds.y[(i, i)] = nominal[i];
                seeds.yd[(i, ny + i)] = nominal[i];
            }
            let (nr, nz) = (point.plant.equations().len(), point.plant.outputs().len());
            let (mut r, mut z) = (vec![0.0; nr], vec![0.0; nz]);
            let (mut dr, mut dz) = (Matrix::zeros(nr, 2 * ny), Matrix::zeros(nz, 2 * ny));
            let Point { plant, y, yd, u } = &mut point;
            plant.along(At { time: 0.0, y, yd, u }, &seeds, (&mut r, &mut z), &mut dr, &mut dz).expect("finite");
            let largest: Vec<f64> = (0..nr).map(|i| (0..2 * ny).map(|k| dr[(i, k)].abs()).fold(r[i].abs().max(1e-12), f64::max)).collect();
            for k in 0..2 * ny {
                let mut moved = |by: f64| {
                    let x = if k < ny { &mut point.y[k] } else { &mut point.yd[k - ny] };
                    let kept = *x;
                    *x = kept + by * nominal[k % ny];
                    let residual = point.residual();
                    *(if k < ny { &mut point.y[k] } else { &mut point.yd[k - ny] }) = kept;
                    residual
                };
                let steps = [2e-3, 1e-3, 5e-4, 2.5e-4, 1.25e-4];
                let moved = steps.map(|h| [moved(h), moved(-h)]);
                for i in 0..nr {
                    let found = extrapolated(std::array::from_fn(|s| (moved[s][0][i] - moved[s][1][i]) / (2.0 * steps[s])));
                    let name = || {
                        format!(
                            "{model}, {}: {} by {}{}",
                            formulation.name(),
                            point.plant.equations()[i].name,
                            if k < ny { "" } else { "rate of " },
                            point.plant.unknowns()[k % ny].signal.name
                        )
                    };
                    agreement.near(&name(), found / largest[i], dr[(i, k)] / largest[i], &rule);
                }
            }
        }
    }
    agreement.assert();
}

#[test]
fn outputs_alone_are_those_of_the_residual() {
    let mut numbers = Numbers(5);
    for model in bundled_models() {
        let Point { plant: mut other, y, yd, u } = Point::general(model, Formulation::Ggl, &mut numbers);
        let mut plant = TreePlant::in_formulation(system(model), Formulation::Ggl);
        let (mut room, mut found, mut expected) = (vec![0.0; yd.len()], vec![0.0; plant.outputs().len()], vec![0.0; plant.outputs().len()]);
        let (still, idle) = (vec![0.0; yd.len()], vec![0.0; u.len()]);
        for (y, yd, u) in [(&still, &still, &idle), (&y, &yd, &u), (&y, &still, &u), (&y, &yd, &idle), (&still, &yd, &u)] {
            let at = At { time: 0.3, y, yd, u };
            // once by themselves, once where rates were solved for just before
            let (mut completed, mut rates) = (y.clone(), yd.clone());
            for solved in [false, true] {
                // some models cannot be evaluated where everything is zero
                let at = if solved { At { y: &completed, yd: &rates, ..at } } else { at };
                if other.evaluate(at, &mut room, &mut expected).is_err() {
                    continue;
                }
                plant.observe(at, &mut room, &mut found).unwrap_or_else(|error| panic!("{model}: {error:?}"));
                for (signal, (a, b)) in plant.outputs().iter().zip(found.iter().zip(&expected)) {
                    assert!(a == b || (a.is_nan() && b.is_nan()), "{model}, {}, {solved}: {a} is not {b}", signal.name);
                }
                if plant.solve_rates(at.time, &mut completed, u, &mut rates).is_err() {
                    break;
                }
            }
        }
    }
}
