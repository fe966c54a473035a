//! From SVG to PNG in pure Rust. Letters must be outlines: the rasterizer is built without fonts.

use super::PlotError;
use resvg::{tiny_skia, usvg};

/// Largest side of an image in pixels.
const LARGEST: f64 = 20_000.0;

/// `svg` as PNG with `scale` pixels per unit.
pub(super) fn png(svg: &str, scale: f64) -> Result<Vec<u8>, PlotError> {
    let failed = |because: String| PlotError::Raster { because };
    let tree = usvg::Tree::from_str(svg, &usvg::Options::default()).map_err(|e| failed(e.to_string()))?;
    let (width, height) = (f64::from(tree.size().width()) * scale, f64::from(tree.size().height()) * scale);
    if !(1.0..=LARGEST).contains(&width) || !(1.0..=LARGEST).contains(&height) {
        return Err(failed(format!("{width:.0} × {height:.0} pixels at scale {scale}")));
    }
    let mut image =
        tiny_skia::Pixmap::new(width.ceil() as u32, height.ceil() as u32).ok_or_else(|| failed("no memory for the image".to_owned()))?;
    resvg::render(&tree, tiny_skia::Transform::from_scale(scale as f32, scale as f32), &mut image.as_mut());
    image.encode_png().map_err(|e| failed(e.to_string()))
}
