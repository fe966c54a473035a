//! KINSOL on the same classic systems as the native method.

#[path = "../../native/tests/classic/mod.rs"]
mod classic;

use classic::*;
use problem::{AlgebraicEnding, AlgebraicMethod, AlgebraicOptions};
use std::panic::{AssertUnwindSafe, catch_unwind};
use sundials::{Kinsol, Strategy};

#[test]
fn published_solutions() {
    published_solutions_are_reached(&mut Kinsol::default());
}

#[test]
fn full_steps_reach_the_easy_ones() {
    let mut kinsol = Kinsol::new(Strategy::FullStep);
    for system in [rosenbrock(), powell_singular(), broyden_tridiagonal()] {
        let (outcome, _) = system.solve(&mut kinsol, &AlgebraicOptions::default());
        assert!(outcome.converged(), "{outcome:?}");
    }
}

#[test]
fn accelerated_iterations_reach_the_easy_ones_with_few_matrices() {
    for strategy in [Strategy::Picard, Strategy::FixedPoint] {
        let mut kinsol = Kinsol::new(strategy);
        for _ in 0..2 {
            let (outcome, x) = broyden_tridiagonal().solve(&mut kinsol, &AlgebraicOptions::default());
            assert!(outcome.converged() && outcome.effort.jacobians <= 3, "{} {outcome:?}", kinsol.name());
            let (newton, exact) = broyden_tridiagonal().solve(&mut Kinsol::default(), &AlgebraicOptions::default());
            assert!(
                newton.effort.jacobians > outcome.effort.jacobians && x.iter().zip(&exact).all(|(a, b)| (a - b).abs() < 1e-8),
                "{newton:?}"
            );
        }
        assert_eq!(ending_of(parallel_lines(), &mut kinsol).0, AlgebraicEnding::Singular);
        assert!(matches!(ending_of(undefined_at_the_start(), &mut kinsol).0, AlgebraicEnding::Evaluation(_)));
        assert!(!matches!(ending_of(no_real_root(), &mut kinsol).0, AlgebraicEnding::Converged));
        let panic = catch_unwind(AssertUnwindSafe(|| ending_of(panics_away_from_the_start(), &mut kinsol))).unwrap_err();
        assert_eq!(panic.downcast_ref::<&str>(), Some(&"the law has no value here"));
    }
}

#[test]
fn products_lead_to_the_same_solutions() {
    let mut kinsol = Kinsol::new(Strategy::Krylov);
    for _ in 0..2 {
        for system in [rosenbrock, powell_singular, broyden_tridiagonal] {
            let (outcome, x) = system().solve(&mut kinsol, &AlgebraicOptions::default());
            assert!(outcome.converged() && outcome.effort.products > 0, "{outcome:?}");
            assert!(outcome.effort.jacobians <= outcome.effort.iterations / 10 + 2, "{outcome:?}");
            let (_, exact) = system().solve(&mut Kinsol::default(), &AlgebraicOptions::default());
            // the solution of one of them is a multiple root
            assert!(x.iter().zip(&exact).all(|(a, b)| (a - b).abs() < 1e-2), "{x:?} {exact:?}");
        }
    }
    assert!(matches!(ending_of(undefined_at_the_start(), &mut kinsol).0, AlgebraicEnding::Evaluation(_)));
    assert!(!matches!(ending_of(no_real_root(), &mut kinsol).0, AlgebraicEnding::Converged));
    assert_eq!(ending_of(parallel_lines(), &mut kinsol).0, AlgebraicEnding::Singular);
    let panic = catch_unwind(AssertUnwindSafe(|| ending_of(panics_away_from_the_start(), &mut kinsol))).unwrap_err();
    assert_eq!(panic.downcast_ref::<&str>(), Some(&"the law has no value here"));
}

#[test]
fn undefined_regions() {
    undefined_regions_are_left(&mut Kinsol::default());
}

#[test]
fn units() {
    units_do_not_matter(&mut Kinsol::default());
}

#[test]
fn bounds() {
    bounds_are_respected(&mut Kinsol::default());
}

#[test]
fn failures() {
    failures_are_named(&mut Kinsol::default());
}

#[test]
fn local_minima() {
    local_minima_are_no_solutions(&mut Kinsol::default());
}

#[test]
fn derivatives() {
    derivatives_fit_their_functions();
}

#[test]
fn a_panic_passes_through_and_leaves_the_solver_usable() {
    let mut kinsol = Kinsol::default();
    let panic = catch_unwind(AssertUnwindSafe(|| ending_of(panics_away_from_the_start(), &mut kinsol))).unwrap_err();
    assert_eq!(panic.downcast_ref::<&str>(), Some(&"the law has no value here"));
    published_solutions_are_reached(&mut kinsol);
}

#[test]
fn solvers_on_two_threads_agree_to_the_last_bit() {
    let solve = |mut kinsol: Kinsol| {
        let mut system = brown_almost_linear();
        let mut x = system.start();
        kinsol.solve(&mut system, &mut x, &AlgebraicOptions::default());
        x
    };
    // created here, moved there
    let (here, there) = (Kinsol::default(), Kinsol::default());
    let other = std::thread::spawn(move || solve(there));
    assert_eq!(solve(here), other.join().unwrap());
}

#[test]
fn the_linked_version_is_the_vendored_one() {
    assert_eq!(sundials::version(), "7.1.1");
}
