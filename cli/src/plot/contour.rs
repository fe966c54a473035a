//! A quantity over a grid of two others: filled bands, labeled lines, and the infeasible regions with their causes.

use super::axis::{self, Axis};
use super::canvas::{Anchor, CAP_HEIGHT, Canvas, Ground, Lettering, Pen, Point, Rect, Setting};
use super::contour_label::{self, Labeled};
use super::field::{Edges, End, Field};
use super::legend::{Key, Legend};
use super::lines::{Band, Curve, LinePanel, Lines, draw_title, top_of};
use super::panel::{Panel, ROOM_BELOW, Side};
use super::style::{self, ColorMap};
use super::{PlotError, text};

/// What is known at a node of the grid.
#[derive(Clone, Debug, PartialEq)]
pub enum Node {
    /// The value of the quantity; one that is not finite counts as infeasible without a name.
    Value(f64),
    /// No value: the name of the limit that stood in the way, for example `tire_saturated`.
    Infeasible(String),
}

/// A contour map.
#[derive(Clone, Debug, PartialEq)]
pub struct Contour {
    title: String,
    x: Axis,
    y: Axis,
    value: Axis,
    columns: Vec<f64>,
    rows: Vec<f64>,
    nodes: Vec<Node>,
    limits: Vec<(usize, f64, f64)>,
}

impl Contour {
    /// A map of `value` over the grid `x` × `y`.
    ///
    /// Arguments: each direction is an axis with the places of the nodes in rising or falling order; `nodes` row by row,
    /// x running fastest. A grid with a single row or column is drawn as a curve.
    ///
    /// # Errors
    /// [`PlotError::Shape`], [`PlotError::Order`].
    pub fn new(
        title: impl Into<String>,
        x: (Axis, Vec<f64>),
        y: (Axis, Vec<f64>),
        value: Axis,
        nodes: Vec<Node>,
    ) -> Result<Self, PlotError> {
        for (axis, places) in [&x, &y] {
            let rising = places.windows(2).all(|w| w[0] < w[1]);
            let falling = places.windows(2).all(|w| w[0] > w[1]);
            if !(rising || falling) || !places.iter().all(|&p| axis.shows(p)) {
                return Err(PlotError::Order { axis: axis.label.clone() });
            }
        }
        if x.1.is_empty() || y.1.is_empty() || x.1.len() * y.1.len() != nodes.len() {
            return Err(PlotError::Shape { columns: x.1.len(), rows: y.1.len(), given: nodes.len() });
        }
        Ok(Self { title: title.into(), x: x.0, y: y.0, value, columns: x.1, rows: y.1, nodes, limits: Vec::new() })
    }

    /// The same map with the places between nodes at which values of a row end: index of the row, place along x, value there.
    #[must_use]
    pub fn with_limits(self, limits: Vec<(usize, f64, f64)>) -> Self {
        Self { limits, ..self }
    }

    /// The figure as SVG.
    pub(super) fn draw(&self, lettering: Lettering) -> String {
        match (self.columns.len(), self.rows.len()) {
            (_, 1) => self.section(&self.x, &self.columns, (&self.y, self.rows[0])).draw(lettering),
            (1, _) => self.section(&self.y, &self.rows, (&self.x, self.columns[0])).draw(lettering),
            _ => self.draw_map(lettering),
        }
    }

