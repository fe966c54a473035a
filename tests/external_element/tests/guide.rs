//! The guide about this crate, every command of it.

use std::path::Path;
use std::{env, fs};
use validation::guide::hold;

#[test]
fn the_guide_does_what_it_says() {
    let text = fs::read_to_string(Path::new(env!("CARGO_MANIFEST_DIR")).join("../../docs/guide/own_element.md")).expect("the guide");
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join("guide").join("own_element");
    fs::create_dir_all(&folder).expect("a folder can be made");
    env::set_current_dir(&folder).expect("a folder can be entered");
    let programs: [validation::guide::Program<'_>; 2] = [("mybike", &external_element::kinds), ("fastbike", &fastbike::standard_kinds)];
    assert!(hold("own_element.md", &text, &programs) >= 5);
}
