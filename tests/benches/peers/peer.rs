//! What the peers need, and the table of quotients.

use crate::clock::Measured;
use std::process::Command;

/// A case and what the peers need for it, in nanoseconds.
struct Row {
    case: &'static str,
    pinocchio: Option<f64>,
    generated: Option<f64>,
    /// Largest quotient to Pinocchio that the design allows.
    allowed: Option<f64>,
}

const fn row(case: &'static str, pinocchio: f64, generated: f64, allowed: f64) -> Row {
    Row { case, pinocchio: Some(pinocchio), generated: Some(generated), allowed: Some(allowed) }
}

/// Least time per call. Pinocchio 4.1 in C++ (clang -O3 -march=native) and C generated from Pinocchio through CasADi solve the same
/// equations; both were measured on another machine of the same class (a cloud machine with two cores), so the quotients carry the
/// difference between the machines. The tree of 38 degrees of freedom was a public humanoid of the same size there.
const PEERS: &[Row] = &[
    row("rnea moto11", 490.0, 140.0, 1.0),
    row("aba moto11", 990.0, 280.0, 1.0),
    Row { case: "crba moto11", pinocchio: Some(328.0), generated: Some(74.0), allowed: None },
    row("drnea moto11", 2_000.0, 790.0, 2.0),
    row("rnea tree38", 2_800.0, 1_200.0, 1.0),
    row("aba tree38", 5_500.0, 2_500.0, 1.0),
    Row { case: "drnea tree38", pinocchio: Some(10_700.0), generated: None, allowed: Some(2.0) },
    row("trim moto11, native Newton", 37_000.0, 7_100.0, 1.0),
    row("trim moto11, KINSOL", 37_000.0, 7_100.0, 1.0),
    row("state matrix moto11", 61_000.0, 2_900.0, 25.0 / 61.0),
];

/// Largest times that the design allows where no peer was timed, in nanoseconds.
const BUDGETS: &[(&str, f64)] = &[
    ("modes moto11, one of 200 speeds", 180_000.0),
    ("map moto11, 600 trims", 50_000_000.0),
    ("second of moto11, IDA", 5_000_000.0),
    ("second of moto11, dopri5", 1_100_000.0),
    ("second of moto11, erk", 1_100_000.0),
    ("second of moto11, CVODE", 1_100_000.0),
    ("lane change of gsxr1000, IDA", 100_000_000.0),
];

/// Prints the table of everything that was measured.
pub fn print(measured: &[Measured]) {
    println!("\nleast processor time per call, and quotients to the peers (measured on another machine of the same class)");
    println!("{:<34}{:>12}{:>14}{:>14}{:>10}", "case", "µs", "/ Pinocchio", "/ generated C", "allowed");
    for Measured { name, least } in measured {
        let row = PEERS.iter().find(|row| row.case == name);
        let quotient = |peer: Option<f64>| peer.map_or("–".to_owned(), |peer| format!("{:.2}", least / peer));
        let (pinocchio, generated) = (quotient(row.and_then(|r| r.pinocchio)), quotient(row.and_then(|r| r.generated)));
        let allowed = row.and_then(|r| r.allowed).map_or("–".to_owned(), |a| format!("≤ {a:.2}"));
        println!("{name:<34}{:>12.3}{pinocchio:>14}{generated:>14}{allowed:>10}", least / 1e3);
    }
    for (case, budget) in BUDGETS {
        if let Some(measured) = measured.iter().find(|m| m.name == *case) {
            println!("{case}: {:.2} of its budget of {:.0} µs", measured.least / budget, budget / 1e3);
        }
    }
    same_machine(measured);
}

/// Times Pinocchio where its Python package is, on this machine and in this run: in C++ if that can be compiled.
fn same_machine(measured: &[Measured]) {
    let Ok(python) = std::env::var("PINOCCHIO_PYTHON") else {
        println!("\nPINOCCHIO_PYTHON is not set: no peer was timed on this machine.");
        return;
    };
    let output = Command::new(&python).arg("-c").arg(include_str!("pinocchio.py")).current_dir(env!("CARGO_MANIFEST_DIR")).output();
    let text = match output {
        Ok(output) if output.status.success() => String::from_utf8_lossy(&output.stdout).into_owned(),
        Ok(output) => return println!("\n{python} failed: {}", String::from_utf8_lossy(&output.stderr)),
        Err(error) => return println!("\n{python} cannot be run: {error}"),
    };
    let how = text.lines().find_map(|line| line.strip_prefix("# ")).unwrap_or("Pinocchio");
    println!("\non this machine, in this run: {how}");
    println!("{:<34}{:>12}{:>14}{:>10}", "case", "µs", "ours / it", "allowed");
    for line in text.lines() {
        let Some((case, ns)) = line.split_once('\t') else { continue };
        let Ok(ns) = ns.parse::<f64>() else { continue };
        let quotient = measured.iter().find(|m| m.name == case).map_or("–".to_owned(), |m| format!("{:.2}", m.least / ns));
        let allowed =
            PEERS.iter().find(|row| row.case == case).and_then(|row| row.allowed).map_or("–".to_owned(), |a| format!("≤ {a:.2}"));
        println!("{case:<34}{:>12.3}{quotient:>14}{allowed:>10}", ns / 1e3);
    }
}
