//! Tests of the C example, with the shared and the static library.

use std::process::Command;

use crate::common::{library, root, run};

const SAYS: &str = "\
edge 0: spad_rst 0, spad_sel 0000000001
edge 1: spad_rst 0, spad_sel 0000000001
edge 2: spad_rst 0, spad_sel 0000000001
edge 3: spad_rst 1, spad_sel 0000000001
edge 4: spad_rst 0, spad_sel 0000000001
spad_control: cycle 4, time 32000 ps, spad_sel: expected 0000000001, got 0000000000
";

#[test]
fn c_has_the_model_from_either_library() {
    let folder = tempfile::tempdir().unwrap();
    let library = library();
    let rpath = format!("-Wl,-rpath,{}", library.display());
    let fixed = ["libtofsim_dpi.a", "-lm", "-lpthread", "-ldl"];
    for (name, libraries) in [("fixed", &fixed[..]), ("shared", &["libtofsim_dpi.so", &rpath])] {
        let program = folder.path().join(name);
        let built = Command::new("cc")
            .args(["-std=c99", "-Wall", "-Wextra", "-pedantic", "-Werror", "-I"])
            .arg(root().join("crates/dpi/include"))
            .arg(root().join("examples/bench/model.c"))
            .args(libraries)
            .arg("-o")
            .arg(&program)
            .current_dir(&library)
            .output()
            .expect("cc: apt-get install gcc");
        assert!(built.status.success(), "{}", String::from_utf8_lossy(&built.stderr));
        let done = run(&program, folder.path(), &[]);
        assert!(done.is_fine && done.text == SAYS, "{name}: {}", done.text);
        let refused = run(&program, folder.path(), &["nowhere"]);
        let expected = "tofsim_new: scenario: nowhere: no such file or built-in scenario";
        assert!(!refused.is_fine && refused.text.starts_with(expected), "{name}: {}", refused.text);
    }
}
