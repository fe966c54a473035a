//! Labels on contour lines: where a line is straight, roomy and not steep, and where no other line or label is hit.

use super::canvas::{Point, Rect};
use super::{style, text};

/// A contour line and what it is to be labeled with.
#[derive(Clone, Debug)]
pub(super) struct Labeled {
    pub(super) line: Vec<Point>,
    pub(super) label: String,
}

/// The place of a label: center, turn in degrees clockwise, and the stretch of the line that it replaces.
#[derive(Clone, Copy, Debug)]
pub(super) struct Place {
    pub(super) center: Point,
    pub(super) turn: f64,
    pub(super) stretch: (f64, f64),
}

/// Distance between the points by which lines are represented.
const PITCH: f64 = 3.0;
/// Free space before and after a label on its line; more where a minus sign might be taken for a piece of the line.
fn air(label: &str) -> f64 {
    if label.starts_with('\u{2212}') { 8.0 } else { 4.0 }
}

/// A line with its arc length.
struct Track {
    points: Vec<Point>,
    length: Vec<f64>,
}

impl Track {
    fn new(points: &[Point]) -> Self {
        let mut length = vec![0.0];
        length.extend(points.windows(2).scan(0.0, |s, w| {
            *s += distance(w[0], w[1]);
            Some(*s)
        }));
        Self { points: points.to_vec(), length }
    }

    fn total(&self) -> f64 {
        self.length.last().copied().unwrap_or(0.0)
    }

    /// Point at arc length `s`.
    fn at(&self, s: f64) -> Point {
        let k = self.length.partition_point(|&l| l < s).clamp(1, self.points.len() - 1);
        let (p, q) = (self.points[k - 1], self.points[k]);
        let t = ((s - self.length[k - 1]) / (self.length[k] - self.length[k - 1])).clamp(0.0, 1.0);
        (p.0 + t * (q.0 - p.0), p.1 + t * (q.1 - p.1))
    }

    /// Arc lengths about [`PITCH`] apart.
    fn stations(&self) -> impl Iterator<Item = f64> + use<> {
        let (total, n) = (self.total(), (self.total() / PITCH).ceil() as usize);
        (0..=n).map(move |k| total * k as f64 / n.max(1) as f64)
    }
}

fn distance(p: Point, q: Point) -> f64 {
    (p.0 - q.0).hypot(p.1 - q.1)
}

/// A rectangle turned about its center.
struct Box {
    center: Point,
    along: Point,
    half: (f64, f64),
}

impl Box {
    /// Distance of `p` outside the box along its worse axis; negative inside.
    fn clearance(&self, p: Point) -> f64 {
        let (dx, dy) = (p.0 - self.center.0, p.1 - self.center.1);
        let (along, across) = (dx * self.along.0 + dy * self.along.1, dy * self.along.0 - dx * self.along.1);
        (along.abs() - self.half.0).max(across.abs() - self.half.1)
    }

    /// Points over the box, dense enough to stand for it.
    fn samples(&self) -> Vec<Point> {
        let n = (2.0 * self.half.0 / PITCH).ceil() as i32;
        let place =
            |a: f64, c: f64| (self.center.0 + a * self.along.0 - c * self.along.1, self.center.1 + a * self.along.1 + c * self.along.0);
        (0..=n)
            .flat_map(|k| [-1.0, 0.0, 1.0].map(|c| place(self.half.0 * (2.0 * f64::from(k) / f64::from(n) - 1.0), c * self.half.1)))
            .collect()
    }
}

/// One place per line, or none where it would hit something; earlier lines choose first. `walls` are lines without labels.
pub(super) fn place(lines: &[Labeled], walls: &[Vec<Point>], frame: Rect) -> Vec<Option<Place>> {
    let tracks: Vec<Track> = lines.iter().map(|l| Track::new(&l.line)).collect();
    let mut obstacles: Vec<(Option<(usize, f64)>, Point)> = Vec::new();
    for (k, track) in tracks.iter().enumerate() {
        obstacles.extend(track.stations().map(|s| (Some((k, s)), track.at(s))));
    }
    for wall in walls.iter().filter(|w| w.len() > 1) {
        let track = Track::new(wall);
        obstacles.extend(track.stations().map(|s| (None, track.at(s))));
    }
    let mut places = Vec::with_capacity(lines.len());
    for (k, labeled) in lines.iter().enumerate() {
        let width = text::width(&labeled.label, style::CONTOUR_LABEL_SIZE);
        let best = candidates(&tracks[k], width, air(&labeled.label))
            .filter_map(|candidate| cost(&candidate, &tracks[k], k, &obstacles, frame).map(|c| (c, candidate)))
            .min_by(|a, b| a.0.total_cmp(&b.0));
        if let Some((_, Candidate { outline, .. })) = &best {
            obstacles.extend(outline.samples().into_iter().map(|p| (None, p)));
        }
        places.push(best.map(|(_, c)| c.place));
    }
    places
}

struct Candidate {
    place: Place,
    outline: Box,
}

