//! One-dimensional force laws: what springs, dampers, air columns, stops and friction have in common.
//!
//! `F(x, v) = F₀ + k (x − x₀) + F_air(x) + F_stop(x) + F_damp(v) + F_c tanh(v/v_c)`, positive F opposes positive x.
//!
//! | symbol | unit | |
//! |---|---|---|
//! | x, v | m or rad, and per s | deflection and its rate |
//! | p₀A | N | initial force of the air column, `F_air = p₀A [(L₀/(L₀ − x))ⁿ − 1]`, valid for x < L₀ |
//! | S | | C2 one-sided ramp of width w: `F_stop = k_b S(x − x_b) − k_t S(x_t − x)` |
//! | v₀ | | rounding of the bilinear damper, `½(c_b + c_r) v + ½(c_b − c_r)(√(v² + v₀²) − v₀)` |
//!
//! Source: elementary parts; the air column is the polytropic law of a closed volume, the smoothing is ours.

use crate::scalar::{
    CubicSpline, Pchip, Real,
    smooth::{ramp, ramp_integral},
};

/// Elastic part.
#[derive(Clone, Debug)]
pub enum Spring {
    /// `F₀ + k (x − x₀)`.
    Linear {
        /// Force at the reference deflection, N or N m.
        preload: f64,
        /// Stiffness, N/m or N m/rad.
        stiffness: f64,
        /// Reference deflection x₀, m or rad.
        reference: f64,
    },
    /// Force against deflection, C2 spline.
    Table(CubicSpline),
}

/// Viscous part.
#[derive(Clone, Debug)]
pub enum Damping {
    /// `c v`.
    Linear(f64),
    /// Different slopes in the two directions, rounded over v₀.
    Bilinear {
        /// Slope for v > 0 (bump).
        bump: f64,
        /// Slope for v < 0 (rebound).
        rebound: f64,
        /// Rounding speed v₀.
        rounding: f64,
    },
    /// Force against speed, monotone C1 interpolation.
    Table(Pchip),
}

/// Air column.
#[derive(Clone, Copy, Debug)]
pub struct Air {
    /// Initial force p₀ A, N.
    pub force: f64,
    /// Column length L₀, m.
    pub length: f64,
    /// Polytropic exponent n, 1 to 1.4.
    pub exponent: f64,
}

/// End stops.
#[derive(Clone, Copy, Debug)]
pub struct Stops {
    /// Deflection at which the lower stop (top-out) begins.
    pub lower: f64,
    /// Deflection at which the upper stop (bump) begins.
    pub upper: f64,
    /// Stiffness of the stops.
    pub stiffness: f64,
    /// Width over which the stiffness builds up.
    pub width: f64,
}

/// Dry friction.
#[derive(Clone, Copy, Debug)]
pub struct Friction {
    /// Force at large speed.
    pub force: f64,
    /// Speed v_c over which it turns its sign.
    pub speed: f64,
}

/// All parts together.
#[derive(Clone, Debug)]
pub struct SpringDamperLaw {
    /// Elastic part.
    pub spring: Spring,
    /// Viscous part.
    pub damping: Damping,
    /// Air column.
    pub air: Option<Air>,
    /// End stops.
    pub stops: Option<Stops>,
    /// Dry friction.
    pub friction: Option<Friction>,
}

impl SpringDamperLaw {
    /// A linear spring and a linear damper.
    pub fn linear(preload: f64, stiffness: f64, damping: f64) -> Self {
        let spring = Spring::Linear { preload, stiffness, reference: 0.0 };
        Self { spring, damping: Damping::Linear(damping), air: None, stops: None, friction: None }
    }

    /// Elastic force at deflection x.
    #[inline]
    pub fn elastic<S: Real>(&self, x: S) -> S {
        let mut F = match &self.spring {
            Spring::Linear { preload, stiffness, reference } => (x - *reference) * *stiffness + *preload,
            Spring::Table(table) => table.value(x),
        };
        if let Some(a) = self.air {
            let ratio = (-(x / a.length) + 1.0).recip();
            F += (ratio.powf(a.exponent) - 1.0) * a.force;
        }
        if let Some(s) = self.stops {
            F += (ramp(x - s.upper, s.width) - ramp(-x + s.lower, s.width)) * s.stiffness;
        }
        F
    }

    /// Viscous force at rate v.
    #[inline]
    pub fn viscous<S: Real>(&self, v: S) -> S {
        let mut F = match &self.damping {
            Damping::Linear(c) => v * *c,
            Damping::Bilinear { bump, rebound, rounding } => {
                let bend = (v * v + rounding * rounding).sqrt() - *rounding;
                v * (0.5 * (bump + rebound)) + bend * (0.5 * (bump - rebound))
            }
            Damping::Table(table) => table.value(v),
        };
        if let Some(f) = self.friction {
            F += (v / f.speed).tanh() * f.force;
        }
        F
    }

    /// Force that opposes deflection.
    #[inline]
    pub fn force<S: Real>(&self, x: S, v: S) -> S {
        self.elastic(x) + self.viscous(v)
    }

    /// Stored energy, J: the integral of the elastic force from x = 0.
    pub fn stored<S: Real>(&self, x: S) -> S {
        let mut U = match &self.spring {
            Spring::Linear { preload, stiffness, reference } => {
                let d = x - *reference;
                d * d * (0.5 * stiffness) + x * *preload
            }
            Spring::Table(table) => table.integral(x),
        };
        if let Some(a) = self.air {
            let rest = -(x / a.length) + 1.0;
            let compressed = if (a.exponent - 1.0).abs() < 1e-9 {
                -rest.ln() * a.length
            } else {
                (rest.powf(1.0 - a.exponent) - 1.0) * (a.length / (a.exponent - 1.0))
            };
            U += (compressed - x) * a.force;
        }
        if let Some(s) = self.stops {
            U += (ramp_integral(x - s.upper, s.width) + ramp_integral(-x + s.lower, s.width)) * s.stiffness;
        }
        U
    }
}
