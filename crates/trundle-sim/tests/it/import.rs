//! Imported glTF scenes: textures, units, and damaged files.

use proptest::prelude::*;
use std::io;
use std::path::Path;
use trundle_sim::Mesh;
use trundle_sim::import::{
    GltfOptions, ImportError, ImportFault, ImportNote, ImportedScene, UpAxis, gltf, gltf_from_bytes,
};

/// A GLB of a JSON text and a buffer.
fn glb(json: &str, binary: &[u8]) -> Vec<u8> {
    let padded = |bytes: &[u8], pad: u8| {
        let mut padded = bytes.to_vec();
        padded.resize(bytes.len().next_multiple_of(4), pad);
        padded
    };
    let (json, binary) = (padded(json.as_bytes(), b' '), padded(binary, 0));
    let word = |x: usize| (x as u32).to_le_bytes();
    let total = word(12 + 16 + json.len() + binary.len());
    let parts: [&[u8]; 9] = [
        b"glTF",
        &word(2),
        &total,
        &word(json.len()),
        b"JSON",
        &json,
        &word(binary.len()),
        b"BIN\0",
        &binary,
    ];
    parts.concat()
}

/// Four corners of the unit square (x, y), their texture coordinates, and indices of six kinds of corners.
fn square() -> Vec<u8> {
    let floats: [f32; 20] = [
        0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 1.0, 1.0, 0.0, 0.0, 1.0, 0.0, // positions
        0.0, 1.0, 1.0, 1.0, 1.0, 0.0, 0.0, 0.0, // texture coordinates
    ];
    let indices: [u16; 6] = [0, 1, 2, 0, 2, 3];
    let mut bytes: Vec<u8> = floats.iter().flat_map(|x| x.to_le_bytes()).collect();
    bytes.extend(indices.iter().flat_map(|i| i.to_le_bytes()));
    bytes
}

/// A glTF of the square: `primitive`, `node` and `rest` are further members.
fn description(primitive: &str, node: &str, rest: &str) -> String {
    format!(
        r#"{{"asset":{{"version":"2.0"}},"scene":0,"scenes":[{{"nodes":[0]}}],
        "nodes":[{{"mesh":0{node}}}],
        "meshes":[{{"name":"rug","primitives":[{{"attributes":{{"POSITION":0,"TEXCOORD_0":1}}{primitive}}}]}}],
        "accessors":[
          {{"bufferView":0,"componentType":5126,"count":4,"type":"VEC3","min":[0,0,0],"max":[1,1,0]}},
          {{"bufferView":1,"componentType":5126,"count":4,"type":"VEC2"}},
          {{"bufferView":2,"componentType":5123,"count":6,"type":"SCALAR"}}],
        "bufferViews":[{{"buffer":0,"byteLength":48}},{{"buffer":0,"byteOffset":48,"byteLength":32}},
          {{"buffer":0,"byteOffset":80,"byteLength":12}}],
        "buffers":[{{"byteLength":92}}]{rest}}}"#
    )
}

const INDEXED: &str = r#","indices":2"#;

fn nowhere(_: &str) -> io::Result<Vec<u8>> {
    Err(io::ErrorKind::NotFound.into())
}

fn read(json: &str, options: &GltfOptions) -> Result<Mesh, ImportError> {
    scene(json, options).map(|scene| scene.mesh)
}

fn scene(json: &str, options: &GltfOptions) -> Result<ImportedScene, ImportError> {
    gltf_from_bytes("rug.glb", &glb(json, &square()), options, &nowhere)
}

fn message(json: &str) -> String {
    read(json, &GltfOptions::default()).unwrap_err().to_string()
}

