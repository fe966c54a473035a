//! Where descriptions come from: the bundled models, or the disk.

use mbody::description::Library;
use mbody::description::finding::{Finding, Findings, suggestion};
use std::borrow::Cow;
use std::fs;
use std::path::{Path, PathBuf};

/// Name below `models/` and text of every bundled file.
const BUNDLED: &[(&str, &str)] = include!(concat!(env!("OUT_DIR"), "/bundled.rs"));

/// Folders of bundled models, in the order in which a bare name is looked up.
const FOLDERS: [&str; 2] = ["vehicles", "mechanisms"];

/// A description and the files beside it.
#[derive(Clone, Debug)]
pub struct Source {
    /// Name of the description in its library, for messages.
    pub file: String,
    /// Short name for headings.
    pub name: String,
    /// Folder on disk; `None` for a bundled model.
    folder: Option<PathBuf>,
    /// Folder below `models/` of a bundled model.
    bundled: String,
}

fn bundled(name: &str) -> Option<&'static str> {
    BUNDLED.iter().find(|(n, _)| *n == name).map(|(_, text)| *text)
}

/// Names of all bundled models.
pub fn bundled_models() -> Vec<&'static str> {
    let names = BUNDLED.iter().filter_map(|(path, _)| {
        let mut parts = path.split('/');
        let (folder, name, file) = (parts.next()?, parts.next()?, parts.next()?);
        let stem = file.rsplit_once('.')?.0;
        (FOLDERS.contains(&folder) && stem == name).then_some(name)
    });
    let mut names: Vec<&str> = names.collect();
    names.dedup();
    names
}

impl Source {
    /// The model a user asked for: a bundled name, or a path that ends in `.yaml`, `.yml` or `.urdf`.
    pub fn find(model: &str) -> Result<Self, Findings> {
        let path = Path::new(model);
        let extension = path.extension().and_then(|e| e.to_str()).unwrap_or_default();
        if matches!(extension, "yaml" | "yml" | "urdf") {
            if !path.is_file() {
                return Err(Finding::error("missing_file", format!("file `{model}` was not found")).into());
            }
            let file = path.file_name().map(|n| n.to_string_lossy().into_owned()).unwrap_or_default();
            let name = path.file_stem().map(|n| n.to_string_lossy().into_owned()).unwrap_or_default();
            let folder = path.parent().filter(|p| !p.as_os_str().is_empty()).unwrap_or(Path::new(".")).to_path_buf();
            return Ok(Self { file, name, folder: Some(folder), bundled: String::new() });
        }
        for folder in FOLDERS {
            for extension in ["yaml", "urdf"] {
                let path = format!("{folder}/{model}");
                if bundled(&format!("{path}/{model}.{extension}")).is_some() {
                    return Ok(Self { file: format!("{model}.{extension}"), name: model.to_owned(), folder: None, bundled: path });
                }
            }
        }
        let known = bundled_models();
        let hint = suggestion(model, known.iter().copied())
            .unwrap_or_else(|| format!("bundled models: {}; or give the path of a .yaml or .urdf file", known.join(", ")));
        Err(Finding::error("unknown_model", format!("there is no bundled model `{model}`")).with_hint(hint).into())
    }

    /// Whether the description is a plain URDF.
    pub fn is_urdf(&self) -> bool {
        self.file.ends_with(".urdf")
    }
}

impl Library for Source {
    fn text(&self, name: &str) -> Option<Cow<'_, str>> {
        let beside = match &self.folder {
            Some(folder) => fs::read_to_string(folder.join(name)).ok().map(Cow::Owned),
            None => bundled(&format!("{}/{name}", self.bundled)).map(Cow::Borrowed),
        };
        beside.or_else(|| bundled(&format!("tires/{name}")).map(Cow::Borrowed))
    }
}
