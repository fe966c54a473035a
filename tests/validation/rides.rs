//! Rides: the virtual rider follows the bundled maneuvers, the way a motorcycle is steered.

use fastbike::plan::Request;
use mbody::description::OneText;
use mbody::description::finding::Findings;
use validation::agreement::{Agreement, absolute};
use validation::evidence::Row;
use validation::numbers::Numbers;
use validation::rode::{Care, Rode, read};
use validation::vehicle::Vehicle;

/// Rows of the table.
pub const EVIDENCE: &[Row] = validation::evidence![
    paths_are_followed => (
        "`gsxr1000` and `ref11` ride every bundled maneuver at 15, 25 and 35 m/s (U-turn: 3, 5 and 8 m/s), stretched until its path asks for 5 m/s² to the side at \
         most: none falls, the base point stays near the path",
        "the path asked for",
        "0.3 m: a fifth of the room beside a motorcycle 0.5 m wide in the middle of a lane of 3.5 m"
    ),
    the_lane_change_of_the_paper => (
        "lane change of 3.6 m in 40 m at 25 m/s with `gsxr1000`: within 0.35 m of the path; roll to both sides and steering torque have the size of a point mass on \
         this path",
        "V. Cossalter, R. Lot, F. Maggio, FastBike (Fig. 4): the maneuver; its measured histories are not public. Peak of the quintic 10 w V²/(√3 L²) = 8.1 m/s²",
        "roll 0.4 to 1.2 times atan(8.1/9.81), since the rider cuts the corners; torque below 100 N m, what two arms exert"
    ),
    the_ride_at_full_throttle_ends_at_the_top_speed => (
        "`gsxr1000` in its sixth gear and `scooter` behind its variator ride `top_speed`: after 150 s at full throttle they have the top speed of the steady state; the engine is never asked for more \
         than it gives, and the integral of the speed does not grow meanwhile",
        "`trim --top-speed`",
        "1e-5 of the speed: what e^(−t/T) leaves; margin −1e-3 N m: table of 1000 speeds of the wheel"
    ),
    a_speed_out_of_reach_does_not_wind_the_rider_up => (
        "`gsxr1000` asked for 110 m/s during half a minute and then for 70 m/s: it is there at once and holds it",
        "the speed asked for",
        "0.3 m/s six seconds after the demand is level: the speed loop of 0.7 rad/s"
    ),
    left_turns_begin_with_the_bar_to_the_right => (
        "`gsxr1000` and `ref11`, lane changes to the left at 15, 25 and 35 m/s: the first steering torque and the first steering angle are to the right, then the \
         motorcycle leans to the left (counter-steering); to the right the opposite",
        "R. S. Sharp, J. Mech. Eng. Sci. 13 (1971) 316–329 and every rider's experience",
        "signs, once 0.5 % of the peak is exceeded"
    ),
];

/// Lateral acceleration asked for at most, m/s².
const SIDE: f64 = 5.0;

