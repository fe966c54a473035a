//! Are they the right equations? Published cases, one file each.

#![allow(non_snake_case)]

mod chain;
mod gsxr1000;
mod moto11;
mod ref11;
mod sel04;

use validation::evidence;

#[test]
fn the_table_of_evidence_is_up_to_date() {
    evidence::hold("validation", &[ref11::EVIDENCE, gsxr1000::EVIDENCE, moto11::EVIDENCE, sel04::EVIDENCE, chain::EVIDENCE]);
}