    fn draw_map(&self, lettering: Lettering) -> String {
        let x_range = self.x.span(self.columns.iter().copied(), 0.0);
        let y_range = self.y.span(self.rows.iter().copied(), 0.0);
        let y = Side::vertical(&self.y, y_range, style::PANEL_HEIGHT);
        let labels = y.label_width();
        let frame = Rect { x: Side::room(labels), y: top_of(&self.title), width: style::PANEL_WIDTH, height: style::PANEL_HEIGHT };
        let panel = Panel::new(frame, Side::horizontal(&self.x, x_range, frame.width), y);

        let columns: Vec<f64> = self.columns.iter().map(|&v| panel.x(v)).collect();
        let rows: Vec<f64> = self.rows.iter().map(|&v| panel.y(v)).collect();
        let values: Vec<f64> = self.nodes.iter().map(Node::value).collect();
        let ends: Vec<End> = self.limits.iter().map(|&(row, x, value)| End { row, x: panel.x(x), value }).collect();
        let field = Field::new(&columns, &rows, &values, &ends);
        let levels = Levels::choose(&values);

        let mut canvas = Canvas::new(lettering);
        canvas.clip(frame);
        let causes = self.draw_causes(&mut canvas, &columns, &rows);
        if let Some(levels) = &levels {
            draw_field(&mut canvas, &field, levels, frame);
        }
        canvas.unclip();
        panel.draw_frame(&mut canvas);
        if let Some(levels) = &levels {
            draw_lone(&mut canvas, &field, levels, frame);
        }
        panel.draw_x_labels(&mut canvas);
        panel.draw_y_labels(&mut canvas, labels);
        let right = match &levels {
            Some(levels) => levels.draw_bar(&mut canvas, &self.value, frame),
            None => frame.right() + style::BORDER,
        };
        let mut bottom = frame.bottom() + ROOM_BELOW;
        if !causes.is_empty() {
            causes.draw_flow(&mut canvas, (frame.x, bottom + style::GAP), frame.width);
            bottom += style::GAP + causes.flow_height(frame.width);
        }
        draw_title(&mut canvas, &self.title, frame);
        canvas.finish(right, bottom + style::BORDER, &self.title)
    }

    /// Hatches every place with the cause of the nearest infeasible node; the feasible region is drawn over it later.
    fn draw_causes(&self, canvas: &mut Canvas, columns: &[f64], rows: &[f64]) -> Legend {
        let mut names: Vec<&str> = Vec::new();
        let seeds: Vec<Option<usize>> = self
            .nodes
            .iter()
            .map(|node| {
                let name = node.cause()?;
                Some(names.iter().position(|n| *n == name).unwrap_or_else(|| {
                    names.push(name);
                    names.len() - 1
                }))
            })
            .collect();
        let nearest = spread(&seeds, columns.len(), rows.len());
        let (x, y) = (borders(columns), borders(rows));
        let mut legend = Legend::default();
        for (kind, name) in names.iter().enumerate() {
            let mut edges = Edges::default();
            for node in (0..nearest.len()).filter(|&n| nearest[n] == Some(kind)) {
                let (i, j) = (node % columns.len(), node / columns.len());
                let corners = [(x[i], y[j]), (x[i + 1], y[j]), (x[i + 1], y[j + 1]), (x[i], y[j + 1])];
                (0..4).for_each(|k| edges.add(corners[k], corners[(k + 1) % 4]));
            }
            let rings = edges.chains();
            canvas.area(&rings, Ground::Hatch(kind));
            if names.len() > 1 {
                rings.iter().for_each(|ring| canvas.polyline(ring, Pen::solid(style::RULE, 0.8)));
            }
            legend.add(Key::Area(Ground::Hatch(kind)), &text::words(name));
        }
        legend
    }

    /// A grid with a single row or column as a curve, the infeasible stretches shaded.
    fn section(&self, along: &Axis, places: &[f64], (across, at): (&Axis, f64)) -> Lines {
        let points = places.iter().zip(&self.nodes).map(|(&p, node)| (p, node.value())).collect();
        let borders = borders(places);
        let bands = self
            .nodes
            .iter()
            .enumerate()
            .filter_map(|(k, node)| Some(Band { name: node.cause()?.to_owned(), range: (borders[k], borders[k + 1]) }))
            .collect();
        let unit = if across.unit == "-" { String::new() } else { format!(" {}", text::unit(&across.unit)) };
        let fixed = format!("{} {}{unit}", across.label, text::significant(at, 4));
        let title = if self.title.is_empty() { fixed } else { format!("{} · {fixed}", self.title) };
        let curve = Curve::new(self.value.label.clone(), points);
        let (first, last) = (borders[0].min(borders[places.len()]), borders[0].max(borders[places.len()]));
        let x = along.clone().between(first, last);
        Lines { title, x, panels: vec![LinePanel { y: self.value.clone(), curves: vec![curve] }], bands, variants: Vec::new() }
    }
}

