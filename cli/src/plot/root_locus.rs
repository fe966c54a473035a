//! Eigenvalues in the complex plane: upper half, lines of constant damping ratio, the unstable half shaded.
//!
//! The window holds all oscillations; real eigenvalues far to the left, and what moves faster than the frame is high, are named
//! below the figure.

use super::axis::Axis;
use super::canvas::{Anchor, CAP_HEIGHT, Canvas, Ground, Lettering, Pen, Rect, Setting};
use super::legend::{Key, Legend};
use super::lines::{dense, draw_title, top_of};
use super::panel::{Panel, ROOM_BELOW, Side};
use super::{style, text};

/// The path of one eigenvalue under one name.
#[derive(Clone, Debug, PartialEq)]
pub struct Locus {
    /// Name in the legend; paths of one name look alike.
    pub name: String,
    /// Real part, 1/s, and imaginary part, rad/s, along the sweep.
    pub points: Vec<(f64, f64)>,
    /// The first point is that of the first value of the sweep, and marked.
    pub begins: bool,
    /// Which of [`RootLocus::variants`]; 0 where there are none.
    pub variant: usize,
}

/// Eigenvalues along a sweep.
#[derive(Clone, Debug, PartialEq)]
pub struct RootLocus {
    /// Title above the figure.
    pub title: String,
    /// The paths.
    pub branches: Vec<Locus>,
    /// What is prescribed at the first value of the sweep, for the legend; empty without a sweep.
    pub first: String,
    /// Names of variants, the base first; empty where there is only one. Their paths differ in dashes.
    pub variants: Vec<String>,
}

/// Height of the drawing area.
const HEIGHT: f64 = 380.0;
/// Damping ratios of the lines.
const DAMPING: [f64; 7] = [0.02, 0.05, 0.1, 0.2, 0.3, 0.5, 0.7];
/// Oscillations above this are out of sight, rad/s: beyond 25 Hz the models say little.
const FASTEST: f64 = 157.0;

impl RootLocus {
    /// The figure as SVG.
    pub(super) fn draw(&self, lettering: Lettering) -> String {
        let (x_range, y_range) = self.window();
        let (x_axis, y_axis) = (Axis::new("Real part", "1/s"), Axis::new("Imaginary part", "rad/s"));
        let y_side = Side::vertical(&y_axis, y_range, HEIGHT);
        let labels = y_side.label_width();
        // labels of the damping lines stand between title and frame
        let top = top_of(&self.title) + style::CONTOUR_LABEL_SIZE + style::GAP;
        let frame = Rect { x: Side::room(labels), y: top, width: style::PANEL_WIDTH, height: HEIGHT };
        let panel = Panel::new(frame, Side::horizontal(&x_axis, x_range, style::PANEL_WIDTH), y_side);
        let mut canvas = Canvas::new(lettering);
        let unstable = Rect { x: panel.x(0.0), width: frame.right() - panel.x(0.0), ..frame };
        canvas.rect(unstable, Some(Ground::Plain(style::SHADE)), None);
        panel.draw_grid(&mut canvas);
        canvas.line((panel.x(0.0), frame.y), (panel.x(0.0), frame.bottom()), Pen::solid(style::RULE, 0.9));
        draw_damping(&mut canvas, &panel, x_range.0, y_range.1);
        canvas.clip(frame.shrunk(-style::MARKER));
        self.draw_branches(&mut canvas, &panel);
        canvas.unclip();
        panel.draw_frame(&mut canvas);
        panel.draw_y_labels(&mut canvas, labels);
        panel.draw_x_labels(&mut canvas);
        draw_title(&mut canvas, &self.title, frame);
        let right = self.draw_legend(&mut canvas, &panel);
        let mut bottom = frame.bottom() + ROOM_BELOW;
        for line in self.beyond(x_range, y_range, frame.width) {
            bottom += style::LABEL_SIZE + style::GAP;
            canvas.text(&line, Setting::new((frame.x, bottom), style::LABEL_SIZE, Anchor::Start));
        }
        canvas.finish(right, bottom + style::BORDER, &self.title)
    }

