//! Small plants written by hand.

use problem::{
    At, Dae, Differentiable, Equation, EquationKind, EvalError, Explicit, Input, Limit, Limits, Matrix, Off, Outputs, Projection,
    ProjectionError, Seeds, Side, Signal, Unknown, UnknownKind,
};

/// Writes rows or outputs at a point.
type Write = fn(At<'_>, &mut [f64]) -> Result<(), EvalError>;

/// Writes multipliers into y, and ẏ, from (y, u).
type Rates = fn(&mut [f64], &[f64], &mut [f64]) -> Result<(), EvalError>;

/// A plant whose rows and outputs are quadratic in (y, ẏ, u).
#[derive(Clone)]
pub struct Plant {
    pub unknowns: Vec<Unknown>,
    pub equations: Vec<Equation>,
    inputs: Vec<Input>,
    outputs: Vec<Signal>,
    pub limits: Vec<Limit>,
    pub rows: Write,
    pub signals: Write,
    pub onto: fn(&mut [f64], &[bool]) -> Result<(), ProjectionError>,
    pub rates: Rates,
    /// Time from which on an equation cannot be evaluated, and which.
    pub ends: Option<(f64, usize)>,
}

fn unknown(name: &str, unit: &'static str, kind: UnknownKind, design: f64) -> Unknown {
    Unknown {
        signal: Signal::new(name, unit, ""),
        kind,
        cyclic: false,
        differential: kind != UnknownKind::Algebraic,
        nominal: 1.0,
        absolute_tolerance: 1e-8,
        design,
        start: None,
    }
}

fn equation(name: &str, unit: &'static str, nominal: f64, kind: EquationKind) -> Equation {
    Equation { name: name.to_owned(), unit: unit.into(), nominal, kind }
}

/// Mass of the oscillator, kg.
pub const MASS: f64 = 2.0;
/// Its spring, N/m.
pub const STIFFNESS: f64 = 50.0;
/// Its damper, N s/m.
pub const DAMPING: f64 = 1.2;

/// A cart on a spring and a damper: m ẍ + d ẋ + k x = F. It starts at x = 0.1 m.
pub fn oscillator() -> Plant {
    Plant {
        unknowns: vec![unknown("cart.x", "m", UnknownKind::Position, 0.1), unknown("cart.speed", "m/s", UnknownKind::Velocity, 0.0)],
        equations: vec![
            equation("rate of cart.x", "m/s", 1.0, EquationKind::Kinematic),
            equation("force along cart", "N", 10.0, EquationKind::Dynamic),
        ],
        inputs: vec![Input { signal: Signal::new("cart.force", "N", ""), rate: None, nominal: 1.0, default: 0.0 }],
        outputs: vec![Signal::new("spring.force", "N", "")],
        limits: vec![Limit {
            name: "spring_stop".into(),
            signal: "spring.force".to_owned(),
            threshold: -2.0,
            side: Side::Below,
            nominal: 1.0,
            about: "".into(),
        }],
        rows: |at, r| {
            r[0] = at.yd[0] - at.y[1];
            r[1] = MASS * at.yd[1] + DAMPING * at.y[1] + STIFFNESS * at.y[0] - at.u[0];
            Ok(())
        },
        signals: |at, z| {
            z[0] = STIFFNESS * at.y[0];
            Ok(())
        },
        onto: |_, _| Ok(()),
        rates: |y, u, yd| {
            yd[0] = y[1];
            yd[1] = (u[0] - DAMPING * y[1] - STIFFNESS * y[0]) / MASS;
            Ok(())
        },
        ends: None,
    }
}

/// Gravity, m/s².
pub const GRAVITY: f64 = 9.81;
/// Mass of the pendulum, kg.
pub const BOB: f64 = 1.5;

/// Rows of the pendulum.
fn pendulum_rows(at: At<'_>, r: &mut [f64]) -> Result<(), EvalError> {
    let [x, y, vx, vy, lambda, mu] = at.y[..6] else { return Err(EvalError::Fatal { equation: 0 }) };
    r[0] = at.yd[0] - vx - x * mu;
    r[1] = at.yd[1] - vy - y * mu;
    r[2] = BOB * at.yd[2] + x * lambda;
    r[3] = BOB * (at.yd[3] + GRAVITY) + y * lambda;
    r[4] = 0.5 * (x * x + y * y - 1.0);
    r[5] = x * vx + y * vy;
    Ok(())
}

/// A bob on a rod of 1 m in Cartesian coordinates, stabilized after Gear, Gupta and Leimkuhler (GGL): q̇ = v + Jᵀμ, m v̇ = −m g − Jᵀλ,
/// g(q) = (q·q − 1)/2 = 0, J v = q·v = 0. Its design pose is horizontal.
pub fn pendulum() -> Plant {
    let (position, velocity, algebraic) = (UnknownKind::Position, UnknownKind::Velocity, UnknownKind::Algebraic);
    Plant {
        unknowns: vec![
            unknown("bob.x", "m", position, 1.0),
            unknown("bob.y", "m", position, 0.0),
            unknown("bob.x_rate", "m/s", velocity, 0.0),
            unknown("bob.y_rate", "m/s", velocity, 0.0),
            unknown("rod.tension", "N/m", algebraic, 0.0),
            unknown("rod.correction", "1/s", algebraic, 0.0),
        ],
        equations: vec![
            equation("rate of bob.x", "m/s", 1.0, EquationKind::Kinematic),
            equation("rate of bob.y", "m/s", 1.0, EquationKind::Kinematic),
            equation("force along bob.x", "N", 10.0, EquationKind::Dynamic),
            equation("force along bob.y", "N", 10.0, EquationKind::Dynamic),
            equation("length of rod", "m²", 1.0, EquationKind::Constraint),
            equation("stretching of rod", "m²/s", 1.0, EquationKind::VelocityConstraint),
        ],
        inputs: Vec::new(),
        outputs: vec![Signal::new("bob.energy", "J", "")],
        limits: Vec::new(),
        rows: pendulum_rows,
        signals: |at, z| {
            z[0] = BOB * (0.5 * (at.y[2] * at.y[2] + at.y[3] * at.y[3]) + GRAVITY * at.y[1]);
            Ok(())
        },
        onto: |y, held| {
            if held.first() == Some(&true) {
                // below the pivot
                if y[0].abs() > 1.0 {
                    let by = 0.5 * (y[0] * y[0] - 1.0);
                    return Err(ProjectionError::Open { rows: vec![Off { row: "length of rod".to_owned(), by, unit: "m²".to_owned() }] });
                }
                y[1] = -(1.0 - y[0] * y[0]).sqrt();
            }
            let length = y[0].hypot(y[1]);
            (y[0], y[1]) = (y[0] / length, y[1] / length);
            let along = y[0] * y[2] + y[1] * y[3];
            (y[2], y[3]) = (y[2] - along * y[0], y[3] - along * y[1]);
            Ok(())
        },
        rates: |y, _, yd| {
            let lambda = BOB * (y[2] * y[2] + y[3] * y[3] - GRAVITY * y[1]) / (y[0] * y[0] + y[1] * y[1]);
            (y[4], y[5]) = (lambda, 0.0);
            (yd[0], yd[1]) = (y[2], y[3]);
            (yd[2], yd[3]) = (-y[0] * lambda / BOB, -GRAVITY - y[1] * lambda / BOB);
            Ok(())
        },
        ends: None,
    }
}

/// The same pendulum with a horizontal force on the bob and an additional weight, N.
pub fn driven_pendulum() -> Plant {
    let input = |name: &str| Input { signal: Signal::new(name, "N", ""), rate: None, nominal: 1.0, default: 0.0 };
    Plant {
        inputs: vec![input("bob.push"), input("bob.weight")],
        rows: |at, r| {
            pendulum_rows(at, r)?;
            (r[2], r[3]) = (r[2] - at.u[0], r[3] + at.u[1]);
            Ok(())
        },
        rates: |y, u, yd| {
            let along = y[0] * u[0] - y[1] * (BOB * GRAVITY + u[1]);
            let lambda = (BOB * (y[2] * y[2] + y[3] * y[3]) + along) / (y[0] * y[0] + y[1] * y[1]);
            (y[4], y[5]) = (lambda, 0.0);
            (yd[0], yd[1]) = (y[2], y[3]);
            (yd[2], yd[3]) = ((u[0] - y[0] * lambda) / BOB, -GRAVITY - (u[1] + y[1] * lambda) / BOB);
            Ok(())
        },
        ..pendulum()
    }
}

impl Dae for Plant {
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
        self.lasts(at.time)?;
        (self.rows)(at, residual)
    }
}

