//! Legends: what is listed, how large the list is, and where it stands in nobody's way.

use super::canvas::{Anchor, CAP_HEIGHT, Canvas, Ground, Pen, Point, Rect, Setting};
use super::panel::Panel;
use super::{style, text};

/// What stands before the name of an entry.
#[derive(Clone, Copy, Debug)]
pub(super) enum Key {
    /// A line, with the marker of this index where it has markers.
    Line(Pen, Option<usize>),
    /// A ring: where paths begin.
    Ring,
    /// An area.
    Area(Ground),
}

/// The entries of a legend.
#[derive(Clone, Debug, Default)]
pub(super) struct Legend {
    entries: Vec<(Key, String)>,
}

const KEY_WIDTH: f64 = 26.0;
const ROW: f64 = 17.0;
const PADDING: f64 = 6.0;

impl Legend {
    pub(super) fn add(&mut self, key: Key, name: &str) {
        self.entries.push((key, name.to_owned()));
    }

    pub(super) fn is_empty(&self) -> bool {
        self.entries.is_empty()
    }

    /// Width and height of the entries as one column, padding included.
    pub(super) fn column_size(&self) -> (f64, f64) {
        let widest = self.entries.iter().map(|(_, name)| entry_width(name)).fold(0.0, f64::max);
        (widest + 2.0 * PADDING, ROW * self.entries.len() as f64 + PADDING)
    }

    /// Corner of `frame` where the column covers none of `obstacles`; none where every corner is taken.
    pub(super) fn free_corner(&self, frame: Rect, obstacles: &[Point]) -> Option<Point> {
        let (width, height) = self.column_size();
        let inset = style::TICK + 4.0;
        if width > 0.6 * frame.width || height > 0.6 * frame.height {
            return None;
        }
        let (left, right) = (frame.x + inset, frame.right() - inset - width);
        let (top, bottom) = (frame.y + inset, frame.bottom() - inset - height);
        [(right, top), (left, top), (right, bottom), (left, bottom)].into_iter().find(|&(x, y)| {
            let around = Rect { x, y, width, height }.shrunk(-style::MARKER - 2.0);
            !obstacles.iter().any(|&p| around.contains(p))
        })
    }

    /// Draws the entries as one column with its upper left corner at `at`.
    pub(super) fn draw_column(&self, canvas: &mut Canvas, at: Point) {
        let (width, height) = self.column_size();
        Panel::blank(canvas, Rect { x: at.0, y: at.1, width, height });
        for (i, entry) in self.entries.iter().enumerate() {
            draw_entry(canvas, entry, (at.0 + PADDING, at.1 + PADDING / 2.0 + ROW * (i as f64 + 0.5)));
        }
    }

    /// Height of the entries as lines of at most `width`.
    pub(super) fn flow_height(&self, width: f64) -> f64 {
        ROW * self.flow(width).last().map_or(0.0, |&(_, y)| y + 1.0)
    }

    /// Draws the entries as lines of at most `width` with the upper left corner at `at`.
    pub(super) fn draw_flow(&self, canvas: &mut Canvas, at: Point, width: f64) {
        for (entry, (x, row)) in self.entries.iter().zip(self.flow(width)) {
            draw_entry(canvas, entry, (at.0 + x, at.1 + ROW * (row + 0.5)));
        }
    }

    /// Offset and row of each entry in lines of at most `width`.
    fn flow(&self, width: f64) -> Vec<(f64, f64)> {
        let (mut x, mut row) = (0.0, 0.0);
        let mut places = Vec::new();
        for (_, name) in &self.entries {
            if x > 0.0 && x + entry_width(name) > width {
                (x, row) = (0.0, row + 1.0);
            }
            places.push((x, row));
            x += entry_width(name) + 3.0 * PADDING;
        }
        places
    }
}

fn entry_width(name: &str) -> f64 {
    KEY_WIDTH + style::GAP + text::width(name, style::LABEL_SIZE)
}

/// Draws one entry with the middle of its left edge at (x, y).
fn draw_entry(canvas: &mut Canvas, (key, name): &(Key, String), (x, y): Point) {
    match *key {
        Key::Line(pen, marker) => {
            canvas.line((x + 1.0, y), (x + KEY_WIDTH - 1.0, y), pen);
            if let Some(index) = marker {
                draw_marker(canvas, index, (x + KEY_WIDTH / 2.0, y), pen);
            }
        }
        Key::Ring => canvas.disc((x + KEY_WIDTH / 2.0, y), 1.3 * style::MARKER, style::WHITE, Pen::solid(style::INK, 1.5)),
        Key::Area(ground) => {
            let swatch = Rect { x: x + 1.0, y: y - 5.5, width: KEY_WIDTH - 2.0, height: 11.0 };
            canvas.rect(swatch, Some(ground), Some(Pen::solid(style::RULE, 0.7)));
        }
    }
    let baseline = y + CAP_HEIGHT / 2.0 * style::LABEL_SIZE;
    canvas.text(name, Setting::new((x + KEY_WIDTH + style::GAP, baseline), style::LABEL_SIZE, Anchor::Start));
}

/// Draws the marker of the curve with this index: disc, square, triangle, diamond, in turn.
pub(super) fn draw_marker(canvas: &mut Canvas, index: usize, (x, y): Point, pen: Pen) {
    let r = style::MARKER;
    let outline = Pen::solid(style::WHITE, 0.7);
    let corners: &[Point] = match index % 4 {
        0 => return canvas.disc((x, y), r, pen.color, outline),
        1 => &[(-0.9, -0.9), (0.9, -0.9), (0.9, 0.9), (-0.9, 0.9), (-0.9, -0.9)],
        2 => &[(0.0, -1.25), (1.15, 0.85), (-1.15, 0.85), (0.0, -1.25)],
        _ => &[(0.0, -1.3), (1.1, 0.0), (0.0, 1.3), (-1.1, 0.0), (0.0, -1.3)],
    };
    let ring: Vec<Point> = corners.iter().map(|(dx, dy)| (x + r * dx, y + r * dy)).collect();
    canvas.area(std::slice::from_ref(&ring), Ground::Plain(pen.color));
    canvas.polyline(&ring, outline);
}
