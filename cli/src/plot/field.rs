//! A quantity on the nodes of a grid, some of them without a value: regions above a level and the lines at a level.
//!
//! Each cell with four values is cut into four triangles about its center (mean of the corners), each cell with three values is one triangle;
//! the quantity is linear on a triangle. A region is the union of the clipped triangles, found by letting edges that are walked in both
//! directions cancel. No case table, no saddle ambiguity, and a missing value is simply an absent triangle.
//!
//! Where it is known at which place between two nodes of a row the values end, rows are joined up to these ends by triangles between their
//! points, in the order of their places.

use super::canvas::Point;
use std::collections::BTreeMap;

/// A piecewise linear function on a part of the plane.
#[derive(Clone, Debug)]
pub(super) struct Field {
    points: Vec<Point>,
    values: Vec<f64>,
    triangles: Vec<[usize; 3]>,
    /// Nodes with a value but without a triangle.
    pub(super) lone: Vec<usize>,
}

/// Where the values of a row end between two nodes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct End {
    pub(super) row: usize,
    pub(super) x: f64,
    pub(super) value: f64,
}

impl Field {
    /// The field over the grid of `columns` × `rows`, values row by row, NaN where there is none; `ends` of rows where they are known.
    pub(super) fn new(columns: &[f64], rows: &[f64], values: &[f64], ends: &[End]) -> Self {
        let mut points: Vec<Point> = rows.iter().flat_map(|&y| columns.iter().map(move |&x| (x, y))).collect();
        let mut values = values.to_vec();
        let mut triangles = Vec::new();
        let n = columns.len();
        let mut used = vec![false; values.len()];
        let known = values.clone();
        let mut runs = Vec::with_capacity(rows.len());
        for (j, &y) in rows.iter().enumerate() {
            let of_row: Vec<End> = ends.iter().copied().filter(|e| e.row == j).collect();
            runs.push(run(&known[j * n..(j + 1) * n], columns, &of_row).map(|run| run.place(j * n, y, &mut points, &mut values)));
        }
        let rising = columns.len() > 1 && columns[1] > columns[0];
        let mut joined = vec![false; rows.len()];
        for j in 1..rows.len() {
            if let (Some(below), Some(above)) = (&runs[j - 1], &runs[j]) {
                join(below, above, rising, (&mut points, &mut values), &mut triangles);
                joined[j] = true;
                below.iter().chain(above).for_each(|&k| used.get_mut(k).into_iter().for_each(|u| *u = true));
            }
        }
        let apart = (1..rows.len()).filter(|j| !joined[*j]).collect::<Vec<_>>();
        for (i, j) in apart.into_iter().flat_map(|j| (1..n).map(move |i| (i, j))) {
            let corners = [(j - 1) * n + i - 1, (j - 1) * n + i, j * n + i, j * n + i - 1];
            let known: Vec<usize> = corners.into_iter().filter(|&c| values[c].is_finite()).collect();
            match known[..] {
                [a, b, c, d] => {
                    let center = points.len();
                    points.push(((points[a].0 + points[c].0) / 2.0, (points[a].1 + points[c].1) / 2.0));
                    values.push(known.iter().map(|&k| values[k] / 4.0).sum());
                    triangles.extend([[a, b, center], [b, c, center], [c, d, center], [d, a, center]]);
                }
                [a, b, c] => triangles.push([a, b, c]),
                _ => continue,
            }
            known.iter().for_each(|&k| used[k] = true);
        }
        let lone = (0..used.len()).filter(|&k| values[k].is_finite() && !used[k]).collect();
        Self { points, values, triangles, lone }
    }

    /// Place of a node.
    pub(super) fn point(&self, node: usize) -> Point {
        self.points[node]
    }

    /// Value at a node.
    pub(super) fn value(&self, node: usize) -> f64 {
        self.values[node]
    }

    /// Rings around the region where the field is at least `level`; −∞ gives the whole domain.
    pub(super) fn region(&self, level: f64) -> Vec<Vec<Point>> {
        self.boundary(level).0.chains()
    }