impl Outputs for Plant {
    fn outputs(&self) -> &[Signal] {
        &self.outputs
    }
    fn evaluate(&mut self, at: At<'_>, residual: &mut [f64], outputs: &mut [f64]) -> Result<(), EvalError> {
        (self.signals)(at, outputs)?;
        self.residual(at, residual)
    }
}

impl Limits for Plant {
    fn limits(&self) -> &[Limit] {
        &self.limits
    }
}

impl Plant {
    fn lasts(&self, time: f64) -> Result<(), EvalError> {
        match self.ends {
            Some((end, equation)) if time > end => Err(EvalError::Recoverable { equation }),
            _ => Ok(()),
        }
    }

    /// Rows and outputs one unit along a direction, times `weight`, are added to a column of derivatives.
    fn add(&self, at: At<'_>, seeds: &Seeds, j: usize, weight: f64, d: (&mut [f64], &mut [f64])) -> Result<(), EvalError> {
        // room for the largest plant: the service is watched for allocations
        let mut moved = [[0.0; 6]; 3];
        for (moved, (x, s)) in moved.iter_mut().zip([(at.y, &seeds.y), (at.yd, &seeds.yd), (at.u, &seeds.u)]) {
            moved.iter_mut().zip(x.iter().zip(s.column(j))).for_each(|(m, (x, s))| *m = x + weight.signum() * s);
        }
        let [y, yd, u] = &moved;
        let at = At { time: at.time, y: &y[..at.y.len()], yd: &yd[..at.yd.len()], u: &u[..at.u.len()] };
        for (write, column) in [(self.rows, d.0), (self.signals, d.1)] {
            let mut values = [0.0; 6];
            write(at, &mut values)?;
            column.iter_mut().zip(&values).for_each(|(entry, v)| *entry += weight * v);
        }
        Ok(())
    }
}

