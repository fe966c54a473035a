//! What a crate outside can do with its own elements, and what is asked of them.

use external_element::{BrushParameters, EddyCurrentDamper, KINDS, kinds};
use fastbike::run_captured;
use mbody::model::BodyIndex;
use motorcycle::tire::{LawParameters, Slip, TireLaw, conformity};
use serde_json::Value;
use validation::conformity::Conformity;

const MODEL: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/models/mybike.yaml");

/// A tire with the friction law of the crate.
const BRUSH: &str = "{ wheel: front_axle, radius: 0.3 m, crown: { torus: { radius: 60 mm } }, road: front_road, \
     law: { brush: { cornering_stiffness: 12, camber_stiffness: 0.9, friction: 1.2, half_length: 0.045 } }, \
     carcass: { deformable: { radial: { stiffness: 150 kN/m, damping: 300 N s/m }, lateral: { stiffness: 160 kN/m, damping: 100 N s/m } } } }";

fn brush() -> BrushParameters {
    BrushParameters { cornering_stiffness: 12.0, camber_stiffness: 0.9, friction: 1.2, half_length: 0.05 }
}

fn json(arguments: &[&str]) -> Value {
    let answer = run_captured(kinds(), arguments);
    assert_eq!(answer.status, 0, "{arguments:?}: {}", answer.stderr);
    serde_json::from_str(&answer.stdout).unwrap_or_else(|e| panic!("{arguments:?}: {e}"))
}

fn number(value: &Value) -> f64 {
    value.as_f64().unwrap_or_else(|| panic!("{value} is no number"))
}

#[test]
fn the_friction_law_conforms() {
    conformity::holds(&brush().law().expect("a tire"));
}

/// Half of the sliding slip: 7/8 of the friction (Pacejka 2012, 3.2: 1 − (1 − θσ)³); beyond it all of it.
#[test]
fn the_brush_slides_where_it_should() {
    let law = brush().law().expect("a tire");
    let sliding = 3.0 * 1.2 / 12.0;
    let at = |lateral: f64| law.friction(&Slip { load: 1000.0, lateral, longitudinal: 0.0, camber: 0.0, speed: 20.0 });
    assert!((at(0.5 * sliding).lateral - 1050.0).abs() < 1e-3 && (at(2.0 * sliding).lateral - 1200.0).abs() < 1e-9);
    assert!((at(2.0 * sliding).utilization - 1.0).abs() < 1e-12 && at(2.0 * sliding).aligning_moment == 0.0);
    assert!(brush().law().is_ok() && BrushParameters { friction: 0.0, ..brush() }.law().is_err());
}

/// At ω_m the greatest torque, at half and twice of it 0.8 of that.
#[test]
fn the_damper_fades() {
    let damper = EddyCurrentDamper { joint: BodyIndex::WORLD, greatest: 20.0, rate: 6.0 };
    for (rate, share) in [(6.0, 1.0), (3.0, 0.8), (12.0, 0.8), (-6.0, -1.0)] {
        assert!((damper.torque(rate) - share * 20.0).abs() < 1e-12);
    }
}

/// What is asked of every kind of FastBike itself: schema, exact derivatives, balance of power, symmetry of the road, no allocation.
#[test]
fn the_elements_conform() {
    let conformity = Conformity::of(kinds(), KINDS, &[("tire", BRUSH)]);
    conformity.the_schema_accepts_every_example_and_refuses_unknown_keys();
    conformity.derivatives_are_exact();
    conformity.energy_is_accounted_for();
    conformity.nothing_depends_on_place_and_heading();
    conformity.dual_numbers_carry_the_same_values();
    conformity.evaluation_allocates_nothing(|run| allocation_counter::measure(run).count_total);
}

#[test]
fn the_command_knows_the_elements() {
    let check = run_captured(kinds(), ["check", MODEL]);
    assert_eq!((check.status, check.stderr.as_str()), (0, ""), "{}", check.stdout);
    let info = run_captured(kinds(), ["info", "--kinds"]).stdout;
    assert!(info.contains("eddy_current_damper — eddy-current damper"), "{info}");
    let schema = run_captured(kinds(), ["schema"]).stdout;
    assert!(schema.contains("\"brush\"") && schema.contains("\"eddy_current_damper\""));
    // the standard command does not know them, and says so
    let standard = run_captured(fastbike::standard_kinds(), ["check", MODEL]);
    assert!(standard.status == 2 && format!("{}{}", standard.stdout, standard.stderr).contains("eddy_current_damper"));
}

#[test]
fn the_vehicle_turns_and_its_damper_calms_the_wobble() {
    let trim = json(&["trim", MODEL, "--speed", "30", "--lean", "35deg", "--format", "json"]);
    let signal = |name: &str| number(&trim["points"][0]["signals"][name]);
    assert_eq!(trim["points"][0]["ending"], "reached");
    // linear bristles push as slip and camber say
    let use_of = signal("rear_tire.friction_use");
    assert!((0.3..0.9).contains(&use_of), "{use_of}");
    let wobble = |set: &[&str]| {
        let modes = json(&[&["modes", MODEL, "--speed", "40", "--format", "json"], set].concat());
        let modes = modes["points"][0]["modes"].as_array().cloned().unwrap_or_default();
        let named = modes.iter().find(|m| m["name"] == "wobble").unwrap_or_else(|| panic!("no wobble: {modes:?}"));
        number(&named["damping_ratio"])
    };
    let (strong, weak) = (wobble(&[]), wobble(&["--set", "magnet_damper.torque=2 N m"]));
    assert!(strong > weak + 0.05, "{strong} {weak}");
}

#[test]
fn mistakes_are_told() {
    for (set, expected) in
        [("magnet_damper.torqe=3 N m", "torque"), ("magnet_damper.rate=3 N m", "rad/s"), ("rear_tire.law.brush.friction=-1", "friction")]
    {
        let answer = run_captured(kinds(), ["check", MODEL, "--set", set]);
        let said = format!("{}{}", answer.stdout, answer.stderr);
        assert!(answer.status == 2 && said.contains(expected), "{set}: {said}");
    }
}
