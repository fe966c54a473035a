//! A plant as `ẏ = f(t, y)` of its differential unknowns, on the manifold of its constraints.

use super::SharedPlant;
use super::acting::{Acting, Observer};
use super::differences::{Differences, Directional};
use super::watch::Watch;
use problem::contract::finite;
use problem::{At, Derivatives, EquationKind, EvalError, Integrable, Matrix, OdeProblem, Off, ProjectionError, Seeds, UnknownKind};

/// All unknowns of a plant around the states of its explicit form.
pub(super) struct Whole<'a, 'p> {
    plant: &'a SharedPlant<'p>,
    acting: &'a Acting<'a>,
    /// Indices of the differential unknowns: the states.
    states: Vec<usize>,
    /// The row that belongs to each state: rate of a coordinate, equation of motion, row of an element.
    rows: Vec<usize>,
    y: Vec<f64>,
    yd: Vec<f64>,
    u: Vec<f64>,
    /// Time of the point that was completed last, while y and ẏ are still those of it.
    completed: Option<f64>,
}

impl<'a, 'p> Whole<'a, 'p> {
    /// Starts from a consistent point.
    pub(super) fn new(plant: &'a SharedPlant<'p>, acting: &'a Acting<'a>, y: &[f64], yd: &[f64]) -> Self {
        let p = plant.borrow();
        let states: Vec<usize> = (0..y.len()).filter(|&i| p.unknowns()[i].differential).collect();
        let row = |state: usize| {
            let unknown = p.unknowns()[state].kind;
            let kind = match unknown {
                UnknownKind::Position => EquationKind::Kinematic,
                UnknownKind::Velocity => EquationKind::Dynamic,
                UnknownKind::State | UnknownKind::Algebraic => EquationKind::Element,
            };
            // rows follow the unknowns of their kind in order
            let nth = p.unknowns()[..state].iter().filter(|u| u.kind == unknown).count();
            let rows = p.equations().iter().enumerate().filter(|(_, e)| e.kind == kind);
            rows.map(|(i, _)| i).nth(nth).unwrap_or_default()
        };
        let rows = states.iter().map(|&i| row(i)).collect();
        let (y, yd, u) = (y.to_vec(), yd.to_vec(), vec![0.0; p.inputs().len()]);
        Self { plant, acting, states, rows, y, yd, u, completed: None }
    }

    /// Completes the states by multipliers and rates: all of y and ẏ.
    pub(super) fn complete(&mut self, time: f64, states: &[f64]) -> Result<(&[f64], &[f64]), EvalError> {
        if self.is_completed(time, states) {
            return Ok((&self.y, &self.yd));
        }
        self.scatter(time, states);
        self.plant.borrow_mut().solve_rates(time, &mut self.y, &self.u, &mut self.yd)?;
        if finite(&self.yd).is_err()
            && let Some(k) = self.states.iter().position(|&i| !self.yd[i].is_finite())
        {
            return Err(EvalError::Recoverable { equation: self.rows[k] });
        }
        self.completed = Some(time);
        Ok((&self.y, &self.yd))
    }

    /// Writes the rates of the states.
    fn rates(&mut self, time: f64, states: &[f64], rates: &mut [f64]) -> Result<(), EvalError> {
        self.complete(time, states)?;
        rates.iter_mut().zip(&self.states).for_each(|(rate, &i)| *rate = self.yd[i]);
        Ok(())
    }

    /// The next point is completed anew, even if it is the last one.
    pub(super) fn forget(&mut self) {
        self.completed = None;
    }

    /// Whether y and ẏ are those of a point.
    fn is_completed(&self, time: f64, states: &[f64]) -> bool {
        self.completed == Some(time) && self.states.iter().zip(states).all(|(&i, x)| self.y[i] == *x)
    }

    fn scatter(&mut self, time: f64, states: &[f64]) {
        self.completed = None;
        self.acting.at(time, &mut self.u);
        for (&i, &x) in self.states.iter().zip(states) {
            self.y[i] = x;
        }
    }
}

/// What ∂f/∂y comes from.
enum Tangent {
    /// One direction per state or one alone, and the derivatives of all rates along them.
    Exact { all: (Seeds, Matrix), one: (Seeds, Matrix) },
    /// Rates beside the point.
    Differences { columns: Differences, along: Directional },
}

impl Tangent {
    fn new(plant: &dyn Integrable, states: &[usize], derivatives: Derivatives) -> Self {
        match derivatives {
            Derivatives::Exact => {
                let (n, m) = (plant.unknowns().len(), states.len());
                let directions = |count| (Seeds::zeros(n, plant.inputs().len(), count), Matrix::zeros(n, count));
                let (mut all, one) = (directions(m), directions(1));
                states.iter().enumerate().for_each(|(k, &i)| all.0.y[(i, k)] = 1.0);
                Self::Exact { all, one }
            }
            Derivatives::Differences => {
                let nominal: Vec<f64> = states.iter().map(|&i| plant.unknowns()[i].nominal).collect();
                let kinds = states.iter().map(|&i| plant.unknowns()[i].kind as usize).collect();
                let along = Directional::new(nominal.clone(), kinds, states.len());
                Self::Differences { columns: Differences::new(nominal, states.len()), along }
            }
        }
    }
}

/// The explicit form of a plant and its inputs.
pub(super) struct ExplicitForm<'a, 'p> {
    whole: Whole<'a, 'p>,
    watch: &'a Watch,
    observer: Observer<'a, 'p>,
    absolute_tolerance: Vec<f64>,
    tangent: Tangent,
    /// Why the last evaluation failed.
    failure: Option<EvalError>,
    /// Rows that the last projection could not satisfy.
    off: Vec<Off>,
}

