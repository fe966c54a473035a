//! The systems.

use problem::{DaeProblem, EvalError, Matrix, OdeProblem};

/// ẍ = −x as a first-order system: the exact solution from (0, 1) is (sin t, cos t).
pub struct Oscillator {
    /// Whether ẋ = −½ is an event, beside a function that never leaves zero.
    pub watched: bool,
}

impl Oscillator {
    pub const START: [f64; 2] = [0.0, 1.0];

    pub fn exact(time: f64) -> Vec<f64> {
        vec![time.sin(), time.cos()]
    }
}

impl OdeProblem for Oscillator {
    fn size(&self) -> usize {
        2
    }
    fn absolute_tolerance(&self) -> &[f64] {
        &[1.0; 2]
    }
    fn rates(&mut self, _time: f64, y: &[f64], yd: &mut [f64]) -> Result<(), EvalError> {
        yd.copy_from_slice(&[y[1], -y[0]]);
        Ok(())
    }
    fn jacobian(&mut self, _time: f64, _y: &[f64], jacobian: &mut Matrix) -> Result<(), EvalError> {
        jacobian.as_mut_slice().copy_from_slice(&[0.0, -1.0, 1.0, 0.0]);
        Ok(())
    }
    fn event_count(&self) -> usize {
        if self.watched { 2 } else { 0 }
    }
    fn events(&mut self, _time: f64, y: &[f64], values: &mut [f64]) -> Result<(), EvalError> {
        values.copy_from_slice(&[0.0, y[1] + 0.5]);
        Ok(())
    }
}

impl DaeProblem for Oscillator {
    fn size(&self) -> usize {
        2
    }
    fn differential(&self) -> &[bool] {
        &[true; 2]
    }
    fn absolute_tolerance(&self) -> &[f64] {
        &[1.0; 2]
    }
    fn residual(&mut self, _time: f64, y: &[f64], yd: &[f64], residual: &mut [f64]) -> Result<(), EvalError> {
        residual.copy_from_slice(&[yd[0] - y[1], yd[1] + y[0]]);
        Ok(())
    }
    fn jacobian(&mut self, _time: f64, c: f64, _y: &[f64], _yd: &[f64], jacobian: &mut Matrix) -> Result<(), EvalError> {
        jacobian.as_mut_slice().copy_from_slice(&[c, 1.0, -1.0, c]);
        Ok(())
    }
    fn event_count(&self) -> usize {
        if self.watched { 2 } else { 0 }
    }
    fn events(&mut self, _time: f64, y: &[f64], _yd: &[f64], values: &mut [f64]) -> Result<(), EvalError> {
        values.copy_from_slice(&[0.0, y[1] + 0.5]);
        Ok(())
    }
}

/// Chemical kinetics after H. H. Robertson, 1966, with the sum of concentrations as third equation (index 1).
pub struct Robertson {
    /// Whether y₁ = 10⁻⁴ and y₃ = 10⁻² are events.
    pub events: bool,
}

impl Robertson {
    pub const START: ([f64; 3], [f64; 3]) = ([1.0, 0.0, 0.0], [-0.04, 0.04, 0.0]);
}

impl DaeProblem for Robertson {
    fn size(&self) -> usize {
        3
    }
    fn differential(&self) -> &[bool] {
        &[true, true, false]
    }
    fn absolute_tolerance(&self) -> &[f64] {
        &[1e-8, 1e-14, 1e-6]
    }
    fn residual(&mut self, _time: f64, y: &[f64], yd: &[f64], residual: &mut [f64]) -> Result<(), EvalError> {
        let (first, second, third) = (0.04 * y[0], 3e7 * y[1] * y[1], 1e4 * y[1] * y[2]);
        residual.copy_from_slice(&[yd[0] + first - third, yd[1] - first + third + second, y[0] + y[1] + y[2] - 1.0]);
        Ok(())
    }
    fn jacobian(&mut self, _time: f64, c: f64, y: &[f64], _yd: &[f64], jacobian: &mut Matrix) -> Result<(), EvalError> {
        jacobian.column_mut(0).copy_from_slice(&[c + 0.04, -0.04, 1.0]);
        jacobian.column_mut(1).copy_from_slice(&[-1e4 * y[2], c + 1e4 * y[2] + 6e7 * y[1], 1.0]);
        jacobian.column_mut(2).copy_from_slice(&[-1e4 * y[1], 1e4 * y[1], 1.0]);
        Ok(())
    }
    fn event_count(&self) -> usize {
        if self.events { 2 } else { 0 }
    }
    fn events(&mut self, _time: f64, y: &[f64], _yd: &[f64], values: &mut [f64]) -> Result<(), EvalError> {
        values.copy_from_slice(&[y[0] - 1e-4, y[2] - 0.01]);
        Ok(())
    }
}

