//! A quantity on the nodes of a grid, some of them without a value: regions above a level and the lines at a level.
//!
//! Each cell with four values is cut into four triangles about its center (mean of the corners), each cell with three values is one triangle;
//! the quantity is linear on a triangle. A region is the union of the clipped triangles, found by letting edges that are walked in both
//! directions cancel. No case table, no saddle ambiguity, and a missing value is simply an absent triangle.

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

impl Field {
    /// The field over the grid of `columns` × `rows`, values row by row, NaN where there is none.
    pub(super) fn new(columns: &[f64], rows: &[f64], values: &[f64]) -> Self {
        let mut points: Vec<Point> = rows.iter().flat_map(|&y| columns.iter().map(move |&x| (x, y))).collect();
        let mut values = values.to_vec();
        let mut triangles = Vec::new();
        let n = columns.len();
        let mut used = vec![false; values.len()];
        for (i, j) in (1..rows.len()).flat_map(|j| (1..n).map(move |i| (i, j))) {
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
        Field::new(&nodes, &nodes, &values)
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
        let field = Field::new(&[0.0, 1.0, 2.0], &[0.0, 1.0], &[1.0, 1.0, f64::NAN, 1.0, f64::NAN, 1.0]);
        assert_eq!(area(&field.region(f64::NEG_INFINITY)), 0.5);
        assert_eq!(field.lone, [5]);
    }
}
