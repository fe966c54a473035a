//! A plant as `0 = F(t, y, ẏ)` with rows in units of their nominal values.

use super::SharedPlant;
use super::acting::{Acting, Observer};
use super::diagnosis::{TOLD, off};
use super::differences::{Differences, Directional};
use super::watch::Watch;
use problem::{At, DaeProblem, Derivatives, EvalError, IntegrationOptions, Matrix, Off, Seeds};

/// The implicit form of a plant and its inputs.
pub(super) struct Implicit<'a, 'p> {
    plant: &'a SharedPlant<'p>,
    acting: &'a Acting<'a>,
    watch: &'a Watch,
    observer: Observer<'a, 'p>,
    differential: Vec<bool>,
    absolute_tolerance: Vec<f64>,
    nominal: Vec<f64>,
    u: Vec<f64>,
    outputs: Vec<f64>,
    /// Residual of the last evaluation, SI units.
    last: Vec<f64>,
    /// Why the last evaluation failed.
    failure: Option<EvalError>,
    seeds: Seeds,
    /// The c that the seeds are set for.
    seeded: Option<f64>,
    d_residual: Matrix,
    d_outputs: Matrix,
    /// One direction and the derivatives along it.
    along: (Seeds, Matrix, Matrix),
    differences: Option<Differences>,
    yd: Vec<f64>,
    directional: Option<Directional>,
    /// y over ẏ: a point and a direction.
    stacked: (Vec<f64>, Vec<f64>),
}

impl<'a, 'p> Implicit<'a, 'p> {
    pub(super) fn new(
        plant: &'a SharedPlant<'p>,
        acting: &'a Acting<'a>,
        watch: &'a Watch,
        options: &IntegrationOptions,
        algebraic_factor: f64,
    ) -> Self {
        let observer = Observer::new(plant, acting);
        let p = plant.borrow();
        let (ny, nf, nu, nz) = (p.unknowns().len(), p.equations().len(), p.inputs().len(), p.outputs().len());
        // the method multiplies all of them by the factor of the options
        let share = algebraic_factor / options.absolute_tolerance_factor.max(f64::MIN_POSITIVE);
        let mut seeds = Seeds::zeros(ny, nu, ny);
        let quotients = options.derivatives == Derivatives::Differences;
        let nominal: Vec<f64> = p.unknowns().iter().map(|u| u.nominal).collect();
        let kinds = || p.unknowns().iter().map(|u| u.kind as usize);
        // unknowns and rates of each kind by themselves
        let groups = kinds().map(|kind| 2 * kind).chain(kinds().map(|kind| 2 * kind + 1)).collect();
        (0..ny).for_each(|i| seeds.y[(i, i)] = 1.0);
        Self {
            plant,
            acting,
            watch,
            observer,
            differential: p.unknowns().iter().map(|u| u.differential).collect(),
            absolute_tolerance: p.unknowns().iter().map(|u| u.absolute_tolerance * if u.differential { 1.0 } else { share }).collect(),
            nominal: p.equations().iter().map(|e| e.nominal).collect(),
            u: vec![0.0; nu],
            outputs: vec![0.0; nz],
            last: vec![0.0; nf],
            failure: None,
            seeds,
            seeded: None,
            d_residual: Matrix::zeros(nf, ny),
            d_outputs: Matrix::zeros(nz, ny),
            along: (Seeds::zeros(ny, nu, 1), Matrix::zeros(nf, 1), Matrix::zeros(nz, 1)),
            directional: quotients.then(|| Directional::new(nominal.repeat(2), groups, nf)),
            differences: quotients.then(|| Differences::new(nominal, nf)),
            yd: vec![0.0; ny],
            stacked: (vec![0.0; 2 * ny], vec![0.0; 2 * ny]),
        }
    }

    /// One direction per unknown: y_i + c ẏ_i. Rates of algebraic unknowns appear nowhere.
    fn seed(&mut self, c: f64) {
        if self.seeded != Some(c) {
            for i in (0..self.differential.len()).filter(|&i| self.differential[i]) {
                self.seeds.yd[(i, i)] = c;
            }
            self.seeded = Some(c);
        }
    }

    /// Evaluations of the residual for difference quotients.
    pub(super) fn evaluations(&self) -> usize {
        let of_columns = self.differences.as_ref().map_or(0, |differences| differences.evaluations);
        of_columns + self.directional.as_ref().map_or(0, |directional| directional.evaluations)
    }

    /// The matrix from residuals beside the point.
    fn quotients(
        &mut self,
        (time, c): (f64, f64),
        (y, yd): (&[f64], &[f64]),
        differences: &mut Differences,
        jacobian: &mut Matrix,
    ) -> Result<(), EvalError> {
        let mut beside = std::mem::take(&mut self.yd);
        let evaluate = |y: &[f64], (j, step): (usize, f64), residual: &mut [f64]| {
            beside.copy_from_slice(yd);
            if self.differential[j] {
                beside[j] += c * step;
            }
            self.residual(time, y, &beside, residual)
        };
        let evaluated = differences.quotients(y, evaluate, jacobian);
        self.yd = beside;
        evaluated
    }

