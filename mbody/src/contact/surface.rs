//! Smooth surfaces on which bodies roll and touch.
//!
//! ```text
//! z = h(x, y),   k = (−h_x, −h_y, 1)/√(1 + h_x² + h_y²),   P0 = (x, y, h(x, y))
//! ```
//!
//! h height, m; h_x, h_y its slopes; k unit normal, upward; P0 point of the tangent plane. A height field is a tensor product
//! of natural cubic splines over a grid: twice continuously differentiable, straight on outside the grid.
//!
//! Source: C. de Boor, *A Practical Guide to Splines*, Springer 1978, chapter XVII (tensor products).
//! Range: surfaces that are functions of (x, y). Contact models add their own: radii of the surface well above those of the body.

use crate::scalar::Real;
use crate::scalar::spline::{CurveError, Ends, second_derivatives, weights};
use crate::spatial::Vec3;
use std::sync::Arc;

/// Height of a surface and its slopes above one point of the horizontal plane.
#[derive(Clone, Copy, Debug)]
pub struct Elevation<S> {
    /// Height, m.
    pub height: S,
    /// Slope along x.
    pub slope_x: S,
    /// Slope along y.
    pub slope_y: S,
}

/// A plane through a point, with its unit normal.
#[derive(Clone, Copy, Debug)]
pub struct TangentPlane<S> {
    /// A point of the plane, m.
    pub point: Vec3<S>,
    /// Unit normal.
    pub normal: Vec3<S>,
}

impl<S: Real> TangentPlane<S> {
    /// The plane moved along its normal.
    pub fn raised(self, distance: S) -> Self {
        Self { point: self.point + self.normal.scaled(distance), normal: self.normal }
    }
}

/// A surface `z = h(x, y)`.
pub trait Surface {
    /// Height and slopes above (x, y).
    fn elevation<S: Real>(&self, x: S, y: S) -> Elevation<S>;

    /// How often a contact point is looked for anew from the tangent plane of the last one: 1 for a plane.
    fn passes(&self) -> usize;

    /// The tangent plane above (x, y).
    fn tangent_plane<S: Real>(&self, x: S, y: S) -> TangentPlane<S> {
        let Elevation { height, slope_x, slope_y } = self.elevation(x, y);
        let up = (slope_x * slope_x + slope_y * slope_y + 1.0).sqrt().recip();
        TangentPlane { point: Vec3::new(x, y, height), normal: Vec3::new(-slope_x * up, -slope_y * up, up) }
    }
}

/// Why data do not make a surface.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
pub enum SurfaceError {
    /// A plane that is vertical, faces down, or has no direction.
    #[error("the normal of the plane must point upward, but its vertical part is {vertical}")]
    NormalNotUpward {
        /// Vertical part of the normal as given.
        vertical: f64,
    },
    /// The number of heights is not the number of grid points.
    #[error("a grid of {columns} by {rows} points needs {} heights, not {found}", columns * rows)]
    WrongCount {
        /// Points along x.
        columns: usize,
        /// Points along y.
        rows: usize,
        /// Heights given.
        found: usize,
    },
    /// A grid line or the heights along it.
    #[error("the grid along {axis}: {cause}")]
    Grid {
        /// `x` or `y`.
        axis: char,
        /// What is wrong with it.
        cause: CurveError,
    },
}

/// A plane in any upward attitude.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Plane {
    point: Vec3<f64>,
    slope_x: f64,
    slope_y: f64,
}

impl Plane {
    /// The horizontal plane z = 0.
    pub const LEVEL: Self = Self { point: Vec3 { x: 0.0, y: 0.0, z: 0.0 }, slope_x: 0.0, slope_y: 0.0 };

    /// The plane through a point with a normal of any length.
    ///
    /// # Errors
    /// A normal that does not point upward. Contact against steeper planes takes a [`TangentPlane`] directly.
    pub fn new(point: Vec3<f64>, normal: Vec3<f64>) -> Result<Self, SurfaceError> {
        match normal.normalized() {
            Some(k) if k.z > 1e-6 => Ok(Self { point, slope_x: -k.x / k.z, slope_y: -k.y / k.z }),
            _ => Err(SurfaceError::NormalNotUpward { vertical: normal.z }),
        }
    }
}

impl Surface for Plane {
    #[inline]
    fn elevation<S: Real>(&self, x: S, y: S) -> Elevation<S> {
        let height = (x - self.point.x) * self.slope_x + (y - self.point.y) * self.slope_y + self.point.z;
        Elevation { height, slope_x: S::from_f64(self.slope_x), slope_y: S::from_f64(self.slope_y) }
    }