impl Node {
    /// The value, NaN where there is none.
    fn value(&self) -> f64 {
        match self {
            Self::Value(v) if v.is_finite() => *v,
            _ => f64::NAN,
        }
    }

    fn cause(&self) -> Option<&str> {
        match self {
            Self::Value(v) if v.is_finite() => None,
            Self::Value(_) => Some("no value"),
            Self::Infeasible(name) => Some(name),
        }
    }
}

/// Gives every node the seed nearest to it in steps along the grid.
fn spread(seeds: &[Option<usize>], columns: usize, rows: usize) -> Vec<Option<usize>> {
    let mut nearest = seeds.to_vec();
    let mut queue: std::collections::VecDeque<usize> = (0..seeds.len()).filter(|&n| seeds[n].is_some()).collect();
    while let Some(node) = queue.pop_front() {
        let (i, j) = (node % columns, node / columns);
        let neighbors = [
            (i > 0).then(|| node - 1),
            (i + 1 < columns).then(|| node + 1),
            (j > 0).then(|| node - columns),
            (j + 1 < rows).then(|| node + columns),
        ];
        for next in neighbors.into_iter().flatten() {
            if nearest[next].is_none() {
                nearest[next] = nearest[node];
                queue.push_back(next);
            }
        }
    }
    nearest
}

/// Borders halfway between places, the outermost at the outer places themselves.
fn borders(places: &[f64]) -> Vec<f64> {
    let mut borders = vec![places[0]];
    borders.extend(places.windows(2).map(|w| (w[0] + w[1]) / 2.0));
    borders.push(places[places.len() - 1]);
    borders
}

/// Range of sorted values without the outermost fiftieth at an end that lies more than a whole range away from the rest.
fn typical_range(sorted: &[f64]) -> (f64, f64) {
    let at = |share: f64| sorted[(share * (sorted.len() - 1) as f64).round() as usize];
    let (low, high, inner) = (at(0.0), at(1.0), at(0.98) - at(0.02));
    if sorted.len() < 20 || inner <= 0.0 {
        return (low, high);
    }
    let low = if at(0.02) - low > 1.5 * inner { at(0.02) } else { low };
    let high = if high - at(0.98) > 1.5 * inner { at(0.98) } else { high };
    (low, high)
}

/// The levels of a map and their colors.
#[derive(Clone, Debug)]
struct Levels {
    /// Edges of the color bands, rising; two equal ones for a constant field.
    edges: Vec<f64>,
    /// Whether values lie below the first or above the last edge.
    open: (bool, bool),
    map: ColorMap,
    exponent: i32,
    decimals: usize,
}

impl Levels {
    /// About ten levels at nice numbers; none where no value is finite. A few values far outside the rest do not stretch the scale.
    fn choose(values: &[f64]) -> Option<Self> {
        let mut sorted: Vec<f64> = values.iter().copied().filter(|v| v.is_finite()).collect();
        sorted.sort_by(f64::total_cmp);
        let (first, last) = (*sorted.first()?, *sorted.last()?);
        let (low, high) = typical_range(&sorted);
        // a span lost in rounding noise is no span
        if high - low <= 1e-10 * high.abs().max(low.abs()) {
            let exponent = axis::common_exponent(low);
            return Some(Self { edges: vec![low, low], open: (false, false), map: ColorMap::Sequential, exponent, decimals: 3 });
        }
        let (step, _) = axis::nice_step(high - low, 9);
        let edges: Vec<f64> = axis::multiples((low / step).floor() * step, (high / step).ceil() * step, step);
        let exponent = axis::common_exponent(edges[0].abs().max(edges[edges.len() - 1].abs()));
        let decimals = text::decimals(step / 10f64.powi(exponent));
        let open = (first < edges[0] - 1e-9 * step, last > edges[edges.len() - 1] + 1e-9 * step);
        let map = ColorMap::for_range(edges[0], edges[edges.len() - 1]);
        Some(Self { edges, open, map, exponent, decimals })
    }

