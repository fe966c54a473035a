//! One or several quantities against another, in panels stacked over a common horizontal axis.

use super::axis::Axis;
use super::canvas::{Anchor, Canvas, Ground, Lettering, Pen, Point, Rect, Setting};
use super::legend::{Key, Legend, draw_marker};
use super::panel::{Panel, ROOM_BELOW, Side};
use super::{style, text};
use std::borrow::Cow;

/// Points of a line beyond which those that cannot be told apart are left out.
const MANY: usize = 4000;

/// Whether the points of a curve are marked.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Markers {
    /// Marked while they are few enough to be told apart.
    #[default]
    WhenFew,
    /// Always marked.
    Always,
    /// Never marked, except a point without neighbors.
    Never,
}

/// A curve.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Curve {
    /// Name in the legend.
    pub name: String,
    /// Points in the order in which they are joined; a value that is not finite interrupts the curve.
    pub points: Vec<(f64, f64)>,
    /// Whether the points are marked.
    pub markers: Markers,
    /// Which of [`Lines::variants`]; curves of one name then have one color, and variants differ in dashes.
    pub variant: usize,
}

impl Curve {
    /// A curve with markers while its points are few.
    pub fn new(name: impl Into<String>, points: Vec<(f64, f64)>) -> Self {
        Self { name: name.into(), points, markers: Markers::WhenFew, variant: 0 }
    }
}

/// One panel.
#[derive(Clone, Debug, PartialEq)]
pub struct LinePanel {
    /// The vertical axis.
    pub y: Axis,
    /// The curves; a single one needs no legend.
    pub curves: Vec<Curve>,
}

/// A shaded range of the horizontal axis, for example where a limit was met.
#[derive(Clone, Debug, PartialEq)]
pub struct Band {
    /// Name in the legend; bands of one name look alike.
    pub name: String,
    /// First and last value.
    pub range: (f64, f64),
}

/// Curves in stacked panels.
#[derive(Clone, Debug, PartialEq)]
pub struct Lines {
    /// Title above the figure; may be empty.
    pub title: String,
    /// The common horizontal axis.
    pub x: Axis,
    /// The panels from top to bottom.
    pub panels: Vec<LinePanel>,
    /// Shaded ranges, in all panels.
    pub bands: Vec<Band>,
    /// Names of variants, the base first; empty where there is only one.
    pub variants: Vec<String>,
}

/// Curves with more points than this are not marked by themselves.
const FEW: usize = 32;

impl Lines {
    /// The figure as SVG.
    pub(super) fn draw(&self, lettering: Lettering) -> String {
        let (panels, labels) = self.layout();
        let mut canvas = Canvas::new(lettering);
        let mut right = panels.first().map_or(style::PANEL_WIDTH, |p| p.frame.right()) + style::BORDER + style::GAP;
        let mut bottom = 0.0_f64;
        let legends = self.band_legend();
        for (k, (panel, content)) in panels.iter().zip(&self.panels).enumerate() {
            let styles = (0..k).map(|i| self.panels[i].curves.len()).sum::<usize>() * usize::from(self.single_curves());
            self.draw_bands(&mut canvas, panel);
            panel.draw_grid(&mut canvas);
            canvas.clip(panel.frame.shrunk(-style::MARKER));
            content.draw_curves(&mut canvas, panel, (styles, &self.variants));
            canvas.unclip();
            panel.draw_frame(&mut canvas);
            panel.draw_y_labels(&mut canvas, labels);
            // what a panel above has told already is not told again
            if k == 0 || content.names() != self.panels[k - 1].names() {
                right = right.max(content.draw_legend(&mut canvas, panel, (styles, &self.variants)));
            }
            bottom = panel.frame.bottom();
        }
        if let Some(last) = panels.last() {
            last.draw_x_labels(&mut canvas);
            bottom += ROOM_BELOW;
            if !legends.is_empty() {
                legends.draw_flow(&mut canvas, (last.frame.x, bottom + style::GAP), last.frame.width);
                bottom += style::GAP + legends.flow_height(last.frame.width);
            }
            draw_title(&mut canvas, &self.title, last.frame);
        }
        canvas.finish(right, bottom + style::BORDER, &self.title)
    }

    /// Every panel has one curve: the color then tells the panels apart.
    fn single_curves(&self) -> bool {
        self.panels.iter().all(|p| p.curves.len() <= 1)
    }