    /// Ranges of real and imaginary parts.
    fn window(&self) -> ((f64, f64), (f64, f64)) {
        let all = || self.branches.iter().flat_map(|b| &b.points).copied().filter(|(re, im)| re.is_finite() && im.is_finite());
        let oscillating = || all().filter(|(re, im)| *im > 0.0 && re.hypot(*im) < FASTEST);
        let fastest = oscillating().map(|p| p.1).fold(0.0, f64::max);
        let height = if fastest > 0.0 { 1.05 * fastest } else { 1.0 };
        let stable = match fastest > 0.0 {
            true => oscillating().map(|p| p.0).fold(-0.1 * height, f64::min).max(-height),
            false => all().map(|p| p.0).fold(-0.1, f64::min),
        };
        let unstable = all().map(|p| p.0).fold(0.0, f64::max).min(-stable);
        let (left, right) = (1.06 * stable, (1.1 * unstable).max(-0.08 * stable));
        ((left, right), (-0.015 * height, height))
    }

    /// Names of oscillations, then the others, each once.
    fn names(&self) -> Vec<&str> {
        let oscillates = |b: &&Locus| b.points.iter().filter(|p| p.1 > 0.0).count() * 2 > b.points.len();
        let (oscillations, mut others): (Vec<&Locus>, Vec<&Locus>) = self.branches.iter().partition(oscillates);
        // dashes belong to the variants: no more names than colors, real modes least of all
        others.retain(|_| self.variants.is_empty());
        let mut names: Vec<&str> = Vec::new();
        for branch in oscillations.into_iter().chain(others) {
            if !names.contains(&branch.name.as_str()) {
                names.push(&branch.name);
            }
        }
        names
    }

    fn visible(panel: &Panel, branch: &Locus) -> bool {
        branch.points.iter().any(|&p| panel.place(p).is_some_and(|at| panel.frame.shrunk(-1.0).contains(at)))
    }

    /// Names with an index each that chooses their color, visible ones only.
    fn shown(&self, panel: &Panel) -> Vec<&str> {
        let visible = |name: &&str| self.branches.iter().any(|b| b.name == **name && Self::visible(panel, b));
        self.names().into_iter().filter(visible).collect()
    }

