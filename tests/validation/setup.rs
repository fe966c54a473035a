//! Setup of vehicles: published geometry, statics and energy as independent paths to loads, rates and ratios.

use serde_json::Value;
use validation::evidence::Row;

/// Rows of the table.
pub const EVIDENCE: &[Row] = validation::evidence![
    published_geometry_is_met => (
        "`setup`: rake, trail, wheelbase of the benchmark bicycle; rake, fork offset, wheelbase of the GSX-R1000",
        "Meijaard et al. (2007), table 1: π/10, 0.08 m, 1.02 m; Sharp, Evangelou, Limebeer (2004): 0.4189 rad, 1.410 m; MotorcycleLib prints an offset of 0.026553 m",
        "1e-9 for the bicycle; half of the last published digit for the GSX-R1000, whose static pose is its design pose to 1e-6"
    ),
    the_jack_carries_what_the_road_carries => (
        "`setup`: force of the jack at no travel is the load of the tires of the axle in the trim, for forks, arms, linkages, loops, bushings, three wheels",
        "equilibrium of the whole vehicle, another system of equations",
        "1e-6 of the load: the residual of the trim"
    ),
    wheel_rates_are_those_of_trims_under_load => (
        "`setup`: wheel rate of fork and linkage of the GSX-R1000",
        "fork by hand, K/cos² ε; rear by static trims with 2 kg more and less on the saddle, load over the height that the arm gives the wheel",
        "1e-6 by hand; 0.5 % by trims, whose chassis pitches"
    ),
    forces_and_motion_ratios_do_one_work => (
        "`setup`: work of the jack from full extension to the stop is what springs store and weights gain, on four vehicles; what a fork does not carry is the weight of legs and wheel",
        "energy: F = Σ f τ + weight of what moves, integrated over the curve; 19.15 kg of the published data",
        "2e-3 of the work: trapezes of 2.5 mm over end stops"
    ),
    squat_is_that_of_the_line_through_the_squat_point => (
        "`setup`: squat angle by the path of the contact point with a locked drive; braking angle of a fork; shaft with its reaction on the arm",
        "Cossalter's construction (chain); −rake (fork); the line from contact to pivot, 0.36 m/0.48 m (sidecar)",
        "1e-6: differences over 0.4 mm"
    ),
    mass_center_and_inertia_are_sums => (
        "`setup`: mass center and inertia of the benchmark bicycle; shares of the components of the GSX-R1000 add up",
        "by hand from Meijaard et al. (2007), table 1: 94 kg, 32.16/94 m, 80.95/94 m",
        "1e-9"
    ),
];

fn setup(arguments: &[&str]) -> Value {
    command(&[&["setup"], arguments, &["--format", "json"]].concat())
}

fn command(arguments: &[&str]) -> Value {
    let answer = fastbike::run_captured(fastbike::standard_kinds(), arguments);
    assert_eq!(answer.status, 0, "{arguments:?}: {}", answer.stderr);
    serde_json::from_str(&answer.stdout).unwrap_or_else(|e| panic!("{arguments:?}: {e}"))
}

fn number(value: &Value) -> f64 {
    value.as_f64().unwrap_or_else(|| panic!("{value} is no number"))
}

fn numbers(value: &Value) -> Vec<f64> {
    value.as_array().unwrap_or_else(|| panic!("{value} is no list")).iter().map(number).collect()
}

#[track_caller]
fn close(value: &Value, expected: f64, tolerance: f64) {
    assert!((number(value) - expected).abs() <= tolerance, "{value} against {expected}, tolerance {tolerance}");
}