/// IFToMM multibody benchmark A01: a point of 1 kg on a massless rod of 1 m, released at rest from (−1, 0), in Cartesian
/// coordinates. Implicit: index 2 after Gear, Gupta and Leimkuhler, unknowns x, y, ẋ, ẏ, λ, μ. Explicit: λ eliminated.
pub struct Pendulum {
    /// Whether the explicit form projects.
    pub projected: bool,
    /// Whether the lowest point is an event.
    pub watched: bool,
}

const GRAVITY: f64 = 9.81;

impl Pendulum {
    pub const START: [f64; 4] = [-1.0, 0.0, 0.0, 0.0];
    pub const IMPLICIT_START: ([f64; 6], [f64; 6]) = ([-1.0, 0.0, 0.0, 0.0, 0.0, 0.0], [0.0, 0.0, 0.0, -GRAVITY, 0.0, 0.0]);

    /// t, x and y from Jacobi's elliptic functions, <https://www.iftomm-multibody.org/benchmark>, problem A01.
    #[allow(clippy::excessive_precision, reason = "as printed")]
    pub const EXACT: [(f64, [f64; 2]); 9] = [
        (0.0, [-1.0, 0.0]),
        (0.25, [-0.9536646122114010, -0.3008717457915883]),
        (0.5, [-0.3910487915505462, -0.9203699487851923]),
        (1.0, [0.9862917511318754, -0.1650108531255410]),
        (2.0, [-0.7935661953433218, -0.6084839304437913]),
        (3.0, [0.1766517899228403, -0.9842734097378922]),
        (5.0, [-0.9423054350437570, -0.3347543384140018]),
        (7.5, [-0.7274587213083741, -0.6861514474169571]),
        (10.0, [-0.2750874625761167, -0.9614192050991252]),
    ];

    /// First passage of the lowest point: K(sin 45°)/√(g/L), with K = 1.854 074 677 301 371 9.
    pub fn lowest() -> f64 {
        1.854_074_677_301_371_9 / GRAVITY.sqrt()
    }

    pub fn times() -> Vec<f64> {
        Self::EXACT.iter().map(|row| row.0).collect()
    }

    pub fn exact(time: f64) -> Vec<f64> {
        Self::EXACT.iter().find(|row| row.0 == time).map(|row| row.1.to_vec()).expect("a time of the table")
    }
}

impl DaeProblem for Pendulum {
    fn size(&self) -> usize {
        6
    }
    fn differential(&self) -> &[bool] {
        &[true, true, true, true, false, false]
    }
    fn absolute_tolerance(&self) -> &[f64] {
        &[1.0, 1.0, 1.0, 1.0, 10.0, 1.0]
    }
    fn residual(&mut self, _time: f64, s: &[f64], sd: &[f64], residual: &mut [f64]) -> Result<(), EvalError> {
        let &[x, y, u, v, lambda, mu] = s else { unreachable!() };
        residual.copy_from_slice(&[
            sd[0] - u + x * mu,
            sd[1] - v + y * mu,
            sd[2] + x * lambda,
            sd[3] + y * lambda + GRAVITY,
            0.5 * (x * x + y * y - 1.0),
            x * u + y * v,
        ]);
        Ok(())
    }
    fn jacobian(&mut self, _time: f64, c: f64, s: &[f64], _sd: &[f64], jacobian: &mut Matrix) -> Result<(), EvalError> {
        let &[x, y, u, v, lambda, mu] = s else { unreachable!() };
        jacobian.column_mut(0).copy_from_slice(&[c + mu, 0.0, lambda, 0.0, x, u]);
        jacobian.column_mut(1).copy_from_slice(&[0.0, c + mu, 0.0, lambda, y, v]);
        jacobian.column_mut(2).copy_from_slice(&[-1.0, 0.0, c, 0.0, 0.0, x]);
        jacobian.column_mut(3).copy_from_slice(&[0.0, -1.0, 0.0, c, 0.0, y]);
        jacobian.column_mut(4).copy_from_slice(&[0.0, 0.0, x, y, 0.0, 0.0]);
        jacobian.column_mut(5).copy_from_slice(&[x, y, 0.0, 0.0, 0.0, 0.0]);
        Ok(())
    }
    fn event_count(&self) -> usize {
        usize::from(self.watched)
    }
    fn events(&mut self, _time: f64, s: &[f64], _sd: &[f64], values: &mut [f64]) -> Result<(), EvalError> {
        values[0] = s[0];
        Ok(())
    }
}

