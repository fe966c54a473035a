//! Are they the right equations? Published cases, one file each.

#![allow(non_snake_case)]

mod bicycle;
mod chain;
mod gsxr1000;
mod gsxr1000_acceleration;
mod gsxr1000_cornering;
mod gsxr1000_linkage;
mod mechanisms;
mod motions;
mod moto11;
mod ref11;
mod responses;
mod rides;
mod rolling_disc;
mod sel04;
mod setup;
mod sharp1971;
mod tire_property_files;
mod topologies;
mod trends;

use validation::evidence;

#[test]
fn the_table_of_evidence_is_up_to_date() {
    let vehicles = [ref11::EVIDENCE, gsxr1000::EVIDENCE, gsxr1000_cornering::EVIDENCE, moto11::EVIDENCE, sel04::EVIDENCE, chain::EVIDENCE];
    let rows: Vec<_> = vehicles
        .iter()
        .chain(bicycle::EVIDENCE)
        .chain([
            &mechanisms::EVIDENCE,
            &motions::EVIDENCE,
            &rolling_disc::EVIDENCE,
            &gsxr1000_linkage::EVIDENCE,
            &responses::EVIDENCE,
            &gsxr1000_acceleration::EVIDENCE,
            &sharp1971::EVIDENCE,
            &trends::EVIDENCE,
            &tire_property_files::EVIDENCE,
            &rides::EVIDENCE,
            &setup::EVIDENCE,
        ])
        .chain(topologies::EVIDENCE)
        .copied()
        .collect();
    evidence::hold("validation", &rows);
}
