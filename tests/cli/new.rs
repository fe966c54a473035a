//! `new`: a bundled model becomes a folder that stands on its own.

use super::{fastbike, folder};
use fastbike::library::{Source, bundled_models, bundled_setups};
use std::fs;

#[test]
fn every_bundled_model_becomes_a_folder_that_stands_on_its_own() {
    let place = folder("new");
    for model in bundled_models().into_iter().chain(bundled_setups()) {
        let target = place.join(format!("my_{model}"));
        let made = fastbike(&["new", &target.display().to_string(), "--from", model]);
        assert_eq!((made.status, made.stderr.as_str()), (0, ""), "{model}: {}", made.stdout);
        let ending = if Source::find(model).expect("a bundled model").is_urdf() { "urdf" } else { "yaml" };
        let main = target.join(format!("my_{model}.{ending}")).display().to_string();
        assert!(made.stdout.starts_with(&main) && made.stdout.contains("next:"), "{}", made.stdout);
        let (copied, bundled) = (fastbike(&["check", &main]), fastbike(&["check", model]));
        assert_eq!((copied.status, copied.stdout.replace("my_", "")), (0, bundled.stdout), "{model}: {}", copied.stderr);
        assert!(target.join(format!("SOURCE_{model}.md")).is_file() || bundled_setups().contains(&model), "{model}");
        // nothing is read from elsewhere: without any other file of the folder there is an error
        let others = fs::read_dir(&target).expect("a folder").flatten().map(|f| f.path());
        for other in others.filter(|p| p.extension().is_some_and(|e| e == "urdf") && !p.ends_with(format!("my_{model}.urdf"))) {
            fs::write(&other, "<robot/>").expect("a file can be written");
            assert_eq!(fastbike(&["check", &main]).status, 2, "{model} does not read {}", other.display());
        }
    }
}

#[test]
fn what_is_there_already_stays() {
    let place = folder("new_again");
    let target = place.join("bike");
    fs::create_dir(&target).expect("a folder");
    let answer = fastbike(&["new", &target.display().to_string(), "--from", "ref11"]);
    assert_eq!((answer.status, answer.stdout.as_str()), (2, ""));
    assert!(answer.stderr.contains("error[exists_already]"), "{}", answer.stderr);
    assert_eq!(fs::read_dir(&target).map(Iterator::count).ok(), Some(0));
}
