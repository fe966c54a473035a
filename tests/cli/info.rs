//! `info`: what there is.

use super::fastbike;

#[test]
fn without_a_model_the_bundled_ones_are_listed() {
    let answer = fastbike(&["info"]);
    assert_eq!((answer.status, answer.stderr.as_str()), (0, ""));
    for model in ["gsxr1000", "moto11", "ref11", "tree38"] {
        assert!(answer.stdout.lines().any(|l| l.trim_start().starts_with(model)), "{model}: {}", answer.stdout);
    }
}

#[test]
fn a_model_is_told_with_bodies_elements_and_signals() {
    let answer = fastbike(&["info", "ref11"]);
    assert_eq!((answer.status, answer.stderr.as_str()), (0, ""));
    let text = answer.stdout;
    for section in
        ["bodies and joints (in the order of q and v)", "elements", "coordinates", "velocities", "element states", "inputs", "outputs"]
    {
        assert!(text.lines().any(|l| l == section), "`{section}`: {text}");
    }
    for signal in ["chassis.roll", "steer.angle", "steer.torque", "front_brake.torque", "rear_tire.normal_force", "lateral_acceleration"] {
        assert!(text.lines().any(|l| l.split_whitespace().next() == Some(signal)), "`{signal}`: {text}");
    }
    assert!(text.contains("6 moving bodies, 11 degrees of freedom"), "{text}");
}

#[test]
fn every_kind_is_told_with_an_example() {
    let answer = fastbike(&["info", "--kinds"]);
    assert_eq!((answer.status, answer.stderr.as_str()), (0, ""));
    for kind in fastbike::standard_kinds().elements() {
        assert!(answer.stdout.contains(&format!("{} — {}", kind.name, kind.about)), "{}", kind.name);
        assert!(answer.stdout.contains(&format!("example: {}: ", kind.name)), "{}", kind.name);
    }
    for kind in motorcycle::maneuver::section::KINDS {
        assert!(answer.stdout.contains(&format!("{} — {}", kind.name, kind.about)), "{}", kind.name);
        assert!(answer.stdout.contains(&format!("example: {}: ", kind.name)), "{}", kind.name);
    }
}
