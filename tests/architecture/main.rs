//! Rules of the house that the compiler does not hold: arrows between packages, words, prints, unsafe code, spelling.
//!
//! Every violation names `file:line`. The rules look at the text of the repository, not at this build of it.

mod arrows;
mod source;
mod spelling;

use source::{File, code_only, repository, words};

/// Words that the engine must not know: it moves bodies, not vehicles.
const TRADE: [&str; 7] = ["tire", "tyre", "motorcycle", "fork", "rider", "handlebar", "swingarm"];
/// Macros that write to the terminal.
const PRINTS: [&str; 5] = ["println!", "eprintln!", "print!", "eprint!", "dbg!"];
/// Macros that stand for work not done.
const STUBS: [&str; 2] = ["todo!", "unimplemented!"];
/// First parts of paths that exist on one machine only.
const MACHINE_FOLDERS: [&str; 5] = ["work", "root", "tmp", "home", "Users"];

/// Every line of `text` on which `offends` finds something, as `file:line: what it found`.
fn offenses(file: &File, text: &str, offends: impl Fn(&str) -> Option<String>) -> Vec<String> {
    let found = text.lines().enumerate().filter_map(|(i, line)| offends(line).map(|what| (i + 1, what)));
    found.map(|(line, what)| format!("{}:{line}: {what}", file.path)).collect()
}

/// Offenses in the code (comments and strings blanked) of the Rust files that `applies` selects.
fn in_code(applies: impl Fn(&str) -> bool, offends: impl Fn(&str) -> Option<String>) -> Vec<String> {
    let files = repository().into_iter().filter(|file| file.path.ends_with(".rs") && applies(&file.path));
    files.flat_map(|file| offenses(&file, &code_only(&file.text), &offends)).collect()
}

/// The first of `macros` that the line calls.
fn calls(line: &str, macros: &[&str]) -> Option<String> {
    let called = |name: &&&str| line.match_indices(**name).any(|(at, _)| !line[..at].ends_with(|c: char| c.is_alphanumeric() || c == '_'));
    macros.iter().find(called).map(|name| format!("calls `{name}`"))
}

/// Whether the file belongs to the library part of a package that must neither print nor read files.
fn library(path: &str) -> bool {
    ["mbody/src/", "motorcycle/src/", "solvers/"].iter().any(|folder| path.starts_with(folder)) && !path.contains("/benches/")
}

fn hold(rule: &str, violations: &[String]) {
    assert!(violations.is_empty(), "{rule}:\n  {}\n", violations.join("\n  "));
}

#[test]
fn packages_depend_only_along_the_arrows() {
    hold("a package depends on another that it must not know (ARCHITECTURE.md shows the arrows)", &arrows::violations());
}

/// The README's first command says `cargo run` without a name.
#[test]
fn plain_cargo_run_has_one_command() {
    assert_eq!(arrows::commands_of_plain_cargo(), ["fastbike"], "default-members in Cargo.toml");
}

#[test]
fn the_engine_contains_no_word_of_the_trade() {
    let engine = repository().into_iter().filter(|file| file.path.starts_with("mbody/src/"));
    let violations: Vec<_> = engine.flat_map(|file| offenses(&file, &file.text, trade_word)).collect();
    hold("mbody knows bodies and joints, no vehicles", &violations);
}

fn trade_word(line: &str) -> Option<String> {
    words(line)
        .find(|word| TRADE.iter().any(|trade| word == trade || word.strip_suffix('s') == Some(trade)))
        .map(|word| format!("`{word}`"))
}

#[test]
fn only_the_sundials_package_contains_unsafe_code() {
    let word = |line: &str| line.split(|c: char| !c.is_alphanumeric() && c != '_').any(|word| word == "unsafe");
    let violations = in_code(|path| !path.starts_with("solvers/sundials/src/raw/"), |line| word(line).then(|| "`unsafe`".into()));
    hold("unsafe code belongs to solvers/sundials/src/raw", &violations);
}