    /// Variants differ in dashes; where there are none, dashes tell apart what has run out of colors.
    fn dash(&self, branch: &Locus, style: usize) -> &'static str {
        if self.variants.is_empty() { style::round_dash(style) } else { style::curve_dash(branch.variant) }
    }

    fn draw_branches(&self, canvas: &mut Canvas, panel: &Panel) {
        let shown = self.shown(panel);
        let few = self.branches.iter().map(|b| b.points.len()).max().unwrap_or(0) <= 100;
        for branch in &self.branches {
            let Some(style) = shown.iter().position(|n| *n == branch.name) else { continue };
            let pen = Pen { dash: self.dash(branch, style), ..pen(style) };
            let run: Vec<_> = branch.points.iter().filter_map(|&p| panel.place(p)).collect();
            canvas.polyline(&run, Pen { width: 1.2, ..pen });
            if few && branch.variant == 0 {
                run.iter().for_each(|&p| canvas.disc(p, 0.55 * style::MARKER, pen.color, Pen::solid(pen.color, 0.3)));
            }
        }
        for branch in self.branches.iter().filter(|b| b.begins) {
            let style = shown.iter().position(|n| *n == branch.name);
            if let (Some(style), Some(at)) = (style, branch.points.first().and_then(|&p| panel.place(p))) {
                canvas.disc(at, 1.3 * style::MARKER, style::WHITE, Pen::solid(pen(style).color, 1.5));
            }
        }
    }

    /// Draws the legend; returns the right edge of what was drawn.
    fn draw_legend(&self, canvas: &mut Canvas, panel: &Panel) -> f64 {
        let mut legend = Legend::default();
        for (k, name) in self.shown(panel).into_iter().enumerate() {
            legend.add(Key::Line(Pen { dash: if self.variants.is_empty() { pen(k).dash } else { "" }, ..pen(k) }, None), name);
        }
        for (k, name) in self.variants.iter().enumerate() {
            legend.add(Key::Line(Pen { dash: style::curve_dash(k), ..Pen::solid(style::INK, 1.2) }, None), name);
        }
        if !self.first.is_empty() {
            legend.add(Key::Ring, &self.first);
        }
        legend.add(Key::Line(DAMPING_PEN, None), "damping ratio");
        legend.add(Key::Area(Ground::Plain(style::SHADE)), "unstable");
        let at = (panel.frame.right() + 2.0 * style::GAP, panel.frame.y);
        let runs = self.branches.iter().map(|b| b.points.iter().filter_map(|&p| panel.place(p)).collect::<Vec<_>>());
        let obstacles: Vec<_> = runs.flat_map(|run| dense(&run)).collect();
        let at = legend.free_corner(panel.frame, &obstacles).unwrap_or(at);
        legend.draw_column(canvas, at);
        (at.0 + legend.column_size().0).max(panel.frame.right()) + style::BORDER
    }

    /// Lines of text that name what is out of sight.
    fn beyond(&self, (left, right): (f64, f64), (low, high): (f64, f64), width: f64) -> Vec<String> {
        let outside = |&(re, im): &(f64, f64)| re < left || re > right || im > high || im < low;
        let mut counts: Vec<String> = Vec::new();
        for name in self.names() {
            if self.branches.iter().any(|b| b.name == name && b.points.iter().any(outside)) {
                counts.push(name.to_owned());
            }
        }
        let mut lines: Vec<String> = Vec::new();
        for (k, name) in counts.iter().enumerate() {
            let word = if k + 1 < counts.len() { format!("{name},") } else { name.clone() };
            match lines.last_mut() {
                Some(line) if text::width(&format!("{line} {word}"), style::LABEL_SIZE) < width => *line = format!("{line} {word}"),
                Some(_) => lines.push(word),
                None => lines.push(format!("Out of sight, wholly or in part: {word}")),
            }
        }
        lines
    }
}

fn pen(index: usize) -> Pen {
    Pen { color: style::curve_color(index), width: style::CURVE_WIDTH, dash: style::round_dash(index) }
}

const DAMPING_PEN: Pen = Pen { color: style::HATCH, width: 0.8, dash: "4 3" };

/// Rays of constant damping ratio, labeled where they leave the frame.
fn draw_damping(canvas: &mut Canvas, panel: &Panel, left: f64, high: f64) {
    let mut taken = f64::INFINITY;
    for ratio in DAMPING {
        let (re, im) = (-ratio, (1.0 - ratio * ratio).sqrt());
        // the ray ends at the upper or the left side
        let length = (high / im).min(left / re);
        let Some(end) = panel.place((re * length, im * length)) else { continue };
        let Some(origin) = panel.place((0.0, 0.0)) else { continue };
        canvas.line(origin, end, DAMPING_PEN);
        let label = ratio.to_string();
        let size = style::CONTOUR_LABEL_SIZE;
        let half = 0.5 * text::width(&label, size);
        if high / im <= left / re {
            if end.0 + half + style::GAP < taken {
                canvas.text(&label, Setting::new((end.0, panel.frame.y - style::GAP + 1.0), size, Anchor::Middle));
                taken = end.0 - half;
            }
        } else {
            let at = (panel.frame.x + style::TICK + 3.0, end.1);
            let ground = Rect { x: at.0 - 2.0, y: at.1 - 0.5 * size - 1.0, width: 2.0 * half + 4.0, height: size + 2.0 };
            canvas.rect(ground, Some(Ground::Plain(style::WHITE)), None);
            canvas.text(&label, Setting::new((at.0, at.1 + CAP_HEIGHT / 2.0 * size), size, Anchor::Start));
        }
    }
}
