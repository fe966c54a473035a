//! Motions over time, by the names of signals: start, integration by either method, energies and drift along the way.

use crate::agreement::{Agreement, absolute};
use crate::tree::Named;
use crate::vehicle::State;
use analyses::Variables;
use analyses::transient::{Driven, Inputs, Method, Simulation, Start, Transient, Worst};
use fastbike::backend::{Integrator, integration};
use fastbike::library::Source;
use fastbike::standard_kinds;
use mbody::assembly::{BaseDescription, assemble, assemble_urdf};
use mbody::description::Library;
use mbody::dynamics::{Account, Formulation, System, TreePlant};
use mbody::spatial::Vec3;
use problem::{AlgebraicErrors, At, Dae, Integrable, IntegrationOptions};
use std::sync::Arc;

/// A method with its tolerances.
#[derive(Clone, Copy, Debug)]
pub enum By {
    /// Explicit Runge–Kutta with projection; share of each unknown, and of its absolute tolerance.
    Erk(f64, f64),
    /// Implicit multistep on the stabilized form of index 2; tolerances as before.
    Ida(f64, f64),
    /// Backward differentiation of the explicit form with projection; tolerances as before.
    Bdf(f64, f64),
    /// Adams formulas of the explicit form; tolerances as before.
    Adams(f64, f64),
    /// Dormand and Prince's pair on the explicit form with projection; tolerances as before.
    Dopri5(f64, f64),
    /// A row of the command's table of integrators, by name; tolerances as before.
    Named(&'static str, f64, f64),
}

impl By {
    /// The row of the table, relative tolerance, factor of absolute tolerances.
    fn parts(self) -> (&'static str, f64, f64) {
        match self {
            Self::Erk(relative, absolute) => ("erk", relative, absolute),
            Self::Ida(relative, absolute) => ("ida", relative, absolute),
            Self::Bdf(relative, absolute) => ("cvode", relative, absolute),
            Self::Adams(relative, absolute) => ("cvode_adams", relative, absolute),
            Self::Dopri5(relative, absolute) => ("dopri5", relative, absolute),
            Self::Named(name, relative, absolute) => (name, relative, absolute),
        }
    }

    /// Runs a simulation with these tolerances.
    ///
    /// # Panics
    /// It cannot start.
    pub fn run(self, mut transient: Transient, plant: &mut dyn Integrable, inputs: &dyn Inputs) -> Simulation {
        let (name, relative_tolerance, absolute_tolerance_factor) = self.parts();
        let algebraic = AlgebraicErrors::Suppressed;
        transient.options =
            IntegrationOptions { relative_tolerance, absolute_tolerance_factor, max_steps: 50_000, algebraic, ..Default::default() };
        let run = match integration(name).unwrap_or_else(|| panic!("no integrator `{name}`")).make {
            Integrator::Implicit(make) => transient.run(plant, inputs, Method::Dae(make().as_mut())),
            Integrator::Explicit(make) => transient.run(plant, inputs, Method::Ode(make().as_mut())),
        };
        run.unwrap_or_else(|error| panic!("{error}"))
    }
}

/// A motion that was computed.
pub struct Course {
    plant: TreePlant,
    /// What the integration left.
    pub simulation: Simulation,
    u: Vec<f64>,
}

/// A bundled model; the tree of a plain URDF flies freely.
///
/// # Panics
/// It does not assemble.
pub fn system(model: &str) -> Arc<System> {
    let source = Source::find(model).unwrap_or_else(|findings| panic!("{findings}"));
    let (assembled, findings) = match source.is_urdf() {
        true => assemble_urdf(&source.file, &source.text(&source.file).unwrap_or_default(), BaseDescription::Free, 9.81, &[]),
        false => assemble(&source.file, &source, &standard_kinds(), &[]),
    };
    assembled.unwrap_or_else(|| panic!("{model}: {findings}")).system
}

impl Course {
    /// A bundled model from its stated start, where `given` values of unknowns and inputs replace the stated ones.
    ///
    /// # Panics
    /// It does not assemble, or cannot start.
    pub fn of(model: &str, given: &[Named], times: &[f64], by: By) -> Self {
        Self::along(system(model), given, times, by)
    }

    /// The same of a system.
    ///
    /// # Panics
    /// It cannot start.
    pub fn along(system: Arc<System>, given: &[Named], times: &[f64], by: By) -> Self {
        Self::driven(system, given, times, by, None)
    }