    fn passes(&self) -> usize {
        1
    }
}

/// Heights over a rectangular grid, joined with two continuous derivatives.
#[derive(Clone, Debug, PartialEq)]
pub struct HeightField {
    x: Vec<f64>,
    y: Vec<f64>,
    /// (h, h_xx, h_yy, h_xxyy) at the grid points; x runs fastest.
    nodes: Vec<[f64; 4]>,
    passes: usize,
}

impl HeightField {
    /// The surface through the heights `heights[row * x.len() + column]` above `(x[column], y[row])`.
    ///
    /// Contact is sought in two passes; see [`Self::with_passes`].
    ///
    /// # Errors
    /// Grid lines that are not increasing, fewer than two points along an axis, a wrong number of heights or one that is not finite.
    pub fn new(x: &[f64], y: &[f64], heights: &[f64]) -> Result<Self, SurfaceError> {
        let (columns, rows) = (x.len(), y.len());
        if heights.len() != columns * rows {
            return Err(SurfaceError::WrongCount { columns, rows, found: heights.len() });
        }
        check_axis('x', x, heights.chunks_exact(columns.max(1)).map(<[f64]>::to_vec))?;
        check_axis('y', y, (0..columns).map(|c| column(heights, columns, c)))?;
        let along_x =
            |table: &[f64]| -> Vec<f64> { table.chunks_exact(columns).flat_map(|row| second_derivatives(x, row, Ends::Natural)).collect() };
        let h_xx = along_x(heights);
        let h_yy = along_columns(y, heights, columns);
        let h_xxyy = along_columns(y, &h_xx, columns);
        let nodes = (0..heights.len()).map(|i| [heights[i], h_xx[i], h_yy[i], h_xxyy[i]]).collect();
        Ok(Self { x: x.to_vec(), y: y.to_vec(), nodes, passes: 2 })
    }

    /// With another number of passes for the contact point: three where the surface has radii below about 5 m.
    pub fn with_passes(self, passes: usize) -> Self {
        Self { passes: passes.max(1), ..self }
    }
}

fn column(table: &[f64], columns: usize, c: usize) -> Vec<f64> {
    table.iter().skip(c).step_by(columns).copied().collect()
}

fn along_columns(y: &[f64], table: &[f64], columns: usize) -> Vec<f64> {
    let mut result = vec![0.0; table.len()];
    for c in 0..columns {
        for (row, m) in second_derivatives(y, &column(table, columns, c), Ends::Natural).into_iter().enumerate() {
            result[row * columns + c] = m;
        }
    }
    result
}

fn check_axis(axis: char, knots: &[f64], mut lines: impl Iterator<Item = Vec<f64>>) -> Result<(), SurfaceError> {
    let wrong = |cause| SurfaceError::Grid { axis, cause };
    if knots.len() < 2 {
        return Err(wrong(CurveError::TooFewPoints { found: knots.len(), needed: 2 }));
    }
    lines.try_for_each(|line| crate::scalar::spline::check_points(knots, &line, 2)).map_err(wrong)
}

impl Surface for HeightField {
    fn elevation<S: Real>(&self, x: S, y: S) -> Elevation<S> {
        let (wx, wy) = (weights(&self.x, x), weights(&self.y, y));
        let columns = self.x.len();
        let mut sum = Elevation { height: S::zero(), slope_x: S::zero(), slope_y: S::zero() };
        // four corners, each with its value and its derivatives in x, in y and in both
        for (row, along_y) in [0, 1].into_iter().enumerate() {
            for (col, along_x) in [0, 1].into_iter().enumerate() {
                let node = &self.nodes[(wy.interval + row) * columns + wx.interval + col];
                for (part, known) in node.iter().enumerate() {
                    let (ix, iy) = (along_x + 2 * (part & 1), along_y + 2 * (part >> 1));
                    sum.height += wx.value[ix] * wy.value[iy] * *known;
                    sum.slope_x += wx.slope[ix] * wy.value[iy] * *known;
                    sum.slope_y += wx.value[ix] * wy.slope[iy] * *known;
                }
            }
        }
        sum
    }

    fn passes(&self) -> usize {
        self.passes
    }
}

/// Any of the surfaces, for an assembled system.
#[derive(Clone, Debug, PartialEq)]
pub enum Ground {
    /// A plane.
    Plane(Plane),
    /// Heights over a grid.
    HeightField(Arc<HeightField>),
}