    /// The lines along which the field crosses `level`.
    pub(super) fn isolines(&self, level: f64) -> Vec<Vec<Point>> {
        let (mut edges, on_level) = self.boundary(level);
        edges.count.retain(|(from, to), _| on_level.contains_key(from) && on_level.contains_key(to));
        edges.chains()
    }

    /// Boundary edges of the region above `level`, and the points at which the field equals `level`.
    fn boundary(&self, level: f64) -> (Edges, BTreeMap<Key, ()>) {
        let mut edges = Edges::default();
        let mut on_level = BTreeMap::new();
        for triangle in &self.triangles {
            let mut ring: Vec<Point> = Vec::with_capacity(4);
            for (k, &a) in triangle.iter().enumerate() {
                let b = triangle[(k + 1) % 3];
                let (va, vb) = (self.values[a], self.values[b]);
                if va >= level {
                    ring.push(self.points[a]);
                }
                if va == level {
                    on_level.insert(key(self.points[a]), ());
                }
                if (va > level && vb < level) || (va < level && vb > level) {
                    let cut = self.cut(a, b, level);
                    on_level.insert(key(cut), ());
                    ring.push(cut);
                }
            }
            for (k, &from) in ring.iter().enumerate() {
                edges.add(from, ring[(k + 1) % ring.len()]);
            }
        }
        (edges, on_level)
    }

    /// Where the field equals `level` between two nodes; the same to the last bit from either side.
    fn cut(&self, a: usize, b: usize, level: f64) -> Point {
        let (a, b) = (a.min(b), a.max(b));
        let t = (level - self.values[a]) / (self.values[b] - self.values[a]);
        let (p, q) = (self.points[a], self.points[b]);
        (p.0 + t * (q.0 - p.0), p.1 + t * (q.1 - p.1))
    }
}

/// Nodes of a row with values, from the first to the last, and the ends beyond them.
struct Run {
    nodes: std::ops::Range<usize>,
    before: Option<End>,
    after: Option<End>,
}

/// The values of a row as one run whose ends are known; none where they have gaps, or end somewhere between nodes. A row without any known end
/// in a grid is no run: nothing says how its values end.
fn run(values: &[f64], columns: &[f64], ends: &[End]) -> Option<Run> {
    let first = values.iter().position(|v| v.is_finite())?;
    let last = values.iter().rposition(|v| v.is_finite())?;
    let whole = values[first..=last].iter().all(|v| v.is_finite());
    let between = |a: usize, b: usize| {
        let (low, high) = (columns[a].min(columns[b]), columns[a].max(columns[b]));
        ends.iter().copied().find(|e| e.x >= low && e.x <= high)
    };
    let before = if first > 0 { Some(between(first - 1, first)?) } else { None };
    let after = if last + 1 < values.len() { Some(between(last, last + 1)?) } else { None };
    whole.then_some(Run { nodes: first..last + 1, before, after })
}

impl Run {
    /// Indices of its points in order; ends that are no nodes become new points.
    fn place(self, offset: usize, y: f64, points: &mut Vec<Point>, values: &mut Vec<f64>) -> Vec<usize> {
        let (first, last) = (offset + self.nodes.start, offset + self.nodes.end - 1);
        let mut order: Vec<usize> = (first..=last).collect();
        let mut end = |end: Option<End>, node: usize| {
            let end = end.filter(|e| (e.x - points[node].0).abs() > 1e-9)?;
            points.push((end.x, y));
            values.push(end.value);
            Some(points.len() - 1)
        };
        if let Some(before) = end(self.before, first) {
            order.insert(0, before);
        }
        order.extend(end(self.after, last));
        order
    }
}

