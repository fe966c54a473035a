//! The table of evidence: which claim is held by which test, against which source, how closely and why.
//!
//! Tests declare their rows beside them with [`evidence!`](crate::evidence!); the name of a test that does not exist does not
//! compile. Each test target holds its part of `tests/README.md`; with `UPDATE_EVIDENCE=1` it rewrites that part.

use std::path::PathBuf;
use std::sync::Mutex;
use std::{env, fs};

/// One claim.
#[derive(Clone, Copy, Debug)]
pub struct Row {
    /// What is claimed.
    pub claim: &'static str,
    /// Reference: publication, program, or identity.
    pub source: &'static str,
    /// Digits or tolerance, and why.
    pub tolerance: &'static str,
    /// The test that holds it.
    pub test: &'static str,
}

/// Rows of evidence: `evidence![test => (claim, source, tolerance), …]`.
#[macro_export]
macro_rules! evidence {
    ($($test:ident => ($claim:expr, $source:expr, $tolerance:expr)),+ $(,)?) => {
        &[$({
            const _: fn() = $test;
            $crate::evidence::Row {
                claim: $claim,
                source: $source,
                tolerance: $tolerance,
                test: concat!(module_path!(), "::", stringify!($test)),
            }
        }),+]
    };
}

fn table(rows: &[&[Row]]) -> String {
    let mut text = String::from("| claim | reference | agreement, and why | test |\n|---|---|---|---|\n");
    for row in rows.iter().flat_map(|rows| rows.iter()) {
        let cell = |text: &str| text.replace('|', "\\|");
        text += &format!("| {} | {} | {} | `{}` |\n", cell(row.claim), cell(row.source), cell(row.tolerance), row.test);
    }
    text
}

/// Holds one part of `tests/README.md` to the declared rows.
///
/// # Panics
/// The part is missing or stale.
pub fn hold(part: &str, rows: &[&[Row]]) {
    hold_text(part, &table(rows));
}

/// Holds one part of `tests/README.md` to a text that a test makes.
///
/// # Panics
/// The part is missing or stale.
pub fn hold_text(part: &str, fresh: &str) {
    // tests of one binary run at the same time
    static FILE: Mutex<()> = Mutex::new(());
    let _alone = FILE.lock();
    let path = PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("README.md");
    let text = fs::read_to_string(&path).expect("tests/README.md can be read");
    let (open, close) = (format!("<!-- {part}: made from the tests -->\n"), format!("<!-- end of {part} -->"));
    let parts = text.split_once(&open).and_then(|(before, rest)| rest.split_once(&close).map(|(inside, after)| (before, inside, after)));
    let Some((before, inside, after)) = parts else { panic!("tests/README.md has no part `{part}`") };
    if inside == fresh {
        return;
    }
    assert!(env::var_os("UPDATE_EVIDENCE").is_some(), "tests/README.md is stale: run the tests once with UPDATE_EVIDENCE=1");
    fs::write(&path, format!("{before}{open}{fresh}{close}{after}")).expect("tests/README.md can be written");
}
