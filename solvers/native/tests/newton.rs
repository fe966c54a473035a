//! The native Newton method on classic systems.

mod classic;

use classic::*;
use native::Newton;
use problem::{AlgebraicMethod, AlgebraicOptions};

#[test]
fn published_solutions() {
    published_solutions_are_reached(&mut Newton::new());
    published_solutions_are_reached(&mut Newton::simplified());
}

#[test]
fn kept_matrices_save_jacobians() {
    let options = AlgebraicOptions::default();
    let [full, kept] = [Newton::new(), Newton::simplified()].map(|mut newton| broyden_tridiagonal().solve(&mut newton, &options).0);
    assert!(full.converged() && kept.converged() && kept.effort.jacobians < full.effort.jacobians, "{full:?} {kept:?}");
}

#[test]
fn undefined_regions() {
    undefined_regions_are_left(&mut Newton::new());
}

#[test]
fn units() {
    units_do_not_matter(&mut Newton::new());
}

#[test]
fn bounds() {
    bounds_are_respected(&mut Newton::new());
    bounds_are_respected(&mut Newton::simplified());
}

#[test]
fn failures() {
    failures_are_named(&mut Newton::new());
    failures_are_named(&mut Newton::simplified());
}

#[test]
fn local_minima() {
    local_minima_are_no_solutions(&mut Newton::new());
}

#[test]
fn derivatives() {
    derivatives_fit_their_functions();
}

#[test]
#[should_panic(expected = "the law has no value here")]
fn panics_go_on() {
    ending_of(panics_away_from_the_start(), &mut Newton::new());
}

#[test]
fn the_second_solve_of_a_size_allocates_nothing() {
    let (mut newton, options) = (Newton::new(), AlgebraicOptions::default());
    for mut system in [helical_valley(), powell_singular(), brown_almost_linear()] {
        let (start, mut x) = (system.start(), system.start());
        newton.solve(&mut system, &mut x, &options);
        let count = allocation_counter::measure(|| {
            x.copy_from_slice(&start);
            newton.solve(&mut system, &mut x, &options);
        });
        assert_eq!(count.count_total, 0);
    }
}
