//! Instructions per call of the kernels, counted by valgrind: a guard against regressions that no neighbor disturbs.
//!
//! `RUSTFLAGS="-C target-cpu=x86-64-v2" CARGO_TARGET_DIR=target/instructions cargo bench -p validation --bench peers -- --instructions` runs itself under callgrind, each case twice with different numbers of calls, so that what
//! happens once cancels; counts more than [`ALLOWED`] above those of `instructions.csv` fail. `UPDATE_INSTRUCTIONS=1` writes that file. The older instruction set is that which the valgrind of a Debian 12 knows in full: of the usual
//! one it misses a form of `vmovq`. The counts belong to the profile of the workspace and to one compiler: after another one they are written anew.

use crate::clock::Clock;
use std::path::Path;
use std::process::Command;

/// What is counted, and over how many calls: some 50 million instructions, beside which the some 200 000 by which the way there differs from run to run (hash tables with random keys) are half a percent.
const CASES: [(&str, u64); 12] = [
    ("rnea moto11", 8192),
    ("aba moto11", 4096),
    ("crba moto11", 8192),
    ("drnea moto11", 2048),
    ("rnea tree38", 2048),
    ("aba tree38", 1024),
    ("crba tree38", 1024),
    ("drnea tree38", 512),
    ("residual moto11", 4096),
    ("residual gsxr1000", 2048),
    ("jacobian moto11", 256),
    ("frequency point moto11", 2048),
];

/// Share by which a count may grow.
const ALLOWED: f64 = 0.03;

/// Calls of the first of the two runs of a case.
const FIRST: u64 = 64;

/// A clock that only runs one case for some calls, where this process is one of the counted ones: `--count CASE CALLS`.
pub fn counted() -> Option<Clock> {
    let arguments: Vec<String> = std::env::args().collect();
    let at = arguments.iter().position(|a| a == "--count")?;
    Some(Clock::calling(arguments.get(at + 1)?, arguments.get(at + 2)?.parse().ok()?))
}

/// Whether counting is asked for.
pub fn asked() -> bool {
    std::env::args().any(|a| a == "--instructions")
}

/// Instructions of this program with some calls of a case.
fn whole(case: &str, calls: u64) -> Result<u64, String> {
    let program = std::env::current_exe().map_err(|e| e.to_string())?;
    let counting = ["--tool=callgrind", "--callgrind-out-file=/dev/null"];
    let output = Command::new("valgrind").args(counting).arg(program).args(["--count", case, &calls.to_string()]).output();
    let output = output.map_err(|e| format!("valgrind cannot be run: {e}"))?;
    let told = String::from_utf8_lossy(&output.stderr);
    if !output.status.success() {
        let hint = if cfg!(target_feature = "avx2") {
            "build with RUSTFLAGS=\"-C target-cpu=x86-64-v2\", whose instructions it knows"
        } else {
            ""
        };
        return Err(format!("the program ended early under valgrind ({}); {hint}\n{told}", output.status));
    }
    // programs that are looked for are counted too, by themselves: the largest count is that of this one
    let collected = told.lines().filter_map(|line| line.split_once("Collected :")?.1.trim().parse().ok()).max();
    collected.ok_or_else(|| format!("valgrind tells no count:\n{told}"))
}

/// Counts, prints and judges; whether everything is as it was.
pub fn run() -> bool {
    let file = Path::new(env!("CARGO_MANIFEST_DIR")).join("benches/peers/instructions.csv");
    let written = std::fs::read_to_string(&file).unwrap_or_default();
    let before = |case: &str| written.lines().find_map(|line| line.strip_prefix(case)?.strip_prefix(',')?.parse::<f64>().ok());
    let (mut text, mut kept) = (String::from("case,instructions\n"), true);
    println!("{:<28}{:>14}{:>14}{:>10}", "case", "instructions", "before", "quotient");
    for (case, calls) in CASES {
        let counts = [FIRST, FIRST + calls].map(|calls| whole(case, calls));
        let [Ok(few), Ok(many)] = counts else {
            println!("{case}: {}", counts.into_iter().find_map(Result::err).unwrap_or_default());
            return false;
        };
        let each = many.saturating_sub(few) as f64 / calls as f64;
        assert!(each > 0.0, "nothing was counted for `{case}`");
        text += &format!("{case},{each:.0}\n");
        let quotient = before(case).map(|before| each / before);
        kept &= quotient.is_some_and(|q| q <= 1.0 + ALLOWED);
        let told = |value: Option<f64>, digits: usize| value.map_or("–".to_owned(), |v| format!("{v:.digits$}"));
        println!("{case:<28}{each:>14.0}{:>14}{:>10}", told(before(case), 0), told(quotient, 3));
    }
    if std::env::var_os("UPDATE_INSTRUCTIONS").is_some() {
        return std::fs::write(&file, text).is_ok();
    }
    if !kept {
        println!("more than {} % above `instructions.csv`, or a case that it does not have", 100.0 * ALLOWED);
    }
    kept
}
