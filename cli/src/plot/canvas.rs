//! A thin layer over SVG text: shapes in, markup out.

use super::style::{Color, INK, WHITE};
use super::text::{self, FAMILIES};
use std::fmt::Write;

/// A point on the canvas, y downwards.
pub(super) type Point = (f64, f64);

/// A rectangle with sides along the axes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Rect {
    pub(super) x: f64,
    pub(super) y: f64,
    pub(super) width: f64,
    pub(super) height: f64,
}

impl Rect {
    pub(super) fn right(&self) -> f64 {
        self.x + self.width
    }

    pub(super) fn bottom(&self) -> f64 {
        self.y + self.height
    }

    /// The rectangle moved inwards by `by` on all sides.
    pub(super) fn shrunk(&self, by: f64) -> Self {
        Self { x: self.x + by, y: self.y + by, width: self.width - 2.0 * by, height: self.height - 2.0 * by }
    }

    pub(super) fn contains(&self, (x, y): Point) -> bool {
        x >= self.x && x <= self.right() && y >= self.y && y <= self.bottom()
    }
}

/// Pen of a line.
#[derive(Clone, Copy, Debug)]
pub(super) struct Pen {
    pub(super) color: Color,
    pub(super) width: f64,
    /// SVG dash array; empty for a solid line.
    pub(super) dash: &'static str,
}

impl Pen {
    pub(super) const fn solid(color: Color, width: f64) -> Self {
        Self { color, width, dash: "" }
    }
}

/// Ground of an area.
#[derive(Clone, Copy, Debug)]
pub(super) enum Ground {
    Plain(Color),
    /// One of the hatches of [`Canvas::hatch`].
    Hatch(usize),
}

/// Which point of a text its position names, horizontally.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Anchor {
    Start,
    Middle,
    End,
}

/// Position, size and turn of a text.
#[derive(Clone, Copy, Debug)]
pub(super) struct Setting {
    /// Position of the anchor on the baseline.
    pub(super) at: Point,
    pub(super) size: f64,
    pub(super) anchor: Anchor,
    /// Turn about the anchor in degrees, clockwise.
    pub(super) turn: f64,
    pub(super) color: Color,
}

impl Setting {
    pub(super) fn new(at: Point, size: f64, anchor: Anchor) -> Self {
        Self { at, size, anchor, turn: 0.0, color: INK }
    }
}

/// How letters are written.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) enum Lettering {
    /// As text, which can be searched and edited; the reader's machine supplies the font.
    #[default]
    Text,
    /// As outlines of the embedded font, the same everywhere.
    Outlines,
}

/// Height of digits and capitals as a share of the font size; half of it centers a text on a line.
pub(super) const CAP_HEIGHT: f64 = 0.73;

/// An SVG document under construction.
#[derive(Debug, Default)]
pub(super) struct Canvas {
    lettering: Lettering,
    body: String,
    definitions: String,
    clips: usize,
    hatches: Vec<usize>,
}

impl Canvas {
    pub(super) fn new(lettering: Lettering) -> Self {
        Self { lettering, ..Self::default() }
    }

    /// Draws a polyline; a closed ring when the last point equals the first.
    pub(super) fn polyline(&mut self, points: &[Point], pen: Pen) {
        let markup = path_data(std::slice::from_ref(&points.to_vec()), false);
        self.open_path(&markup, pen);
    }

