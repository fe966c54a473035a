//! Do we solve the equations right? Conformity of every kind, identities, conservation, agreement of methods and codes.

#![allow(non_snake_case)]

mod bundled;
mod composition;
mod every_backend;
mod every_constraint;
mod every_element;
mod every_joint;
mod inclines;
mod invariance;
mod linear;
mod mechanisms;
mod recorded;
mod responses;
mod ride;
mod rider;
mod roads;
mod sensitivity;
mod trim;
mod two_loops;

use validation::evidence;

#[test]
fn the_table_of_evidence_is_up_to_date() {
    evidence::hold(
        "verification",
        &[
            every_joint::EVIDENCE,
            every_element::EVIDENCE,
            every_constraint::EVIDENCE,
            every_backend::EVIDENCE,
            mechanisms::EVIDENCE,
            trim::EVIDENCE,
            linear::EVIDENCE,
            responses::EVIDENCE,
            bundled::EVIDENCE,
            composition::EVIDENCE,
            invariance::EVIDENCE,
            sensitivity::EVIDENCE,
            ride::EVIDENCE,
            roads::EVIDENCE,
            inclines::EVIDENCE,
            two_loops::EVIDENCE,
            rider::EVIDENCE,
        ],
    );
}
