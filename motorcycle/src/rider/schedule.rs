//! What a rider knows of the machine: steady states and gains over speed and lateral acceleration.
//!
//! A table over a rectangular grid of speed V and lateral acceleration a (positive to the left), each node a row of numbers. Between the nodes they follow a
//! cubic Hermite surface with three-point slopes, continuous with its first derivatives; outside the grid the value of its edge holds.
//!
//! Source: C. de Boor, *A Practical Guide to Splines*, Springer 1978, chapter IV (three-point slopes: Bessel interpolation).

use mbody::scalar::Real;

/// A table of rows over two variables.
#[derive(Clone, Debug)]
pub struct Table {
    first: Vec<f64>,
    second: Vec<f64>,
    width: usize,
    /// Row of node (i, j) begins at `(i * second.len() + j) * width`.
    rows: Vec<f64>,
}

/// Weights of up to four neighboring nodes and their derivatives.
struct Weights {
    from: usize,
    value: [f64; 4],
    slope: [f64; 4],
}

impl Table {
    /// A table over increasing `first` and `second`, rows in the order (0, 0), (0, 1), … of equal length. `None` where they do not go together.
    pub fn new(first: Vec<f64>, second: Vec<f64>, rows: &[Vec<f64>]) -> Option<Self> {
        let width = rows.first()?.len();
        let increasing = |x: &[f64]| x.windows(2).all(|w| w[0] < w[1]);
        let fits = rows.len() == first.len() * second.len() && rows.iter().all(|r| r.len() == width && r.iter().all(|v| v.is_finite()));
        (fits && increasing(&first) && increasing(&second)).then(|| Self { first, second, width, rows: rows.concat() })
    }

    /// Range of the first and of the second variable.
    pub fn ranges(&self) -> [(f64, f64); 2] {
        [&self.first, &self.second].map(|x| (x[0], x[x.len() - 1]))
    }

    /// Length of a row.
    pub fn width(&self) -> usize {
        self.width
    }

    /// Nodes of both variables.
    pub fn nodes(&self) -> (&[f64], &[f64]) {
        (&self.first, &self.second)
    }

    /// The row of a node.
    pub fn row(&self, i: usize, j: usize) -> &[f64] {
        let begin = (i * self.second.len() + j) * self.width;
        &self.rows[begin..begin + self.width]
    }

    /// Writes the row at (u, v) and its derivatives by both.
    pub fn at(&self, (u, v): (f64, f64), at: &mut Row) {
        let (a, b) = (weights(&self.first, u), weights(&self.second, v));
        for part in [&mut at.value, &mut at.by_first, &mut at.by_second] {
            part.fill(0.0);
        }
        (at.u, at.v) = (u, v);
        for i in 0..4.min(self.first.len() - a.from) {
            for j in 0..4.min(self.second.len() - b.from) {
                let (w, by_first, by_second) = (a.value[i] * b.value[j], a.slope[i] * b.value[j], a.value[i] * b.slope[j]);
                if w == 0.0 && by_first == 0.0 && by_second == 0.0 {
                    continue;
                }
                for (k, entry) in self.row(a.from + i, b.from + j).iter().enumerate() {
                    at.value[k] += w * entry;
                    at.by_first[k] += by_first * entry;
                    at.by_second[k] += by_second * entry;
                }
            }
        }
    }
}

/// A row between the nodes, with its derivatives.
#[derive(Clone, Debug)]
pub struct Row {
    u: f64,
    v: f64,
    value: Vec<f64>,
    by_first: Vec<f64>,
    by_second: Vec<f64>,
}

impl Row {
    /// Room for a row of a table.
    pub fn of(table: &Table) -> Self {
        let zeros = || vec![0.0; table.width];
        Self { u: 0.0, v: 0.0, value: zeros(), by_first: zeros(), by_second: zeros() }
    }

    /// Entry k along with (u, v), whose values are those that the row was written for.
    #[inline]
    pub fn entry<S: Real>(&self, k: usize, (u, v): (S, S)) -> S {
        (u - self.u) * self.by_first[k] + (v - self.v) * self.by_second[k] + self.value[k]
    }
}

