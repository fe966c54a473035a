//! Mechanisms in motion.
use analyses::transient::evenly;
use validation::course::{By, Course};
use validation::reference::Table;
use crate::mechanisms::*;

const METHODS: [By; 5] = [By::Erk(1e-12, 1e-6), By::Erk(1e-13, 1e-8), By::Ida(1e-9, 1e-3), By::Ida(1e-10, 1e-4), By::Ida(1e-11, 1e-5)];

fn look(model: &str, given: &[(&'static str, f64)], times: &[f64], by: By, check: impl Fn(&mut Course) -> f64) {
    let t = std::time::Instant::now();
    let mut c = Course::of(model, given, times, by);
    let s = &c.simulation;
    println!("{model} {by:?} {:?} steps {} rejected {} cf {} res {}", s.ending, s.statistics.steps, s.statistics.rejected, s.statistics.convergence_failures, s.statistics.residuals);
    println!("   drift {:?} {:?}", s.drift.position.as_ref().map(|w| (w.off.by, w.time)), s.drift.velocity.as_ref().map(|w| (w.off.by, w.time)));
    if c.simulation.ending.reached() {
        println!("   check {:e}", check(&mut c));
    }
    let e = c.energies();
    println!("   energy {:e}, start {}, time {:?}", e.iter().map(|x| (x - e[0]).abs()).fold(0.0, f64::max), e[0], t.elapsed());
}

fn table_times(t: &Table) -> Vec<f64> { (0..t.len()).map(|r| t.number(r, "t")).collect() }

#[test]
fn x_pendulum() {
    let table = Table::read("mbs/pendulum.csv");
    for by in METHODS { look("pendulum", &[], &table_times(&table), by, |c| {
        (0..table.len()).map(|r| { let p = c.position(r, "rod", [0.0, 0.0, -1.0]); (p.x - table.number(r, "x")).abs().max((p.z - table.number(r, "y")).abs()) }).fold(0.0, f64::max)
    }); }
}

#[test]
fn x_andrews() {
    let table = Table::read("mbs/andrews_squeezer.csv");
    for by in METHODS { look("andrews_squeezer", &[("motor.torque", SQUEEZER_TORQUE)], &table_times(&table), by, |c| {
        (0..table.len()).flat_map(|r| { let v = squeezer(&table, r); let c = &*c; v.into_iter().map(move |(n, x)| ((c.signal(n)[r] - x)/ if n.ends_with("rate") {1424.0} else {1.0}).abs()).collect::<Vec<_>>() }).fold(0.0, f64::max)
    }); }
}

#[test]
fn x_bricard() {
    let table = Table::read("mbs/bricard.csv");
    let row = |k: usize| ["X", "Y", "Z"].map(|c| table.number(k, c));
    for by in METHODS { look("bricard", &[], &evenly(10.0, 11), by, |c| {
        (0..3).map(|k| { let p = c.position([1, 5, 10][k], "p3", [0.0; 3]); let e = row(k); (p.x - e[0]).abs().max((p.z - e[1]).abs()).max((-p.y - e[2]).abs()) }).fold(0.0, f64::max)
    }); }
}

#[test]
fn x_governor() {
    let table = Table::read("mbs/flyball_governor.csv");
    for by in [By::Ida(1e-7, 1e-1), By::Ida(1e-8, 1e-2), By::Ida(1e-9, 1e-3), By::Ida(1e-10, 1e-4), By::Erk(1e-8, 1e-2), By::Erk(1e-10, 1e-4)] { look("flyball_governor", &[], &table_times(&table), by, |c| {
        (0..table.len()).map(|r| (c.signal("slider.travel")[r] - table.number(r, "s")).abs()).fold(0.0, f64::max)
    }); }
}

#[test]
fn x_top() {
    let table = Table::read("mbs/heavy_top.csv");
    for by in METHODS { look("heavy_top", &[], &table_times(&table), by, |c| {
        (0..table.len()).flat_map(|r| { let v = top(&table, r); let c = &*c; v.into_iter().map(move |(n, x)| (c.signal(n)[r] - x).abs()).collect::<Vec<_>>() }).fold(0.0, f64::max)
    }); }
}

#[test]
fn x_n_four_bar() {
    let table = Table::read("mbs/n_four_bar.csv");
    for by in METHODS { look("n_four_bar", &[], &table_times(&table), by, |c| {
        (0..table.len()).flat_map(|r| { let v = four_bars(table.number(r, "theta"), table.number(r, "theta_dot")); let c = &*c; v.into_iter().map(move |(n, x)| (c.signal(n)[r] - x).abs()).collect::<Vec<_>>() }).fold(0.0, f64::max)
    }); }
}

#[test]
fn x_disc() {
    for by in METHODS { look("rolling_disc", &[], &evenly(10.0, 21), by, |c| {
        ["disc.roll", "disc.yaw_rate", "disc.roll_rate", "disc.pitch_rate"].iter().flat_map(|n| { let s = c.signal(n); s.iter().map(|x| (x - s[0]).abs()).collect::<Vec<_>>() }).fold(0.0, f64::max)
    }); }
}