/// Every place along the line at which the line is nearly straight over the width of the label.
fn candidates(track: &Track, width: f64, air: f64) -> impl Iterator<Item = Candidate> {
    let half = width / 2.0 + air;
    let usable = (track.total() - 2.0 * half - 2.0 * PITCH).max(0.0);
    // a label must not eat most of its line
    let n = if track.total() < 1.8 * width + 12.0 { 0 } else { (usable / PITCH) as usize };
    (0..n).filter_map(move |i| {
        let s = half + PITCH + usable * (i as f64 + 0.5) / n as f64;
        let (p, q, middle) = (track.at(s - half), track.at(s + half), track.at(s));
        let chord = distance(p, q);
        if chord < 1.9 * half {
            return None;
        }
        let mut along = ((q.0 - p.0) / chord, (q.1 - p.1) / chord);
        if along.0 < 0.0 || (along.0 == 0.0 && along.1 > 0.0) {
            along = (-along.0, -along.1);
        }
        let center = ((p.0 + q.0) / 4.0 + middle.0 / 2.0, (p.1 + q.1) / 4.0 + middle.1 / 2.0);
        let outline = Box { center, along, half: (half, 0.5 * style::CONTOUR_LABEL_SIZE + 0.5) };
        Some(Candidate { place: Place { center, turn: along.1.atan2(along.0).to_degrees(), stretch: (s - half, s + half) }, outline })
    })
}

/// How bad a place is; none where the label would hit something or leave the frame.
fn cost(candidate: &Candidate, track: &Track, own: usize, obstacles: &[(Option<(usize, f64)>, Point)], frame: Rect) -> Option<f64> {
    let Candidate { outline, place } = candidate;
    let inner = frame.shrunk(style::TICK + 2.0);
    if !outline.samples().into_iter().all(|p| inner.contains(p)) {
        return None;
    }
    let mut room = 30.0_f64;
    for &(owner, p) in obstacles {
        // the line under the label itself is no obstacle
        if matches!(owner, Some((k, s)) if k == own && s > place.stretch.0 - 12.0 && s < place.stretch.1 + 12.0) {
            continue;
        }
        room = room.min(outline.clearance(p));
        if room < 1.0 {
            return None;
        }
    }
    let bend = track
        .stations()
        .filter(|&s| s > place.stretch.0 && s < place.stretch.1)
        .map(|s| {
            let p = track.at(s);
            let (dx, dy) = (p.0 - outline.center.0, p.1 - outline.center.1);
            (dy * outline.along.0 - dx * outline.along.1).abs()
        })
        .fold(0.0, f64::max);
    let middle = (place.stretch.0 + place.stretch.1) / 2.0 / track.total() - 0.5;
    Some(2.0 * bend + (place.turn.abs() / 45.0).powi(2) + (30.0 - room) / 6.0 + 4.0 * middle.abs())
}

/// The parts of `line` before and after the label.
pub(super) fn interrupted(line: &[Point], place: &Place) -> [Vec<Point>; 2] {
    let track = Track::new(line);
    let (from, to) = place.stretch;
    let vertices = || line.iter().zip(&track.length);
    let mut before: Vec<Point> = vertices().filter(|(_, l)| **l < from).map(|(p, _)| *p).collect();
    before.push(track.at(from));
    let mut after = vec![track.at(to)];
    after.extend(vertices().filter(|(_, l)| **l > to).map(|(p, _)| *p));
    [before, after]
}

#[cfg(test)]
mod tests {
    use super::*;

    const FRAME: Rect = Rect { x: 0.0, y: 0.0, width: 400.0, height: 300.0 };

    fn labeled(line: Vec<Point>) -> Labeled {
        Labeled { line, label: "10.0".to_owned() }
    }

    #[test]
    fn labels_of_neighboring_lines_keep_apart() {
        let lines: Vec<Labeled> =
            (0..6).map(|k| labeled(vec![(0.0, 60.0 + 22.0 * f64::from(k)), (400.0, 60.0 + 22.0 * f64::from(k))])).collect();
        let places: Vec<Place> = place(&lines, &[], FRAME).into_iter().flatten().collect();
        assert_eq!(places.len(), 6);
        for (i, a) in places.iter().enumerate() {
            assert!(places[..i].iter().all(|b| (a.center.1 - b.center.1).abs() > 15.0));
        }
    }

    #[test]
    fn lines_too_close_stay_without_label() {
        let lines: Vec<Labeled> =
            (0..3).map(|k| labeled(vec![(0.0, 100.0 + 5.0 * f64::from(k)), (400.0, 100.0 + 5.0 * f64::from(k))])).collect();
        assert!(place(&lines, &[], FRAME)[1].is_none());
    }

    #[test]
    fn text_never_stands_on_its_head() {
        let back = labeled(vec![(400.0, 100.0), (0.0, 140.0)]);
        let turn = place(&[back], &[], FRAME)[0].map(|p| p.turn);
        assert!(turn.is_some_and(|t| t.abs() < 90.0));
    }

    #[test]
    fn line_is_interrupted_under_its_label() {
        let line = vec![(0.0, 100.0), (400.0, 100.0)];
        let [before, after] = interrupted(&line, &Place { center: (200.0, 100.0), turn: 0.0, stretch: (180.0, 220.0) });
        let x = |p: Option<&Point>| p.map_or(f64::NAN, |p| p.0.round());
        assert_eq!([before.first(), before.last(), after.first(), after.last()].map(x), [0.0, 180.0, 220.0, 400.0]);
    }
}