/// Hermite weights of the two nodes around x and of the outer two that their slopes need.
fn weights(nodes: &[f64], x: f64) -> Weights {
    let n = nodes.len();
    let single = |at: usize| Weights { from: at, value: [1.0, 0.0, 0.0, 0.0], slope: [0.0; 4] };
    if x <= nodes[0] {
        return single(0);
    }
    if x >= nodes[n - 1] {
        return single(n - 1);
    }
    let i = nodes.partition_point(|k| *k <= x) - 1;
    let from = i.saturating_sub(1);
    let h = nodes[i + 1] - nodes[i];
    let t = (x - nodes[i]) / h;
    let (value, slope) = hermite(t);
    let mut weights = Weights { from, value: [0.0; 4], slope: [0.0; 4] };
    let mut add = |node: usize, w: f64, d: f64| {
        weights.value[node - from] += w;
        weights.slope[node - from] += d / h;
    };
    add(i, value[0], slope[0]);
    add(i + 1, value[1], slope[1]);
    for (node, w, d) in [(i, value[2], slope[2]), (i + 1, value[3], slope[3])] {
        for (neighbor, share) in bessel(nodes, node) {
            add(neighbor, h * w * share, h * d * share);
        }
    }
    weights
}

/// Values of the Hermite polynomials at t: both ordinates, both slopes; and their derivatives.
fn hermite(t: f64) -> ([f64; 4], [f64; 4]) {
    let (tt, w) = (t * t, 1.0 - t);
    (
        [(1.0 + 2.0 * t) * w * w, tt * (3.0 - 2.0 * t), t * w * w, -tt * w],
        [-6.0 * t * w, 6.0 * t * w, w * (1.0 - 3.0 * t), t * (3.0 * t - 2.0)],
    )
}

/// Slope at a node as shares of ordinates: that of the parabola through it and its neighbors. At both ends it is zero, as beyond them.
fn bessel(nodes: &[f64], i: usize) -> [(usize, f64); 3] {
    if i == 0 || i + 1 == nodes.len() {
        return [(i, 0.0); 3];
    }
    let (a, b) = (nodes[i] - nodes[i - 1], nodes[i + 1] - nodes[i]);
    [(i - 1, -b / (a * (a + b))), (i, (b - a) / (a * b)), (i + 1, a / (b * (a + b)))]
}

#[cfg(test)]
mod tests {
    use super::*;

    fn table() -> Table {
        let (u, v) = (vec![1.0, 2.0, 2.5, 4.0, 5.0], vec![-2.0, -1.0, 0.5, 2.0]);
        let rows: Vec<Vec<f64>> =
            u.iter().flat_map(|&u: &f64| v.iter().map(move |&v: &f64| vec![u.mul_add(v, 1.0), u.sin() * v.cos()])).collect();
        Table::new(u, v, &rows).unwrap()
    }

    #[test]
    fn nodes_are_met_and_derivatives_are_those_of_the_values() {
        let table = table();
        let mut row = Row::of(&table);
        table.at((2.5, 0.5), &mut row);
        assert!((row.value[0] - 2.25).abs() < 1e-14);
        let h = 1e-6;
        for at in [(1.3, -1.7), (2.2, 0.1), (3.9, 1.9), (4.5, -0.2), (2.5, 0.5), (7.0, 0.3)] {
            table.at(at, &mut row);
            let center = row.clone();
            let mut difference = |du: f64, dv: f64| {
                table.at((at.0 + du, at.1 + dv), &mut row);
                let ahead = row.value[1];
                table.at((at.0 - du, at.1 - dv), &mut row);
                (ahead - row.value[1]) / (2.0 * h)
            };
            assert!((difference(h, 0.0) - center.by_first[1]).abs() < 1e-5, "{at:?}");
            assert!((difference(0.0, h) - center.by_second[1]).abs() < 1e-5, "{at:?}");
        }
    }

    #[test]
    fn tables_that_do_not_go_together_are_refused() {
        assert!(Table::new(vec![1.0, 1.0], vec![0.0], &[vec![0.0], vec![0.0]]).is_none());
        assert!(Table::new(vec![1.0, 2.0], vec![0.0], &[vec![0.0]]).is_none());
        assert!(Table::new(vec![1.0], vec![0.0], &[vec![f64::NAN]]).is_none());
    }
}