    /// The panels in place, and the width of the widest label left of them.
    fn layout(&self) -> (Vec<Panel>, f64) {
        let height = if self.panels.len() > 1 { style::STACKED_HEIGHT } else { style::PANEL_HEIGHT };
        let abscissae = self.panels.iter().flat_map(|p| &p.curves).flat_map(|c| &c.points).map(|p| p.0);
        let bands = self.bands.iter().flat_map(|b| [b.range.0, b.range.1]);
        let x_range = self.x.span(abscissae.chain(bands), 0.02);
        let sides: Vec<Side> = self
            .panels
            .iter()
            .map(|p| Side::vertical(&p.y, p.y.span(p.curves.iter().flat_map(|c| &c.points).map(|p| p.1), 0.06), height))
            .collect();
        let labels = sides.iter().map(Side::label_width).fold(0.0, f64::max);
        let left = Side::room(labels);
        let top = top_of(&self.title);
        let panels = sides
            .into_iter()
            .enumerate()
            .map(|(k, y)| {
                let frame = Rect { x: left, y: top + k as f64 * (height + style::STACKED_GAP), width: style::PANEL_WIDTH, height };
                Panel::new(frame, Side::horizontal(&self.x, x_range, style::PANEL_WIDTH), y)
            })
            .collect();
        (panels, labels)
    }

    /// Names of the bands, each once, in the order of appearance.
    fn band_names(&self) -> Vec<&str> {
        let mut names: Vec<&str> = Vec::new();
        for band in &self.bands {
            if !names.contains(&band.name.as_str()) {
                names.push(&band.name);
            }
        }
        names
    }

    fn band_legend(&self) -> Legend {
        let mut legend = Legend::default();
        for (kind, name) in self.band_names().into_iter().enumerate() {
            legend.add(Key::Area(Ground::Hatch(kind)), &text::words(name));
        }
        legend
    }

    fn draw_bands(&self, canvas: &mut Canvas, panel: &Panel) {
        let names = self.band_names();
        for band in &self.bands {
            let kind = names.iter().position(|n| *n == band.name).unwrap_or(0);
            let (a, b) = (panel.x(band.range.0), panel.x(band.range.1));
            if a.is_finite() && b.is_finite() {
                let (left, right) = (a.min(b).max(panel.frame.x), a.max(b).min(panel.frame.right()));
                canvas.rect(Rect { x: left, width: (right - left).max(0.0), ..panel.frame }, Some(Ground::Hatch(kind)), None);
            }
        }
    }
}

impl LinePanel {
    /// Pen of a curve: its own color, and dashes where neither markers nor solitude tell it apart.
    fn pen(&self, curve: usize, (styles, variants): (usize, &[String])) -> Pen {
        if !variants.is_empty() {
            let Curve { name, variant, .. } = &self.curves[curve];
            let color = self.names().iter().position(|n| *n == name).unwrap_or(0);
            return Pen { color: style::curve_color(color), width: style::CURVE_WIDTH, dash: style::curve_dash(*variant) };
        }
        let plain = self.curves.len() == 1 || self.curves[curve].marked();
        let dash = if plain { "" } else { style::curve_dash(curve) };
        Pen { color: style::curve_color(styles + curve), width: style::CURVE_WIDTH, dash }
    }

    /// Names of the curves, each once.
    pub(super) fn names(&self) -> Vec<&String> {
        let mut names: Vec<&String> = Vec::new();
        for curve in &self.curves {
            if !names.contains(&&curve.name) {
                names.push(&curve.name);
            }
        }
        names
    }

    pub(super) fn draw_curves(&self, canvas: &mut Canvas, panel: &Panel, (styles, variants): (usize, &[String])) {
        for (k, curve) in self.curves.iter().enumerate() {
            let pen = self.pen(k, (styles, variants));
            for run in runs(curve, panel) {
                canvas.polyline(&visible(&run), pen);
                if curve.marked() || run.len() == 1 {
                    run.iter().for_each(|&p| draw_marker(canvas, styles + k, p, pen));
                }
            }
        }
    }