/// Triangles between two rows of points, from their beginnings to their ends.
fn join(
    below: &[usize],
    above: &[usize],
    rising: bool,
    (points, values): (&mut Vec<Point>, &mut Vec<f64>),
    triangles: &mut Vec<[usize; 3]>,
) {
    let (mut i, mut k) = (0, 0);
    while i + 1 < below.len() || k + 1 < above.len() {
        let (a, d) = (below[i], above[k]);
        match (below.get(i + 1).copied(), above.get(k + 1).copied()) {
            (Some(b), Some(c)) if points[a].0 == points[d].0 && points[b].0 == points[c].0 => {
                let center = points.len();
                points.push(((points[a].0 + points[c].0) / 2.0, (points[a].1 + points[c].1) / 2.0));
                values.push([a, b, c, d].iter().map(|&k| values[k] / 4.0).sum());
                triangles.extend([[a, b, center], [b, c, center], [c, d, center], [d, a, center]]);
                (i, k) = (i + 1, k + 1);
            }
            (Some(b), c) if c.is_none_or(|c| (points[b].0 < points[c].0) == rising) => {
                triangles.push([a, b, d]);
                i += 1;
            }
            (_, Some(c)) => {
                triangles.push([a, c, d]);
                k += 1;
            }
            _ => break,
        }
    }
}

type Key = (u64, u64);

fn key(point: Point) -> Key {
    (point.0.to_bits(), point.1.to_bits())
}

fn point(key: Key) -> Point {
    (f64::from_bits(key.0), f64::from_bits(key.1))
}

/// Directed edges; an edge and its reverse cancel.
#[derive(Clone, Debug, Default)]
pub(super) struct Edges {
    count: BTreeMap<(Key, Key), usize>,
}

impl Edges {
    pub(super) fn add(&mut self, from: Point, to: Point) {
        let (from, to) = (key(from), key(to));
        if from == to {
            return;
        }
        match self.count.get_mut(&(to, from)) {
            Some(n) if *n > 1 => *n -= 1,
            Some(_) => drop(self.count.remove(&(to, from))),
            None => *self.count.entry((from, to)).or_default() += 1,
        }
    }

    /// The edges strung together: open lines first from their beginnings, then closed rings, whose last point is the first.
    pub(super) fn chains(&self) -> Vec<Vec<Point>> {
        let mut onward: BTreeMap<Key, Vec<Key>> = BTreeMap::new();
        let mut arriving: BTreeMap<Key, usize> = BTreeMap::new();
        for (&(from, to), &n) in &self.count {
            onward.entry(from).or_default().extend(std::iter::repeat_n(to, n));
            *arriving.entry(to).or_default() += n;
        }
        let surplus = |&(from, to): &(&Key, &Vec<Key>)| to.len() > arriving.get(from).copied().unwrap_or(0);
        let beginnings: Vec<Key> = onward.iter().filter(surplus).map(|(&from, _)| from).collect();
        let mut starts: Vec<Key> = beginnings;
        starts.extend(onward.keys());
        let mut chains = Vec::new();
        for start in starts {
            while onward.get(&start).is_some_and(|to| !to.is_empty()) {
                let mut chain = vec![start];
                let mut here = start;
                while let Some(next) = onward.get_mut(&here).and_then(Vec::pop) {
                    chain.push(next);
                    here = next;
                }
                chains.push(straightened(chain.into_iter().map(point).collect()));
            }
        }
        chains
    }
}