    /// The same with inputs that move.
    ///
    /// # Panics
    /// It cannot start.
    pub fn driven(system: Arc<System>, given: &[Named], times: &[f64], by: By, moving: Option<&dyn Inputs>) -> Self {
        let mut plant = TreePlant::in_formulation(system, Formulation::Ggl);
        let mut u: Vec<f64> = plant.inputs().iter().map(|i| i.default).collect();
        let mut held = Vec::new();
        for (name, value) in given {
            match plant.inputs().iter().position(|i| i.signal.name == *name) {
                Some(i) => u[i] = *value,
                None => held.push((unknown(&plant, name), *value)),
            }
        }
        let mut transient = Transient::new(&plant, times.to_vec());
        let mut start = Start::stated(&plant);
        start.hold(&plant, &held);
        transient.start = start;
        let constant = Driven::new(u.clone());
        let simulation = by.run(transient, &mut plant, moving.unwrap_or(&constant));
        Self { plant, simulation, u }
    }

    /// A vehicle from a steady state with the inputs that it needs there, to which `drive` adds.
    ///
    /// # Panics
    /// It cannot start.
    pub fn ride(state: &State, times: &[f64], by: By, drive: impl FnOnce(&TreePlant, &mut Driven)) -> Self {
        let mut plant = TreePlant::in_formulation(state.system.clone(), Formulation::Ggl);
        let (y, u) = state.arguments();
        let mut transient = Transient::new(&plant, times.to_vec());
        transient.start = Start { y: vec![0.0; plant.unknowns().len()], held: vec![false; plant.unknowns().len()] };
        transient.start.y[..y.len()].copy_from_slice(y);
        let mut inputs = Driven::new(u.to_vec());
        drive(&plant, &mut inputs);
        let simulation = by.run(transient, &mut plant, &inputs);
        Self { plant, simulation, u: u.to_vec() }
    }

    /// The plant, in the stabilized form.
    pub fn plant(&mut self) -> &mut TreePlant {
        &mut self.plant
    }

    /// Number of samples.
    pub fn len(&self) -> usize {
        self.simulation.trajectory.len()
    }

    /// Whether there is no sample.
    pub fn is_empty(&self) -> bool {
        self.simulation.trajectory.is_empty()
    }

    /// A signal over the samples.
    ///
    /// # Panics
    /// There is no such signal.
    pub fn signal(&self, name: &str) -> &[f64] {
        self.simulation.trajectory.column(name).unwrap_or_else(|| {
            panic!("no signal `{name}` among {:?}", self.simulation.trajectory.signals.iter().map(|s| &s.name).collect::<Vec<_>>())
        })
    }

    /// All unknowns at a sample.
    pub fn unknowns(&self, sample: usize) -> Vec<f64> {
        (0..self.plant.unknowns().len()).map(|i| self.simulation.trajectory.columns[i][sample]).collect()
    }

    fn at<T>(&mut self, sample: usize, look: impl FnOnce(&mut TreePlant, At<'_>) -> T) -> T {
        let (y, time) = (self.unknowns(sample), self.simulation.trajectory.time[sample]);
        let yd = vec![0.0; y.len()];
        look(&mut self.plant, At { time, y: &y, yd: &yd, u: &self.u })
    }

    /// Energy account at a sample.
    pub fn account(&mut self, sample: usize) -> Account<f64> {
        self.at(sample, |plant, at| plant.account_at(at))
    }

    /// Kinetic energy, potential energy of gravity and what elements store, J, over the samples.
    pub fn energies(&mut self) -> Vec<f64> {
        let total = |a: Account<f64>| a.kinetic + a.gravity + a.elements.stored;
        (0..self.len()).map(|sample| total(self.account(sample))).collect()
    }

    /// Position of a point of a link in the world at a sample, m.
    ///
    /// # Panics
    /// There is no such link.
    pub fn position(&mut self, sample: usize, link: &str, point: [f64; 3]) -> Vec3<f64> {
        self.at(sample, |plant, at| {
            let frame = plant.system().model().frame(link).unwrap_or_else(|| panic!("no link `{link}`")).clone();
            plant.evaluate_at(at).tree.world.X_WB[frame.body.get()].point(frame.X_BF.point(point.into()))
        })
    }

    /// The whole time was reached, and the constraints held on the way to 1e-9 m, rad, and per second.
    pub fn holds(&self, agreement: &mut Agreement, what: &str) {
        let ending = &self.simulation.ending;
        agreement.holds(&format!("{what} reaches its end: {ending:?}"), ending.reached());
        let stabilized = absolute(1e-9).because("projection, or stabilization at the tolerance of the method");
        for (level, worst) in [("coordinates", &self.simulation.drift.position), ("velocities", &self.simulation.drift.velocity)] {
            if let Some(Worst { off, time }) = worst {
                agreement.near(&format!("{what}: drift of {level}, {off}, at {time} s"), off.by, 0.0, &stabilized);
            }
        }
    }
}

fn unknown(plant: &TreePlant, name: &str) -> usize {
    let all = Variables::of(plant);
    match all.find(name) {
        Some(analyses::Variable::Unknown(i)) => i,
        _ => panic!("no unknown `{name}`"),
    }
}
