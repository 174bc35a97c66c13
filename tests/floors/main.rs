//! Checks the order of the layers: which files may use which (CONTRIBUTING.md).

mod house;
mod tokens;

use std::collections::BTreeSet;
use std::fs;
use std::path::PathBuf;

use house::House;

/// The layers from the bottom up; a layer uses only layers before it.
const ROOMS: [&str; 20] = [
    "text",
    "serial",
    "error",
    "check",
    "numeric",
    "diagnosis",
    "view",
    "light",
    "shape",
    "lessons",
    "pose",
    "calibration",
    "options",
    "reason",
    "report",
    "picture",
    "estimator",
    "scenes",
    "tutorial",
    "wasm",
];
/// Layers that `scenes` may use: scenes with a known answer are made with the code of the inputs and with random numbers, not with
/// the method.
const BELOW_SCENES: [&str; 8] = ["text", "error", "check", "numeric", "view", "light", "pose", "calibration"];
/// Crates that only the bindings may name.
const BINDINGS: [&str; 5] = ["wasm_bindgen", "serde_wasm_bindgen", "js_sys", "web_sys", "console_error_panic_hook"];

fn source() -> PathBuf {
    PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("src")
}

fn may_look(from: &str, into: &str) -> bool {
    let floor = |room: &str| ROOMS.iter().position(|known| *known == room);
    let is_below = matches!((floor(from), floor(into)), (Some(from), Some(into)) if into < from);
    is_below && (from != "scenes" || BELOW_SCENES.contains(&into))
}

/// The layers in the table of lib.rs: names in the first cell of a row, before any bracket and up to a slash.
fn table(library: &str) -> Vec<String> {
    let cells = library.lines().filter_map(|line| line.strip_prefix("// |")?.split(['|', '(']).next());
    let names = cells.flat_map(|cell| cell.split('`').skip(1).step_by(2));
    let mut rooms: Vec<String> = names.filter_map(|name| Some(name.split('/').next()?.to_string())).collect();
    rooms.dedup();
    rooms
}

#[test]
fn a_room_looks_only_into_rooms_before_it() {
    let house = House::read(&source());
    assert!(house.looks().len() > house.rooms().len(), "the sources are not read");
    let forbidden = house.forbidden(may_look);
    assert!(forbidden.is_empty(), "{} looks upwards:\n{}", forbidden.len(), forbidden.join("\n"));
}

#[test]
fn no_two_files_of_a_room_import_each_other() {
    let circles = House::read(&source()).circles();
    assert!(circles.is_empty(), "{} circles:\n{}", circles.len(), circles.join("\n"));
}

#[test]
fn no_two_folders_of_a_room_import_each_other() {
    let circles = House::read(&source()).folder_circles();
    assert!(circles.is_empty(), "{} circles:\n{}", circles.len(), circles.join("\n"));
}

/// The published package of the library has neither of these two folders, so a missing one is skipped.
#[test]
fn no_two_files_beside_the_library_import_each_other() {
    for (folder, fewest) in [("files/src", 30), ("cli/src", 5)] {
        let source = PathBuf::from(env!("CARGO_MANIFEST_DIR")).join(folder);
        if !source.exists() {
            continue;
        }
        let house = House::read(&source);
        assert!(house.looks().len() > fewest, "the sources of {folder} are not read");
        let circles = house.circles();
        assert!(circles.is_empty(), "{} circles:\n{}", circles.len(), circles.join("\n"));
    }
}

#[test]
fn only_the_bindings_know_javascript() {
    let house = House::read(&source());
    let bound = house.bound_to(&BINDINGS);
    assert!(bound.is_empty(), "{bound:?}");
}

#[test]
fn the_table_of_the_library_lists_every_room_in_order() {
    let house = House::read(&source());
    let there: Vec<&str> = ROOMS.into_iter().filter(|room| house.rooms().contains(room)).collect();
    assert_eq!(there.iter().copied().collect::<BTreeSet<_>>(), house.rooms(), "ROOMS lacks one");
    assert_eq!(table(&fs::read_to_string(source().join("lib.rs")).unwrap()), there);
}

mod checker {
    use super::*;
    use crate::tokens::{tokens, without_tests};

    fn upwards(files: &[(&str, &str)]) -> Vec<String> {
        House::of(files.iter().copied()).forbidden(may_look)
    }

    fn circles(files: &[(&str, &str)]) -> Vec<String> {
        House::of(files.iter().copied()).circles()
    }

    #[test]
    fn a_look_upwards_is_found_however_it_is_written() {
        let pose = ("pose.rs", "pub struct Pose; pub fn made() -> Pose { Pose }");
        let library = ("lib.rs", "mod light; mod pose; pub use pose::Pose;");
        for light in [
            "use crate::pose::Pose; fn f() {}",
            "use crate::{error::Error, pose::{self, Pose as Other}}; fn f() {}",
            "fn f() -> u32 { crate::pose::made() }",
            "fn f() { let x = \"// \\\"\"; let lifetime: &'static str = x; super::pose::made() }",
            "use crate::Pose; fn f() {}",
            "mod inner { use super::super::pose::Pose; fn f() {} }",
            "use crate::pose::*; fn f() {}",
            "macro_rules! m { () => { $crate::pose::made() } }",
            "#[cfg(target_arch = \"wasm32\")] use crate::pose::Pose; fn f() {}",
        ] {
            assert_eq!(upwards(&[library, pose, ("light.rs", light)]), ["light.rs -> pose.rs"], "{light}");
        }
        for light in [
            "// crate::pose::made()\n/* crate::pose /* x */ crate::pose */ fn f() { \"crate::pose::made()\"; }",
            "fn f() { r#\"crate::pose::\" crate::pose\"#; b\"crate::pose\"; '\"'; '\\''; }",
            "fn f() {}\n#[cfg(test)]\nmod tests { use crate::pose::Pose; fn g() { { made() } } }",
            "#[cfg(test)]\n#[inline]\nuse crate::pose::{Pose, made};\nfn f() {}",
            "fn pose() { other::pose::made() }",
        ] {
            assert!(upwards(&[library, pose, ("light.rs", light)]).is_empty(), "{light}");
        }
        assert!(upwards(&[library, ("pose.rs", "use crate::light::f;"), ("light.rs", "pub fn f() {}")]).is_empty());
    }

