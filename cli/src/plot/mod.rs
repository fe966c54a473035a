//! Figures: one style, SVG and PNG, no system library.
//!
//! A [`Figure`] is plain data. [`Figure::svg`] composes the drawing with searchable text, [`Figure::png`] rasterizes the same drawing with
//! the letters as outlines of a font compiled into the binary, so it looks the same everywhere. Writing the file is the caller's business.

mod axis;
mod bars;
mod canvas;
mod contour;
mod contour_label;
mod field;
mod grid;
mod legend;
mod lines;
mod panel;
mod phasors;
mod raster;
mod root_locus;
mod sketch;
mod style;
mod text;

pub use axis::{Axis, Scale};
pub use bars::{BarPanel, Bars};
pub use contour::{Contour, Node};
pub use grid::{Grid, GridPanel};
pub use lines::{Band, Curve, LinePanel, Lines, Markers};
pub use phasors::{Phasor, PhasorPanel, Phasors};
pub use root_locus::{Locus, RootLocus};
pub use sketch::{Sketch, Stroke};

use canvas::Lettering;
use std::path::Path;

/// A figure as data, ready to be drawn.
#[derive(Clone, Debug)]
pub enum Figure {
    /// A quantity over two others.
    Contour(Contour),
    /// One or several quantities against another, in stacked panels.
    Lines(Lines),
    /// Curves in panels beside and below each other, each with axes of its own.
    Grid(Grid),
    /// Eigenvalues in the complex plane.
    RootLocus(RootLocus),
    /// Shapes of modes.
    Phasors(Phasors),
    /// What matters most.
    Bars(Bars),
    /// A drawing to scale.
    Sketch(Sketch),
}

impl Figure {
    /// The figure as a standalone SVG document.
    pub fn svg(&self) -> String {
        self.draw(Lettering::Text)
    }

    fn draw(&self, lettering: Lettering) -> String {
        match self {
            Self::Contour(figure) => figure.draw(lettering),
            Self::Lines(figure) => figure.draw(lettering),
            Self::Grid(figure) => figure.draw(lettering),
            Self::RootLocus(figure) => figure.draw(lettering),
            Self::Phasors(figure) => figure.draw(lettering),
            Self::Bars(figure) => figure.draw(lettering),
            Self::Sketch(figure) => figure.draw(lettering),
        }
    }

    /// The figure as a PNG image with `scale` pixels per SVG unit (2 suits screens, 4 suits print).
    ///
    /// # Errors
    /// [`PlotError::Raster`] when the image would be empty or too large.
    pub fn png(&self, scale: f64) -> Result<Vec<u8>, PlotError> {
        raster::png(&self.draw(Lettering::Outlines), scale)
    }

    /// The figure in the given file format.
    ///
    /// # Errors
    /// See [`Figure::png`].
    pub fn encode(&self, format: FileFormat) -> Result<Vec<u8>, PlotError> {
        match format {
            FileFormat::Svg => Ok(self.svg().into_bytes()),
            FileFormat::Png => self.png(style::PNG_SCALE),
        }
    }
}

/// The file formats of figures.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum FileFormat {
    /// Scalable vector graphics.
    Svg,
    /// Portable network graphics.
    Png,
}

impl FileFormat {
    /// The format that the extension of `path` asks for.
    ///
    /// # Errors
    /// [`PlotError::Extension`] for any other extension, or none.
    pub fn of(path: &Path) -> Result<Self, PlotError> {
        match path.extension().and_then(|e| e.to_str()).map(str::to_ascii_lowercase).as_deref() {
            Some("svg") => Ok(Self::Svg),
            Some("png") => Ok(Self::Png),
            _ => Err(PlotError::Extension { path: path.display().to_string() }),
        }
    }
}

/// Why a figure cannot be made.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum PlotError {
    /// The extension names no known format.
    #[error("`{path}`: a figure is written as `.svg` or `.png`")]
    Extension {
        /// The path as given.
        path: String,
    },
    /// The number of values does not fit the grid.
    #[error("a grid of {columns} × {rows} nodes needs {} values, {given} were given", columns * rows)]
    Shape {
        /// Number of nodes along x.
        columns: usize,
        /// Number of nodes along y.
        rows: usize,
        /// Number of values given.
        given: usize,
    },
    /// The nodes of an axis neither rise nor fall throughout, or one of them is not finite.
    #[error("the nodes of `{axis}` are not in strict order")]
    Order {
        /// Label of the axis.
        axis: String,
    },
    /// The drawing could not be turned into pixels.
    #[error("figure cannot be rasterized: {because}")]
    Raster {
        /// What the rasterizer said.
        because: String,
    },
}

#[cfg(test)]
mod tests;
