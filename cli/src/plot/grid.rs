//! Curves in panels beside and below each other, each with axes of its own, and one legend for all.

use super::axis::Axis;
use super::canvas::{Canvas, Lettering, Pen, Rect};
use super::legend::{Key, Legend};
use super::lines::{LinePanel, draw_title, top_of};
use super::panel::{Panel, ROOM_BELOW, Side};
use super::style;

/// One panel.
#[derive(Clone, Debug, PartialEq)]
pub struct GridPanel {
    /// The horizontal axis.
    pub x: Axis,
    /// The vertical axis and the curves; curves of one name look alike in all panels.
    pub lines: LinePanel,
}

/// Panels in rows.
#[derive(Clone, Debug, PartialEq)]
pub struct Grid {
    /// Title above the figure.
    pub title: String,
    /// How many panels stand beside each other.
    pub columns: usize,
    /// The panels, row by row.
    pub panels: Vec<GridPanel>,
    /// What tells curves of one color apart, for the legend: one name per dash pattern.
    pub variants: Vec<String>,
}

/// Width and height of the drawing area of a panel.
const SIZE: (f64, f64) = (290.0, 200.0);

impl Grid {
    /// The figure as SVG.
    pub(super) fn draw(&self, lettering: Lettering) -> String {
        let columns = self.columns.max(1);
        let sides: Vec<Side> = self.panels.iter().map(GridPanel::vertical).collect();
        // all panels of a column begin at the same place
        let room = |column: usize| sides.iter().skip(column).step_by(columns).map(Side::label_width).fold(0.0, f64::max);
        let labels: Vec<f64> = (0..columns).map(room).collect();
        let mut lefts = Vec::with_capacity(columns);
        let mut right = 0.0;
        for width in &labels {
            lefts.push(right + Side::room(*width));
            right += Side::room(*width) + SIZE.0 + style::GAP;
        }
        let top = top_of(&self.title);
        let mut canvas = Canvas::new(lettering);
        let mut bottom = top;
        for (k, (content, y)) in self.panels.iter().zip(sides).enumerate() {
            let (row, column) = (k / columns, k % columns);
            let at = (lefts[column], top + row as f64 * (SIZE.1 + ROOM_BELOW + style::STACKED_GAP));
            let frame = Rect { x: at.0, y: at.1, width: SIZE.0, height: SIZE.1 };
            let xs = content.lines.curves.iter().flat_map(|c| &c.points).map(|p| p.0);
            let panel = Panel::new(frame, Side::horizontal(&content.x, content.x.span(xs, 0.02), SIZE.0), y);
            panel.draw_grid(&mut canvas);
            canvas.clip(frame.shrunk(-style::MARKER));
            content.lines.draw_curves(&mut canvas, &panel, (0, &self.variants));
            canvas.unclip();
            panel.draw_frame(&mut canvas);
            panel.draw_x_labels(&mut canvas);
            panel.draw_y_labels(&mut canvas, labels[column]);
            bottom = f64::max(bottom, frame.bottom() + ROOM_BELOW);
        }
        let all =
            Rect { x: lefts.first().copied().unwrap_or(0.0), y: top, width: right - lefts.first().copied().unwrap_or(0.0), height: 0.0 };
        draw_title(&mut canvas, &self.title, all);
        let legend = self.legend();
        if !legend.is_empty() {
            legend.draw_flow(&mut canvas, (all.x, bottom + style::GAP), all.width);
            bottom += style::GAP + legend.flow_height(all.width);
        }
        canvas.finish(right + style::BORDER, bottom + style::BORDER, &self.title)
    }

    /// Colors by name, dashes by variant.
    fn legend(&self) -> Legend {
        let mut legend = Legend::default();
        let names = self.panels.first().map(|p| p.lines.names()).unwrap_or_default();
        for (k, name) in names.into_iter().enumerate() {
            legend.add(Key::Line(Pen::solid(style::curve_color(k), style::CURVE_WIDTH), None), name);
        }
        for (k, name) in self.variants.iter().enumerate() {
            legend.add(Key::Line(Pen { dash: style::curve_dash(k), ..Pen::solid(style::INK, 1.2) }, None), name);
        }
        legend
    }
}

impl GridPanel {
    fn vertical(&self) -> Side {
        let values = self.lines.curves.iter().flat_map(|c| &c.points).map(|p| p.1);
        Side::vertical(&self.lines.y, self.lines.y.span(values, 0.06), SIZE.1)
    }
}
