//! British spellings, for which an American one exists.

use super::source::{File, words};

/// Beginnings of words, each with the American beginning.
const BEGINNINGS: [(&str, &str); 31] = [
    ("tyre", "tire"),
    ("manoeuvr", "maneuver"),
    ("centre", "center"),
    ("centring", "centering"),
    ("colour", "color"),
    ("behaviour", "behavior"),
    ("favour", "favor"),
    ("neighbour", "neighbor"),
    ("labour", "labor"),
    ("honour", "honor"),
    ("flavour", "flavor"),
    ("vapour", "vapor"),
    ("analyse", "analyze"),
    ("analysing", "analyzing"),
    ("catalyse", "catalyze"),
    ("modelled", "modeled"),
    ("modelling", "modeling"),
    ("labelled", "labeled"),
    ("labelling", "labeling"),
    ("travelled", "traveled"),
    ("travelling", "traveling"),
    ("signalled", "signaled"),
    ("levelled", "leveled"),
    ("levelling", "leveling"),
    ("fibre", "fiber"),
    ("litre", "liter"),
    ("kerb", "curb"),
    ("aluminium", "aluminum"),
    ("artefact", "artifact"),
    ("mould", "mold"),
    ("defence", "defense"),
];
/// Whole words.
const WORDS: [(&str, &str); 10] = [
    ("metre", "meter"),
    ("metres", "meters"),
    ("millimetre", "millimeter"),
    ("millimetres", "millimeters"),
    ("kilometres", "kilometers"),
    ("grey", "gray"),
    ("whilst", "while"),
    ("learnt", "learned"),
    ("licence", "license"),
    ("programme", "program"),
];
/// Stems that take `-ize` here.
const IZE: [&str; 40] = [
    "categor",
    "character",
    "custom",
    "deserial",
    "discret",
    "emphas",
    "equal",
    "factor",
    "general",
    "ideal",
    "initial",
    "line",
    "linear",
    "local",
    "material",
    "maxim",
    "minim",
    "neutral",
    "normal",
    "optim",
    "organ",
    "orthogonal",
    "orthonormal",
    "parameter",
    "parametr",
    "penal",
    "polar",
    "quant",
    "random",
    "real",
    "recogn",
    "regular",
    "serial",
    "special",
    "stabil",
    "summar",
    "symmetr",
    "synchron",
    "util",
    "visual",
];
/// Words of the lists above in a second meaning, and a key of tire property files.
const ALLOWED: [&str; 2] = ["analyses", "tyreside"];

/// `file:line: word, American word` for every British spelling outside quoted titles.
pub fn violations(file: &File) -> Vec<String> {
    // the list itself
    if file.path == "tests/architecture/spelling.rs" || file.path == "tests/architecture/main.rs" {
        return Vec::new();
    }
    let text = if file.path.ends_with(".rs") { without_titles_in_comments(&file.text) } else { without_quotations(&file.text) };
    let lines = text.lines().enumerate();
    let found = lines.flat_map(|(i, line)| words(line).filter_map(move |word| american(&word).map(|better| (i + 1, word, better))));
    found.map(|(line, word, better)| format!("{}:{line}: `{word}`, American `{better}`", file.path)).collect()
}

/// The American spelling of a British word.
fn american(word: &str) -> Option<String> {
    if ALLOWED.contains(&word) {
        return None;
    }
    let beginning = BEGINNINGS.iter().find_map(|(british, better)| word.strip_prefix(british).map(|end| format!("{better}{end}")));
    let whole = || WORDS.iter().find(|(british, _)| *british == word).map(|(_, better)| (*better).to_string());
    let ending = || {
        IZE.iter().find_map(|stem| {
            let end = word.strip_prefix(stem)?;
            let rest = end.strip_prefix("is")?;
            let british = ["e", "ed", "er", "ers", "es", "ing", "ation", "ations"].contains(&rest);
            british.then(|| format!("{stem}iz{rest}"))
        })
    };
    beginning.or_else(whole).or_else(ending)
}

/// A Rust file without what its comments quote; its code as it is.
fn without_titles_in_comments(text: &str) -> String {
    let lines: Vec<&str> = text.lines().collect();
    let comment = |line: &str| line.trim_start().starts_with("//");
    // a title may run over several lines of one comment
    let runs = lines.chunk_by(|a, b| comment(a) == comment(b));
    runs.map(|run| if comment(run[0]) { without_marked(&run.join("\n")) } else { run.join("\n") }).collect::<Vec<_>>().join("\n")
}

/// A text without what it quotes, line by line with `>` or paragraph by paragraph in marks.
fn without_quotations(text: &str) -> String {
    let text = text.lines().map(|line| if line.trim_start().starts_with('>') { "" } else { line }).collect::<Vec<_>>().join("\n");
    text.split("\n\n").map(without_marked).collect::<Vec<_>>().join("\n\n")
}

/// A paragraph without what stands in “quotation marks” or is set *slanted*.
fn without_marked(paragraph: &str) -> String {
    blank(&blank(&blank(paragraph, '“', '”'), '"', '"'), '*', '*')
}

/// Replaces what stands between the marks by blanks; an opening mark without its closing one is left alone.
fn blank(text: &str, open: char, close: char) -> String {
    let mut result = String::with_capacity(text.len());
    let mut rest = text;
    while let Some((before, after)) = rest.split_once(open) {
        result.push_str(before);
        let Some((inside, behind)) = after.split_once(close) else {
            rest = after;
            continue;
        };
        result.extend(inside.chars().map(|c| if c == '\n' { '\n' } else { ' ' }));
        rest = behind;
    }
    result + rest
}

#[test]
fn british_words_are_found_and_titles_are_not() {
    assert_eq!(american("behaviours").as_deref(), Some("behaviors"));
    assert_eq!(american("linearisation").as_deref(), Some("linearization"));
    assert_eq!([american("analyses"), american("realistic"), american("optimist"), american("precise")], [None, None, None, None]);
    let file = |path: &str, text: &str| File { path: path.into(), text: text.into() };
    let title = file("a.md", "See \"The modelling\nof tyres\", *Vehicle Behaviour*.\nIts colour\n");
    assert_eq!(violations(&title), ["a.md:3: `colour`, American `color`"]);
    let code = file("a.rs", "// “Tyre\n// modelling”\nlet s = \"tyre\";");
    assert_eq!(violations(&code), ["a.rs:3: `tyre`, American `tire`"]);
}