    /// Draws the legend where several curves need one; returns the right edge of what was drawn.
    fn draw_legend(&self, canvas: &mut Canvas, panel: &Panel, (styles, variants): (usize, &[String])) -> f64 {
        let mut legend = Legend::default();
        if variants.is_empty() {
            // a curve without a name is told by another panel
            for (k, curve) in self.curves.iter().enumerate().filter(|(_, c)| !c.name.is_empty()) {
                legend.add(Key::Line(self.pen(k, (styles, variants)), curve.marked().then_some(styles + k)), &curve.name);
            }
        } else {
            self.names().iter().enumerate().filter(|(_, name)| !name.is_empty()).for_each(|(k, name)| {
                legend.add(Key::Line(Pen::solid(style::curve_color(k), style::CURVE_WIDTH), None), name);
            });
        }
        for (k, name) in variants.iter().enumerate() {
            legend.add(Key::Line(Pen { dash: style::curve_dash(k), ..Pen::solid(style::INK, 1.2) }, None), name);
        }
        if self.curves.len() < 2 || legend.is_empty() {
            return 0.0;
        }
        let obstacles: Vec<Point> = self.curves.iter().flat_map(|c| runs(c, panel)).flat_map(|run| dense(&run)).collect();
        let beside = (panel.frame.right() + 2.0 * style::GAP, panel.frame.y);
        let at = legend.free_corner(panel.frame, &obstacles).unwrap_or(beside);
        legend.draw_column(canvas, at);
        at.0 + legend.column_size().0 + style::BORDER
    }
}

/// What can be seen of a long line: of points that follow each other within a quarter of a pixel, the first, the lowest, the highest and the last.
fn visible(run: &[Point]) -> Cow<'_, [Point]> {
    if run.len() <= MANY {
        return Cow::Borrowed(run);
    }
    let column = |p: &Point| (4.0 * p.0).floor();
    let mut kept = Vec::new();
    for same in run.chunk_by(|a, b| column(a) == column(b)) {
        let by_height = |a: &usize, b: &usize| same[*a].1.total_cmp(&same[*b].1);
        let (lowest, highest) = ((0..same.len()).min_by(by_height), (0..same.len()).max_by(by_height));
        let mut indices = [0, lowest.unwrap_or(0), highest.unwrap_or(0), same.len() - 1];
        indices.sort_unstable();
        kept.extend(indices.iter().enumerate().filter(|(k, i)| *k == 0 || indices[k - 1] != **i).map(|(_, &i)| same[i]));
    }
    Cow::Owned(kept)
}

impl Curve {
    fn marked(&self) -> bool {
        match self.markers {
            Markers::WhenFew => self.points.len() <= FEW,
            Markers::Always => true,
            Markers::Never => false,
        }
    }
}

/// The curve on the canvas, cut where a point has no place.
fn runs(curve: &Curve, panel: &Panel) -> Vec<Vec<Point>> {
    let places: Vec<Option<Point>> = curve.points.iter().map(|&p| panel.place(p)).collect();
    places.split(Option::is_none).filter(|run| !run.is_empty()).map(|run| run.iter().flatten().copied().collect()).collect()
}

/// Points at most four units apart along a line.
pub(super) fn dense(run: &[Point]) -> Vec<Point> {
    let mut points = run.to_vec();
    for w in run.windows(2) {
        let n = ((w[1].0 - w[0].0).hypot(w[1].1 - w[0].1) / 4.0).min(1000.0) as usize;
        points.extend((1..=n).map(|k| {
            let t = k as f64 / (n + 1) as f64;
            (w[0].0 + t * (w[1].0 - w[0].0), w[0].1 + t * (w[1].1 - w[0].1))
        }));
    }
    points
}

/// Upper edge of the first frame, below the title if there is one.
pub(super) fn top_of(title: &str) -> f64 {
    if title.is_empty() { style::BORDER } else { style::BORDER + style::TITLE_SIZE + 2.0 * style::GAP }
}

/// Sets the title of the figure over `frame`.
pub(super) fn draw_title(canvas: &mut Canvas, title: &str, frame: Rect) {
    let at = (frame.x + frame.width / 2.0, style::BORDER + style::TITLE_SIZE - 1.0);
    canvas.text(title, Setting::new(at, style::TITLE_SIZE, Anchor::Middle));
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A long noisy line keeps its ends and its extremes, and most of it goes.
    #[test]
    fn long_lines_lose_what_cannot_be_seen() {
        let line: Vec<Point> = (0..100_000).map(|k| (k as f64 * 5e-3, ((k * 7919) % 1000) as f64)).collect();
        let kept = visible(&line);
        assert!(kept.len() <= 4 * 2001 && (kept[0], kept[kept.len() - 1]) == (line[0], line[99_999]), "{}", kept.len());
        let range = |points: &[Point]| points.iter().fold((f64::MAX, f64::MIN), |(a, b), p| (a.min(p.1), b.max(p.1)));
        assert_eq!(range(&kept), range(&line));
        assert!(matches!(visible(&line[..MANY]), Cow::Borrowed(_)));
    }
}