/// Changes of a maneuver at a speed (m/s), with lengths grown by a factor.
type Changes = fn(f64, f64) -> Vec<(&'static str, f64)>;

/// What is stretched in the maneuvers that bend.
const STRETCHED: [(&str, Changes); 6] = [
    ("lane_change", |_, x| vec![("path.1.lane_change.length", 20.0 * x)]),
    ("double_lane_change", |_, x| vec![("path.1.double_lane_change.stretch", 0.8 * x)]),
    ("obstacle_avoidance", |_, x| vec![("path.1.double_lane_change.stretch", 0.8 * x)]),
    ("slalom", |_, x| vec![("path.1.slalom.spacing", 15.0 * x)]),
    ("curve_entry", |v, x| {
        vec![("path.1.curve.radius", 0.2 * v * v * x), ("path.1.curve.transition", 2.0 * v), ("path.1.curve.exit", 2.0 * v)]
    }),
    ("steady_circle", |v, x| {
        vec![("path.1.curve.radius", 0.2 * v * v * x), ("path.1.curve.transition", 2.0 * v), ("path.1.curve.length", 8.0 * v)]
    }),
];

fn written(speed: f64, entries: &[(&str, f64)]) -> Vec<String> {
    entries.iter().map(|(path, value)| format!("{path}={value}")).chain([format!("speed={speed}")]).collect()
}

/// Changes by which a maneuver asks for no more than [`SIDE`].
fn gentle(name: &str, speed: f64, changes: Changes) -> Vec<String> {
    let asked = |x: f64| {
        let course = read(name, &written(speed, &changes(speed, x))).course;
        course.speed.greatest_lateral(&course.path)
    };
    let mut x = 1.0;
    while asked(x) > SIDE {
        x *= 1.05;
    }
    written(speed, &changes(speed, x))
}

#[test]
fn paths_are_followed() {
    let mut agreement = Agreement::on("paths");
    let near = absolute(0.3).because("a fifth of the room beside a motorcycle in its lane");
    let mut rides: Vec<(&str, Vec<String>)> = Vec::new();
    for (name, changes) in STRETCHED {
        rides.extend([15.0, 25.0, 35.0].map(|speed| (name, gentle(name, speed, changes))));
    }
    let circle: Changes = |_, x| vec![("path.1.u_turn.radius", 6.0 * x), ("path.1.u_turn.transition", 6.0 * x)];
    rides.extend([3.0, 5.0, 8.0].map(|speed| ("u_turn", gentle("u_turn", speed, circle))));
    rides.extend(
        ["straight", "acceleration", "braking_straight", "braking_in_curve", "steering_impulse", "banked_circle", "hill", "slippery_patch"]
            .map(|name| (name, Vec::new())),
    );
    for model in ["gsxr1000", "ref11"] {
        let vehicle = Vehicle::bundled(model);
        for (name, changes) in &rides {
            let rode = Rode::of(&vehicle, read(name, changes), Care::USUAL, &["rider.path_error", "chassis.roll"]);
            let what = format!("{model}, {name} {changes:?}");
            let (error, ending) = (rode.peak("rider.path_error"), rode.ending());
            println!("{what}: {error:.3} m, {ending}, roll {:.1}°", rode.peak("chassis.roll").to_degrees());
            // at walking pace the path ends where the time does, or a little later
            agreement.holds(&format!("{what}: ends as asked for: {ending}"), ["end_of_path", "reached"].contains(&ending));
            agreement.near(&format!("{what}: offset from the path, m"), error, 0.0, &near);
        }
    }
    agreement.assert();
}

#[test]
fn the_lane_change_of_the_paper() {
    let mut agreement = Agreement::on("lane change of the paper");
    let rode = Rode::of(&Vehicle::bundled("gsxr1000"), read("lane_change", &[]), Care::USUAL, &[]);
    let (roll, torque) = (rode.signal("chassis.roll"), rode.peak("steer.torque"));
    let asked = 10.0 * 3.6 * 25.0 * 25.0 / (3f64.sqrt() * 40.0 * 40.0);
    let point_mass = (asked / 9.81).atan();
    let [left, right] = [roll.iter().copied().fold(0.0, f64::min), roll.iter().copied().fold(0.0, f64::max)];
    println!(
        "offset {:.3} m, roll {:.1}° and {:.1}° of {:.1}°, torque {torque:.1} N m",
        rode.peak("rider.path_error"),
        left.to_degrees(),
        right.to_degrees(),
        point_mass.to_degrees()
    );
    agreement.holds(rode.ending(), rode.ending() == "end_of_path");
    agreement.near(
        "offset, m",
        rode.peak("rider.path_error"),
        0.0,
        &absolute(0.35).because("a fifth of the room beside a motorcycle in its lane"),
    );
    for (side, lean) in [("left", -left), ("right", right)] {
        agreement.holds(&format!("lean to the {side}: {} of a point mass", lean / point_mass), (0.4..1.2).contains(&(lean / point_mass)));
    }
    agreement.holds(&format!("torque {torque} N m"), torque < 100.0);
    agreement.near(
        "speed",
        rode.signal("chassis.forward_speed").iter().copied().fold(f64::INFINITY, f64::min),
        25.0,
        &absolute(0.5).because("held"),
    );
    agreement.assert();
}

#[test]
fn the_ride_at_full_throttle_ends_at_the_top_speed() {
    let mut agreement = Agreement::on("top speed");
    for model in ["gsxr1000", "scooter"] {
        let vehicle = Vehicle::bundled(model);
        let fastest = vehicle.state(&Request { top_speed: true, ..Request::default() }).get("chassis.forward_speed");
        let watched = ["chassis.forward_speed", "engine.torque_margin", "rider.speed_integral"];
        let rode = Rode::of(&vehicle, read("top_speed", &[]), Care::USUAL, &watched);
        let (speed, margin) = (rode.signal("chassis.forward_speed"), rode.signal("engine.torque_margin"));
        agreement.holds(rode.ending(), rode.ending() == "reached");
        let near = absolute(1e-5 * fastest).because("what is left of the way to it");
        agreement.near(&format!("{model}: top speed, m/s"), speed[speed.len() - 1], fastest, &near);
        let least = margin.iter().copied().fold(f64::INFINITY, f64::min);
        agreement.holds(&format!("{model}: margin of the engine {least} N m"), least > -1e-3);
        let integral = rode.peak("rider.speed_integral");
        agreement.holds(&format!("{model}: integral of the speed {integral} m"), integral < 0.1);
    }
    agreement.assert();
}

#[test]
fn a_speed_out_of_reach_does_not_wind_the_rider_up() {
    let changes = ["speed=60", "speed_over_time=[[0, 60], [1, 60], [2, 110], [30, 110], [36, 70]]", "duration=60"].map(String::from);
    let rode = Rode::of(&Vehicle::bundled("gsxr1000"), read("top_speed", &changes), Care::USUAL, &["chassis.forward_speed"]);
    let mut agreement = Agreement::on("a speed out of reach");
    let held = absolute(0.3).because("six seconds of a loop of 0.7 rad/s");
    for (time, speed) in rode.time().iter().zip(rode.signal("chassis.forward_speed")).filter(|(time, _)| **time > 42.0) {
        agreement.near(&format!("speed at {time} s"), speed, 70.0, &held);
    }
    let lowest = rode.signal("chassis.forward_speed").iter().skip(3600).copied().fold(f64::INFINITY, f64::min);
    agreement.holds(&format!("lowest speed {lowest} m/s"), lowest > 69.0);
    agreement.assert();
}

/// Sign of the first value beyond 0.5 % of the peak, and when.
fn first(rode: &Rode, name: &str) -> (f64, f64) {
    let peak = rode.peak(name);
    let at = rode.signal(name).iter().position(|v| v.abs() > 0.005 * peak).expect("a peak");
    (rode.signal(name)[at].signum(), rode.time()[at])
}

#[test]
fn left_turns_begin_with_the_bar_to_the_right() {
    let mut agreement = Agreement::on("counter-steering");
    for model in ["gsxr1000", "ref11"] {
        let vehicle = Vehicle::bundled(model);
        for (speed, side) in [15.0, 25.0, 35.0].into_iter().flat_map(|v| [(v, 1.0), (v, -1.0)]) {
            let mut changes = gentle("lane_change", speed, STRETCHED[0].1);
            changes.push(format!("path.1.lane_change.width={}", 3.6 * side));
            let rode = Rode::of(&vehicle, read("lane_change", &changes), Care::USUAL, &[]);
            let [torque, angle, roll] = ["steer.torque", "steer.angle", "chassis.roll"].map(|name| first(&rode, name));
            let what = format!("{model}, {speed} m/s, side {side}: torque {torque:?}, angle {angle:?}, roll {roll:?}");
            agreement.holds(&format!("{what}: the bar goes the other way"), torque.0 == -side && angle.0 == -side);
            agreement.holds(&format!("{what}: it leans into the turn"), roll.0 == -side);
            agreement.holds(&format!("{what}: torque comes before lean"), torque.1 <= roll.1);
        }
    }
    agreement.assert();
}

/// A maneuver of random sections, speeds, pulses and roads, some of them beyond what can be ridden.
fn random(numbers: &mut Numbers) -> String {
    let speed = numbers.between(4.0, 55.0);
    let side = if numbers.unit() < 0.5 { -1.0 } else { 1.0 };
    let (length, hard) = (numbers.between(0.8, 4.0) * speed, numbers.between(1.0, 14.0));
    let radius = side * speed * speed / hard;
    let section = match (numbers.unit() * 6.0) as usize {
        0 => format!("lane_change: {{ width: {}, length: {length} }}", side * numbers.between(0.5, 6.0)),
        1 => format!(
            "double_lane_change: {{ standard: iso_3888_{}, vehicle_width: 0.8, stretch: {} }}",
            if side < 0.0 { 1 } else { 2 },
            0.05 * speed
        ),
        2 => format!("slalom: {{ spacing: {length}, amplitude: {}, cones: 4 }}", side * numbers.between(0.2, 3.0)),
        3 => format!("curve: {{ radius: {radius}, transition: {length}, length: {length} }}"),
        4 => format!("u_turn: {{ radius: {radius}, transition: {} }}", 0.9 * radius.abs()),
        _ => format!("straight: {{ length: {length} }}"),
    };
    let target = speed * numbers.between(0.3, 1.3);
    let (peak, start, duration) = (numbers.between(-120.0, 120.0), numbers.between(0.0, 2.0), numbers.between(0.02, 0.5));
    let faster = if numbers.unit() < 0.4 {
        format!("speed_over_time: [[0, {speed}], [1, {speed}], [4, {target}], [9, {target}]]\n")
    } else {
        String::new()
    };
    let pulses = if numbers.unit() < 0.4 {
        format!("torque_pulses:\n  - {{ peak: {peak}, start: {start}, duration: {duration} }}\n")
    } else {
        String::new()
    };
    let rough = if numbers.unit() < 0.4 {
        let (class, seed) = (["A", "B", "C", "D"][(numbers.unit() * 4.0) as usize], (numbers.unit() * 1e6) as u32);
        format!("road: {{ iso_8608: {{ class: {class}, seed: {seed} }} }}\n")
    } else {
        String::new()
    };
    let limits = if numbers.unit() < 0.3 { "rider: { delay: 0.1 s, muscles: 30 rad/s }\n" } else { "" };
    format!(
        "maneuver: 1\nname: Random\nspeed: {speed}\n{faster}path:\n  - straight: {{ length: {} }}\n  - {section}\n  - straight: {{ length: {length} }}\n{pulses}{rough}{limits}duration: 15\n",
        0.5 * speed
    )
}

/// No random maneuver panics, hangs or loses data: each is refused with a reason, or ends with a named ending. `RIDES` says how many, 1000 where unset.
#[test]
#[ignore = "minutes; see CONTRIBUTING"]
fn random_rides_end_with_a_name() {
    let count = std::env::var("RIDES").ok().and_then(|n| n.parse().ok()).unwrap_or(1000);
    let vehicle = Vehicle::bundled("gsxr1000");
    let mut numbers = Numbers(2026);
    let mut endings = std::collections::BTreeMap::<String, usize>::new();
    for k in 0..count {
        let text = random(&mut numbers);
        let mut findings = Findings::new();
        let Some(maneuver) = motorcycle::maneuver::read("random.yaml", &OneText(&text), &[], &mut findings) else {
            panic!("{text}\n{findings}")
        };
        let began = std::time::Instant::now();
        let mut because = None;
        let ending = match Rode::tried(&vehicle, maneuver, Care::USUAL, &[]) {
            Err(failure) => format!("refused: {}", failure.to_string().lines().next().unwrap_or_default()),
            Ok(rode) => {
                let history = &rode.history;
                let last = rode.time().last().copied().unwrap_or(f64::NAN);
                assert!(
                    (last - history.outcome.statistics.time).abs() < 0.011,
                    "{k}: told until {last} s, ridden until {:?}\n{text}",
                    history.outcome
                );
                for signal in &history.signals {
                    let lost = rode.signal(&signal.name).iter().position(|v| !v.is_finite());
                    assert!(
                        lost.is_none(),
                        "{k}: `{}` is not finite at {:?} s of {last} s, {:?}\n{text}",
                        signal.name,
                        lost.map(|i| rode.time()[i]),
                        history.outcome
                    );
                }
                assert!(rode.ending() != "failed" || history.outcome.because.is_some(), "{k}: no cause\n{text}");
                because = history.outcome.because.clone();
                rode.ending().to_owned()
            }
        };
        let took = began.elapsed().as_secs_f64();
        assert!(took < 60.0, "{k}: {took} s for\n{text}");
        if !["end_of_path", "reached"].contains(&ending.as_str()) {
            println!("{k}: {ending} after {took:.2} s, because {because:?}\n{text}");
        }
        *endings.entry(ending).or_default() += 1;
    }
    println!("{endings:#?}");
}
