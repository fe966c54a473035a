//! Every integrator, in every form of the problem that it accepts, on four motions: errors against a run near rounding.
//!
//! A backend is held by its row in the table of the command line, so a new one is tested by being there.

use fastbike::backend::{ALGEBRAIC, INTEGRATION, IntegrationBackend, Integrator, Steps};
use fastbike::comparison::{Contender, Motion, Settings, sweeps};
use fastbike::output::comparison::Row as Compared;
use fastbike::{maneuver, motion};
use problem::{Derivatives, LinearSolver};
use validation::course::system;
use validation::evidence::Row;
use validation::vehicle::{leaning, running};

/// Rows of the table.
pub const EVIDENCE: &[Row] = validation::evidence![
    motions_by_every_integrator_agree => (
        "every integrator in every form that it accepts (three formulations of constraints; explicit) follows the benchmark bicycle, Andrews' mechanism, \
         moto11 with a step of steering torque and the begin of ref11's lane change with its rider",
        "the pair of order 8 at a tolerance of 1e-11",
        "relative tolerance 1e-6: errors in nominal values below 1e-3 (5e-3 for Andrews' mechanism, whose multipliers are of the size of its accelerations), since local errors \
         add up over the motion; twenty times that for order two, 0.2 for order one with steps that suit the motion"
    ),
    exact_matrices_and_differences_lead_to_the_same_motion => (
        "integrators that ask for matrices follow the same motion with exact ones and with difference quotients, the explicit form's included",
        "identity",
        "relative tolerance 1e-6: both errors below the same bound"
    ),
    every_linear_solver_leads_to_the_same_motion => (
        "integrators that know a linear solver without matrices follow the same motions by it, in every form, with exact products and with difference quotients",
        "the pair of order 8 at a tolerance of 1e-11",
        "relative tolerance 1e-6: errors below the bounds of matrices"
    ),
    steady_states_by_every_solver_agree => (
        "every solver of algebraic systems finds the same steady turns of moto11, ref11 and gsxr1000, from 10 to 50 m/s and to 29 degrees",
        "KINSOL with line search",
        "1e-7 in nominal values: all end below a residual of 1e-9"
    ),
];

/// A motion and the step that suits it, s.
struct Case {
    model: &'static str,
    maneuver: Option<&'static str>,
    speed: Option<f64>,
    given: &'static [&'static str],
    duration: f64,
    step: f64,
    /// Error allowed at a relative tolerance of 1e-6.
    allowed: f64,
}

const CASES: [Case; 4] = [
    Case { model: "whipple", maneuver: None, speed: None, given: &["chassis.roll_rate=0.05"], duration: 0.5, step: 5e-3, allowed: 1e-3 },
    Case { model: "andrews_squeezer", maneuver: None, speed: None, given: &[], duration: 4e-3, step: 5e-6, allowed: 5e-3 },
    Case { model: "moto11", maneuver: None, speed: Some(30.0), given: &["steer.torque=10"], duration: 0.2, step: 1e-3, allowed: 1e-3 },
    Case { model: "ref11", maneuver: Some("lane_change"), speed: None, given: &[], duration: 0.05, step: 1e-3, allowed: 1e-3 },
];

impl Case {
    /// All contenders at one tolerance, or one step.
    fn compared(&self, contenders: &[Contender]) -> Vec<Compared> {
        let system = system(self.model);
        let maneuver = self.maneuver.map(|name| (name, maneuver::read(name, &[]).unwrap_or_else(|_| panic!("a bundled maneuver"))));
        let speed = maneuver.as_ref().map(|(_, m)| m.course.speed.first()).or(self.speed);
        let request = motion::Request {
            times: (0..=10).map(|k| 0.1 * self.duration * f64::from(k)).collect(),
            relative_tolerance: 1e-6,
            backend: String::new(),
            formulation: None,
            derivatives: Derivatives::Exact,
            linear_solver: LinearSolver::Direct,
            fixed_step: self.step,
            steady: speed.map(|speed| running(&[speed])),
            given: self.given.iter().map(|given| (*given).to_owned()).collect(),
            signals: None,
            until: Vec::new(),
            interrupt: None,
            record: Vec::new(),
            keep: None,
        };
        let motion = Motion { request, system: &system, model: self.model, maneuver };
        let settings = Settings { tolerances: vec![1e-6], steps: vec![self.step], repeats: 1 };
        motion.compare(contenders, &settings).unwrap_or_else(|_| panic!("`{}` cannot start", self.model)).rows
    }

