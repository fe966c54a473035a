//! A plant and its controllers, which together are a plant again.
//!
//! ```text
//! 0 = F(t, y, ẏ, u)      plant
//! u_c = c(t, z, x)       commanded inputs, from measured unknowns z of the plant and states x of the controllers
//! ẋ = f(t, z, x)         controllers
//! ```
//!
//! The unknowns are those of the plant, then x; the rows those of the plant, then `ẋ − f`; the inputs those that nobody commands; the
//! outputs those of the plant, then the commanded inputs under their names, then those of the controllers. Coordinates that a controller
//! reads are no longer cyclic. Commands depend on differential unknowns only, so there is no algebraic loop, and the chain rule
//! through `c` makes the derivatives exact.

mod wire;

use problem::{
    At, Controller, Dae, Differentiable, Equation, EquationKind, EvalError, Explicit, Input, Limit, Limits, Matrix, Outputs, Plant,
    Projection, ProjectionError, Seeds, Signal, Unknown, UnknownKind,
};
use thiserror::Error;
use wire::Wire;

/// Why a plant and controllers do not go together.
#[derive(Clone, Debug, PartialEq, Eq, Error)]
pub enum LoopError {
    /// A controller reads a signal that is not there.
    #[error("a controller measures `{signal}`, which is no signal of this model")]
    UnknownMeasured {
        /// The name.
        signal: String,
        /// What could be measured.
        known: Vec<String>,
    },
    /// A controller reads something that follows from commands at once.
    #[error("a controller measures `{signal}`; it can measure coordinates, velocities and states, not what follows from forces at once")]
    Unmeasurable {
        /// The name.
        signal: String,
    },
    /// A controller commands an input that is not there.
    #[error("a controller commands `{input}`, which is no input of this model")]
    UnknownCommanded {
        /// The name.
        input: String,
        /// What could be commanded.
        known: Vec<String>,
    },
    /// An input has two masters.
    #[error("two controllers command `{input}`")]
    CommandedTwice {
        /// The name.
        input: String,
    },
    /// A signal of a controller has the name of another signal.
    #[error("a controller calls a signal `{signal}`, but there is one of this name")]
    NameTaken {
        /// The name.
        signal: String,
    },
}

/// A plant under the command of controllers.
pub struct ClosedLoop<P> {
    plant: P,
    wires: Vec<Wire>,
    unknowns: Vec<Unknown>,
    equations: Vec<Equation>,
    inputs: Vec<Input>,
    outputs: Vec<Signal>,
    limits: Vec<Limit>,
    /// Where each input of the closed loop stands among those of the plant.
    free: Vec<usize>,
    /// All inputs of the plant.
    u: Vec<f64>,
    /// Directions of the plant and derivatives along them, for the number of columns asked for last.
    directions: Directions,
}

/// Work arrays of derivatives.
struct Directions {
    seeds: Seeds,
    residual: Matrix,
    outputs: Matrix,
    solved: Matrix,
}

impl Directions {
    fn of(plant: &dyn Plant, columns: usize) -> Self {
        Self {
            seeds: Seeds::zeros(plant.unknowns().len(), plant.inputs().len(), columns),
            residual: Matrix::zeros(plant.equations().len(), columns),
            outputs: Matrix::zeros(plant.outputs().len(), columns),
            solved: Matrix::zeros(plant.unknowns().len(), columns),
        }
    }
}

impl<P: Plant> ClosedLoop<P> {
    /// Closes the loop.
    ///
    /// # Errors
    /// A name that is not there or taken, a signal that cannot be measured, an input with two masters.
    pub fn new(plant: P, controllers: Vec<Box<dyn Controller>>) -> Result<Self, LoopError> {
        let (mut unknowns, mut equations) = (plant.unknowns().to_vec(), plant.equations().to_vec());
        let mut outputs = plant.outputs().to_vec();
        let mut limits = plant.limits().to_vec();
        let mut wires: Vec<Wire> = Vec::new();
        for controller in controllers {
            let first = (unknowns.len(), equations.len());
            for state in controller.states() {
                unknowns.push(Unknown { kind: UnknownKind::State, cyclic: false, differential: true, ..state.clone() });
                equations.push(rate_of(state));
            }
            limits.extend_from_slice(controller.limits());
            let wire = Wire::new(controller, first, &plant)?;
            if let Some(&twice) = wire.commanded.iter().find(|&&i| wires.iter().any(|w| w.commanded.contains(&i))) {
                return Err(LoopError::CommandedTwice { input: plant.inputs()[twice].signal.name.clone() });
            }
            // whoever reads a coordinate lets the motion depend on it
            for (reads, unknown) in unknowns.iter_mut().enumerate() {
                unknown.cyclic &= !wire.measured.contains(&reads);
            }
            wires.push(wire);
        }
        for wire in &mut wires {
            wire.first_command = outputs.len();
            outputs.extend(wire.commanded.iter().map(|&i| plant.inputs()[i].signal.clone()));
        }
        for wire in &mut wires {
            wire.first_output = outputs.len();
            outputs.extend_from_slice(wire.controller.outputs());
        }
        let free: Vec<usize> = (0..plant.inputs().len()).filter(|i| !wires.iter().any(|w| w.commanded.contains(i))).collect();
        let inputs: Vec<Input> = free.iter().map(|&i| plant.inputs()[i].clone()).collect();
        // a rate that a controller commands is no input any longer
        let renamed = |input: Input| Input { rate: input.rate.and_then(|rate| free.iter().position(|&i| i == rate)), ..input };
        let inputs = inputs.into_iter().map(renamed).collect();
        let (u, directions) = (plant.inputs().iter().map(|i| i.default).collect(), Directions::of(&plant, 0));
        let closed = Self { plant, wires, unknowns, equations, inputs, outputs, limits, free, u, directions };
        match closed.taken() {
            Some(signal) => Err(LoopError::NameTaken { signal }),
            None => Ok(closed),
        }
    }

