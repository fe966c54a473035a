//! `compare`: rows of methods, their errors, failures that do not end the comparison.

use super::{fastbike, folder, json, number};
use ::fastbike::backend::{ALGEBRAIC, INTEGRATION};

const BICYCLE: [&str; 9] =
    ["compare", "whipple", "--duration", "1s", "--given", "chassis.roll_rate=0.05", "--repeats", "1", "--rtol=1e-5,1e-8"];

#[test]
fn every_method_is_as_good_as_its_tolerance_says() {
    let report = json(&[&BICYCLE[..], &["--format", "json"]].concat(), 0);
    let rows = report["rows"].as_array().expect("rows");
    let mut backends: Vec<&str> = rows.iter().filter_map(|r| r["backend"].as_str()).collect();
    backends.dedup();
    assert_eq!(backends, INTEGRATION.iter().map(|b| b.name).collect::<Vec<_>>());
    for row in rows {
        for key in ["backend", "form", "jacobian", "ending", "wall_s", "steps", "residuals", "jacobians", "error"] {
            assert!(!row[key].is_null(), "`{key}` is missing in {row}");
        }
        assert_eq!(row["ending"], "reached");
        // either a tolerance or a step decides about the error
        let (rtol, step) = (&row["rtol"], &row["step_s"]);
        assert!(rtol.is_null() != step.is_null(), "{row}");
        // errors grow over a second, those of order two more than others
        let share = if row["backend"] == "generalized_alpha" { 1e6 } else { 1e4 };
        let allowed = if rtol.is_null() { 1e-1 } else { (share * number(rtol)).min(1e-1) };
        assert!(number(&row["error"]) < allowed, "{row}");
        assert!(number(&row["constraint_drift"]) < 1e-6 && number(&row["energy_drift"]) < 1e-2, "{row}");
    }
}

#[test]
fn formulations_are_an_axis_of_implicit_methods() {
    let report = json(&[&BICYCLE[..], &["--backends", "ida,erk", "--formulations", "ggl,velocity", "--format", "json"]].concat(), 0);
    let forms: Vec<&str> = report["rows"].as_array().expect("rows").iter().filter_map(|r| r["form"].as_str()).collect();
    assert_eq!(forms, ["ggl", "ggl", "velocity", "velocity", "explicit", "explicit"]);
}

#[test]
fn the_way_to_matrices_is_an_axis_of_methods_that_ask_for_some() {
    let report = json(&[&BICYCLE[..], &["--backends", "cvode,erk", "--jacobian", "exact,differences", "--format", "json"]].concat(), 0);
    let rows = report["rows"].as_array().expect("rows");
    let ways: Vec<&str> = rows.iter().filter_map(|r| r["jacobian"].as_str()).collect();
    assert_eq!(ways, ["exact", "exact", "differences", "differences", "–", "–"]);
    // quotients cost an evaluation per state
    assert!(number(&rows[0]["residuals"]) + 10.0 * number(&rows[0]["jacobians"]) < number(&rows[2]["residuals"]), "{report}");
}

#[test]
fn sweeps_of_steady_states_compare_solvers() {
    let report = json(&["compare", "moto11", "--speed", "10..40:10", "--repeats", "1", "--format", "json"], 0);
    let rows = report["rows"].as_array().expect("rows");
    assert_eq!(rows.len(), ALGEBRAIC.len());
    assert!(rows.iter().all(|r| number(&r["steps"]) == 4.0 && number(&r["rejected"]) == 0.0), "{report}");
    assert!(rows[1..].iter().all(|r| number(&r["error"]) < 1e-7), "{report}");
}

#[test]
fn the_figure_of_work_over_precision_is_written() {
    let file = folder("compare").join("work.svg");
    let answer = fastbike(&[&BICYCLE[..], &["--plot", file.to_str().expect("a path")]].concat());
    assert_eq!(answer.status, 0, "{}", answer.stderr);
    let figure = std::fs::read_to_string(file).expect("a figure");
    assert!(figure.contains("Wall time") && figure.contains("cvode_adams"));
    assert!(answer.stdout.contains("residuals") && answer.stdout.contains("erk"));
}

#[test]
fn mistakes_are_told_in_words() {
    for (arguments, word) in [
        (vec!["compare", "whipple", "--backends", "idda"], "ida"),
        (vec!["compare", "whipple", "--formulations", "gg"], "ggl"),
        (vec!["compare", "whipple", "--rtol", "1"], "out of range"),
        (vec!["compare", "whipple", "--repeats", "0"], "once"),
        (vec!["compare", "whipple", "--steps", "0ms"], "longer than 0"),
        (vec!["compare", "whipple", "--jacobian", "exakt"], "exact"),
        (vec!["compare", "ref11", "lane_chang"], "lane_change"),
    ] {
        let answer = fastbike(&arguments);
        assert!(answer.status == 2 && answer.stderr.contains(word), "{arguments:?}: {} {}", answer.status, answer.stderr);
    }
}
