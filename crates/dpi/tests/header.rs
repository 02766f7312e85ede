//! Test that the C header matches the functions.

use std::path::Path;

/// With `UPDATE_HEADER=1` it is written anew.
#[test]
fn the_header_is_that_of_the_functions() {
    let here = Path::new(env!("CARGO_MANIFEST_DIR"));
    let mut config = cbindgen::Config::from_file(here.join("cbindgen.toml")).unwrap();
    let version = env!("CARGO_PKG_VERSION");
    config.after_includes = Some(format!(
        "\n// The version of this header, for the functions that take that of whoever calls.\n\
         #define TOFSIM_VERSION \"{version}\""
    ));
    let source = here.join("src/border.rs");
    let bindings =
        cbindgen::Builder::new().with_src(source).with_config(config).generate().unwrap();
    let mut text = Vec::new();
    bindings.write(&mut text);
    let (text, path) = (String::from_utf8(text).unwrap(), here.join("include/tofsim.h"));
    if std::env::var_os("UPDATE_HEADER").is_some() {
        std::fs::write(&path, &text).unwrap();
    }
    assert!(
        std::fs::read_to_string(&path).unwrap() == text,
        "UPDATE_HEADER=1 cargo test -p tofsim-dpi writes it anew"
    );
}
