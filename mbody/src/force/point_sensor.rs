//! Motion of a point of a body: height, speed, velocity and acceleration in body axes. No force.

use super::{Declared, Effort, Energy, Evaluated, ForceLaw, OutputDeclared};
use crate::model::BodyIndex;
use crate::scalar::SystemScalar;
use crate::spatial::Vec3;

/// A sensor at a point of a body.
#[derive(Clone, Debug)]
pub struct PointSensor {
    /// The body.
    pub body: BodyIndex,
    /// The point, in the body frame, m.
    pub point: Vec3<f64>,
}

impl ForceLaw for PointSensor {
    fn declare(&self, element: &str) -> Declared {
        const OUTPUTS: [(&str, &str, &str); 8] = [
            ("height", "m", "height of the point in the world"),
            ("point_speed", "m/s", "magnitude of the velocity of the point"),
            ("velocity_x", "m/s", "velocity along x of the body"),
            ("velocity_y", "m/s", "velocity along y of the body"),
            ("velocity_z", "m/s", "velocity along z of the body"),
            ("acceleration_x", "m/s^2", "acceleration along x of the body"),
            ("acceleration_y", "m/s^2", "acceleration along y of the body"),
            ("acceleration_z", "m/s^2", "acceleration along z of the body"),
        ];
        let outputs = OUTPUTS.map(|(q, unit, about)| OutputDeclared { name: format!("{element}.{q}"), unit, about });
        Declared { outputs: outputs.to_vec(), tells_only: true, ..Default::default() }
    }
    fn apply<S: SystemScalar>(&self, at: &Evaluated<'_, S>, out: &mut Effort<'_, S>) {
        let p = at.p_WQ(self.body, self.point);
        let v_W = at.v_WQ(self.body, p);
        let R = &at.X_WB(self.body).R;
        let (v, a) = (R.inverse_times(v_W), R.inverse_times(at.a_WQ(self.body, self.point)));
        out.output(0, p.z);
        // rounded below 1 nm/s so that the derivative exists at rest
        out.output(1, (v.norm_squared() + 1e-18).sqrt());
        for k in 0..3 {
            out.output(2 + k, v[k]);
            out.output(5 + k, a[k]);
        }
    }
    fn energy<S: SystemScalar>(&self, _at: &Evaluated<'_, S>) -> Energy<S> {
        Energy::default()
    }
}
