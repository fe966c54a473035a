//! Measures with criterion on the processor time of the thread, and keeps the least time per call of each case.

use cpu_time::ThreadTime;
use criterion::Criterion;
use std::hint::black_box;
use std::path::Path;
use std::time::Duration;

/// The least time per call of one case.
#[derive(Clone, Debug)]
pub struct Measured {
    /// Name of the case.
    pub name: String,
    /// Nanoseconds per call.
    pub least: f64,
}

/// Runs cases and remembers their least times.
pub struct Clock {
    criterion: Criterion,
    measured: Vec<Measured>,
    /// The only case that is run, and how often; no time is taken then.
    only: Option<(String, u64)>,
}

impl Clock {
    /// With criterion's arguments: a filter, `--save-baseline`, `--baseline`.
    pub fn from_arguments() -> Self {
        let criterion = Criterion::default()
            .sample_size(60)
            .warm_up_time(Duration::from_millis(200))
            .measurement_time(Duration::from_millis(1500))
            .without_plots()
            // beside the other results of cargo, wherever the bench is started
            .output_directory(&Path::new(env!("CARGO_MANIFEST_DIR")).join("../target/criterion"))
            .configure_from_args();
        Self { criterion, measured: Vec::new(), only: None }
    }

    /// Calls one case some times and measures nothing.
    pub fn calling(case: &str, calls: u64) -> Self {
        Self { criterion: Criterion::default(), measured: Vec::new(), only: Some((case.to_owned(), calls)) }
    }

    /// Measures `case`, called with 0, 1, 2 …; `calls` is what one call of it counts for.
    pub fn case(&mut self, name: &str, calls: usize, mut case: impl FnMut(usize)) {
        if let Some((only, calls)) = &self.only {
            if only == name {
                (0..*calls).for_each(|round| case(black_box(round as usize)));
            }
            return;
        }
        let mut least = f64::INFINITY;
        self.criterion.bench_function(name, |bencher| {
            bencher.iter_custom(|rounds| {
                let start = ThreadTime::now();
                for round in 0..rounds {
                    case(black_box(round as usize));
                }
                let spent = start.elapsed();
                least = least.min(spent.as_nanos() as f64 / (rounds as f64 * calls as f64));
                // criterion divides by zero where a clock stands still
                spent.max(Duration::from_nanos(1))
            });
        });
        // a case that the filter left out was never called
        if least.is_finite() {
            self.measured.push(Measured { name: name.to_owned(), least });
        }
    }

    /// Everything that was measured.
    pub fn finish(self) -> Vec<Measured> {
        self.criterion.final_summary();
        self.measured
    }
}
