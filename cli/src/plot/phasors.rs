//! Shapes of modes as phasors: one circle per mode, one arrow per signal; length is magnitude, angle is phase.
//!
//! Names stand in columns beside the circles, joined to their arrows, so that they never cover each other.

use super::canvas::{Anchor, CAP_HEIGHT, Canvas, Ground, Lettering, Pen, Point, Setting};
use super::lines::top_of;
use super::{style, text};
use std::f64::consts::TAU;

/// One signal in one mode.
#[derive(Clone, Debug, PartialEq)]
pub struct Phasor {
    /// Name of the signal.
    pub name: String,
    /// Real and imaginary part; the longest of a panel fills the circle.
    pub value: (f64, f64),
}

/// One mode.
#[derive(Clone, Debug, PartialEq)]
pub struct PhasorPanel {
    /// What the mode is, above the circle.
    pub title: String,
    /// Its signals.
    pub arrows: Vec<Phasor>,
}

/// Shapes of several modes.
#[derive(Clone, Debug, PartialEq)]
pub struct Phasors {
    /// Title above the figure.
    pub title: String,
    /// The modes, row by row.
    pub panels: Vec<PhasorPanel>,
}

/// Radius of a circle.
const RADIUS: f64 = 78.0;
/// Distance from the circle to the names, for the lines that join them.
const REACH: f64 = 22.0;
/// Height of a line of names.
const LINE: f64 = style::LABEL_SIZE + 3.0;
/// Circles beside each other.
const COLUMNS: usize = 2;

/// A name in its place.
struct Label<'a> {
    arrow: usize,
    text: &'a str,
    /// Where the line from the arrow ends.
    at: Point,
    right: bool,
}

impl Phasors {
    /// The figure as SVG.
    pub(super) fn draw(&self, lettering: Lettering) -> String {
        let names = self.names();
        let widest = names.iter().map(|n| text::width(n, style::LABEL_SIZE)).fold(0.0, f64::max);
        let titles = self.panels.iter().map(|p| text::width(&p.title, style::TITLE_SIZE)).fold(0.0, f64::max);
        let width = (2.0 * (RADIUS + REACH + style::GAP + widest)).max(titles) + 3.0 * style::GAP;
        let top = top_of(&self.title);
        let columns = COLUMNS.min(self.panels.len()).max(1);
        let mut canvas = Canvas::new(lettering);
        let mut y = top;
        for row in self.panels.chunks(columns) {
            // room for the column of names where there are more of them than a circle is high
            let most = row.iter().map(|p| p.arrows.len()).max().unwrap_or(0) as f64;
            let height = (2.0 * RADIUS).max(LINE * most);
            let center_y = y + style::TITLE_SIZE + 2.0 * style::GAP + 0.5 * height;
            for (k, panel) in row.iter().enumerate() {
                let x = style::BORDER + width * (k as f64 + 0.5);
                canvas.text(&panel.title, Setting::new((x, y + style::TITLE_SIZE), style::TITLE_SIZE, Anchor::Middle));
                panel.draw(&mut canvas, (x, center_y), &names);
            }
            y = center_y + 0.5 * height + 3.0 * style::GAP;
        }
        let right = 2.0 * style::BORDER + width * columns as f64;
        let middle = 0.5 * right;
        if !self.title.is_empty() {
            let at = (middle, style::BORDER + style::TITLE_SIZE - 1.0);
            canvas.text(&self.title, Setting::new(at, style::TITLE_SIZE, Anchor::Middle));
        }
        for words in ["Length: deviation, 1 rad as long as 1 m, the largest fills the circle", "Angle: phase, counterclockwise leads"] {
            y += style::LABEL_SIZE;
            canvas.text(words, Setting::new((middle, y), style::LABEL_SIZE, Anchor::Middle));
            y += style::GAP;
        }
        canvas.finish(right, y + style::BORDER, &self.title)
    }

    /// Names of all signals, each once: the place among them chooses the color.
    fn names(&self) -> Vec<&str> {
        let mut names: Vec<&str> = Vec::new();
        for arrow in self.panels.iter().flat_map(|p| &p.arrows) {
            if !names.contains(&arrow.name.as_str()) {
                names.push(&arrow.name);
            }
        }
        names
    }
}