    /// A name that two signals have, one of them of a controller.
    fn taken(&self) -> Option<String> {
        let inputs = self.inputs.iter().map(|i| &i.signal.name);
        let mut names: Vec<&String> = self.unknowns.iter().map(|u| &u.signal.name).chain(inputs).collect();
        names.extend(self.outputs.iter().map(|s| &s.name));
        names.sort_unstable();
        let own = |name: &&String| self.wires.iter().any(|w| w.calls(name));
        names.windows(2).filter(|pair| pair[0] == pair[1]).map(|pair| pair[0]).find(own).cloned()
    }

    /// The plant under command.
    pub fn plant(&self) -> &P {
        &self.plant
    }

    /// The plant under command.
    pub fn plant_mut(&mut self) -> &mut P {
        &mut self.plant
    }

    /// Times at which controllers jump or have a corner, s.
    pub fn breaks(&self) -> Vec<f64> {
        self.wires.iter().flat_map(|w| w.controller.breaks()).collect()
    }

    /// All inputs of the plant at the point evaluated last: those given and those commanded.
    pub fn plant_inputs(&self) -> &[f64] {
        &self.u
    }

    /// Lets all controllers answer and collects the inputs of the plant.
    fn command(&mut self, time: f64, y: &[f64], u: &[f64]) -> Result<(), EvalError> {
        for (&i, &value) in self.free.iter().zip(u) {
            self.u[i] = value;
        }
        for wire in &mut self.wires {
            wire.answer(time, y)?;
            wire.give(&mut self.u);
        }
        Ok(())
    }

    /// The same with the directions of the plant.
    fn command_along(&mut self, at: At<'_>, seeds: &Seeds) -> Result<(), EvalError> {
        if self.directions.seeds.columns() != seeds.columns() {
            self.directions = Directions::of(&self.plant, seeds.columns());
        }
        let d = &mut self.directions.seeds;
        for k in 0..seeds.columns() {
            let ny = d.y.rows();
            d.y.column_mut(k).copy_from_slice(&seeds.y.column(k)[..ny]);
            d.yd.column_mut(k).copy_from_slice(&seeds.yd.column(k)[..ny]);
            for (&i, &value) in self.free.iter().zip(seeds.u.column(k)) {
                d.u[(i, k)] = value;
            }
        }
        for (&i, &value) in self.free.iter().zip(at.u) {
            self.u[i] = value;
        }
        for wire in &mut self.wires {
            wire.answer_along(at.time, at.y, &seeds.y)?;
            wire.give(&mut self.u);
            wire.give_along(&mut d.u);
        }
        Ok(())
    }
}

/// The row `ẋ − f` of a state of a controller.
fn rate_of(state: &Unknown) -> Equation {
    Equation {
        name: format!("rate of {}", state.signal.name),
        unit: format!("{}/s", state.signal.unit).into(),
        nominal: state.nominal,
        kind: EquationKind::Element,
    }
}

impl<P: Plant> Dae for ClosedLoop<P> {
    fn unknowns(&self) -> &[Unknown] {
        &self.unknowns
    }
    fn equations(&self) -> &[Equation] {
        &self.equations
    }
    fn inputs(&self) -> &[Input] {
        &self.inputs
    }
    fn residual(&mut self, at: At<'_>, residual: &mut [f64]) -> Result<(), EvalError> {
        self.command(at.time, at.y, at.u)?;
        let (ny, nf) = (self.plant.unknowns().len(), self.plant.equations().len());
        let (of_plant, own) = residual.split_at_mut(nf);
        self.wires.iter().for_each(|wire| wire.rows(&at.yd[ny..], own));
        self.plant.residual(At { time: at.time, y: &at.y[..ny], yd: &at.yd[..ny], u: &self.u }, of_plant)
    }
}

