//! A panel: the frame between two axes, its ticks and titles, and the way from values to places.

use super::axis::{Axis, Scale, Ticks};
use super::canvas::{Anchor, CAP_HEIGHT, Canvas, Ground, Pen, Point, Rect, Setting};
use super::{style, text};

/// One direction of a panel: axis, range and ticks.
#[derive(Clone, Debug)]
pub(super) struct Side {
    title: String,
    scale: Scale,
    range: (f64, f64),
    ticks: Ticks,
}

impl Side {
    /// The horizontal side: as many ticks as labels fit without touching.
    pub(super) fn horizontal(axis: &Axis, range: (f64, f64), length: f64) -> Self {
        let fits = |ticks: &Ticks| {
            let room = length / ticks.major.len().max(1) as f64;
            ticks.major.iter().all(|(_, label)| text::width(label, style::LABEL_SIZE) + 2.0 * style::GAP < room)
        };
        let counts = (2..=(length / 55.0) as usize).rev();
        let ticks = counts.map(|n| Ticks::choose(axis, range, n)).find(fits).unwrap_or_else(|| Ticks::choose(axis, range, 2));
        Self { title: axis.title(ticks.exponent), scale: axis.scale, range, ticks }
    }

    /// The vertical side.
    pub(super) fn vertical(axis: &Axis, range: (f64, f64), length: f64) -> Self {
        let ticks = Ticks::choose(axis, range, ((length / 38.0) as usize).max(2));
        Self { title: axis.title(ticks.exponent), scale: axis.scale, range, ticks }
    }

    /// Place of `value` between 0 (low end) and 1 (high end).
    fn share(&self, value: f64) -> f64 {
        let (low, high) = self.range;
        match self.scale {
            Scale::Linear => (value - low) / (high - low),
            Scale::Logarithmic => (value / low).ln() / (high / low).ln(),
        }
    }

    /// Width of the widest tick label.
    pub(super) fn label_width(&self) -> f64 {
        self.ticks.major.iter().map(|(_, label)| text::width(label, style::LABEL_SIZE)).fold(0.0, f64::max)
    }

    /// Room that a vertical side needs left of the frame when the widest label of its column is `labels` wide.
    pub(super) fn room(labels: f64) -> f64 {
        style::BORDER + style::TITLE_SIZE + style::GAP + labels + style::GAP
    }
}

/// Room that tick labels and title need below a frame.
pub(super) const ROOM_BELOW: f64 = style::GAP + style::LABEL_SIZE + style::GAP + style::TITLE_SIZE + style::GAP;

/// The frame between two axes.
#[derive(Clone, Debug)]
pub(super) struct Panel {
    pub(super) frame: Rect,
    x: Side,
    y: Side,
}

impl Panel {
    pub(super) fn new(frame: Rect, x: Side, y: Side) -> Self {
        Self { frame, x, y }
    }

    /// Horizontal place of `value`.
    pub(super) fn x(&self, value: f64) -> f64 {
        self.frame.x + self.frame.width * self.x.share(value)
    }

    /// Vertical place of `value`.
    pub(super) fn y(&self, value: f64) -> f64 {
        self.frame.bottom() - self.frame.height * self.y.share(value)
    }

    /// Place of a point; none where a coordinate has no place on its axis.
    pub(super) fn place(&self, (x, y): (f64, f64)) -> Option<Point> {
        let place = (self.x(x), self.y(y));
        (place.0.is_finite() && place.1.is_finite()).then_some(place)
    }

    /// Vertical grid lines at the major ticks.
    pub(super) fn draw_columns(&self, canvas: &mut Canvas) {
        for (value, _) in &self.x.ticks.major {
            canvas.line((self.x(*value), self.frame.y), (self.x(*value), self.frame.bottom()), Pen::solid(style::GRID, 0.7));
        }
    }

    /// Grid lines at the major ticks, and a stronger line where y is zero.
    pub(super) fn draw_grid(&self, canvas: &mut Canvas) {
        let pen = Pen::solid(style::GRID, 0.7);
        self.draw_columns(canvas);
        for (value, _) in &self.y.ticks.major {
            canvas.line((self.frame.x, self.y(*value)), (self.frame.right(), self.y(*value)), pen);
        }
        let (low, high) = self.y.range;
        if self.y.scale == Scale::Linear && low < 0.0 && high > 0.0 {
            canvas.line((self.frame.x, self.y(0.0)), (self.frame.right(), self.y(0.0)), Pen::solid(style::RULE, 0.9));
        }
    }