#[test]
fn published_geometry_is_met() {
    let bicycle = setup(&["whipple"]);
    let of = &bicycle["geometry"];
    close(&of["rake"], std::f64::consts::PI / 10.0, 1e-9);
    close(&of["trail"], 0.08, 1e-9);
    close(&of["wheelbase"], 1.02, 1e-9);
    close(&of["normal_trail"], 0.08 * (std::f64::consts::PI / 10.0).cos(), 1e-9);
    let gsxr = setup(&["gsxr1000"]);
    let of = &gsxr["geometry"];
    close(&of["rake"], 0.4189, 5e-5);
    close(&of["wheelbase"], 1.410, 5e-4);
    close(&of["fork_offset"], 0.026_553, 5e-7 + 1e-6);
    close(&of["normal_trail"], number(&of["trail"]) * number(&of["rake"]).cos(), 1e-9);
    let three = setup(&["sidecar"]);
    assert!(number(&three["geometry"]["track_width"]) > 1.0 && three["mass"]["front_load"].is_null(), "{}", three["mass"]);
}

#[test]
fn the_jack_carries_what_the_road_carries() {
    for (model, axles) in [
        ("gsxr1000", &[("front", "front_tire"), ("rear", "rear_tire")][..]),
        ("telelever", &[("front", "front_tire"), ("rear", "rear_tire")]),
        ("duolever", &[("front", "front_tire"), ("rear", "rear_tire")]),
        ("scooter", &[("front", "front_tire"), ("rear", "rear_tire")]),
        ("sidecar", &[("front", "front_tire"), ("rear", "rear_tire"), ("side", "side_tire")]),
        ("tilting_three_wheeler", &[("rear", "rear_tire")]),
    ] {
        let report = setup(&[model]);
        for (axle, tire) in axles {
            let load = number(&report["forces"][format!("{tire}.normal_force")]);
            close(&report["suspensions"][axle]["load"], load, 1e-6 * load);
        }
    }
    let report = setup(&["tilting_three_wheeler"]);
    let load = ["left", "right"].map(|side| number(&report["forces"][format!("front_{side}_tire.normal_force")])).iter().sum::<f64>();
    close(&report["suspensions"]["front"]["load"], load, 1e-6 * load);
}

#[test]
fn wheel_rates_are_those_of_trims_under_load() {
    let report = setup(&["gsxr1000"]);
    let (front, rear) = (&report["suspensions"]["front"], &report["suspensions"]["rear"]);
    let rake = number(&report["geometry"]["rake"]);
    close(&front["wheel_rate"], 25e3 / rake.cos().powi(2), 0.03);
    close(&front["fork_strut.motion_ratio"], 1.0 / rake.cos(), 1e-8);
    close(&front["damping_bump"], 2134.0 / rake.cos().powi(2), 1e-3);
    // rear: the upper body of the rider heavier and lighter
    let states = ["31.68kg", "35.68kg"].map(|mass| {
        let set = format!("link.rider_upper.mass={mass}");
        let trim = command(&["trim", "gsxr1000", "--set", &set, "--format", "json"]);
        let signal = |name: &str| number(&trim["points"][0]["signals"][name]);
        (signal("rear_tire.normal_force"), signal("swingarm.angle"))
    });
    // height of the axle against the pivot, in the chassis: p11 (0.549, 0.3608), axle (0, 0.297)
    let height = |(_, angle): (f64, f64)| {
        let (x, z) = (-0.549f64, 0.297f64 - 0.3608);
        -x * angle.sin() + z * angle.cos()
    };
    let rate = (states[1].0 - states[0].0) / (height(states[1]) - height(states[0]));
    println!("rear wheel rate {} N/m on the stand, {rate} N/m by trims", number(&rear["wheel_rate"]));
    close(&rear["wheel_rate"], rate, 5e-3 * rate);
}