/// The line without the points that lie on the straight way between their neighbors.
fn straightened(line: Vec<Point>) -> Vec<Point> {
    let mut kept: Vec<Point> = Vec::with_capacity(line.len());
    for (k, &p) in line.iter().enumerate() {
        if let (Some(&a), Some(&b)) = (kept.last(), line.get(k + 1)) {
            let ((ux, uy), (wx, wy)) = ((p.0 - a.0, p.1 - a.1), (b.0 - p.0, b.1 - p.1));
            let ahead = ux * wx + uy * wy > 0.0;
            if ahead && (ux * wy - uy * wx).abs() < 1e-9 * (ux.hypot(uy) * wx.hypot(wy)) {
                continue;
            }
        }
        kept.push(p);
    }
    kept
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Area enclosed by rings of one orientation (shoelace formula).
    fn area(rings: &[Vec<Point>]) -> f64 {
        let ring = |r: &Vec<Point>| r.windows(2).map(|w| w[0].0 * w[1].1 - w[1].0 * w[0].1).sum::<f64>() / 2.0;
        rings.iter().map(ring).sum::<f64>().abs()
    }

    fn sampled(n: usize, f: impl Fn(f64, f64) -> f64) -> Field {
        let nodes: Vec<f64> = (0..n).map(|k| 2.0 * k as f64 / (n - 1) as f64 - 1.0).collect();
        let values: Vec<f64> = nodes.iter().flat_map(|&y| nodes.iter().map(|&x| f(x, y)).collect::<Vec<_>>()).collect();
        Field::new(&nodes, &nodes, &values, &[])
    }

    #[test]
    fn region_above_a_plane_is_half_of_the_square() {
        let field = sampled(7, |x, y| x + 0.3 * y);
        assert!((area(&field.region(0.0)) - 2.0).abs() < 1e-12);
        let whole = field.region(f64::NEG_INFINITY);
        assert_eq!((whole.len(), area(&whole)), (1, 4.0));
        assert!(whole[0].len() <= 6, "straight sides keep no inner points: {whole:?}");
        assert_eq!(field.isolines(0.0).len(), 1);
    }

    #[test]
    fn cone_has_circular_isolines() {
        let field = sampled(81, |x, y| (x * x + y * y).sqrt());
        let lines = field.isolines(0.6);
        assert_eq!(lines.len(), 1);
        assert_eq!(lines[0].first(), lines[0].last());
        // linear interpolation errs by h²/8 times the curvature 1/r, and twice that over a cell's diagonal
        assert!(lines[0].iter().all(|p| (p.0.hypot(p.1) - 0.6).abs() < 2.0 * 0.025_f64.powi(2) / 8.0 / 0.6 * 1.1));
    }

    #[test]
    fn line_through_nodes_is_found_once() {
        let field = sampled(5, |x, _| x);
        assert_eq!(field.isolines(0.0).len(), 1);
        assert_eq!(field.isolines(0.0)[0].len(), 2);
    }

    #[test]
    fn saddle_has_two_branches_per_level() {
        let field = sampled(20, |x, y| x * y);
        assert_eq!(field.isolines(0.1).len(), 2);
        assert_eq!(field.isolines(-0.1).len(), 2);
    }

    #[test]
    fn missing_values_leave_holes_and_lone_nodes() {
        let field = Field::new(&[0.0, 1.0, 2.0], &[0.0, 1.0], &[1.0, 1.0, f64::NAN, 1.0, f64::NAN, 1.0], &[]);
        assert_eq!(area(&field.region(f64::NEG_INFINITY)), 0.5);
        assert_eq!(field.lone, [5]);
    }

    #[test]
    fn known_ends_make_a_straight_boundary() {
        // a plane over the triangle x + y < 4, of which the grid alone sees stairs
        let nodes = [0.0, 1.0, 2.0, 3.0, 4.0];
        let value = |x: f64, y: f64| if x + y <= 3.3 { x + 2.0 * y } else { f64::NAN };
        let values: Vec<f64> = nodes.iter().flat_map(|&y| nodes.map(|x| value(x, y))).collect();
        let ends: Vec<End> = (0..4).map(|row| End { row, x: 3.3 - row as f64, value: 3.3 + row as f64 }).collect();
        for (columns, sign) in [(nodes, 1.0), (nodes.map(|x| -x), -1.0)] {
            let ends: Vec<End> = ends.iter().map(|e| End { x: sign * e.x, ..*e }).collect();
            let field = Field::new(&columns, &nodes, &values, &ends);
            let whole = field.region(f64::NEG_INFINITY);
            assert_eq!(whole.len(), 1);
            // trapezoids between rows 0 to 3
            assert!((area(&whole) - (3.3 + 2.3 + 1.3 + 0.3 - 0.5 * (3.3 + 0.3))).abs() < 1e-12, "{}", area(&whole));
            assert!((area(&field.region(2.0)) + 1.0 - area(&whole)).abs() < 1e-12, "{}", area(&field.region(2.0)));
        }
    }
}