#[test]
fn the_bindings_are_touched_in_one_module_only() {
    let violations = in_code(
        |path| !path.starts_with("solvers/sundials/src/raw/"),
        |line| line.contains("sundials_sys").then(|| "`sundials_sys`".into()),
    );
    hold("the C bindings belong to solvers/sundials/src/raw", &violations);
}

#[test]
fn only_the_command_prints() {
    hold("only cli prints", &in_code(library, |line| calls(line, &PRINTS)));
}

#[test]
fn only_the_command_opens_files() {
    let opens =
        |line: &str| ["std::fs", "File::open", "File::create"].iter().find(|way| line.contains(**way)).map(|way| format!("`{way}`"));
    hold("text is handed down by cli; no other package opens a path", &in_code(|path| library(path) && path.contains("/src/"), opens));
}

/// A new vehicle is a new folder, and the difference between two vehicles is files below `models/`: no code asks for one by its name. Samples of reports in tests and help may, and words without a model are looked up in a sample.
#[test]
fn vehicles_are_files() {
    let vehicle = |file: &File| file.path.strip_prefix("models/vehicles/")?.split_once('/').map(|(name, _)| format!("\"{name}\""));
    let names: std::collections::BTreeSet<String> = repository().iter().filter_map(vehicle).collect();
    assert!(names.len() >= 16, "{names:?}");
    let samples = ["cli/src/commands/explain.rs", "cli/src/output/json.rs", "cli/src/output/sample.rs", "cli/src/plot/tests.rs"];
    let code = repository().into_iter().filter(|file| {
        let ours = ["mbody/src/", "motorcycle/src/", "solvers/", "cli/src/"].iter().any(|folder| file.path.starts_with(folder));
        ours && file.path.ends_with(".rs") && !samples.contains(&file.path.as_str())
    });
    let asks = |line: &str| names.iter().find(|name| line.contains(name.as_str())).map(|name| format!("asks for {name}"));
    let violations: Vec<_> = code.flat_map(|file| offenses(&file, &file.text, asks)).collect();
    hold("vehicles are files below models/", &violations);
}

#[test]
fn nothing_is_a_stub() {
    hold("work is done or absent", &in_code(|_| true, |line| calls(line, &STUBS)));
}

#[test]
fn no_file_names_a_path_of_one_machine() {
    let violations: Vec<_> = repository().iter().flat_map(|file| offenses(file, &file.text, machine_path)).collect();
    hold("paths of one machine have no meaning on another", &violations);
}

/// A path that starts at the root in one of the folders above; `a/tmp/b` and `https://host/home/` are none.
fn machine_path(line: &str) -> Option<String> {
    MACHINE_FOLDERS.iter().find_map(|folder| {
        let path = format!("/{folder}/");
        let starts = |at: usize| !line[..at].ends_with(|c: char| c.is_alphanumeric() || "/.}_-~".contains(c));
        line.match_indices(&path).any(|(at, _)| starts(at)).then(|| format!("`{path}`"))
    })
}

#[test]
fn spelling_is_american() {
    let violations: Vec<_> = repository().iter().flat_map(spelling::violations).collect();
    hold("spelling is American outside quoted titles", &violations);
}

#[test]
fn each_rule_sees_what_it_forbids_and_nothing_else() {
    assert_eq!(trade_word("the rear_tires of a FrontFork").as_deref(), Some("`tires`"));
    assert_eq!(trade_word("entire retired stride; override, forked"), None);
    assert_eq!(calls("    println!(\"x\");", &PRINTS).as_deref(), Some("calls `println!`"));
    assert_eq!(calls("my_print!(x)", &PRINTS), None);
    let path = format!("open {}{}", '/', "work/main");
    assert!(machine_path(&path).is_some());
    assert_eq!(machine_path("see https://example.org/home/page and frame/work/sheet"), None);
}
