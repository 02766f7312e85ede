//! Tests of mesh files: each format, and which files are refused.

use super::*;

/// The six faces of a cube of side 2 about the origin, counter-clockwise from outside, as lines of an OBJ file.
const CUBE: &str = "\
# a cube
mtllib cube.mtl
o cube
v -1 -1 -1
v 1 -1 -1
v 1 1 -1
v -1 1 -1
v -1 -1 1 0.5 0.5 0.5
v 1 -1 1
v 1 1 1
v -1 1 1
vn 0 0 1
usemtl white
s off
f 1 4 3 2
f 5//1 6//1 7//1 8//1
f 1/1 2/2 6/3 5/4
f -6 -5 -1 \\
  -2
f 2 3 7 6
f 1 5 8 4
";

/// Creates a mesh from triangles that are known to be closed.
pub fn of(triangles: Vec<[Point; 3]>) -> Mesh {
    let bytes = binary(&triangles);
    parse("made.stl", &bytes).expect("a closed surface");
    Mesh { triangles }
}

/// Creates a cube from OBJ.
pub fn cube() -> Mesh {
    parse("cube.obj", CUBE.as_bytes()).unwrap()
}

/// Formats triangles as ASCII STL.
fn ascii(triangles: &[[Point; 3]]) -> String {
    let mut text = "solid made for a test\n".to_owned();
    for triangle in triangles {
        text += "  facet normal 0 0 0\n    outer loop\n";
        for [x, y, z] in triangle {
            text += &format!("      vertex {x:e} {y:e} {z:e}\n");
        }
        text += "    endloop\n  endfacet\n";
    }
    text + "endsolid\n"
}

/// Formats triangles as binary STL.
pub fn binary(triangles: &[[Point; 3]]) -> Vec<u8> {
    let mut bytes = b"solid in name only".to_vec();
    bytes.resize(80, b' ');
    bytes.extend((triangles.len() as u32).to_le_bytes());
    for triangle in triangles {
        bytes.extend([0; 12]);
        for number in triangle.as_flattened() {
            bytes.extend((*number as f32).to_le_bytes());
        }
        bytes.extend([0; 2]);
    }
    bytes
}

fn error(name: &str, bytes: impl AsRef<[u8]>) -> String {
    parse(name, bytes.as_ref()).unwrap_err().to_string()
}

#[test]
fn all_three_formats_give_the_same_triangles() {
    let cube = cube();
    assert_eq!(cube.triangles().len(), 12);
    assert_eq!(cube.triangles()[0], [[-1.0, -1.0, -1.0], [-1.0, 1.0, -1.0], [1.0, 1.0, -1.0]]);
    assert_eq!(parse("c.stl", ascii(cube.triangles()).as_bytes()).unwrap(), cube);
    assert_eq!(parse("c.STL", ascii(cube.triangles()).to_uppercase().as_bytes()).unwrap(), cube);
    assert_eq!(parse("c.stl", &binary(cube.triangles())).unwrap(), cube);
}

#[test]
fn numbers_that_are_none_are_named_by_their_place() {
    let nan = CUBE.replace("v 1 1 -1", "v 1 nan -1");
    assert_eq!(error("c.obj", nan), "c.obj:6:5: y = nan: expected a finite number");
    let short = CUBE.replace("v 1 1 -1", "v 1 1");
    assert!(error("c.obj", short).starts_with("c.obj:6:1: z: expected a finite number"));
    let mut triangles = cube().triangles;
    triangles[2][1][0] = f64::INFINITY;
    let found = error("c.stl", ascii(&triangles));
    assert_eq!(found, "c.stl:19:14: x = inf: expected a finite number");
    triangles[2][1][0] = f64::NAN;
    let found = error("c.stl", binary(&triangles));
    assert_eq!(found, "c.stl: triangle 3 = NaN: expected finite numbers");
}

#[test]
fn a_mesh_that_is_not_closed_is_refused_with_the_edge_that_is_open() {
    let open = CUBE.replace("f 2 3 7 6\n", "");
    let found = error("c.obj", &open);
    assert!(found.starts_with("c.obj:15:1: [1.0, 1.0, -1.0] to "), "{found}");
    assert!(found.contains("expected a closed mesh, with another triangle"), "{found}");
    let triangles = &cube().triangles[1..];
    assert!(error("c.stl", binary(triangles)).starts_with("c.stl: triangle "));
    let turned = CUBE.replace("f 2 3 7 6", "f 6 7 3 2");
    let found = error("c.obj", turned);
    assert!(found.contains("the 2 triangles at this edge do not go along it"), "{found}");
}

#[test]
fn a_mesh_that_is_inside_out_is_refused_with_its_volume() {
    let mut triangles = cube().triangles;
    triangles.iter_mut().for_each(|triangle| triangle.swap(0, 1));
    let found = error("c.stl", binary(&triangles));
    assert!(found.starts_with("c.stl: volume = -48: expected more than 0"), "{found}");
    let moved = |triangle: &mut [Point; 3]| triangle.iter_mut().for_each(|corner| corner[2] += 9.0);
    triangles.iter_mut().for_each(moved);
    assert!(error("c.stl", binary(&triangles)).contains("inside out"), "wherever it is");
}

#[test]
fn a_corner_that_is_far_beyond_all_is_refused() {
    let far = CUBE.replacen("v 1 ", "v 1e200 ", 1);
    assert_ne!(far, CUBE);
    assert!(error("c.obj", &far).contains("1e200: expected coordinates of 1000000 at most"));
}

#[test]
fn what_is_no_mesh_is_refused() {
    assert!(error("c.ply", CUBE).contains("ends in .obj or .stl"));
    assert!(error("c.obj", "v 0 0 0\n").contains("one triangle at least"));
    assert_eq!(
        error("c.obj", "v 0 0 0\nf 1 2 3\n"),
        "c.obj:2:5: f = 2: expected one of the 1 corners before this line"
    );
    assert!(error("c.obj", "v 0 0 0\nf 0 1 1\n").contains("f = 0"));
    assert!(error("c.obj", "v 0 0 0\nf 1 -2 1\n").contains("f = -2"));
    assert!(error("c.obj", "v 0 0 0\nf 1 1\n").contains("f = 2: expected three corners or more"));
    assert!(error("c.obj", "curv 0 1 2\n").starts_with("c.obj:1:1: "));
    let cut = &binary(&cube().triangles)[..500];
    assert!(error("c.stl", cut).contains("endfacet") || error("c.stl", cut).contains("expected"));
    assert!(error("c.stl", b"\0\0").contains("84 + 50 n bytes"));
    let two = "solid\nfacet normal 0 0 0\nvertex 0 0 0\nvertex 1 0 0\nendfacet\n";
    assert_eq!(error("c.stl", two), "c.stl:5:1: 2: expected three `vertex` in a facet");
    assert!(error("c.stl", "solid\nfacet\nvertex 0 0 0\n").contains("`endfacet` before the end"));
}