    /// Holds every row to what its method promises.
    fn hold(&self, contenders: &[Contender]) {
        let rows = self.compared(contenders);
        assert_eq!(rows.len(), contenders.len());
        let allowed = |row: &Compared| match row.backend.as_str() {
            "linear_euler" => 0.2,
            "ros2" | "generalized_alpha" => 20.0 * self.allowed,
            _ => self.allowed,
        };
        rows.iter().for_each(|row| println!("{}: {}", self.model, told(row)));
        let wrong: Vec<String> =
            rows.iter().filter(|row| row.because.is_some() || row.error.is_nan() || row.error > allowed(row)).map(told).collect();
        assert!(wrong.is_empty(), "{}:\n{}", self.model, wrong.join("\n"));
    }
}

fn told(row: &Compared) -> String {
    let because = row.because.as_deref().unwrap_or("reached the end");
    format!(
        "{} on {}, {} derivatives, {} linear solver: error {:.1e}, {because}",
        row.backend, row.form, row.jacobian, row.linear_solver, row.error
    )
}

/// A backend in every form that it accepts.
fn forms(backend: &'static IntegrationBackend, derivatives: Derivatives, linear_solver: LinearSolver) -> Vec<Contender> {
    let of = |formulation| Contender { backend, formulation, derivatives, linear_solver };
    match backend.make {
        Integrator::Implicit(_) => motion::FORMULATIONS.iter().map(|f| of(Some(f.name().to_owned()))).collect(),
        Integrator::Explicit(_) => vec![of(None)],
    }
}

#[test]
fn motions_by_every_integrator_agree() {
    let all: Vec<Contender> = INTEGRATION.iter().flat_map(|backend| forms(backend, Derivatives::Exact, LinearSolver::Direct)).collect();
    CASES.iter().for_each(|case| case.hold(&all));
}

#[test]
fn every_linear_solver_leads_to_the_same_motion() {
    let solvers = |backend: &'static IntegrationBackend| backend.linear_solvers.iter().skip(1).map(move |linear| (backend, *linear));
    let ways = [Derivatives::Exact, Derivatives::Differences];
    let of = |(backend, linear)| ways.iter().flat_map(move |&derivatives| forms(backend, derivatives, linear));
    let all: Vec<Contender> = INTEGRATION.iter().flat_map(solvers).flat_map(of).collect();
    assert!(!all.is_empty());
    CASES.iter().for_each(|case| case.hold(&all));
}

#[test]
fn exact_matrices_and_differences_lead_to_the_same_motion() {
    let asking = INTEGRATION.iter().filter(|backend| !backend.linear_solvers.is_empty() && backend.steps == Steps::Variable);
    let all: Vec<Contender> = asking.flat_map(|backend| forms(backend, Derivatives::Differences, LinearSolver::Direct)).collect();
    CASES.iter().filter(|case| case.maneuver.is_none()).for_each(|case| case.hold(&all));
}

#[test]
fn steady_states_by_every_solver_agree() {
    let names: Vec<String> = ALGEBRAIC.iter().map(|backend| backend.name.to_owned()).collect();
    let request = leaning(&[10.0, 20.0, 35.0, 50.0], &[0.0, 0.2, 0.5]);
    for model in ["moto11", "ref11", "gsxr1000"] {
        let compared = sweeps(&request, &system(model), model, &names, 1).unwrap_or_else(|_| panic!("a sweep of `{model}`"));
        for row in &compared.rows {
            let found = format!("{model}, {}: {} of {} missed, {:.1e}", row.backend, row.rejected, row.steps, row.error);
            assert!(row.rejected == 0 && row.error.max(0.0) < 1e-7, "{found}");
        }
    }
}