#[test]
fn extras_of_any_kind_are_left_alone() {
    for extras in ["[1]", "\"x\"", "3", "{\"a\":[1]}", "null"] {
        let json = description(INDEXED, &format!(r#","extras":{extras}"#), &format!(r#","extras":{extras}"#));
        let mesh = read(&json, &GltfOptions::default());
        assert_eq!(mesh.map(|mesh| mesh.triangles().len()), Ok(2), "{extras}");
    }
}

#[test]
fn a_texture_of_an_image_that_is_not_there_is_grey() {
    let material = r#","indices":2,"material":0"#;
    for images in [
        r#""images":[{"bufferView":99,"mimeType":"image/png"}],"textures":[{"source":0}]"#,
        r#""textures":[{"source":7}]"#,
    ] {
        let rest = format!(
            r#","materials":[{{"pbrMetallicRoughness":{{"baseColorTexture":{{"index":0}}}}}}],{images}"#
        );
        let scene = scene(&description(material, "", &rest), &GltfOptions::default()).unwrap();
        let lost = |note: &ImportNote| matches!(note, ImportNote::LostTextures { .. });
        assert!(scene.notes.iter().any(lost), "{images}: {:?}", scene.notes);
    }
}

#[test]
fn broken_json_is_named_in_plain_words() {
    let whole = description(INDEXED, "", "");
    let cut = gltf_from_bytes("rug.gltf", &whole.as_bytes()[..300], &GltfOptions::default(), &nowhere);
    let cut = cut.unwrap_err().to_string();
    assert!(cut.contains("in the middle: the file is cut short"), "{cut}");
    let broken = message(&whole.replace("\"scene\":0", "\"scene\"=0"));
    assert!(broken.contains("its JSON is broken at line 1"), "{broken}");
    let nameless = message(&whole.replace("\"asset\"", "\"assets\""));
    assert!(nameless.contains("`asset` is missing"), "{nameless}");
}

fn corner(mesh: &Mesh, i: usize) -> [f32; 3] {
    mesh.positions()[i].map(|x| (x * 1e4).round() / 1e4)
}

#[test]
fn y_up_is_turned_and_z_up_is_not() {
    let standard = read(&description(INDEXED, "", ""), &GltfOptions::default()).unwrap();
    assert_eq!(standard.triangles().len(), 2);
    assert_eq!(corner(&standard, 2), [1.0, 0.0, 1.0]);
    let z_up = read(&description(INDEXED, "", ""), &GltfOptions::z_up()).unwrap();
    assert_eq!(corner(&z_up, 2), [1.0, 1.0, 0.0]);
    assert_eq!(z_up.uvs()[2], [1.0, 0.0]);
    let mut centimetres = GltfOptions::default();
    centimetres.up = UpAxis::Z;
    centimetres.scale = 0.01;
    assert_eq!(corner(&read(&description(INDEXED, "", ""), &centimetres).unwrap(), 2), [0.01, 0.01, 0.0]);
}

#[test]
fn strips_fans_and_plain_corners_make_the_same_square() {
    let area = |primitive: &str| -> f32 {
        let mesh = read(&description(primitive, "", ""), &GltfOptions::z_up()).unwrap();
        let double =
            |[a, b, c]: [[f32; 3]; 3]| ((b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])).abs();
        (0..mesh.triangles().len()).map(|i| double(mesh.corners(i)) / 2.0).sum()
    };
    assert_eq!(area(INDEXED), 1.0);
    assert_eq!(area(r#","mode":6"#), 1.0, "a fan without indices");
    assert_eq!(area(""), 0.5, "a list without indices: one whole triangle");
    assert_eq!(area(r#","mode":5"#), 1.0, "a strip, corners crossed: two halves that overlap");
}

#[test]
fn transforms_of_nodes_multiply() {
    let node = r#","translation":[1,2,3],"rotation":[0,0,0.70710678,0.70710678],"scale":[2,1,1]"#;
    let mesh = read(&description(INDEXED, node, ""), &as_it_lies()).unwrap();
    assert_eq!(corner(&mesh, 1), [1.0, 4.0, 3.0]);
    let tree = description(INDEXED, "", "").replace(
        r#""nodes":[{"mesh":0}]"#,
        r#""nodes":[{"translation":[5,0,0],"children":[1]},{"matrix":[1,0,0,0,0,1,0,0,0,0,1,0,0,0,7,1],"mesh":0}]"#,
    );
    assert_eq!(corner(&read(&tree, &as_it_lies()).unwrap(), 1), [6.0, 0.0, 7.0]);
    let ring = tree.replace(r#","mesh":0}]"#, r#","mesh":0,"children":[0]}]"#);
    assert!(message(&ring).contains("node 0 is reached twice"), "{}", message(&ring));
}

/// z up with a given floor height: no translation.
fn as_it_lies() -> GltfOptions {
    let mut options = GltfOptions::z_up();
    options.floor = Some(0.0);
    options
}

/// Materials with a red factor and the image that `image` describes.
fn textured(image: &str) -> String {
    let rest = format!(
        r#","materials":[{{"name":"wool","pbrMetallicRoughness":{{"baseColorFactor":[1,0.5,0,1],"baseColorTexture":{{"index":0}}}}}}],
        "textures":[{{"source":0}}],"images":[{image}]"#
    );
    description(r#","indices":2,"material":0"#, "", &rest)
}

fn checker() -> Vec<u8> {
    let image = image::RgbImage::from_fn(4, 2, |x, y| image::Rgb([(x * 60) as u8, (y * 200) as u8, 7]));
    let mut bytes = io::Cursor::new(Vec::new());
    image.write_to(&mut bytes, image::ImageFormat::Png).unwrap();
    bytes.into_inner()
}

#[test]
fn textures_come_from_files_and_from_within() {
    let resolve = |name: &str| if name == "a b.png" { Ok(checker()) } else { nowhere(name) };
    let bytes = glb(&textured(r#"{"uri":"a%20b.png"}"#), &square());
    let mesh = gltf_from_bytes("rug.glb", &bytes, &GltfOptions::default(), &resolve).unwrap().mesh;
    let material = &mesh.materials()[0];
    assert_eq!((material.name.as_str(), material.color), ("wool", [255, 188, 0]));
    assert_eq!(material.texture.as_ref().unwrap()[(3, 1)], [180, 200, 7]);
    use base64::Engine as _;
    let coded = base64::engine::general_purpose::STANDARD.encode(checker());
    let within = textured(&format!(r#"{{"uri":"data:image/png;base64,{coded}"}}"#));
    assert_eq!(read(&within, &GltfOptions::default()).unwrap(), mesh);
}

#[test]
fn errors_name_the_file_and_the_item() {
    let points = message(&description(r#","mode":0"#, "", ""));
    assert_eq!(points, "rug.glb: has no triangles in its scene");
    let draco = message(&description(INDEXED, "", r#","extensionsRequired":["KHR_draco_mesh_compression"]"#));
    assert!(draco.contains("needs the glTF extension KHR_draco_mesh_compression"), "{draco}");
    let wild = message(&description(r#","indices":7"#, "", ""));
    assert!(wild.contains("meshes[0].primitives[0].indices"), "{wild}");
    let unbuffered = description(INDEXED, "", "").replace(r#""POSITION":0"#, r#""POSITION":9"#);
    let unbuffered = message(&unbuffered);
    assert!(
        unbuffered.contains("meshes[0].primitives[0].attributes: accessors[9] is meant, but there are 3")
    );
    let huge = message(&description(INDEXED, r#","scale":[1e9,1,1]"#, ""));
    assert!(huge.contains("position 1 of mesh 0 ('rug') is (1000000000, 0, 0) m"), "{huge}");
    let text = gltf_from_bytes("plan.gltf", b"a plan", &GltfOptions::default(), &nowhere).unwrap_err();
    assert!(text.to_string().starts_with("plan.gltf: is not glTF 2.0: "), "{text}");
    let absent = gltf(Path::new("/nowhere/house.glb"), &GltfOptions::default()).unwrap_err();
    assert!(matches!(absent.fault, ImportFault::Unreadable { .. }) && absent.file == "/nowhere/house.glb");
}

#[test]
fn textures_that_cannot_be_read_are_grey_and_noted_once() {
    let lost = |json: &str| {
        let ImportedScene { mesh, notes } = scene(json, &GltfOptions::default()).unwrap();
        let material = &mesh.materials()[0];
        assert_eq!((material.color, material.texture.is_some()), ([150, 110, 0], false));
        assert_eq!(notes.len(), 1, "{notes:?}");
        notes[0].to_string()
    };
    let begin = "textures that cannot be read are grey: 1: ";
    let missing = lost(&textured(r#"{"uri":"wool.png"}"#));
    assert_eq!(missing, format!("{begin}image 0 ('wool.png'): it does not exist"));
    let broken = lost(&textured(r#"{"uri":"data:image/png;base64,AAAA","name":"wool"}"#));
    assert!(broken.starts_with(&format!("{begin}image 0 ('wool'): cannot be decoded")), "{broken}");
    let webp = lost(&textured(r#"{"uri":"data:image/webp;base64,UklGRhIAAABXRUJQVlA4TAYAAAAvQWxvAGs="}"#));
    assert_eq!(webp, format!("{begin}image 0: is WebP, expected PNG or JPEG"));
    let sourceless = textured(r#"{"uri":"wool.png"}"#).replace(
        r#""textures":[{"source":0}]"#,
        r#""textures":[{"extensions":{"EXT_texture_webp":{"source":0}}}],"extensionsUsed":["EXT_texture_webp"]"#,
    );
    assert_eq!(lost(&sourceless), format!("{begin}a texture names no PNG or JPEG image"));
    let many = ImportNote::LostTextures { reasons: vec!["a".into(), "b".into(), "c".into(), "d".into()] };
    assert_eq!(many.to_string(), "textures that cannot be read are grey: 4: a; b; c; ...");
}

/// The square with a colour at each corner, in the place of its texture coordinates: `kind` of the accessor and its bytes.
fn colored(kind: &str, bytes: &[u8], rest: &str) -> ImportedScene {
    let mut buffer = square();
    buffer[48..48 + bytes.len()].copy_from_slice(bytes);
    let json = description(INDEXED, "", rest)
        .replace("TEXCOORD_0", "COLOR_0")
        .replace(r#"{"bufferView":1,"componentType":5126,"count":4,"type":"VEC2"}"#, kind);
    gltf_from_bytes("rug.glb", &glb(&json, &buffer), &GltfOptions::default(), &nowhere).unwrap()
}

#[test]
fn colours_of_vertices_are_drawn() {
    let kind = r#"{"bufferView":1,"componentType":5121,"normalized":true,"count":4,"type":"VEC4"}"#;
    let corners = [[255, 0, 0, 255], [0, 255, 0, 255], [0, 0, 255, 255], [255, 255, 255, 255]];
    let ImportedScene { mesh, notes } = colored(kind, corners.as_flattened(), "");
    assert!(notes.is_empty(), "{notes:?}");
    let picture = mesh.materials()[0].texture.as_ref().unwrap();
    let seen = |corner: u32| {
        let [u, v] = mesh.uvs()[corner as usize];
        picture[((u * picture.width() as f32) as usize, (v * picture.height() as f32) as usize)]
    };
    let of_triangle = |i: usize| mesh.triangles()[i].corners.map(seen);
    assert_eq!(of_triangle(0), [[255, 0, 0], [0, 255, 0], [0, 0, 255]]);
    assert_eq!(of_triangle(1), [[255, 0, 0], [0, 0, 255], [255; 3]]);
    let white = colored(kind, &[255; 16], "").mesh;
    assert_eq!((white.materials()[0].texture.is_none(), white.positions().len()), (true, 4));
}

#[test]
fn a_floor_elsewhere_comes_to_lie_at_zero() {
    let flat = |node: &str, options: GltfOptions| scene(&description(INDEXED, node, ""), &options).unwrap();
    let below = r#","translation":[0,0,-10]"#;
    let ImportedScene { mesh, notes } = flat(below, GltfOptions::z_up());
    assert_eq!(corner(&mesh, 2), [1.0, 1.0, 0.0]);
    assert_eq!(notes, [ImportNote::FloorMoved { height_m: -10.0 }]);
    let mut gltf = GltfOptions::z_up();
    gltf.floor = Some(-12.0);
    let named = flat(below, gltf);
    assert_eq!((corner(&named.mesh, 2), named.notes.len()), ([1.0, 1.0, 2.0], 0));
    let near = flat(r#","translation":[0,0,0.1]"#, GltfOptions::z_up());
    assert_eq!((corner(&near.mesh, 2), near.notes.len()), ([1.0, 1.0, 0.1], 0), "left where it is");
    let wall =
        scene(&description(INDEXED, r#","translation":[0,5,0]"#, ""), &GltfOptions::default()).unwrap();
    assert_eq!(corner(&wall.mesh, 0), [0.0, 0.0, 5.0], "a wall is not floor");
}

#[test]
fn a_scene_of_another_unit_is_noted() {
    let notes = |scale: f64| {
        let mut options = GltfOptions::default();
        options.scale = scale;
        scene(&description(INDEXED, "", ""), &options).unwrap().notes
    };
    assert_eq!(notes(2.0), []);
    assert!(notes(250.0)[0].to_string().contains("--scale 0.01"), "{:?}", notes(250.0));
    assert!(notes(0.01)[0].to_string().contains("is the scale right?"));
}

#[test]
fn bad_numbers_are_named() {
    let with = |at: usize, bytes: &[u8]| {
        let mut buffer = square();
        buffer[at..at + bytes.len()].copy_from_slice(bytes);
        let file = glb(&description(INDEXED, "", ""), &buffer);
        gltf_from_bytes("rug.glb", &file, &GltfOptions::default(), &nowhere).unwrap_err().to_string()
    };
    let nan = with(16, &f32::NAN.to_le_bytes());
    assert!(nan.starts_with("rug.glb: accessor 0 is [1.0, NaN, 0.0] at element 1"), "{nan}");
    let index = with(84, &900_u16.to_le_bytes());
    assert!(index.starts_with("rug.glb: index 2 of accessor 2 is 900, expected below 4"), "{index}");
    let claim = description(INDEXED, "", "").replace(r#""count":6"#, r#""count":4000000000"#);
    assert!(message(&claim).contains("accessor 2 is 4000000000 elements long"), "{}", message(&claim));
    let short = description(INDEXED, "", "").replace(r#""count":6"#, r#""count":7"#);
    assert!(message(&short).contains("cut short"), "{}", message(&short));
}

#[test]
fn a_view_longer_than_its_accessor_is_read_to_the_accessors_end() {
    let whole = description(INDEXED, "", "");
    let json = whole.replace(r#""byteOffset":80,"byteLength":12"#, r#""byteOffset":80,"byteLength":24"#);
    let options = GltfOptions::default();
    assert_eq!(read(&json, &options).unwrap(), read(&whole, &options).unwrap());
    let beyond = whole.replace(r#""byteOffset":80,"#, r#""byteOffset":96,"#);
    assert!(message(&beyond).contains("cut short"), "{}", message(&beyond));
}

#[test]
fn a_file_cut_short_is_reported() {
    let whole = glb(&description(INDEXED, "", ""), &square());
    let cut = gltf_from_bytes("rug.glb", &whole[..whole.len() - 40], &GltfOptions::default(), &nowhere);
    let message = cut.unwrap_err().to_string();
    assert!(message.contains(&format!("{} bytes, expected {}", whole.len() - 40, whole.len())), "{message}");
}

/// A file with all supported content.
fn rich_file() -> Vec<u8> {
    let json = textured(r#"{"bufferView":3,"mimeType":"image/png"}"#)
        .replace(r#""byteLength":12}]"#, r#""byteLength":12},{"buffer":0,"byteOffset":92,"byteLength":SIZE}]"#)
        .replace(r#""buffers":[{"byteLength":92}]"#, r#""buffers":[{"byteLength":TOTAL}]"#)
        .replace(
            r#""max":[1,1,0]}"#,
            r#""max":[1,1,0],"sparse":{"count":2,"indices":{"bufferView":2,"componentType":5123},"values":{"bufferView":0}}}"#,
        );
    let png = checker();
    let json = json.replace("SIZE", &png.len().to_string()).replace("TOTAL", &(92 + png.len()).to_string());
    glb(&json, &[square(), png].concat())
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 2000, ..ProptestConfig::default() })]
    #[test]
    fn broken_files_never_panic(
        flips in prop::collection::vec((any::<prop::sample::Index>(), 0..8_u8), 0..6),
        cut in prop::option::of(any::<prop::sample::Index>()),
    ) {
        let mut bytes = rich_file();
        for (at, bit) in flips {
            let at = at.index(bytes.len());
            bytes[at] ^= 1 << bit;
        }
        if let Some(cut) = cut {
            bytes.truncate(cut.index(bytes.len()));
        }
        let _ = gltf_from_bytes("broken.glb", &bytes, &GltfOptions::default(), &nowhere);
    }
}

#[test]
fn the_rich_file_is_whole() {
    let mesh = gltf_from_bytes("rich.glb", &rich_file(), &GltfOptions::z_up(), &nowhere).unwrap().mesh;
    assert_eq!(mesh.triangles().len(), 2);
    assert_eq!(mesh.materials()[0].texture.as_ref().unwrap()[(1, 0)], [60, 0, 7]);
}

#[test]
fn small_house_is_19_by_11_metres_and_stands_on_its_floor() {
    let Some(path) = crate::shared_data("scenes/small_house.glb") else { return };
    let ImportedScene { mesh, notes } = gltf(&path, &GltfOptions::z_up()).unwrap();
    assert_eq!(notes, []);
    assert!((145_000..=145_844).contains(&mesh.triangles().len()), "{}", mesh.triangles().len());
    assert_eq!(mesh.materials().iter().filter(|m| m.texture.is_some()).count(), 64);
    let extent = |k: usize| {
        let of = |pick: fn(f32, f32) -> f32| mesh.positions().iter().map(|p| p[k]).reduce(pick).unwrap();
        (of(f32::min), of(f32::max))
    };
    let ((x0, x1), (y0, y1), (z0, _)) = (extent(0), extent(1), extent(2));
    assert!((18.0..20.0).contains(&(x1 - x0)) && (10.0..12.0).contains(&(y1 - y0)), "{x0} {x1} {y0} {y1}");
    assert!(z0.abs() < 0.2, "{z0}");
}
