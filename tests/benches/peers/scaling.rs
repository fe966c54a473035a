//! How cost grows: with the bodies of a chain, and down with the cores of the machine in a sweep.

use crate::clock::{Clock, Measured};
use fastbike::plan::{Prescribed, Request, Turn};
use mbody::algorithm::{aba::aba, kinematics, rnea::rnea};
use mbody::stage::Workspace;
use std::hint::black_box;
use std::time::{Duration, Instant};
use validation::tree::chain;
use validation::vehicle::Vehicle;

/// Links of the chains.
const LINKS: [usize; 3] = [10, 100, 1000];

/// Sweeps are timed this often; the least counts.
const REPEATS: usize = 7;

fn links(clock: &mut Clock, count: usize) {
    clock.case(&format!("assembly, chain of {count}"), 1, |_| {
        black_box(chain(count));
    });
    let system = chain(count);
    let model = system.model();
    let mut w = Workspace::<f64>::new(model);
    for k in 0..count {
        w.position.q[k] = 0.3 * (k as f64).sin();
        w.velocity.v[k] = (0.7 * k as f64).cos();
    }
    clock.case(&format!("rnea, chain of {count}"), count, |round| {
        w.acceleration.vd[round % count] = 1e-3 * round as f64;
        kinematics::position(model, &mut w.position);
        kinematics::velocity(model, &w.position, &mut w.velocity);
        kinematics::acceleration(model, &w.position, &w.velocity, &mut w.acceleration);
        rnea(model, &w.position, &w.velocity, &w.acceleration, &w.applied, &mut w.transmitted, &mut w.tau);
        black_box(&w.tau);
    });
    w.tau.fill(0.0);
    clock.case(&format!("aba, chain of {count}"), count, |round| {
        w.tau[round % count] = 1e-3 * round as f64;
        kinematics::position(model, &mut w.position);
        kinematics::velocity(model, &w.position, &mut w.velocity);
        aba(model, &mut w);
        black_box(&w.acceleration.vd);
    });
}

/// A map of 31 speeds and 31 leans on a number of threads, by the clock on the wall.
fn map(system: &std::sync::Arc<mbody::dynamics::System>, threads: usize) -> (Duration, usize) {
    let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("threads");
    let values = |low: f64, high: f64| (0..31).map(|k| low + (high - low) * f64::from(k) / 30.0).collect();
    let request = Request {
        speed: Some(Prescribed { name: "speed", unit: "m/s", values: values(10.0, 70.0) }),
        turn: Some((Turn::Lean, Prescribed { name: "lean", unit: "rad", values: values(0.0, 0.7) })),
        front_brake_share: 0.7,
        ..Request::default()
    };
    pool.install(|| {
        let begun = Instant::now();
        let Ok(steady) = fastbike::steady::run(&request, system, "kinsol", "") else { panic!("a map") };
        (begun.elapsed(), steady.points.len())
    })
}

/// Times chains; sweeps are printed by [`sweeps`].
pub fn run(clock: &mut Clock) {
    LINKS.iter().for_each(|&count| links(clock, count));
}

/// Prints the cost per link, and the throughput of a map over threads up to the cores of the machine.
pub fn print(measured: &[Measured]) {
    for algorithm in ["rnea", "aba"] {
        let at = |count: usize| measured.iter().find(|m| m.name == format!("{algorithm}, chain of {count}")).map(|m| m.least);
        if let [Some(ten), Some(hundred), Some(thousand)] = LINKS.map(at) {
            println!("{algorithm}, a link of a chain of 100 and of 1000 costs {:.2} and {:.2} of one of 10", hundred / ten, thousand / ten);
        }
    }
    // a filter that asks for kernels gets kernels
    if std::env::args().skip(1).any(|a| !a.starts_with("--")) {
        return;
    }
    let system = Vehicle::bundled("gsxr1000").system;
    let least = |threads: usize| (0..REPEATS).map(|_| map(&system, threads)).min().expect("repeats");
    let cores = std::thread::available_parallelism().map_or(1, |n| n.get());
    let (alone, points) = least(1);
    for threads in 1..=cores {
        let (time, _) = if threads == 1 { (alone, points) } else { least(threads) };
        let speedup = alone.as_secs_f64() / time.as_secs_f64();
        println!(
            "map of {points} steady states of gsxr1000 on {threads} of {cores} cores: {:.1} ms, {speedup:.2} times as fast as on one",
            1e3 * time.as_secs_f64()
        );
    }
}
