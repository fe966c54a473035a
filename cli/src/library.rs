//! Where descriptions come from: the bundled models, or the disk.

use mbody::description::finding::{Finding, Findings, nearest, suggestion};
use mbody::description::{Library, beside};
use std::borrow::Cow;
use std::fs;
use std::io::ErrorKind;
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

/// Text of a bundled file, by its name below `models/`.
pub fn bundled_file(name: &str) -> Option<&'static str> {
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

/// Names of all bundled setups.
pub fn bundled_setups() -> Vec<&'static str> {
    BUNDLED.iter().filter_map(|(path, _)| path.strip_prefix("setups/")?.strip_suffix(".yaml")).collect()
}

/// Names of all bundled maneuvers.
pub fn bundled_maneuvers() -> Vec<&'static str> {
    BUNDLED.iter().filter_map(|(path, _)| path.strip_prefix("maneuvers/")?.strip_suffix(".yaml")).collect()
}

/// A maneuver and the files beside it: a bundled name, or a path that ends in `.yaml` or `.yml`.
///
/// # Errors
/// There is none.
pub fn maneuver(name: &str) -> Result<Source, Findings> {
    let path = Path::new(name);
    if path.extension().is_some_and(|e| e == "yaml" || e == "yml") {
        readable(path, name)?;
        return Ok(Source::on_disk(path));
    }
    let file = format!("{name}.yaml");
    if bundled_file(&format!("maneuvers/{file}")).is_some() {
        return Ok(Source { file, name: name.to_owned(), folder: None, bundled: "maneuvers".to_owned() });
    }
    let known = bundled_maneuvers();
    let finding = Finding::error("unknown_maneuver", format!("there is no bundled maneuver `{name}`"));
    Err(finding.with_hint_from(suggestion(name, known.iter().copied())).into())
}

/// Names of all bundled tires.
pub fn bundled_tires() -> Vec<&'static str> {
    BUNDLED.iter().filter_map(|(path, _)| Some(path.strip_prefix("tires/")?.rsplit_once('.')?.0)).collect()
}

/// A tire by itself: the path of a tire property file, or the name of a bundled tire; none where `name` looks like neither.
///
/// # Errors
/// There is no such file.
pub fn tire(name: &str) -> Result<Option<Source>, Findings> {
    let path = Path::new(name);
    if path.extension().is_some_and(|e| e.eq_ignore_ascii_case("tir")) {
        readable(path, name)?;
        return Ok(Some(Source::on_disk(path)));
    }
    let found = ["yaml", "tir"].map(|e| format!("{name}.{e}")).into_iter().find(|file| bundled_file(&format!("tires/{file}")).is_some());
    Ok(found.map(|file| Source { file, name: name.to_owned(), folder: None, bundled: "tires".to_owned() }))
}

impl Source {
    /// The model a user asked for: a bundled name, or a path that ends in `.yaml`, `.yml` or `.urdf`.
    pub fn find(model: &str) -> Result<Self, Findings> {
        let path = Path::new(model);
        let extension = path.extension().and_then(|e| e.to_str()).unwrap_or_default();
        if matches!(extension, "yaml" | "yml" | "urdf") {
            readable(path, model)?;
            return Ok(Self::on_disk(path));
        }
        for folder in FOLDERS {
            for extension in ["yaml", "urdf"] {
                let path = format!("{folder}/{model}");
                if bundled_file(&format!("{path}/{model}.{extension}")).is_some() {
                    return Ok(Self { file: format!("{model}.{extension}"), name: model.to_owned(), folder: None, bundled: path });
                }
            }
        }
        let file = format!("{model}.yaml");
        if bundled_file(&format!("setups/{file}")).is_some() {
            return Ok(Self { file, name: model.to_owned(), folder: None, bundled: "setups".to_owned() });
        }
        if path.exists() {
            return Err(no_description(path, model).into());
        }
        let known = [bundled_models(), bundled_setups()].concat();
        let finding = Finding::error("unknown_model", format!("there is no bundled model `{model}`"));
        Err(finding.with_hint_from(suggestion(model, known.iter().copied())).into())
    }