impl<P: Plant> Outputs for ClosedLoop<P> {
    fn outputs(&self) -> &[Signal] {
        &self.outputs
    }
    fn evaluate(&mut self, at: At<'_>, residual: &mut [f64], outputs: &mut [f64]) -> Result<(), EvalError> {
        self.command(at.time, at.y, at.u)?;
        let (ny, nf, nz) = (self.plant.unknowns().len(), self.plant.equations().len(), self.plant.outputs().len());
        let (of_plant, own) = residual.split_at_mut(nf);
        self.wires.iter().for_each(|wire| wire.rows(&at.yd[ny..], own));
        self.wires.iter().for_each(|wire| wire.tell(outputs));
        let at = At { time: at.time, y: &at.y[..ny], yd: &at.yd[..ny], u: &self.u };
        self.plant.evaluate(at, of_plant, &mut outputs[..nz])
    }
    fn observe(&mut self, at: At<'_>, residual: &mut [f64], outputs: &mut [f64]) -> Result<(), EvalError> {
        self.command(at.time, at.y, at.u)?;
        let (ny, nf, nz) = (self.plant.unknowns().len(), self.plant.equations().len(), self.plant.outputs().len());
        self.wires.iter().for_each(|wire| wire.tell(outputs));
        let at = At { time: at.time, y: &at.y[..ny], yd: &at.yd[..ny], u: &self.u };
        self.plant.observe(at, &mut residual[..nf], &mut outputs[..nz])
    }
}

impl<P: Plant> Differentiable for ClosedLoop<P> {
    fn along(
        &mut self,
        at: At<'_>,
        seeds: &Seeds,
        values: (&mut [f64], &mut [f64]),
        residual: &mut Matrix,
        outputs: &mut Matrix,
    ) -> Result<(), EvalError> {
        self.command_along(at, seeds)?;
        let (ny, nf, nz) = (self.plant.unknowns().len(), self.plant.equations().len(), self.plant.outputs().len());
        let (of_plant, own) = values.0.split_at_mut(nf);
        self.wires.iter().for_each(|wire| wire.rows(&at.yd[ny..], own));
        self.wires.iter().for_each(|wire| wire.tell(values.1));
        for k in 0..seeds.columns() {
            let (rows, signals) = (&mut residual.column_mut(k)[nf..], outputs.column_mut(k));
            self.wires.iter().for_each(|wire| wire.rows_along(k, &seeds.yd.column(k)[ny..], rows));
            self.wires.iter().for_each(|wire| wire.tell_along(k, signals));
        }
        let at = At { time: at.time, y: &at.y[..ny], yd: &at.yd[..ny], u: &self.u };
        let d = &mut self.directions;
        let differentiated = self.plant.along(at, &d.seeds, (of_plant, &mut values.1[..nz]), &mut d.residual, &mut d.outputs);
        for k in 0..seeds.columns() {
            residual.column_mut(k)[..nf].copy_from_slice(d.residual.column(k));
            outputs.column_mut(k)[..nz].copy_from_slice(d.outputs.column(k));
        }
        differentiated
    }
}

impl<P: Plant> Limits for ClosedLoop<P> {
    fn limits(&self) -> &[Limit] {
        &self.limits
    }
}

impl<P: Projection> Projection for ClosedLoop<P> {
    /// As the plant does, under the commands at the point before it is moved.
    fn project(&mut self, time: f64, y: &mut [f64], u: &[f64], held: &[bool]) -> Result<(), ProjectionError> {
        self.command(time, y, u).map_err(ProjectionError::Evaluation)?;
        let ny = self.plant.unknowns().len();
        self.plant.project(time, &mut y[..ny], &self.u, held.get(..ny).unwrap_or_default())
    }

    fn independence(&mut self, time: f64, y: &[f64], u: &[f64]) -> f64 {
        match self.command(time, y, u) {
            Ok(()) => self.plant.independence(time, &y[..self.plant.unknowns().len()], &self.u),
            Err(_) => f64::NAN,
        }
    }
}

impl<P: Explicit> Explicit for ClosedLoop<P> {
    fn solve_rates(&mut self, time: f64, y: &mut [f64], u: &[f64], yd: &mut [f64]) -> Result<(), EvalError> {
        self.command(time, y, u)?;
        let ny = self.plant.unknowns().len();
        self.wires.iter().for_each(|wire| wire.rates(&mut yd[ny..]));
        self.plant.solve_rates(time, &mut y[..ny], &self.u, &mut yd[..ny])
    }
    fn rates_along(&mut self, at: At<'_>, seeds: &Seeds, solved: &mut Matrix) -> Result<(), EvalError> {
        self.command_along(at, seeds)?;
        let ny = self.plant.unknowns().len();
        let d = &mut self.directions;
        let at = At { time: at.time, y: &at.y[..ny], yd: &at.yd[..ny], u: &self.u };
        self.plant.rates_along(at, &d.seeds, &mut d.solved)?;
        for k in 0..seeds.columns() {
            let (of_plant, own) = solved.column_mut(k).split_at_mut(ny);
            of_plant.copy_from_slice(d.solved.column(k));
            self.wires.iter().for_each(|wire| wire.rates_along(k, own));
        }
        Ok(())
    }
}