#[test]
fn forces_and_motion_ratios_do_one_work() {
    for (model, axle) in [("gsxr1000", "front"), ("gsxr1000", "rear"), ("telelever", "front"), ("sidecar", "side")] {
        let report = setup(&[model]);
        let suspension = &report["suspensions"][axle];
        let curve = &suspension["curve"];
        let (travel, load) = (numbers(&curve["travel"]), numbers(&curve["load"]));
        let springs = curve["springs"].as_object().unwrap_or_else(|| panic!("{curve}"));
        // what the springs do not carry is weight: the same at every travel but for levers of the arm
        let weight = |k: usize| -> f64 {
            let carried = springs.values().map(|s| numbers(&s["force"])[k] * numbers(&s["motion_ratio"])[k]);
            load[k] - carried.sum::<f64>()
        };
        let weights: Vec<f64> = (0..travel.len()).map(weight).collect();
        let spread = weights.iter().fold(0f64, |most, w| most.max((w - weights[0]).abs()));
        assert!(weights[0] > 50.0 && spread < 0.03 * number(&suspension["load"]), "{model} {axle}: {weights:?}");
        if (model, axle) == ("gsxr1000", "front") {
            // fork legs 7.25 kg and wheel 11.9 kg hang on the fork, whatever its travel
            assert!(weights.iter().all(|w| (w - (7.25 + 11.9) * 9.81).abs() < 1e-3), "{weights:?}");
        }
        let work = |force: &dyn Fn(usize) -> f64, along: &[f64]| -> f64 {
            (1..along.len()).map(|k| 0.5 * (force(k) + force(k - 1)) * (along[k] - along[k - 1])).sum()
        };
        let jack = work(&|k| load[k], &travel);
        let stored: f64 = springs
            .values()
            .map(|s| {
                let (force, compression) = (numbers(&s["force"]), numbers(&s["compression"]));
                work(&|k| force[k], &compression)
            })
            .sum();
        let gained = work(&|k| weights[k], &travel);
        println!("{model} {axle}: jack {jack} J, springs {stored} J, weights {gained} J");
        assert!((jack - stored - gained).abs() < 2e-3 * jack, "{model} {axle}: {jack} {stored} {gained}");
    }
}

#[test]
fn squat_is_that_of_the_line_through_the_squat_point() {
    for model in ["gsxr1000", "ref11", "supermoto"] {
        let report = setup(&[model]);
        let of = &report["pull"];
        let slope = number(&of["squat_point_height"]) / number(&of["squat_point_forward"]);
        close(&of["squat_angle"], slope.atan(), 1e-6);
        let transfer = number(&report["mass"]["load_transfer_angle"]).tan();
        close(&of["squat_ratio"], transfer / slope, 1e-5);
        close(&of["braking_angle"], -number(&report["geometry"]["rake"]), 1e-6);
    }
    let sidecar = setup(&["sidecar"]);
    close(&sidecar["pull"]["squat_angle"], (0.36f64 / 0.48).atan(), 1e-6);
    // unloaded by braking: the leading link of the sidecar, the arm of the telelever
    assert!(number(&sidecar["pull"]["anti_dive"]) > 1.0);
    assert!((0.5..1.0).contains(&number(&setup(&["telelever"])["pull"]["anti_dive"])));
}

#[test]
fn mass_center_and_inertia_are_sums() {
    let of = &setup(&["whipple"])["mass"];
    close(&of["mass"], 94.0, 1e-12);
    close(&of["mass_center_forward"], (85.0 * 0.3 + 4.0 * 0.9 + 3.0 * 1.02) / 94.0, 1e-9);
    close(&of["mass_center_height"], (2.0 * 0.3 + 85.0 * 0.9 + 4.0 * 0.7 + 3.0 * 0.35) / 94.0, 1e-9);
    let bodies = [(2.0, 0.0, 0.3, 0.0603), (85.0, 0.3, 0.9, 9.2), (4.0, 0.9, 0.7, 0.058_92), (3.0, 1.02, 0.35, 0.1405)];
    let height = number(&of["mass_center_height"]);
    let roll: f64 = bodies.iter().map(|(m, _, z, xx)| xx + m * (z - height).powi(2)).sum();
    close(&of["roll_inertia"], roll, 1e-6);
    let report = setup(&["gsxr1000"]);
    let components = report["components"].as_array().cloned().unwrap_or_default();
    for (k, name) in ["roll_inertia", "pitch_inertia", "yaw_inertia"].into_iter().enumerate() {
        let sum: f64 = components.iter().map(|c| number(&c["share"][k])).sum();
        close(&report["mass"][name], sum, 1e-9);
    }
    close(&report["mass"]["mass"], 250.65, 1e-9);
}
