//! The one style of all figures: sizes in SVG units (1/96 inch), colors, gradients.

use colorous::Gradient;

/// Width of the drawing area of one panel.
pub(super) const PANEL_WIDTH: f64 = 400.0;
/// Height of the drawing area of a figure with one panel.
pub(super) const PANEL_HEIGHT: f64 = 300.0;
/// Height of the drawing area of each of several stacked panels.
pub(super) const STACKED_HEIGHT: f64 = 165.0;
/// Gap between stacked panels.
pub(super) const STACKED_GAP: f64 = 14.0;
/// Empty border around everything.
pub(super) const BORDER: f64 = 12.0;
/// Size of axis titles.
pub(super) const TITLE_SIZE: f64 = 13.0;
/// Size of tick labels and legend entries.
pub(super) const LABEL_SIZE: f64 = 11.5;
/// Size of labels on contour lines.
pub(super) const CONTOUR_LABEL_SIZE: f64 = 10.0;
/// Length of a major tick; minor ticks have 3/5 of it.
pub(super) const TICK: f64 = 5.0;
/// Gap between a tick and its label, and between other neighbors.
pub(super) const GAP: f64 = 5.0;
/// Width of the frame of a panel.
pub(super) const FRAME_WIDTH: f64 = 0.9;
/// Width of curves.
pub(super) const CURVE_WIDTH: f64 = 1.8;
/// Radius of markers.
pub(super) const MARKER: f64 = 3.2;
/// Pixels per SVG unit in PNG files.
pub(super) const PNG_SCALE: f64 = 2.5;

/// A color, with opacity where it is less than one.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Color {
    rgb: [u8; 3],
    /// 0 invisible, 1 opaque.
    pub(super) opacity: f64,
}

impl Color {
    const fn new(r: u8, g: u8, b: u8) -> Self {
        Self { rgb: [r, g, b], opacity: 1.0 }
    }

    /// The same color, partly transparent.
    pub(super) const fn faded(self, opacity: f64) -> Self {
        Self { opacity, ..self }
    }

    /// `#rrggbb`.
    pub(super) fn hex(self) -> String {
        let [r, g, b] = self.rgb;
        format!("#{r:02x}{g:02x}{b:02x}")
    }

    /// Relative luminance (WCAG 2.2): 0 black, 1 white.
    fn luminance(self) -> f64 {
        let linear = self.rgb.map(|c| {
            let c = f64::from(c) / 255.0;
            if c <= 0.04045 { c / 12.92 } else { ((c + 0.055) / 1.055).powf(2.4) }
        });
        0.2126 * linear[0] + 0.7152 * linear[1] + 0.0722 * linear[2]
    }

    /// Black or white, whichever reads better on this color: equal contrast ratios meet at a luminance of 0.18.
    pub(super) fn ink(self) -> Self {
        if self.luminance() > 0.18 { INK } else { WHITE }
    }
}

/// Text and frames.
pub(super) const INK: Color = Color::new(0x1a, 0x1a, 0x1a);
/// Background.
pub(super) const WHITE: Color = Color::new(0xff, 0xff, 0xff);
/// Grid lines.
pub(super) const GRID: Color = Color::new(0xe4, 0xe4, 0xe4);
/// Zero lines and boundaries between infeasible regions.
pub(super) const RULE: Color = Color::new(0x8a, 0x8a, 0x8a);
/// Ground of infeasible regions.
pub(super) const SHADE: Color = Color::new(0xec, 0xec, 0xec);
/// Hatch lines of infeasible regions.
pub(super) const HATCH: Color = Color::new(0x9c, 0x9c, 0x9c);

/// Curve colors of Okabe and Ito, "Color universal design" (2008), the yellow left out: it is too faint for lines on white.
const CURVES: [Color; 7] = [
    Color::new(0x00, 0x72, 0xb2),
    Color::new(0xd5, 0x5e, 0x00),
    Color::new(0x00, 0x9e, 0x73),
    Color::new(0xcc, 0x79, 0xa7),
    Color::new(0x1a, 0x1a, 0x1a),
    Color::new(0x56, 0xb4, 0xe9),
    Color::new(0xe6, 0x9f, 0x00),
];
/// Dash patterns beside the colors, so that curves differ in print as well.
const DASHES: [&str; 4] = ["", "7 3", "2 2.5", "8 2.5 2 2.5"];

/// Color of the curve with this index.
pub(super) fn curve_color(index: usize) -> Color {
    CURVES[index % CURVES.len()]
}

/// Dash pattern of the curve with this index; empty for a solid line.
pub(super) fn curve_dash(index: usize) -> &'static str {
    DASHES[index % DASHES.len()]
}

/// Dash pattern where colors tell curves apart as long as they last: another one for every round of colors.
pub(super) fn round_dash(index: usize) -> &'static str {
    DASHES[index / CURVES.len() % DASHES.len()]
}

/// How values become colors.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum ColorMap {
    /// One sign only: viridis from low to high.
    Sequential,
    /// Both signs: blue below zero, white at zero, red above.
    Diverging,
}

impl ColorMap {
    /// The map that suits values between `low` and `high`.
    pub(super) fn for_range(low: f64, high: f64) -> Self {
        if low < 0.0 && high > 0.0 { Self::Diverging } else { Self::Sequential }
    }

    /// Color of `value` on the scale from `low` to `high`; a diverging scale is symmetric about zero.
    pub(super) fn color(self, value: f64, low: f64, high: f64) -> Color {
        let (gradient, t): (Gradient, f64) = match self {
            // the dark end is left out so that lines and labels stay readable
            Self::Sequential if high > low => (colorous::VIRIDIS, 0.25 + 0.75 * (value - low) / (high - low)),
            Self::Sequential => (colorous::VIRIDIS, 0.6),
            Self::Diverging => (colorous::RED_BLUE, 0.5 - 0.42 * value / low.abs().max(high.abs())),
        };
        let c = gradient.eval_continuous(t.clamp(0.0, 1.0));
        Color::new(c.r, c.g, c.b)
    }
}
