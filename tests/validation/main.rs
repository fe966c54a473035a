//! Are they the right equations? Published cases, one file each.

#![allow(non_snake_case)]

mod chain;
mod gsxr1000;
mod gsxr1000_cornering;
mod moto11;
mod ref11;
mod sel04;

use validation::evidence::{self, Row};

const EVIDENCE: &[&[Row]] =
    &[ref11::EVIDENCE, gsxr1000::EVIDENCE, gsxr1000_cornering::EVIDENCE, moto11::EVIDENCE, sel04::EVIDENCE, chain::EVIDENCE];

#[test]
fn the_table_of_evidence_is_up_to_date() {
    evidence::hold("validation", EVIDENCE);
}