    /// Frame of a panel whose rows have names instead of values: ticks of the horizontal axis, and a line where it is zero.
    pub(super) fn draw_zero_and_frame(&self, canvas: &mut Canvas) {
        canvas.line((self.x(0.0), self.frame.y), (self.x(0.0), self.frame.bottom()), Pen::solid(style::INK, 0.9));
        self.draw_x_ticks(canvas);
        canvas.rect(self.frame, None, Some(Pen::solid(style::INK, style::FRAME_WIDTH)));
    }

    fn draw_x_ticks(&self, canvas: &mut Canvas) {
        let (top, bottom) = (self.frame.y, self.frame.bottom());
        let pen = Pen::solid(style::INK, 0.7);
        for (value, length) in lengths(&self.x.ticks) {
            let x = self.x(value);
            canvas.line((x, bottom), (x, bottom - length), pen);
            canvas.line((x, top), (x, top + length), pen);
        }
    }

    /// Frame and ticks, which point inwards on all four sides.
    pub(super) fn draw_frame(&self, canvas: &mut Canvas) {
        let (left, right) = (self.frame.x, self.frame.right());
        let pen = Pen::solid(style::INK, 0.7);
        self.draw_x_ticks(canvas);
        for (value, length) in lengths(&self.y.ticks) {
            let y = self.y(value);
            canvas.line((left, y), (left + length, y), pen);
            canvas.line((right, y), (right - length, y), pen);
        }
        canvas.rect(self.frame, None, Some(Pen::solid(style::INK, style::FRAME_WIDTH)));
    }

    /// Tick labels and title of the horizontal axis.
    pub(super) fn draw_x_labels(&self, canvas: &mut Canvas) {
        let labels = self.frame.bottom() + style::GAP + CAP_HEIGHT * style::LABEL_SIZE + 2.0;
        for (value, label) in &self.x.ticks.major {
            canvas.text(label, Setting::new((self.x(*value), labels), style::LABEL_SIZE, Anchor::Middle));
        }
        let title = (self.frame.x + self.frame.width / 2.0, labels + style::GAP + style::TITLE_SIZE);
        canvas.text(&self.x.title, Setting::new(title, style::TITLE_SIZE, Anchor::Middle));
    }

    /// Tick labels and title of the vertical axis; `labels` is the width of the widest label in the column of panels.
    pub(super) fn draw_y_labels(&self, canvas: &mut Canvas, labels: f64) {
        let right = self.frame.x - style::GAP;
        for (value, label) in &self.y.ticks.major {
            let baseline = self.y(*value) + CAP_HEIGHT / 2.0 * style::LABEL_SIZE;
            canvas.text(label, Setting::new((right, baseline), style::LABEL_SIZE, Anchor::End));
        }
        let at = (right - labels - style::GAP - 2.0, self.frame.y + self.frame.height / 2.0);
        // a title longer than the panel is set smaller rather than into its neighbor
        let size = style::TITLE_SIZE
            .min(style::TITLE_SIZE * (self.frame.height + style::STACKED_GAP) / text::width(&self.y.title, style::TITLE_SIZE));
        canvas.text(&self.y.title, Setting { turn: -90.0, ..Setting::new(at, size, Anchor::Middle) });
    }

    /// Fills the frame with white, for a legend or label that must be readable on anything.
    pub(super) fn blank(canvas: &mut Canvas, rect: Rect) {
        canvas.rect(rect, Some(Ground::Plain(style::WHITE.faded(0.88))), Some(Pen::solid(style::GRID, 0.8)));
    }
}

fn lengths(ticks: &Ticks) -> impl Iterator<Item = (f64, f64)> {
    let minor = ticks.minor.iter().map(|&v| (v, 0.6 * style::TICK));
    minor.chain(ticks.major.iter().map(|(v, _)| (*v, style::TICK)))
}