    fn is_constant(&self) -> bool {
        self.edges[0] == self.edges[self.edges.len() - 1]
    }

    fn bands(&self) -> usize {
        self.edges.len() - 1
    }

    fn band_color(&self, band: usize) -> style::Color {
        let middle = (self.edges[band] + self.edges[band + 1]) / 2.0;
        self.map.color(middle, self.edges[0], self.edges[self.bands()])
    }

    fn color(&self, value: f64) -> style::Color {
        self.band_color(self.edges.partition_point(|&e| e <= value).clamp(1, self.bands()) - 1)
    }

    fn label(&self, value: f64) -> String {
        let value = value / 10f64.powi(self.exponent);
        if self.is_constant() { text::significant(value, 4) } else { text::number(value, self.decimals) }
    }

    /// Levels at which lines are drawn.
    fn lines(&self) -> impl Iterator<Item = f64> {
        let (first, last) = (self.edges[0], self.edges[self.bands()]);
        let drawn = move |&e: &f64| (e > first || self.open.0) && (e < last || self.open.1);
        self.edges.iter().copied().filter(drawn).filter(|_| !self.is_constant())
    }

    /// Draws the color bar right of `frame`; returns the right edge of what was drawn.
    fn draw_bar(&self, canvas: &mut Canvas, value: &Axis, frame: Rect) -> f64 {
        const WIDTH: f64 = 15.0;
        let tip = 10.0;
        let bar = Rect { x: frame.right() + 16.0, y: frame.y, width: WIDTH, height: frame.height };
        let pen = Pen::solid(style::INK, style::FRAME_WIDTH);
        let (top, bottom) = (bar.y + if self.open.1 { tip } else { 0.0 }, bar.bottom() - if self.open.0 { tip } else { 0.0 });
        let height = (bottom - top) / self.bands() as f64;
        for band in 0..self.bands() {
            let y = bottom - height * (band + 1) as f64;
            // a little longer than the band, so that no gap shows below the next one
            let overlap = if band == 0 { 0.0 } else { 0.5 };
            canvas.rect(Rect { y, height: height + overlap, ..bar }, Some(Ground::Plain(self.band_color(band))), None);
        }
        let middle = bar.x + WIDTH / 2.0;
        let mut outline = vec![(bar.x, bottom), (bar.x, top)];
        if self.open.1 {
            outline.push((middle, bar.y));
            canvas.area(&[vec![(bar.x, top), (middle, bar.y), (bar.right(), top)]], Ground::Plain(self.band_color(self.bands() - 1)));
        }
        outline.extend([(bar.right(), top), (bar.right(), bottom)]);
        if self.open.0 {
            outline.push((middle, bar.bottom()));
            canvas.area(&[vec![(bar.x, bottom), (middle, bar.bottom()), (bar.right(), bottom)]], Ground::Plain(self.band_color(0)));
        }
        outline.push((bar.x, bottom));
        let place = |k: usize| if self.is_constant() { (top + bottom) / 2.0 } else { bottom - height * k as f64 };
        let marked = if self.is_constant() { 1 } else { self.edges.len() };
        let mut widest = 0.0_f64;
        for k in 0..marked {
            let (y, label) = (place(k), self.label(self.edges[k]));
            let zero = self.edges[k] == 0.0 && self.map == ColorMap::Diverging;
            canvas.line((bar.x, y), (bar.right() + 3.0, y), Pen::solid(style::INK, if zero { 1.8 } else { 0.7 }));
            let at = (bar.right() + style::GAP + 2.0, y + CAP_HEIGHT / 2.0 * style::LABEL_SIZE);
            canvas.text(&label, Setting::new(at, style::LABEL_SIZE, Anchor::Start));
            widest = widest.max(text::width(&label, style::LABEL_SIZE));
        }
        canvas.polyline(&outline, pen);
        let title =
            (bar.right() + style::GAP + 2.0 + widest + style::GAP + CAP_HEIGHT * style::TITLE_SIZE + 3.0, frame.y + frame.height / 2.0);
        canvas.text(&value.title(self.exponent), Setting { turn: -90.0, ..Setting::new(title, style::TITLE_SIZE, Anchor::Middle) });
        title.0 + style::BORDER
    }
}