impl Default for Ground {
    fn default() -> Self {
        Self::Plane(Plane::LEVEL)
    }
}

impl Surface for Ground {
    #[inline]
    fn elevation<S: Real>(&self, x: S, y: S) -> Elevation<S> {
        match self {
            Self::Plane(plane) => plane.elevation(x, y),
            Self::HeightField(field) => field.elevation(x, y),
        }
    }

    fn passes(&self) -> usize {
        match self {
            Self::Plane(plane) => plane.passes(),
            Self::HeightField(field) => field.passes(),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scalar::Jet;

    fn hills() -> HeightField {
        let x: Vec<f64> = (0..40).map(|i| -2.0 + 0.1 * f64::from(i)).collect();
        let y: Vec<f64> = (0..30).map(|i| -1.5 + 0.1 * f64::from(i)).collect();
        let heights: Vec<f64> = y.iter().flat_map(|y| x.iter().map(|x| height(*x, *y)).collect::<Vec<_>>()).collect();
        HeightField::new(&x, &y, &heights).unwrap()
    }

    fn height(x: f64, y: f64) -> f64 {
        0.1 * (1.3 * x).sin() * (0.9 * y + 0.2).cos() + 0.05 * x
    }

    #[test]
    fn a_plane_keeps_its_point_and_its_normal() {
        let normal = Vec3::new(0.1, -0.2, 0.9).normalized().unwrap();
        let plane = Plane::new(Vec3::new(1.0, 2.0, 3.0), normal * 7.0).unwrap();
        let tangent = plane.tangent_plane(-0.4, 0.9);
        assert!((tangent.normal - normal).norm() < 1e-15);
        assert!((tangent.point - Vec3::new(1.0, 2.0, 3.0)).dot(normal).abs() < 1e-15);
        assert_eq!(Plane::new(Vec3::zero(), Vec3::new(1.0, 0.0, 0.0)), Err(SurfaceError::NormalNotUpward { vertical: 0.0 }));
    }

    #[test]
    fn a_height_field_passes_through_its_heights_and_follows_the_hills_between() {
        let field = hills();
        assert!((field.elevation(-1.0, 0.3).height - height(-1.0, 0.3)).abs() < 1e-14);
        for (x, y) in [(0.03, 0.14), (0.77, -0.58), (-1.11, 0.69)] {
            // fourth order in the mesh of 0.1 m: 5/384 · 0.1⁴ · |h_xxxx| ≈ 4e-7 m
            assert!((field.elevation(x, y).height - height(x, y)).abs() < 1e-6);
        }
    }

    #[test]
    fn slopes_are_the_derivatives_of_the_height_also_outside_the_grid() {
        let field = hills();
        for (x, y) in [(0.33, 0.21), (-2.5, 0.4), (0.3, 5.0), (9.0, -7.0)] {
            let constant = Jet::constant;
            let e = field.elevation(x, y);
            assert!((field.elevation(Jet::new(x, 1.0, 0.0), constant(y)).height.d - e.slope_x).abs() < 1e-13, "at {x}, {y}");
            assert!((field.elevation(constant(x), Jet::new(y, 1.0, 0.0)).height.d - e.slope_y).abs() < 1e-13, "at {x}, {y}");
        }
    }

    #[test]
    fn curvature_is_continuous_across_cells() {
        let field = hills();
        let bend = |x: f64| field.elevation(Jet::new(x, 1.0, 0.0), Jet::new(0.2, 0.5, 0.0)).height;
        for x in [0.0, -2.0, 1.9] {
            let (a, b) = (bend(x - 1e-9), bend(x + 1e-9));
            assert!((a.d - b.d).abs() < 1e-7 && (a.dd - b.dd).abs() < 1e-6, "at {x}");
        }
    }

    #[test]
    fn a_faulty_grid_is_named() {
        let wrong = HeightField::new(&[0.0, 1.0], &[0.0, 0.0], &[0.0; 4]);
        assert_eq!(wrong, Err(SurfaceError::Grid { axis: 'y', cause: CurveError::NotIncreasing { point: 1, at: 0.0 } }));
        assert_eq!(HeightField::new(&[0.0, 1.0], &[0.0], &[0.0; 3]), Err(SurfaceError::WrongCount { columns: 2, rows: 1, found: 3 }));
        assert!(HeightField::new(&[], &[], &[]).is_err());
    }
}
