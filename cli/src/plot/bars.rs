//! What matters most, as horizontal bars from zero to either side: one panel per case, one row per item, one bar per series.

use super::axis::Axis;
use super::canvas::{Anchor, CAP_HEIGHT, Canvas, Ground, Lettering, Rect, Setting};
use super::legend::{Key, Legend};
use super::lines::{draw_title, top_of};
use super::panel::{Panel, ROOM_BELOW, Side};
use super::{style, text};

/// One panel.
#[derive(Clone, Debug, PartialEq)]
pub struct BarPanel {
    /// What the rows belong to, above the frame.
    pub title: String,
    /// Name of each row and its values, one per series.
    pub rows: Vec<(String, Vec<f64>)>,
}

/// Bars in stacked panels.
#[derive(Clone, Debug, PartialEq)]
pub struct Bars {
    /// Title above the figure.
    pub title: String,
    /// What the bars measure; each panel has its own range.
    pub x: Axis,
    /// Names of the series.
    pub series: Vec<String>,
    /// The panels from top to bottom.
    pub panels: Vec<BarPanel>,
}

/// Height of a row.
const ROW: f64 = 22.0;

impl Bars {
    /// The figure as SVG.
    pub(super) fn draw(&self, lettering: Lettering) -> String {
        let names = self.panels.iter().flat_map(|p| &p.rows).map(|(name, _)| text::width(name, style::LABEL_SIZE));
        let left = style::BORDER + names.fold(0.0, f64::max) + 2.0 * style::GAP;
        let mut canvas = Canvas::new(lettering);
        let mut y = top_of(&self.title);
        let whole = Rect { x: left, y, width: style::PANEL_WIDTH, height: 0.0 };
        for content in &self.panels {
            canvas.text(&content.title, Setting::new((left, y + style::TITLE_SIZE), style::TITLE_SIZE, Anchor::Start));
            let top = y + style::TITLE_SIZE + 1.5 * style::GAP;
            let frame = Rect { x: left, y: top, width: style::PANEL_WIDTH, height: ROW * content.rows.len().max(1) as f64 };
            let panel = self.panel(content, frame);
            self.draw_panel(&mut canvas, content, &panel);
            y = frame.bottom() + ROOM_BELOW + 2.0 * style::GAP;
        }
        let mut legend = Legend::default();
        for (k, name) in self.series.iter().enumerate() {
            legend.add(Key::Area(Ground::Plain(style::curve_color(k))), name);
        }
        legend.draw_flow(&mut canvas, (left, y - style::GAP), style::PANEL_WIDTH);
        y += legend.flow_height(style::PANEL_WIDTH) - style::GAP;
        draw_title(&mut canvas, &self.title, whole);
        canvas.finish(left + style::PANEL_WIDTH + 2.0 * style::BORDER, y + style::BORDER, &self.title)
    }

    /// The frame with a horizontal axis that holds zero.
    fn panel(&self, content: &BarPanel, frame: Rect) -> Panel {
        let values = content.rows.iter().flat_map(|(_, values)| values).copied();
        let range = self.x.span(values.chain([0.0]), 0.06);
        let rows = Side::vertical(&Axis::new("", ""), (0.0, 1.0), frame.height);
        Panel::new(frame, Side::horizontal(&self.x, range, frame.width), rows)
    }

    fn draw_panel(&self, canvas: &mut Canvas, content: &BarPanel, panel: &Panel) {
        panel.draw_columns(canvas);
        let thickness = 0.76 * ROW / self.series.len().max(1) as f64;
        for (row, (name, values)) in content.rows.iter().enumerate() {
            let top = panel.frame.y + ROW * row as f64;
            let baseline = top + 0.5 * ROW + CAP_HEIGHT / 2.0 * style::LABEL_SIZE;
            canvas.text(name, Setting::new((panel.frame.x - style::GAP, baseline), style::LABEL_SIZE, Anchor::End));
            for (k, value) in values.iter().enumerate().filter(|(_, v)| v.is_finite()) {
                let (a, b) = (panel.x(0.0), panel.x(*value));
                let bar = Rect { x: a.min(b), y: top + 0.12 * ROW + thickness * k as f64, width: (b - a).abs(), height: thickness };
                canvas.rect(bar, Some(Ground::Plain(style::curve_color(k))), None);
            }
        }
        panel.draw_zero_and_frame(canvas);
        panel.draw_x_labels(canvas);
    }
}
