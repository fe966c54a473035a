//! A drawing to scale in a vertical plane: circles, lines, points and dimensions over the ground.

use super::canvas::{Anchor, Canvas, Lettering, Pen, Point, Rect, Setting};
use super::legend::{Key, Legend};
use super::lines::{draw_title, top_of};
use super::style;

/// How a line is drawn.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Stroke {
    /// A part in front.
    Thick,
    /// Construction lines.
    Thin,
    /// An axis: dash and dot.
    Axis,
    /// First color.
    First,
    /// Second color.
    Second,
    /// Fourth color.
    Fourth,
}

impl Stroke {
    fn pen(self) -> Pen {
        match self {
            Self::Thick => Pen::solid(style::INK, 1.6),
            Self::Thin => Pen::solid(style::RULE, 0.8),
            Self::Axis => Pen { dash: "10 3 2 3", ..Pen::solid(style::INK, 0.9) },
            Self::First => Pen::solid(style::curve_color(0), style::CURVE_WIDTH),
            Self::Second => Pen { dash: "7 3", ..Pen::solid(style::curve_color(1), style::CURVE_WIDTH) },
            Self::Fourth => Pen::solid(style::curve_color(2), style::CURVE_WIDTH),
        }
    }
}

/// A shape; lengths in m, points (x, z), x to the right and z up.
#[derive(Clone, Debug, PartialEq)]
enum Shape {
    Circle { center: [f64; 2], radius: f64, stroke: Stroke },
    Line { from: [f64; 2], to: [f64; 2], stroke: Stroke, name: String },
    Point { at: [f64; 2], name: String },
    Dimension { from: [f64; 2], to: [f64; 2], text: String, row: usize },
    Note { at: [f64; 2], text: String },
}

/// A drawing to scale.
#[derive(Clone, Debug, PartialEq)]
pub struct Sketch {
    title: String,
    shapes: Vec<Shape>,
}

/// Width of the drawing.
const WIDTH: f64 = 640.0;
/// Distance of dimension lines below the ground.
const ROW: f64 = 24.0;

impl Sketch {
    /// An empty drawing over the ground z = 0.
    pub fn new(title: impl Into<String>) -> Self {
        Self { title: title.into(), shapes: Vec::new() }
    }
    /// Adds a circle.
    pub fn circle(&mut self, center: [f64; 2], radius: f64, stroke: Stroke) {
        self.shapes.push(Shape::Circle { center, radius, stroke });
    }
    /// Adds a line; a name puts it into the legend.
    pub fn line(&mut self, from: [f64; 2], to: [f64; 2], stroke: Stroke, name: impl Into<String>) {
        self.shapes.push(Shape::Line { from, to, stroke, name: name.into() });
    }
    /// Adds a point with its name beside it.
    pub fn point(&mut self, at: [f64; 2], name: impl Into<String>) {
        self.shapes.push(Shape::Point { at, name: name.into() });
    }
    /// Adds a horizontal dimension below the ground, in a row from 1 on.
    pub fn dimension(&mut self, from: [f64; 2], to: [f64; 2], text: impl Into<String>, row: usize) {
        self.shapes.push(Shape::Dimension { from, to, text: text.into(), row });
    }
    /// Adds a text beside a point.
    pub fn note(&mut self, at: [f64; 2], text: impl Into<String>) {
        self.shapes.push(Shape::Note { at, text: text.into() });
    }

    /// Left, right and upper end, m.
    fn extent(&self) -> [f64; 3] {
        let mut extent = [f64::INFINITY, f64::NEG_INFINITY, 0.1];
        let mut reach = |[x, z]: [f64; 2], by: f64| {
            if x.is_finite() && z.is_finite() {
                extent = [extent[0].min(x - by), extent[1].max(x + by), extent[2].max(z + by)];
            }
        };
        for shape in &self.shapes {
            match shape {
                Shape::Circle { center, radius, .. } => reach(*center, *radius),
                Shape::Line { from, to, .. } | Shape::Dimension { from, to, .. } => {
                    reach(*from, 0.0);
                    reach(*to, 0.0);
                }
                Shape::Point { at, .. } | Shape::Note { at, .. } => reach(*at, 0.02),
            }
        }
        if extent[1] <= extent[0] { [0.0, 1.0, extent[2]] } else { extent }
    }