impl PhasorPanel {
    fn draw(&self, canvas: &mut Canvas, center: Point, names: &[&str]) {
        let grid = Pen::solid(style::GRID, 0.8);
        canvas.disc(center, RADIUS, style::WHITE, Pen::solid(style::INK, style::FRAME_WIDTH));
        canvas.disc(center, 0.5 * RADIUS, style::WHITE, grid);
        for k in 0..6 {
            let (sin, cos) = (TAU * f64::from(k) / 12.0).sin_cos();
            let end = |side: f64| (center.0 + side * RADIUS * cos, center.1 - side * RADIUS * sin);
            canvas.line(end(-1.0), end(1.0), if k % 3 == 0 { Pen::solid(style::RULE, 0.7) } else { grid });
        }
        let largest = self.arrows.iter().map(|a| a.value.0.hypot(a.value.1)).fold(f64::MIN_POSITIVE, f64::max);
        let tip = |arrow: &Phasor| (center.0 + RADIUS * arrow.value.0 / largest, center.1 - RADIUS * arrow.value.1 / largest);
        for label in self.labels(center, &tip) {
            let edge = if label.right { label.at.0 - REACH + 6.0 } else { label.at.0 + REACH - 6.0 };
            canvas.polyline(&[tip(&self.arrows[label.arrow]), (edge, label.at.1), label.at], Pen::solid(style::HATCH, 0.7));
            let (anchor, gap) = if label.right { (Anchor::Start, 3.0) } else { (Anchor::End, -3.0) };
            let baseline = label.at.1 + CAP_HEIGHT / 2.0 * style::LABEL_SIZE;
            canvas.text(label.text, Setting::new((label.at.0 + gap, baseline), style::LABEL_SIZE, anchor));
        }
        // short arrows last, on top of long ones
        let mut order: Vec<&Phasor> = self.arrows.iter().collect();
        order.sort_by(|a, b| b.value.0.hypot(b.value.1).total_cmp(&a.value.0.hypot(a.value.1)));
        for arrow in order {
            let color = names.iter().position(|n| *n == arrow.name).unwrap_or(0);
            draw_arrow(canvas, center, tip(arrow), style::curve_color(color));
        }
    }

    /// Names on the side of their arrows, from top to bottom in the order of the arrows' ends, a line apart at least.
    fn labels(&self, center: Point, tip: &dyn Fn(&Phasor) -> Point) -> Vec<Label<'_>> {
        let mut labels = Vec::new();
        for right in [true, false] {
            let mut side: Vec<(usize, f64)> = (self.arrows.iter().enumerate())
                .map(|(k, arrow)| (k, tip(arrow)))
                .filter(|(_, end)| (end.0 >= center.0) == right)
                .map(|(k, end)| (k, end.1))
                .collect();
            side.sort_by(|a, b| a.1.total_cmp(&b.1));
            let x = if right { center.0 + RADIUS + REACH } else { center.0 - RADIUS - REACH };
            for (place, y) in apart(&side.iter().map(|s| s.1).collect::<Vec<_>>(), center.1).into_iter().enumerate() {
                let arrow = side[place].0;
                labels.push(Label { arrow, text: &self.arrows[arrow].name, at: (x, y), right });
            }
        }
        labels
    }
}

/// Heights near the wanted ones, a line apart, none outside a circle about the middle as far as there is room.
fn apart(wanted: &[f64], middle: f64) -> Vec<f64> {
    let half = RADIUS.max(0.5 * LINE * wanted.len() as f64) - 0.5 * LINE;
    let mut heights: Vec<f64> = Vec::with_capacity(wanted.len());
    for &y in wanted {
        let least = heights.last().map_or(middle - half, |last| last + LINE);
        heights.push(y.max(least));
    }
    let mut most = middle + half;
    for y in heights.iter_mut().rev() {
        *y = y.min(most);
        most = *y - LINE;
    }
    heights
}

/// An arrow from the center; a head only where there is room for one.
fn draw_arrow(canvas: &mut Canvas, from: Point, to: Point, color: style::Color) {
    let pen = Pen::solid(color, style::CURVE_WIDTH);
    let length = (to.0 - from.0).hypot(to.1 - from.1);
    const HEAD: f64 = 8.0;
    if length < 1.5 * HEAD {
        canvas.line(from, to, pen);
        canvas.disc(to, 0.6 * style::MARKER, color, Pen::solid(color, 0.3));
        return;
    }
    let (ux, uy) = ((to.0 - from.0) / length, (to.1 - from.1) / length);
    let back = (to.0 - HEAD * ux, to.1 - HEAD * uy);
    canvas.line(from, back, pen);
    let wing = |side: f64| (back.0 - side * 0.42 * HEAD * uy, back.1 + side * 0.42 * HEAD * ux);
    canvas.area(&[vec![to, wing(1.0), wing(-1.0), to]], Ground::Plain(color));
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_keep_a_line_between_them() {
        for wanted in [vec![0.0; 9], vec![-70.0, -69.0, 3.0, 4.0, 77.0, 78.0], vec![100.0, 101.0], vec![]] {
            let heights = apart(&wanted, 0.0);
            assert!(heights.windows(2).all(|w| w[1] - w[0] > LINE - 1e-9), "{heights:?}");
            assert!(heights.iter().all(|y| y.abs() <= RADIUS), "{heights:?}");
        }
    }
}