    #[test]
    fn scenes_stand_on_the_inputs_alone() {
        let scene = |text| {
            upwards(&[("lib.rs", ""), ("scenes/mod.rs", text), ("shape.rs", "fn f() {}"), ("view.rs", "fn f() {}")])
        };
        assert_eq!(scene("fn g() { crate::shape::f() }"), ["scenes/mod.rs -> shape.rs"]);
        assert!(scene("fn g() { crate::view::f() }").is_empty());
    }

    #[test]
    fn files_that_import_each_other_are_found_directly_and_by_way_of_others() {
        let library = ("lib.rs", "mod pose;");
        let rooms = ("pose/mod.rs", "mod a; mod b; mod c; pub use a::A; pub(crate) use b::{B, C};");
        let [two, three] =
            [("pose/b.rs", "use super::A; pub struct B;"), ("pose/b.rs", "use super::c::C; pub struct B;")];
        let a = ("pose/a.rs", "use crate::pose::B; pub struct A;");
        let c = ("pose/c.rs", "use super::super::pose::A; pub struct C;");
        assert_eq!(circles(&[library, rooms, a, two, c]), ["pose/a.rs -> pose/b.rs -> pose/a.rs"]);
        assert_eq!(circles(&[library, rooms, a, three, c]), ["pose/a.rs -> pose/b.rs -> pose/c.rs -> pose/a.rs"]);
        assert!(circles(&[library, rooms, a, ("pose/b.rs", "pub struct B;"), c]).is_empty());
        // An alias of the module leads to its file as well.
        let a = ("pose/a.rs", "use super as room; pub struct A(room::b::B);");
        assert_eq!(circles(&[library, rooms, a, two, c]).len(), 1);
    }

    #[test]
    fn folders_that_import_each_other_are_found_though_no_two_files_do() {
        let library = ("lib.rs", "mod pose;");
        let modules = ("pose/mod.rs", "mod a; mod b; pub struct Pose;");
        let [a, b] = [("pose/a/mod.rs", "mod x; mod y;"), ("pose/b/mod.rs", "mod z;")];
        let y = ("pose/a/y.rs", "use crate::pose::Pose; pub struct Y;");
        let z = ("pose/b/z.rs", "use crate::pose::a::y::Y; pub struct Z;");
        let folder_circles = |x| {
            let files = [library, modules, a, b, y, z, ("pose/a/x.rs", x)];
            assert!(circles(&files).is_empty());
            House::of(files).folder_circles()
        };
        assert_eq!(folder_circles("use crate::pose::b::z::Z; fn f() {}"), ["pose/a/ -> pose/b/ -> pose/a/"]);
        assert!(folder_circles("use crate::pose::Pose; fn f() {}").is_empty());
    }

    #[test]
    fn a_module_file_counts_where_it_has_code_of_its_own() {
        let library = ("lib.rs", "mod pose;");
        let child = ("pose/a.rs", "use super::Pose; pub struct A;");
        let circle = ["pose/a.rs -> pose/mod.rs -> pose/a.rs"];
        for code in [
            "mod a; use a::A; pub struct Pose(A);",
            "mod a; pub struct Pose(a::A);",
            "mod a; pub use a::A; pub struct Pose(A);",
        ] {
            assert_eq!(circles(&[library, ("pose/mod.rs", code), child]), circle, "{code}");
        }
        assert!(circles(&[library, ("pose/mod.rs", "mod a; pub use a::A; pub struct Pose;"), child]).is_empty());
        assert!(circles(&[library, ("pose/mod.rs", "mod a; use a::A;"), ("pose/a.rs", "pub struct A;")]).is_empty());
        let inner = ("pose/a.rs", "pub struct A; mod inner { use super::A; fn f() {} }");
        assert!(circles(&[library, ("pose/mod.rs", "mod a; pub struct Pose(a::A);"), inner]).is_empty());
    }

    #[test]
    fn javascript_is_found_outside_of_the_bindings() {
        let files =
            [("wasm/mod.rs", "use js_sys::Array;"), ("view.rs", "fn f(x: js_sys::Array) {}"), ("pose.rs", "// js_sys")];
        assert_eq!(House::of(files).bound_to(&BINDINGS), ["view.rs"]);
    }

    #[test]
    fn a_table_is_read_row_by_row() {
        let library = "//! | `image` | the documentation has tables of its own |\n// | room | holds |\n// |---|---|\n\
            // | `text`, `error` | `x` |\n// | [`view`](View) | |\n// | `shape/a` ([`A`]) | |\n// | `shape/b` | |\nmod x;";
        assert_eq!(table(library), ["text", "error", "view", "shape"]);
    }

    #[test]
    fn words_are_told_from_strings_and_lifetimes() {
        let found = tokens("fn f<'a>(x: &'a str) { br#\"q \"# ; 'x' ; b'y' ; r }");
        let expected = ["fn", "f", "<", ">", "(", "x", ":", "&", "str", ")", "{", ";", ";", "b", ";", "r", "}"];
        assert_eq!(found, expected);
        assert_eq!(without_tests(&tokens("#[cfg(test)] fn a(x: [u8; 2]) {} b")), ["b"]);
    }
}