    /// The figure as SVG.
    pub(super) fn draw(&self, lettering: Lettering) -> String {
        let [left, right, top] = self.extent();
        let scale = WIDTH / (right - left);
        let upper = top_of(&self.title) + 10.0;
        let ground = upper + top * scale;
        let place = |[x, z]: [f64; 2]| -> Point { (style::BORDER + (x - left) * scale, ground - z * scale) };
        let mut canvas = Canvas::new(lettering);
        let (rows, mut legend) = (self.rows(), Legend::default());
        canvas.line((style::BORDER, ground), (style::BORDER + WIDTH, ground), Pen::solid(style::INK, 1.0));
        for shape in &self.shapes {
            match shape {
                Shape::Circle { center, radius, stroke } => {
                    let ring = (0..=120).map(|k| {
                        let angle = f64::from(k) / 120.0 * std::f64::consts::TAU;
                        place([center[0] + radius * angle.cos(), center[1] + radius * angle.sin()])
                    });
                    canvas.polyline(&ring.collect::<Vec<_>>(), stroke.pen());
                }
                Shape::Line { from, to, stroke, name } => {
                    canvas.line(place(*from), place(*to), stroke.pen());
                    if !name.is_empty() {
                        legend.add(Key::Line(stroke.pen(), None), name);
                    }
                }
                Shape::Point { .. } | Shape::Note { .. } => {}
                Shape::Dimension { from, to, text, row } => {
                    draw_dimension(&mut canvas, (place(*from), place(*to)), text, ground + *row as f64 * ROW)
                }
            }
        }
        // points and words over the lines
        for shape in &self.shapes {
            let (at, text) = match shape {
                Shape::Point { at, name } => {
                    canvas.disc(place(*at), style::MARKER, style::WHITE, Pen::solid(style::INK, 1.2));
                    (at, name)
                }
                Shape::Note { at, text } => (at, text),
                _ => continue,
            };
            let (x, y) = place(*at);
            // to the side on which there is room
            let (dx, anchor) = if x > 0.75 * WIDTH { (-7.0, Anchor::End) } else { (7.0, Anchor::Start) };
            canvas.text(text, Setting::new((x + dx, y - 5.0), style::LABEL_SIZE, anchor));
        }
        let frame = Rect { x: style::BORDER, y: upper, width: WIDTH, height: ground - upper };
        draw_title(&mut canvas, &self.title, frame);
        let mut bottom = ground + rows as f64 * ROW + 10.0;
        legend.draw_flow(&mut canvas, (style::BORDER, bottom), WIDTH);
        bottom += legend.flow_height(WIDTH);
        canvas.finish(WIDTH + 2.0 * style::BORDER, bottom + style::BORDER, &self.title)
    }

    fn rows(&self) -> usize {
        let row = |shape: &Shape| if let Shape::Dimension { row, .. } = shape { *row } else { 0 };
        self.shapes.iter().map(row).max().unwrap_or(0)
    }
}

/// A dimension line at a height, with its witness lines and its text.
fn draw_dimension(canvas: &mut Canvas, (from, to): (Point, Point), text: &str, y: f64) {
    let pen = Pen::solid(style::INK, 0.8);
    for end in [from, to] {
        canvas.line((end.0, end.1 + 3.0), (end.0, y + 4.0), Pen::solid(style::RULE, 0.7));
    }
    canvas.line((from.0, y), (to.0, y), pen);
    let inward = if to.0 > from.0 { 1.0 } else { -1.0 };
    let arrow = if (to.0 - from.0).abs() > 16.0 { 6.0 } else { 2.0 };
    for (x, side) in [(from.0, inward), (to.0, -inward)] {
        canvas.line((x, y), (x + side * arrow, y - 2.5), pen);
        canvas.line((x, y), (x + side * arrow, y + 2.5), pen);
    }
    let right = from.0.max(to.0);
    let (at, anchor) = match (to.0 - from.0).abs() > 160.0 {
        true => (((from.0 + to.0) / 2.0, y - 3.0), Anchor::Middle),
        false if right > 0.75 * WIDTH => ((from.0.min(to.0) - 6.0, y + 4.0), Anchor::End),
        false => ((right + 6.0, y + 4.0), Anchor::Start),
    };
    canvas.text(text, Setting::new(at, style::LABEL_SIZE, anchor));
}