    /// A file and those beside it.
    fn on_disk(path: &Path) -> Self {
        let file = path.file_name().map(|n| n.to_string_lossy().into_owned()).unwrap_or_default();
        let name = path.file_stem().map(|n| n.to_string_lossy().into_owned()).unwrap_or_default();
        let folder = path.parent().filter(|p| !p.as_os_str().is_empty()).unwrap_or(Path::new(".")).to_path_buf();
        Self { file, name, folder: Some(folder), bundled: String::new() }
    }

    /// Whether it is compiled into the command.
    pub fn is_bundled(&self) -> bool {
        self.folder.is_none()
    }

    /// Whether the description is a plain URDF.
    pub fn is_urdf(&self) -> bool {
        self.file.ends_with(".urdf")
    }
}

/// Whether there is a text at the path.
fn readable(path: &Path, model: &str) -> Result<(), Findings> {
    let missing = |message: String| Finding::error("missing_file", message);
    if path.is_dir() {
        return Err(no_description(path, model).into());
    }
    let Err(error) = fs::read_to_string(path) else { return Ok(()) };
    let finding = match error.kind() {
        ErrorKind::NotFound => {
            let stem = path.file_stem().and_then(|s| s.to_str()).unwrap_or_default();
            let bundled = nearest(stem, bundled_models()).map(|name| format!("there is a bundled model `{name}`, named without ending"));
            missing(format!("file `{model}` was not found")).with_hint_from(bundled)
        }
        ErrorKind::InvalidData => Finding::error("not_text", format!("file `{model}` is no text in UTF-8")),
        ErrorKind::PermissionDenied => missing(format!("file `{model}` may not be read")),
        _ => missing(format!("file `{model}` cannot be read: {error}")),
    };
    Err(finding.into())
}

/// Something is there, but no description.
fn no_description(path: &Path, model: &str) -> Finding {
    let what = if path.is_dir() { "a folder" } else { "neither a .yaml nor a .urdf file" };
    Finding::error("no_description", format!("`{model}` is {what}"))
        .with_hint("give the path of a .yaml description or of a plain .urdf, or the name of a bundled model")
}

/// In front of the name of a bundled file below `models/`, where a text on disk or in another folder refers to it.
const SCHEME: &str = "bundled:";

/// Folders of bundled files that are found by their bare name.
const SHARED: [&str; 2] = ["parts", "tires"];

impl Library for Source {
    fn text(&self, name: &str) -> Option<Cow<'_, str>> {
        if let Some(path) = name.strip_prefix(SCHEME) {
            return bundled_file(path).map(Cow::Borrowed);
        }
        let beside = match &self.folder {
            Some(folder) => fs::read_to_string(folder.join(name)).ok().map(Cow::Owned),
            None => bundled_file(&beside(&format!("{}/", self.bundled), name)).map(Cow::Borrowed),
        };
        beside.or_else(|| SHARED.iter().find_map(|folder| bundled_file(&format!("{folder}/{name}"))).map(Cow::Borrowed))
    }

    /// A file beside the text, then a bundled model, part or tire. The ending `.yaml` may be left out.
    fn resolve(&self, name: &str, within: &str) -> String {
        let near = match within.strip_prefix(SCHEME) {
            Some(within) => format!("{SCHEME}{}", beside(within, name)),
            None => beside(within, name),
        };
        let candidates = match name.strip_prefix(SCHEME) {
            Some(_) => vec![name.to_owned()],
            None => {
                let model = FOLDERS.iter().map(|folder| format!("{SCHEME}{folder}/{name}/{name}.yaml"));
                let setup = format!("{SCHEME}setups/{name}.yaml");
                let shared = SHARED.iter().flat_map(|f| ["", ".yaml"].map(|end| format!("{SCHEME}{f}/{name}{end}")));
                [near.clone(), format!("{near}.yaml")].into_iter().chain(model).chain([setup]).chain(shared).collect()
            }
        };
        candidates.into_iter().find(|c| self.text(c).is_some()).unwrap_or(near)
    }
}
