//! Every kind of element, assembled from its own example: nothing is listed here, a new row of a table of kinds is held at once.

use std::sync::LazyLock;
use validation::conformity::Conformity;
use validation::evidence::Row;

/// Rows of the table.
pub const EVIDENCE: &[Row] = validation::evidence![
    the_schema_accepts_every_example_and_refuses_unknown_keys => (
        "the schema accepts the example of every kind of element and refuses an unknown key at any depth of it",
        "the kinds themselves",
        "exact"
    ),
    derivatives_are_exact => (
        "derivatives of residual and outputs of every kind of element along every y, ẏ and u are exact, in four regimes of motion",
        "central differences, extrapolated (Richardson)",
        "relative 1e-6, and 64 ulp of the largest force over the step: rounding of the differences after some hundred operations"
    ),
    energy_is_accounted_for => (
        "P = −d(stored)/dt + supplied − dissipated for every kind of element",
        "balance of power",
        "1e-13 of the largest term: double precision"
    ),
    nothing_depends_on_place_and_heading => (
        "forces and outputs of every kind of element do not see x, y and yaw; positions on the road move along",
        "symmetry of the level road",
        "1e-10 of the largest row, 1e-11 of the largest output: double precision"
    ),
    dual_numbers_carry_the_same_values => (
        "evaluation on dual numbers of 8, 16 and 24 directions gives the values of plain numbers, for every kind of element",
        "identity",
        "exact: the same operations"
    ),
    evaluation_allocates_nothing => (
        "evaluation of residual, outputs and derivatives allocates nothing, for every kind of element",
        "counting allocator",
        "exact"
    ),
];

/// Elements beside the examples: what the shortest written form of a kind leaves to a file.
const BESIDE: [(&str, &str); 2] = [
    ("tire", "{ wheel: front_axle, law: { tir: mf61_example.tir }, road: front_road }"),
    (
        "tire",
        "{ wheel: front_axle, radius: 0.3 m, crown: { torus: { radius: 60 mm } }, law: { tir: { file: mf52_example.tir, beyond_fit: extrapolate } }, \
         carcass: { deformable: { radial: { stiffness: 150 kN/m, damping: 300 N s/m }, lateral: { stiffness: 160 kN/m, damping: 100 N s/m } } } }",
    ),
];

/// All kinds, assembled once.
static KINDS: LazyLock<Conformity> = LazyLock::new(|| {
    let kinds = fastbike::standard_kinds();
    let held = kinds.elements().to_vec();
    Conformity::of(kinds, &held, &BESIDE)
});

#[test]
fn the_schema_accepts_every_example_and_refuses_unknown_keys() {
    KINDS.the_schema_accepts_every_example_and_refuses_unknown_keys();
}

#[test]
fn derivatives_are_exact() {
    KINDS.derivatives_are_exact();
}

#[test]
fn energy_is_accounted_for() {
    KINDS.energy_is_accounted_for();
}

#[test]
fn nothing_depends_on_place_and_heading() {
    KINDS.nothing_depends_on_place_and_heading();
}

#[test]
fn dual_numbers_carry_the_same_values() {
    KINDS.dual_numbers_carry_the_same_values();
}

#[test]
fn evaluation_allocates_nothing() {
    KINDS.evaluation_allocates_nothing(|run| allocation_counter::measure(run).count_total);
}
