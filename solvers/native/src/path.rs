//! From steps to samples and events: what all one-step methods here share.
//!
//! A method takes steps of its own length and knows the points within the last one. Samples are such points, and so are the roots of event
//! functions, bracketed until rounding is all that separates the ends.

use problem::contract::{coincide, crossed, resolution, secant};
use problem::{EvalError, Flow, IntegrationEnding, Sink};

/// A trajectory under way.
pub(crate) trait Path {
    /// Takes one step that does not pass `limit`.
    fn step(&mut self, limit: f64) -> Result<(), IntegrationEnding>;
    /// Begin and end of the last step; both are the start before the first.
    fn span(&self) -> (f64, f64);
    /// Writes the point and its rates at a time within the last step.
    fn point(&mut self, time: f64, y: &mut [f64], yd: &mut [f64]) -> Result<(), EvalError>;
    /// Number of event functions.
    fn event_count(&self) -> usize;
    /// Writes the event functions of a point.
    fn events(&mut self, time: f64, y: &[f64], yd: &[f64], values: &mut [f64]) -> Result<(), EvalError>;
}

/// What was reached: ending, time and number of steps.
pub(crate) struct Reached {
    pub ending: IntegrationEnding,
    pub time: f64,
    pub steps: usize,
}

/// Event functions at the ends of a bracket, and a point within it.
#[derive(Debug, Default)]
pub(crate) struct Roots {
    before: Vec<f64>,
    beyond: Vec<f64>,
    within: Vec<f64>,
    y: Vec<f64>,
    yd: Vec<f64>,
}

/// A root: its time, the event function, whether that rises.
type Root = (f64, usize, bool);

impl Roots {
    fn begin(&mut self, path: &mut dyn Path, (y, yd): (&[f64], &[f64])) -> Result<(), EvalError> {
        for values in [&mut self.before, &mut self.beyond, &mut self.within] {
            values.resize(path.event_count(), 0.0);
        }
        self.y.resize(y.len(), 0.0);
        self.yd.resize(y.len(), 0.0);
        if self.before.is_empty() {
            return Ok(());
        }
        path.events(path.span().0, y, yd, &mut self.before)
    }

    fn look(&mut self, path: &mut dyn Path, time: f64) -> Result<(), EvalError> {
        path.point(time, &mut self.y, &mut self.yd)?;
        path.events(time, &self.y, &self.yd, &mut self.within)
    }

    /// The first root within the last step.
    fn within(&mut self, path: &mut dyn Path) -> Result<Option<Root>, EvalError> {
        if self.before.is_empty() {
            return Ok(None);
        }
        let (mut begin, mut end) = path.span();
        self.look(path, end)?;
        if crossed(&self.before, &self.within).is_none() {
            self.before.copy_from_slice(&self.within);
            return Ok(None);
        }
        self.beyond.copy_from_slice(&self.within);
        let (mut weights, mut moved_end) = ((1.0, 1.0), None);
        while end - begin > resolution(begin, end) {
            let width = end - begin;
            let least = 0.5 * resolution(begin, end);
            // the earliest of the secants, not too close to either end, so that the bracket closes from both sides
            let at = begin + (secant(&self.before, &self.beyond, weights.0, weights.1) * width).clamp(least, width - least);
            self.look(path, at)?;
            let is_end = crossed(&self.before, &self.within).is_some();
            let halved = if moved_end == Some(is_end) { 0.5 } else { 1.0 };
            if is_end {
                self.beyond.copy_from_slice(&self.within);
                (end, weights) = (at, (weights.0 * halved, 1.0));
            } else {
                self.before.copy_from_slice(&self.within);
                (begin, weights) = (at, (1.0, weights.1 * halved));
            }
            moved_end = Some(is_end);
        }
        let event = crossed(&self.before, &self.beyond).unwrap_or(0);
        Ok(Some((end, event, self.before[event] < 0.0)))
    }
}

/// Follows a path through all times, or until something ends it; y and ẏ are those of the time reached.
pub(crate) fn follow(
    path: &mut dyn Path,
    times: &[f64],
    (y, yd): (&mut [f64], &mut [f64]),
    max_steps: usize,
    roots: &mut Roots,
    sink: Sink<'_>,
) -> Reached {
    let stop = times[times.len() - 1];
    let mut reached = Reached { ending: IntegrationEnding::Finished, time: times[0], steps: 0 };
    let mut root: Option<Root> = None;
    let begun = roots.begin(path, (y, yd));
    let mut visit = |y: &mut [f64], yd: &mut [f64], reached: &mut Reached| -> Result<(), IntegrationEnding> {
        begun.map_err(IntegrationEnding::Evaluation)?;
        for &time in times {
            let allowed = reached.steps + max_steps.max(1);
            while root.is_none() && path.span().1 < time && !coincide(path.span().1, time) {
                if reached.steps == allowed {
                    return Err(IntegrationEnding::TooManySteps);
                }
                path.step(stop)?;
                reached.steps += 1;
                reached.time = path.span().1;
                root = roots.within(path).map_err(IntegrationEnding::Evaluation)?;
            }
            if let Some((at, event, rising)) = root.filter(|root| root.0 <= time) {
                reached.time = at;
                return Err(IntegrationEnding::Event { event, rising });
            }
            reached.time = time;
            path.point(time.min(path.span().1), y, yd).map_err(IntegrationEnding::Evaluation)?;
            if sink(time, y, yd) == Flow::Stop {
                return Err(IntegrationEnding::Stopped);
            }
        }
        Ok(())
    };
    let visited = visit(y, yd, &mut reached);
    reached.ending = visited.err().unwrap_or(IntegrationEnding::Finished);
    if !matches!(reached.ending, IntegrationEnding::Finished | IntegrationEnding::Stopped) {
        let (begin, end) = path.span();
        if !matches!(reached.ending, IntegrationEnding::Event { .. }) {
            reached.time = end;
        }
        // what cannot be evaluated there leaves the sample before
        let at = reached.time.clamp(begin, end);
        if path.point(at, &mut roots.y, &mut roots.yd).is_ok() {
            y.copy_from_slice(&roots.y);
            yd.copy_from_slice(&roots.yd);
        }
    }
    reached
}
