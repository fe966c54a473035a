//! The linear equations of the benchmark bicycle as functions of its parameters.
//!
//! Source: J. P. Meijaard, J. M. Papadopoulos, A. Ruina, A. L. Schwab, Proc. R. Soc. A 463 (2007) 1955–1982, table 1 and appendix A; x forward, y right, z
//! down, lean and steer positive to the right, both wheels on the road, q = (lean, steer):
//! `M q̈ + v C₁ q̇ + (g K₀ + v² K₂) q = f`.

use super::source::matrix;
use nalgebra::{Complex, Matrix2};
use validation::agreement::{Agreement, absolute};
use validation::evidence::Row;
use validation::reference::Table;

/// Rows of the table.
pub const EVIDENCE: &[Row] = validation::evidence![
    formulas_give_the_matrices_of_the_benchmark => (
        "the formulas that sensitivities are held to give the matrices of the benchmark bicycle",
        "Meijaard et al. (2007), appendix A, M, C₁, K₀, K₂",
        "2e-14 of the largest entry: double precision"
    ),
];

/// The parameters of table 1.
#[derive(Clone, Copy, Debug)]
pub struct Bicycle {
    /// Wheelbase, trail, tilt of the steering axis, gravity.
    pub w: f64,
    pub c: f64,
    pub lambda: f64,
    pub g: f64,
    /// Wheels: radius, mass, inertia across and about the axle.
    pub r_R: f64,
    pub m_R: f64,
    pub IR_xx: f64,
    pub IR_yy: f64,
    pub r_F: f64,
    pub m_F: f64,
    pub IF_xx: f64,
    pub IF_yy: f64,
    /// Rear frame: center, mass, inertia about it.
    pub x_B: f64,
    pub z_B: f64,
    pub m_B: f64,
    pub IB_xx: f64,
    pub IB_xz: f64,
    pub IB_zz: f64,
    /// Front frame.
    pub x_H: f64,
    pub z_H: f64,
    pub m_H: f64,
    pub IH_xx: f64,
    pub IH_xz: f64,
    pub IH_zz: f64,
}

/// Table 1.
pub const BENCHMARK: Bicycle = Bicycle {
    w: 1.02,
    c: 0.08,
    lambda: std::f64::consts::PI / 10.0,
    g: 9.81,
    r_R: 0.3,
    m_R: 2.0,
    IR_xx: 0.0603,
    IR_yy: 0.12,
    r_F: 0.35,
    m_F: 3.0,
    IF_xx: 0.1405,
    IF_yy: 0.28,
    x_B: 0.3,
    z_B: -0.9,
    m_B: 85.0,
    IB_xx: 9.2,
    IB_xz: 2.4,
    IB_zz: 2.8,
    x_H: 0.9,
    z_H: -0.7,
    m_H: 4.0,
    IH_xx: 0.05892,
    IH_xz: -0.00756,
    IH_zz: 0.00708,
};

impl Bicycle {
    /// M, C₁, K₀, K₂.
    pub fn matrices(&self) -> [Matrix2<f64>; 4] {
        let b = self;
        let (sin, cos) = b.lambda.sin_cos();
        // the whole (A1–A6)
        let m_T = b.m_R + b.m_B + b.m_H + b.m_F;
        let x_T = (b.x_B * b.m_B + b.x_H * b.m_H + b.w * b.m_F) / m_T;
        let z_T = (-b.r_R * b.m_R + b.z_B * b.m_B + b.z_H * b.m_H - b.r_F * b.m_F) / m_T;
        let wheels = b.IR_xx + b.IF_xx;
        let height = |m: f64, z: f64| m * z * z;
        let heights = height(b.m_R, b.r_R) + height(b.m_B, b.z_B) + height(b.m_H, b.z_H) + height(b.m_F, b.r_F);
        let IT_xx = wheels + b.IB_xx + b.IH_xx + heights;
        let IT_xz = b.IB_xz + b.IH_xz - b.m_B * b.x_B * b.z_B - b.m_H * b.x_H * b.z_H + b.m_F * b.w * b.r_F;
        let IT_zz = wheels + b.IB_zz + b.IH_zz + height(b.m_B, b.x_B) + height(b.m_H, b.x_H) + height(b.m_F, b.w);
        // the front assembly (A7–A15)
        let m_A = b.m_H + b.m_F;
        let x_A = (b.x_H * b.m_H + b.w * b.m_F) / m_A;
        let z_A = (b.z_H * b.m_H - b.r_F * b.m_F) / m_A;
        let IA_xx = b.IH_xx + b.IF_xx + height(b.m_H, b.z_H - z_A) + height(b.m_F, b.r_F + z_A);
        let IA_xz = b.IH_xz - b.m_H * (b.x_H - x_A) * (b.z_H - z_A) + b.m_F * (b.w - x_A) * (b.r_F + z_A);
        let IA_zz = b.IH_zz + b.IF_xx + height(b.m_H, b.x_H - x_A) + height(b.m_F, b.w - x_A);
        let u_A = (x_A - b.w - b.c) * cos - z_A * sin;
        let IA_ll = m_A * u_A * u_A + IA_xx * sin * sin + 2.0 * IA_xz * sin * cos + IA_zz * cos * cos;
        let IA_lx = -m_A * u_A * z_A + IA_xx * sin + IA_xz * cos;
        let IA_lz = m_A * u_A * x_A + IA_xz * sin + IA_zz * cos;
        // trail over wheelbase, spins, static moment (A16–A18)
        let mu = b.c / b.w * cos;
        let (S_R, S_F) = (b.IR_yy / b.r_R, b.IF_yy / b.r_F);
        let S_T = S_R + S_F;
        let S_A = m_A * u_A + mu * m_T * x_T;
        // (A19–A28)
        let M_xd = IA_lx + mu * IT_xz;
        let M = Matrix2::new(IT_xx, M_xd, M_xd, IA_ll + 2.0 * mu * IA_lz + mu * mu * IT_zz);
        let K0 = Matrix2::new(m_T * z_T, -S_A, -S_A, -S_A * sin);
        let K2 = Matrix2::new(0.0, (S_T - m_T * z_T) / b.w * cos, 0.0, (S_A + S_F * sin) / b.w * cos);
        let C1 = Matrix2::new(
            0.0,
            mu * S_T + S_F * cos + IT_xz / b.w * cos - mu * m_T * z_T,
            -(mu * S_T + S_F * cos),
            IA_lz / b.w * cos + mu * (S_A + IT_zz / b.w * cos),
        );
        [M, C1, K0, K2]
    }

    /// `det(M s² + v C₁ s + g K₀ + v² K₂)`, zero at an eigenvalue.
    pub fn characteristic(&self, s: Complex<f64>, v: f64) -> Complex<f64> {
        let [M, C1, K0, K2] = self.matrices().map(|m| m.map(|e| Complex::new(e, 0.0)));
        let real = |x: f64| Complex::new(x, 0.0);
        (M * (s * s) + C1 * (s * v) + K0 * real(self.g) + K2 * real(v * v)).determinant()
    }
}

#[test]
fn formulas_give_the_matrices_of_the_benchmark() {
    let table = Table::read("bicycle/matrices.csv");
    let mut agreement = Agreement::on("benchmark bicycle: formulas of appendix A");
    for (found, name) in BENCHMARK.matrices().iter().zip(["M", "C1", "K0", "K2"]) {
        let expected = matrix(&table, name);
        let double = absolute(2e-14 * expected.amax()).because("double precision of the largest entry");
        agreement.all_near(name, found.as_slice(), expected.as_slice(), &double);
    }
    agreement.assert();
}
