//! Every message of the URDF reader.

use super::*;

#[test]
fn local_files() {
    let Ok(list) = std::env::var("URDF_FILES") else { return };
    for file in list.split_whitespace() {
        let text = std::fs::read_to_string(file).unwrap();
        let (robot, findings) = read(file.rsplit('/').next().unwrap(), &text);
        println!("== {file} {:?} {}", robot.map(|r| (r.links.len(), r.joints.len())), findings.summary());
        println!("{findings}");
    }
}
