//! One value per scalar of the assembled system: how laws that are generic over the scalar can be stored.
//!
//! A generic method cannot be called through `dyn`. A law is therefore stored once per scalar behind a trait that is
//! object-safe for that one scalar, and [`SystemScalar::pick`] chooses. Any crate can declare a [`Family`] of its own and
//! store `PerScalar<ItsFamily>`; a new scalar is one line in the list below.

use super::{Lanes, Real};

/// A type that depends on the scalar: `dyn Law<S>` behind a pointer, or the workspace for S.
pub trait Family {
    /// The member of the family for scalar S.
    type Of<S: SystemScalar>;
}

/// Builds the members of a family, scalar by scalar.
pub trait Make<F: Family> {
    /// The member for scalar S.
    fn make<S: SystemScalar>(&self) -> F::Of<S>;
}

/// A scalar over which the assembled system can be evaluated: `f64` and the dual numbers with 8, 16 and 24 directions.
pub trait SystemScalar: Real {
    /// Number of directions; 0 for `f64`.
    const DIRECTIONS: usize;
    /// The member for this scalar.
    fn pick<F: Family>(all: &PerScalar<F>) -> &F::Of<Self>;
    /// The member for this scalar.
    fn pick_mut<F: Family>(all: &mut PerScalar<F>) -> &mut F::Of<Self>;
    /// Derivative along one direction.
    fn derivative(&self, direction: usize) -> f64;
    /// Sets the derivative along one direction.
    fn set_derivative(&mut self, direction: usize, value: f64);
}

macro_rules! system_scalars {
    ($($field:ident: $scalar:ty, $directions:expr, |$x:ident, $i:ident, $v:ident| $get:expr, $set:expr;)*) => {
        /// One member of a family for each scalar of the assembled system.
        pub struct PerScalar<F: Family> {
            $($field: F::Of<$scalar>,)*
        }

        impl<F: Family> PerScalar<F> {
            /// All members, from a maker.
            pub fn new(maker: &impl Make<F>) -> Self {
                Self { $($field: maker.make::<$scalar>(),)* }
            }
        }

        $(impl SystemScalar for $scalar {
            const DIRECTIONS: usize = $directions;
            #[inline(always)]
            fn pick<F: Family>(all: &PerScalar<F>) -> &F::Of<Self> {
                &all.$field
            }
            #[inline(always)]
            fn pick_mut<F: Family>(all: &mut PerScalar<F>) -> &mut F::Of<Self> {
                &mut all.$field
            }
            #[inline(always)]
            fn derivative(&self, $i: usize) -> f64 {
                let $x = self;
                $get
            }
            #[inline(always)]
            fn set_derivative(&mut self, $i: usize, $v: f64) {
                let $x = self;
                $set
            }
        })*
    };
}

system_scalars! {
    plain: f64, 0, |_x, _i, _v| 0.0, ();
    lanes_8: Lanes<2>, 8, |x, i, v| x.derivative(i), x.set_derivative(i, v);
    lanes_16: Lanes<4>, 16, |x, i, v| x.derivative(i), x.set_derivative(i, v);
    lanes_24: Lanes<6>, 24, |x, i, v| x.derivative(i), x.set_derivative(i, v);
}
