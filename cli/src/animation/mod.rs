//! Animations: one self-contained page that shows a motion or modes in three dimensions, without any request to the outside.
//!
//! The viewer is kept as plain sources in `viewer/` and put together with the data when a page is written. Arrays are numbers of 32 bits,
//! little-endian, in base64. The drawing is always in ISO axes; what stands beside it is in the axes and units asked for.

mod base64;
mod contact;
mod modes;
mod run;
mod scene;
mod shape;

pub use modes::page as page_of_modes;
pub use run::page as page_of_run;
pub use scene::Scene;

use crate::arguments::argument;
use crate::{Context, Failure, results};
use serde_json::Value;
use std::path::Path;

/// The frame of the page; `{{…}}` marks where the parts go.
const PAGE: &str = include_str!("viewer/page.html");
/// Its looks.
const STYLE: &str = include_str!("viewer/style.css");
/// Its program, in the order of use.
const PROGRAM: [&str; 9] = [
    include_str!("viewer/algebra.js"),
    include_str!("viewer/mesh.js"),
    include_str!("viewer/painter.js"),
    include_str!("viewer/camera.js"),
    include_str!("viewer/figure.js"),
    include_str!("viewer/film.js"),
    include_str!("viewer/stage.js"),
    include_str!("viewer/beside.js"),
    include_str!("viewer/viewer.js"),
];

/// Whether a page can be written under this name, before anything is computed.
///
/// # Errors
/// Another ending than `.html`, or a folder that does not exist.
pub fn check(path: &Path) -> Result<(), Failure> {
    let text = path.display().to_string();
    if path.extension().is_none_or(|e| !e.eq_ignore_ascii_case("html")) {
        let finding = argument("animate", &text, "unknown_value", "there is no animation of this format");
        return Err(finding.with_hint("the name of the file ends in `.html`; it opens in a browser").into());
    }
    match path.parent() {
        Some(folder) if !folder.as_os_str().is_empty() && !folder.is_dir() => {
            let why = format!("the folder `{}` does not exist", folder.display());
            Err(argument("animate", &text, "missing_folder", why).with_hint("make the folder first, or name another one").into())
        }
        _ => Ok(()),
    }
}

/// Writes a page and says how large it is.
///
/// # Errors
/// The file cannot be written.
pub fn write(context: &Context, path: &Path, page: &str) -> Result<(), Failure> {
    results::write(path, page.as_bytes())?;
    let size = page.len() as f64 / 1e3;
    let told = if size < 1e3 { format!("{size:.0} kB") } else { format!("{:.1} MB", size / 1e3) };
    context.console.complain(&format!("animation: `{}`, {told}, opens in a browser without a network\n", path.display()));
    Ok(())
}

/// The page around the data.
fn assemble(title: &str, data: &Value) -> String {
    // nothing inside a script element may look like its end
    let data = data.to_string().replace("</", "<\\/");
    let title = title.replace('&', "&amp;").replace('<', "&lt;");
    let parts = [("{{title}}", title), ("{{style}}", STYLE.to_owned()), ("{{data}}", data), ("{{program}}", PROGRAM.concat())];
    let mut page = String::with_capacity(PAGE.len() + parts.iter().map(|p| p.1.len()).sum::<usize>());
    let mut rest = PAGE;
    for (mark, part) in parts {
        let (before, after) = rest.split_once(mark).unwrap_or((rest, ""));
        page.push_str(before);
        page.push_str(&part);
        rest = after;
    }
    page.push_str(rest);
    page
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde_json::json;

    #[test]
    fn the_page_holds_its_parts_once_and_the_data_cannot_end_their_element() {
        let page = assemble("a < b", &json!({ "about": "</script>" }));
        assert!(page.contains("<title>a &lt; b</title>") && !page.contains("{{"));
        assert_eq!(page.matches("</script>").count(), 2, "data and program");
        assert!(page.contains("<\\/script>"));
    }

    #[test]
    fn names_of_files_are_checked_before_anything_is_computed() {
        let says = |path: &str| check(Path::new(path)).map_err(|e| e.to_string());
        assert!(says("run.html").is_ok() && says("./run.HTML").is_ok());
        assert!(says("run.mp4").is_err_and(|e| e.contains("no animation of this format")));
        assert!(says("no_such_folder/run.html").is_err_and(|e| e.contains("`no_such_folder` does not exist")));
    }
}