impl Differentiable for Plant {
    fn along(
        &mut self,
        at: At<'_>,
        seeds: &Seeds,
        values: (&mut [f64], &mut [f64]),
        residual: &mut Matrix,
        outputs: &mut Matrix,
    ) -> Result<(), EvalError> {
        self.evaluate(at, values.0, values.1)?;
        residual.fill(0.0);
        outputs.fill(0.0);
        // central differences of quadratic functions are exact whatever the step
        for j in 0..seeds.columns() {
            for weight in [0.5, -0.5] {
                self.add(at, seeds, j, weight, (residual.column_mut(j), outputs.column_mut(j)))?;
            }
        }
        Ok(())
    }
}

impl Projection for Plant {
    fn project(&mut self, _time: f64, y: &mut [f64], _u: &[f64], held: &[bool]) -> Result<(), ProjectionError> {
        (self.onto)(y, held)
    }
}

impl Explicit for Plant {
    fn solve_rates(&mut self, time: f64, y: &mut [f64], u: &[f64], yd: &mut [f64]) -> Result<(), EvalError> {
        self.lasts(time)?;
        (self.rates)(y, u, yd)
    }
    fn rates_along(&mut self, at: At<'_>, seeds: &Seeds, solved: &mut Matrix) -> Result<(), EvalError> {
        let step = 1e-6;
        for k in 0..seeds.columns() {
            let [above, below] = [step, -step].map(|step| {
                let mut y: Vec<f64> = at.y.iter().zip(seeds.y.column(k)).map(|(y, d)| y + step * d).collect();
                let u: Vec<f64> = at.u.iter().zip(seeds.u.column(k)).map(|(u, d)| u + step * d).collect();
                let mut yd = at.yd.to_vec();
                (self.rates)(&mut y, &u, &mut yd).map(|()| (y, yd))
            });
            let ((above, rates_above), (below, rates_below)) = (above?, below?);
            for (i, unknown) in self.unknowns.iter().enumerate() {
                let difference = if unknown.differential { rates_above[i] - rates_below[i] } else { above[i] - below[i] };
                solved[(i, k)] = difference / (2.0 * step);
            }
        }
        Ok(())
    }
}