impl OdeProblem for Pendulum {
    fn size(&self) -> usize {
        4
    }
    fn absolute_tolerance(&self) -> &[f64] {
        &[1.0; 4]
    }
    fn rates(&mut self, _time: f64, s: &[f64], sd: &mut [f64]) -> Result<(), EvalError> {
        let &[x, y, u, v] = s else { unreachable!() };
        let lambda = (u * u + v * v - GRAVITY * y) / (x * x + y * y);
        sd.copy_from_slice(&[u, v, -x * lambda, -y * lambda - GRAVITY]);
        Ok(())
    }
    fn jacobian(&mut self, _time: f64, s: &[f64], jacobian: &mut Matrix) -> Result<(), EvalError> {
        let &[x, y, u, v] = s else { unreachable!() };
        let square = x * x + y * y;
        let lambda = (u * u + v * v - GRAVITY * y) / square;
        let slopes = [-2.0 * x * lambda, -GRAVITY - 2.0 * y * lambda, 2.0 * u, 2.0 * v];
        for (j, slope) in slopes.iter().enumerate() {
            jacobian.column_mut(j).copy_from_slice(&[0.0, 0.0, -x * slope / square, -y * slope / square]);
        }
        jacobian[(0, 2)] = 1.0;
        jacobian[(1, 3)] = 1.0;
        jacobian[(2, 0)] -= lambda;
        jacobian[(3, 1)] -= lambda;
        Ok(())
    }
    fn project(&mut self, _time: f64, s: &mut [f64]) -> Result<(), EvalError> {
        if self.projected {
            let length = s[0].hypot(s[1]);
            s[0] /= length;
            s[1] /= length;
            let along = s[0] * s[2] + s[1] * s[3];
            s[2] -= along * s[0];
            s[3] -= along * s[1];
        }
        Ok(())
    }
    fn event_count(&self) -> usize {
        usize::from(self.watched)
    }
    fn events(&mut self, _time: f64, s: &[f64], values: &mut [f64]) -> Result<(), EvalError> {
        values[0] = s[0];
        Ok(())
    }
}

/// A satellite between earth and moon, in the rotating frame: a closed orbit with four loops.
///
/// Equations, start and period: E. Hairer, S. P. Nørsett, G. Wanner, *Solving Ordinary Differential Equations I*, Springer 1993,
/// section II.0, (0.1) and (0.2).
pub struct Arenstorf;

impl Arenstorf {
    #[allow(clippy::excessive_precision, reason = "as printed")]
    pub const START: [f64; 4] = [0.994, 0.0, 0.0, -2.001_585_106_379_082_522_405_378_622_24];
    #[allow(clippy::excessive_precision, reason = "as printed")]
    pub const PERIOD: f64 = 17.065_216_560_157_962_558_891_720_624_9;
}

impl OdeProblem for Arenstorf {
    fn size(&self) -> usize {
        4
    }
    fn absolute_tolerance(&self) -> &[f64] {
        &[1.0; 4]
    }
    fn rates(&mut self, _time: f64, s: &[f64], sd: &mut [f64]) -> Result<(), EvalError> {
        let &[x, y, u, v] = s else { unreachable!() };
        let mu = 0.012277471;
        let nu = 1.0 - mu;
        let earth = (x + mu).hypot(y).powi(3);
        let moon = (x - nu).hypot(y).powi(3);
        sd[0] = u;
        sd[1] = v;
        sd[2] = x + 2.0 * v - nu * (x + mu) / earth - mu * (x - nu) / moon;
        sd[3] = y - 2.0 * u - nu * y / earth - mu * y / moon;
        Ok(())
    }
    fn jacobian(&mut self, _time: f64, s: &[f64], jacobian: &mut Matrix) -> Result<(), EvalError> {
        let (mu, nu) = (0.012277471, 1.0 - 0.012277471);
        let mut slopes = [[1.0, 0.0], [0.0, 1.0]];
        for (mass, x) in [(nu, s[0] + mu), (mu, s[0] - nu)] {
            let (at, distance) = ([x, s[1]], x.hypot(s[1]));
            for (i, row) in slopes.iter_mut().enumerate() {
                row[i] -= mass / distance.powi(3);
                row.iter_mut().zip(at).for_each(|(slope, along)| *slope += 3.0 * mass * at[i] * along / distance.powi(5));
            }
        }
        jacobian.column_mut(0).copy_from_slice(&[0.0, 0.0, slopes[0][0], slopes[1][0]]);
        jacobian.column_mut(1).copy_from_slice(&[0.0, 0.0, slopes[0][1], slopes[1][1]]);
        jacobian.column_mut(2).copy_from_slice(&[1.0, 0.0, 0.0, -2.0]);
        jacobian.column_mut(3).copy_from_slice(&[0.0, 1.0, 2.0, 0.0]);
        Ok(())
    }
}