impl<'a, 'p> ExplicitForm<'a, 'p> {
    /// Starts from a consistent point.
    pub(super) fn new(
        plant: &'a SharedPlant<'p>,
        acting: &'a Acting<'a>,
        watch: &'a Watch,
        (y, yd): (&[f64], &[f64]),
        derivatives: Derivatives,
    ) -> Self {
        let whole = Whole::new(plant, acting, y, yd);
        let observer = Observer::new(plant, acting);
        let p = plant.borrow();
        let absolute_tolerance = whole.states.iter().map(|&i| p.unknowns()[i].absolute_tolerance).collect();
        let tangent = Tangent::new(&**p, &whole.states, derivatives);
        drop(p);
        Self { whole, watch, observer, absolute_tolerance, tangent, failure: None, off: Vec::new() }
    }

    /// Evaluations of rates for difference quotients.
    pub(super) fn evaluations(&self) -> usize {
        match &self.tangent {
            Tangent::Exact { .. } => 0,
            Tangent::Differences { columns, along } => columns.evaluations + along.evaluations,
        }
    }

    /// The states among all unknowns.
    pub(super) fn states(&self) -> &[usize] {
        &self.whole.states
    }

    /// The next point is evaluated anew, even if it is the last one.
    pub(super) fn forget(&mut self) {
        self.whole.forget();
    }

    /// Why the last evaluation failed, if it did.
    pub(super) fn failure(&self) -> Option<EvalError> {
        self.failure
    }

    /// Rows that the last projection could not satisfy, worst first; empty where it succeeded.
    pub(super) fn off(&self) -> &[Off] {
        &self.off
    }
}

impl OdeProblem for ExplicitForm<'_, '_> {
    fn size(&self) -> usize {
        self.whole.states.len()
    }
    fn absolute_tolerance(&self) -> &[f64] {
        &self.absolute_tolerance
    }
    fn rates(&mut self, time: f64, y: &[f64], yd: &mut [f64]) -> Result<(), EvalError> {
        let completed = self.whole.rates(time, y, yd);
        self.failure = completed.err();
        completed
    }
    fn jacobian(&mut self, time: f64, y: &[f64], jacobian: &mut Matrix) -> Result<(), EvalError> {
        let whole = &mut self.whole;
        let differentiated = match &mut self.tangent {
            Tangent::Exact { all: (seeds, solved), .. } => whole.complete(time, y).map(|_| ()).and_then(|()| {
                let at = At { time, y: &whole.y, yd: &whole.yd, u: &whole.u };
                whole.plant.borrow_mut().rates_along(at, seeds, solved)?;
                for k in 0..whole.states.len() {
                    for (entry, &i) in jacobian.column_mut(k).iter_mut().zip(&whole.states) {
                        *entry = solved[(i, k)];
                    }
                }
                Ok(())
            }),
            Tangent::Differences { columns, .. } => columns.quotients(y, |y, _, rates| whole.rates(time, y, rates), jacobian),
        };
        self.failure = differentiated.err();
        differentiated
    }
    fn product(&mut self, time: f64, y: &[f64], v: &[f64], product: &mut [f64]) -> Result<(), EvalError> {
        let whole = &mut self.whole;
        let differentiated = match &mut self.tangent {
            Tangent::Exact { one: (seeds, solved), .. } => whole.complete(time, y).map(|_| ()).and_then(|()| {
                whole.states.iter().zip(v).for_each(|(&i, v)| seeds.y[(i, 0)] = *v);
                let at = At { time, y: &whole.y, yd: &whole.yd, u: &whole.u };
                whole.plant.borrow_mut().rates_along(at, seeds, solved)?;
                product.iter_mut().zip(&whole.states).for_each(|(entry, &i)| *entry = solved[(i, 0)]);
                Ok(())
            }),
            Tangent::Differences { along, .. } => along.product(y, v, |y, rates| whole.rates(time, y, rates), product),
        };
        self.failure = differentiated.err();
        differentiated
    }
    fn project(&mut self, time: f64, y: &mut [f64]) -> Result<(), EvalError> {
        let whole = &mut self.whole;
        // a point that stays where it is keeps its rates
        let completed = whole.is_completed(time, y).then_some(time);
        whole.scatter(time, y);
        let projected = whole.plant.borrow_mut().project(time, &mut whole.y, &whole.u, &[]);
        self.off.clear();
        match projected {
            Ok(()) => {
                whole.completed = completed.filter(|_| y.iter().zip(&whole.states).all(|(state, &i)| *state == whole.y[i]));
                for (state, &i) in y.iter_mut().zip(&whole.states) {
                    *state = whole.y[i];
                }
                Ok(())
            }
            Err(ProjectionError::Evaluation(e)) => {
                self.failure = Some(e);
                Err(e)
            }
            // the step was too long to find back from; a shorter one may end nearer
            Err(ProjectionError::Open { rows } | ProjectionError::Velocity { rows }) => {
                self.off = rows;
                Err(EvalError::Recoverable { equation: whole.rows.first().copied().unwrap_or_default() })
            }
        }
    }
    fn event_count(&self) -> usize {
        self.watch.count()
    }
    fn events(&mut self, time: f64, y: &[f64], values: &mut [f64]) -> Result<(), EvalError> {
        let point = self.whole.complete(time, y);
        let watched = point.and_then(|point| self.watch.values(&mut self.observer, time, point, values));
        self.failure = watched.err();
        watched
    }
}
