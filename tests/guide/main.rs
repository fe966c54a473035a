//! Are the guides true? Every command in `docs/guide` is run as a new user would, in an empty folder.
//!
//! One test: the working folder belongs to the process. The guide of external elements is held by the crate that it is about.

use std::env;
use std::fs;
use std::path::Path;
use validation::guide::hold;

#[test]
fn guides_do_what_they_say() {
    let docs = Path::new(env!("CARGO_MANIFEST_DIR")).join("../docs/guide");
    for name in ["first_change.md", "own_vehicle.md"] {
        let text = fs::read_to_string(docs.join(name)).unwrap_or_else(|e| panic!("{name}: {e}"));
        let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join("guide").join(name);
        if folder.exists() {
            fs::remove_dir_all(&folder).expect("an old folder can be removed");
        }
        fs::create_dir_all(&folder).expect("a folder can be made");
        env::set_current_dir(&folder).expect("a folder can be entered");
        assert!(hold(name, &text, &[("fastbike", &fastbike::standard_kinds)]) >= 7, "{name} has hardly any commands");
    }
}
