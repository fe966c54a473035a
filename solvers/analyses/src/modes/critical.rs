//! Where a quantity changes its sign along a sweep: critical speeds, where a mode becomes stable or unstable.
//!
//! Source: G. E. Forsythe, M. A. Malcolm, C. B. Moler, *Computer Methods for Mathematical Computations*, Prentice-Hall 1977, 7.2
//! (secant steps in a bracket); M. Dowell, P. Jarratt, BIT 11 (1971) 168–174 (Illinois rule).

/// Finds the zero of a function between two points with values of different sign, to a width of the bracket.
///
/// # Returns
/// The abscissa of the zero; `None` where the function cannot be evaluated on the way, or the values have one sign.
pub fn zero(f: &mut dyn FnMut(f64) -> Option<f64>, left: (f64, f64), right: (f64, f64), width: f64) -> Option<f64> {
    let ((mut a, mut fa), (mut b, mut fb)) = (left, right);
    if fa * fb > 0.0 {
        return None;
    }
    let mut bisect = false;
    for _ in 0..200 {
        if fa == 0.0 || fb == 0.0 || (b - a).abs() <= width {
            break;
        }
        // a bisection after every step that has not halved the bracket: two steps per halving at worst
        let before = (b - a).abs();
        let x = if bisect { 0.5 * (a + b) } else { b - fb * (b - a) / (fb - fa) };
        let fx = f(x)?;
        if fx * fb < 0.0 {
            (a, fa) = (b, fb);
        } else {
            // Illinois rule: the end that stays counts half
            fa *= 0.5;
        }
        (b, fb) = (x, fx);
        bisect = !bisect && (b - a).abs() > 0.5 * before;
    }
    Some(if fa.abs() < fb.abs() { a } else { b })
}

#[cfg(test)]
mod tests {
    use super::zero;

    #[test]
    fn zeros_are_found_to_the_width_asked_for() {
        for (f, left, right, expected) in [
            ((|x: f64| x * x - 2.0) as fn(f64) -> f64, 0.0, 2.0, 2f64.sqrt()),
            (|x| x.powi(9), -1.0, 3.0, 0.0),
            (|x| (x - 0.3).tanh(), -9.0, 200.0, 0.3),
            (|x: f64| x.cos(), 1.0, 2.0, std::f64::consts::FRAC_PI_2),
        ] {
            let mut count = 0;
            let found = zero(
                &mut |x| {
                    count += 1;
                    Some(f(x))
                },
                (left, f(left)),
                (right, f(right)),
                1e-10,
            );
            let found = found.expect("a change of sign");
            assert!((found - expected).abs() < 2e-10, "{found} instead of {expected}");
            // two per halving of the bracket
            assert!(count <= 80, "{count} evaluations");
        }
        assert_eq!(zero(&mut |x| Some(x), (1.0, 1.0), (2.0, 2.0), 1e-9), None);
        assert_eq!(zero(&mut |_| None, (-1.0, -1.0), (2.0, 2.0), 1e-9), None);
    }
}