    fn open_path(&mut self, data: &str, pen: Pen) {
        let _ = writeln!(self.body, r#"<path d="{data}" fill="none"{}/>"#, stroke(pen));
    }

    /// Draws a straight line.
    pub(super) fn line(&mut self, from: Point, to: Point, pen: Pen) {
        self.polyline(&[from, to], pen);
    }

    /// Fills the area enclosed by `rings` (even-odd).
    pub(super) fn area(&mut self, rings: &[Vec<Point>], ground: Ground) {
        if rings.is_empty() {
            return;
        }
        let (fill, opacity) = self.fill(ground);
        let _ = writeln!(self.body, r#"<path d="{}" fill="{fill}"{opacity} fill-rule="evenodd"/>"#, path_data(rings, true));
    }

    /// Draws a rectangle.
    pub(super) fn rect(&mut self, rect: Rect, ground: Option<Ground>, pen: Option<Pen>) {
        let (fill, opacity) = ground.map_or(("none".to_owned(), String::new()), |g| self.fill(g));
        let _ = writeln!(
            self.body,
            r#"<rect x="{}" y="{}" width="{}" height="{}" fill="{fill}"{opacity}{}/>"#,
            short(rect.x),
            short(rect.y),
            short(rect.width),
            short(rect.height),
            pen.map(stroke).unwrap_or_default()
        );
    }

    /// Draws a disc.
    pub(super) fn disc(&mut self, (x, y): Point, radius: f64, ground: Color, pen: Pen) {
        let _ = writeln!(
            self.body,
            r#"<circle cx="{}" cy="{}" r="{}" fill="{}"{}/>"#,
            short(x),
            short(y),
            short(radius),
            ground.hex(),
            stroke(pen)
        );
    }

    /// Sets a text.
    pub(super) fn text(&mut self, text: &str, setting: Setting) {
        if text.is_empty() {
            return;
        }
        match self.lettering {
            Lettering::Text => self.letters(text, setting),
            Lettering::Outlines => self.outlines(text, setting),
        }
    }

    fn outlines(&mut self, text: &str, setting: Setting) {
        let Setting { at: (x, y), size, anchor, turn, color } = setting;
        let back = match anchor {
            Anchor::Start => 0.0,
            Anchor::Middle => 0.5,
            Anchor::End => 1.0,
        } * text::width(text, size);
        let (data, scale) = text::outlines(text, size);
        let _ = writeln!(
            self.body,
            r#"<path transform="translate({} {}) rotate({}) translate({} 0) scale({scale:.6} {:.6})" d="{data}" fill="{}"/>"#,
            short(x),
            short(y),
            short(turn),
            short(-back),
            -scale,
            color.hex()
        );
    }

    fn letters(&mut self, text: &str, setting: Setting) {
        let Setting { at: (x, y), size, anchor, turn, color } = setting;
        let anchor = match anchor {
            Anchor::Start => "",
            Anchor::Middle => r#" text-anchor="middle""#,
            Anchor::End => r#" text-anchor="end""#,
        };
        let turn = if turn == 0.0 { String::new() } else { format!(r#" transform="rotate({} {} {})""#, short(turn), short(x), short(y)) };
        let _ = writeln!(
            self.body,
            r#"<text x="{}" y="{}" font-size="{}" fill="{}"{anchor}{turn}>{}</text>"#,
            short(x),
            short(y),
            short(size),
            color.hex(),
            escape(text)
        );
    }

    /// Everything until the matching [`Canvas::unclip`] is cut off outside `rect`.
    pub(super) fn clip(&mut self, rect: Rect) {
        self.clips += 1;
        let Rect { x, y, width, height } = rect;
        let _ = writeln!(
            self.definitions,
            r#"<clipPath id="clip{}"><rect x="{}" y="{}" width="{}" height="{}"/></clipPath>"#,
            self.clips,
            short(x),
            short(y),
            short(width),
            short(height)
        );
        let _ = writeln!(self.body, r#"<g clip-path="url(#clip{})">"#, self.clips);
    }

    /// Ends the effect of [`Canvas::clip`].
    pub(super) fn unclip(&mut self) {
        self.body.push_str("</g>\n");
    }

    /// The document, cropped to `width` × `height`.
    pub(super) fn finish(self, width: f64, height: f64, title: &str) -> String {
        let (width, height) = (width.ceil(), height.ceil());
        let title = if title.is_empty() { String::new() } else { format!("<title>{}</title>\n", escape(title)) };
        format!(
            "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{width}\" height=\"{height}\" viewBox=\"0 0 {width} {height}\" \
             font-family=\"{FAMILIES}\">\n{title}<defs>\n{}</defs>\n\
             <rect width=\"{width}\" height=\"{height}\" fill=\"{}\"/>\n{}</svg>\n",
            self.definitions,
            WHITE.hex(),
            self.body
        )
    }

    fn fill(&mut self, ground: Ground) -> (String, String) {
        match ground {
            Ground::Plain(color) if color.opacity < 1.0 => (color.hex(), format!(r#" fill-opacity="{}""#, short(color.opacity))),
            Ground::Plain(color) => (color.hex(), String::new()),
            Ground::Hatch(kind) => (self.hatch(kind), String::new()),
        }
    }

    /// Reference to a hatch, defined on first use. Six kinds, then they repeat.
    fn hatch(&mut self, kind: usize) -> String {
        use super::style::{HATCH, SHADE};
        /// Turn in degrees and the marks in a tile of 7 × 7 units.
        const KINDS: [(f64, &str); 6] = [
            (45.0, "M0 3.5H7"),
            (-45.0, "M0 3.5H7"),
            (0.0, "M0 3.5H7"),
            (90.0, "M0 3.5H7"),
            (45.0, "M0 3.5H7M3.5 0V7"),
            (45.0, "M2.6 3.5H4.4M3.5 2.6V4.4"),
        ];
        let kind = kind % KINDS.len();
        if !self.hatches.contains(&kind) {
            self.hatches.push(kind);
            let (turn, marks) = KINDS[kind];
            let _ = writeln!(
                self.definitions,
                r#"<pattern id="hatch{kind}" width="7" height="7" patternUnits="userSpaceOnUse" patternTransform="rotate({turn})"><rect width="7" height="7" fill="{}"/><path d="{marks}" stroke="{}" stroke-width="0.8" fill="none"/></pattern>"#,
                SHADE.hex(),
                HATCH.hex()
            );
        }
        format!("url(#hatch{kind})")
    }
}

fn stroke(pen: Pen) -> String {
    let mut markup = format!(r#" stroke="{}" stroke-width="{}""#, pen.color.hex(), short(pen.width));
    if pen.color.opacity < 1.0 {
        let _ = write!(markup, r#" stroke-opacity="{}""#, short(pen.color.opacity));
    }
    if pen.dash.is_empty() {
        markup.push_str(r#" stroke-linejoin="round" stroke-linecap="round""#);
    } else {
        let _ = write!(markup, r#" stroke-dasharray="{}" stroke-linejoin="round""#, pen.dash);
    }
    markup
}

/// Path data of several polylines; `closed` ends each with `Z`.
fn path_data(lines: &[Vec<Point>], closed: bool) -> String {
    let mut data = String::new();
    for line in lines {
        for (i, &(x, y)) in line.iter().enumerate() {
            let _ = write!(data, "{}{} {}", if i == 0 { "M" } else { "L" }, short(x), short(y));
        }
        if closed || (line.len() > 2 && line.first() == line.last()) {
            data.push('Z');
        }
    }
    data
}

/// A coordinate with two decimals at most.
fn short(value: f64) -> String {
    let text = format!("{value:.2}");
    let text = text.trim_end_matches('0').trim_end_matches('.');
    if text == "-0" { "0".to_owned() } else { text.to_owned() }
}

fn escape(text: &str) -> String {
    text.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;").replace('"', "&quot;")
}