    /// The product of the matrix with v from residuals beside the point.
    fn quotient(
        &mut self,
        (time, c): (f64, f64),
        (y, yd): (&[f64], &[f64]),
        (v, product): (&[f64], &mut [f64]),
        directional: &mut Directional,
    ) -> Result<(), EvalError> {
        let n = y.len();
        let (mut point, mut along) = std::mem::take(&mut self.stacked);
        point[..n].copy_from_slice(y);
        point[n..].copy_from_slice(yd);
        along[..n].copy_from_slice(v);
        for ((rate, &differential), v) in along[n..].iter_mut().zip(&self.differential).zip(v) {
            *rate = if differential { c * v } else { 0.0 };
        }
        let evaluate = |beside: &[f64], residual: &mut [f64]| self.residual(time, &beside[..n], &beside[n..], residual);
        let evaluated = directional.product(&point, &along, evaluate, product);
        self.stacked = (point, along);
        evaluated
    }

    /// Why the last evaluation failed, if it did.
    pub(super) fn failure(&self) -> Option<EvalError> {
        self.failure
    }

    /// Rows that were off most at the last evaluation, worst first.
    pub(super) fn worst(&self) -> Vec<Off> {
        let share = |i: &usize| (self.last[*i] / self.nominal[*i]).abs();
        let mut rows: Vec<usize> = (0..self.last.len()).filter(|i| share(i) > 0.0).collect();
        rows.sort_by(|a, b| share(b).total_cmp(&share(a)));
        let plant = self.plant.borrow();
        rows.iter().take(TOLD).map(|&i| off(&plant.equations()[i], self.last[i])).collect()
    }
}

impl DaeProblem for Implicit<'_, '_> {
    fn size(&self) -> usize {
        self.differential.len()
    }
    fn differential(&self) -> &[bool] {
        &self.differential
    }
    fn absolute_tolerance(&self) -> &[f64] {
        &self.absolute_tolerance
    }
    fn residual(&mut self, time: f64, y: &[f64], yd: &[f64], residual: &mut [f64]) -> Result<(), EvalError> {
        self.acting.at(time, &mut self.u);
        let evaluated = self.plant.borrow_mut().residual(At { time, y, yd, u: &self.u }, &mut self.last);
        self.failure = evaluated.err();
        for ((scaled, row), nominal) in residual.iter_mut().zip(&self.last).zip(&self.nominal) {
            *scaled = row / nominal;
        }
        evaluated
    }
    fn jacobian(&mut self, time: f64, c: f64, y: &[f64], yd: &[f64], jacobian: &mut Matrix) -> Result<(), EvalError> {
        if let Some(mut differences) = self.differences.take() {
            let evaluated = self.quotients((time, c), (y, yd), &mut differences, jacobian);
            self.differences = Some(differences);
            return evaluated;
        }
        self.seed(c);
        self.acting.at(time, &mut self.u);
        let at = At { time, y, yd, u: &self.u };
        let values = (&mut self.last[..], &mut self.outputs[..]);
        let evaluated = self.plant.borrow_mut().along(at, &self.seeds, values, &mut self.d_residual, &mut self.d_outputs);
        self.failure = evaluated.err();
        for j in 0..jacobian.columns() {
            let column = jacobian.column_mut(j).iter_mut().zip(self.d_residual.column(j)).zip(&self.nominal);
            column.for_each(|((scaled, entry), nominal)| *scaled = entry / nominal);
        }
        evaluated
    }
    fn product(&mut self, (time, c): (f64, f64), (y, yd): (&[f64], &[f64]), v: &[f64], product: &mut [f64]) -> Result<(), EvalError> {
        if let Some(mut directional) = self.directional.take() {
            let evaluated = self.quotient((time, c), (y, yd), (v, product), &mut directional);
            self.directional = Some(directional);
            return evaluated;
        }
        let (seeds, d_residual, d_outputs) = &mut self.along;
        seeds.y.as_mut_slice().copy_from_slice(v);
        for ((rate, &differential), v) in seeds.yd.as_mut_slice().iter_mut().zip(&self.differential).zip(v) {
            *rate = if differential { c * v } else { 0.0 };
        }
        self.acting.at(time, &mut self.u);
        let at = At { time, y, yd, u: &self.u };
        let values = (&mut self.last[..], &mut self.outputs[..]);
        let evaluated = self.plant.borrow_mut().along(at, seeds, values, d_residual, d_outputs);
        self.failure = evaluated.err();
        let rows = d_residual.as_slice().iter().zip(&self.nominal);
        product.iter_mut().zip(rows).for_each(|(scaled, (entry, nominal))| *scaled = entry / nominal);
        evaluated
    }
    fn event_count(&self) -> usize {
        self.watch.count()
    }
    fn events(&mut self, time: f64, y: &[f64], yd: &[f64], values: &mut [f64]) -> Result<(), EvalError> {
        let watched = self.watch.values(&mut self.observer, time, (y, yd), values);
        self.failure = watched.err();
        watched
    }
}