/// Draws bands, lines, labels and the boundary of the feasible region.
fn draw_field(canvas: &mut Canvas, field: &Field, levels: &Levels, frame: Rect) {
    let domain = field.region(f64::NEG_INFINITY);
    canvas.area(&domain, Ground::Plain(levels.band_color(0)));
    for band in 1..levels.bands() {
        canvas.area(&field.region(levels.edges[band]), Ground::Plain(levels.band_color(band)));
    }
    let mut lines: Vec<(f64, Labeled)> = levels
        .lines()
        .flat_map(|level| field.isolines(level).into_iter().map(move |line| (level, line)))
        .map(|(level, line)| (level, Labeled { line, label: levels.label(level) }))
        .collect();
    // the zero line chooses its label first, then the longest
    lines.sort_by(|a, b| (b.0 == 0.0).cmp(&(a.0 == 0.0)).then_with(|| b.1.line.len().cmp(&a.1.line.len())));
    let labeled: Vec<Labeled> = lines.iter().map(|(_, l)| l.clone()).collect();
    let places = contour_label::place(&labeled, &domain, frame);
    for ((level, Labeled { line, label }), place) in lines.iter().zip(places) {
        let pen = if *level == 0.0 { Pen::solid(style::INK, 2.0) } else { Pen::solid(style::INK.faded(0.75), 0.75) };
        let Some(place) = place else {
            canvas.polyline(line, pen);
            continue;
        };
        contour_label::interrupted(line, &place).iter().for_each(|part| canvas.polyline(part, pen));
        draw_centered(canvas, label, place.center, place.turn, levels.color(*level).ink());
    }
    domain.iter().for_each(|ring| canvas.polyline(ring, Pen::solid(style::INK, 1.2)));
}

/// Draws nodes with a value but without neighbors as dots; a few of them with their values.
fn draw_lone(canvas: &mut Canvas, field: &Field, levels: &Levels, frame: Rect) {
    for &node in &field.lone {
        let (x, y) = field.point(node);
        canvas.disc((x, y), style::MARKER + 1.0, levels.color(field.value(node)), Pen::solid(style::INK, 0.9));
        if field.lone.len() <= 3 {
            let label = text::significant(field.value(node) / 10f64.powi(levels.exponent), 4);
            let width = text::width(&label, style::LABEL_SIZE) + 6.0;
            let left = if x + 9.0 + width < frame.right() { x + 9.0 } else { x - 9.0 - width };
            let top = (y - 8.0).clamp(frame.y + 2.0, frame.bottom() - 18.0);
            Panel::blank(canvas, Rect { x: left, y: top, width, height: 16.0 });
            draw_plain(canvas, &label, (left + 3.0, top + 8.0));
        }
    }
}

fn draw_centered(canvas: &mut Canvas, label: &str, center: Point, turn: f64, color: style::Color) {
    let size = style::CONTOUR_LABEL_SIZE;
    let (sin, cos) = turn.to_radians().sin_cos();
    let drop = CAP_HEIGHT / 2.0 * size;
    let at = (center.0 - drop * sin, center.1 + drop * cos);
    canvas.text(label, Setting { turn, color, ..Setting::new(at, size, Anchor::Middle) });
}

fn draw_plain(canvas: &mut Canvas, label: &str, (x, y): Point) {
    canvas.text(label, Setting::new((x, y + CAP_HEIGHT / 2.0 * style::LABEL_SIZE), style::LABEL_SIZE, Anchor::Start));
}
