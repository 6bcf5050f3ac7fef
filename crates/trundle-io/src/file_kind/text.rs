//! Recognition of text files by their first lines.

use super::FileKind;
use crate::files::with_line_ends;
use std::borrow::Cow;

/// First words of the lines of a CARMEN log.
const CARMEN_WORDS: [&str; 12] = [
    "FLASER",
    "RLASER",
    "ODOM",
    "PARAM",
    "ROBOTLASER1",
    "ROBOTLASER2",
    "RAWLASER1",
    "RAWLASER2",
    "RAWLASER3",
    "RAWLASER4",
    "TRUEPOS",
    "SYNC",
];

/// Keys of a map's YAML file, two of which give it away.
const MAP_KEYS: [&str; 6] = ["image", "resolution", "origin", "negate", "occupied_thresh", "free_thresh"];

/// Number of lines that are inspected. A kind whose marks come later is not recognised. Source: ours.
const INSPECTED_LINES: usize = 60;

/// Number of bytes of a text with one that is not UTF-8, on average. With more of them a file is binary. Source: ours.
const MIN_BYTES_A_FOREIGN_ONE: usize = 30;

/// The kind of a file of text, else `Binary`.
pub(super) fn kind_of(head: &[u8]) -> FileKind {
    let Some(text) = as_text(head) else { return FileKind::Binary };
    let text = with_line_ends(text.trim_start_matches('\u{feff}'));
    let text = text.as_ref();
    let lines: Vec<&str> = text.lines().map(str::trim).take(INSPECTED_LINES).collect();
    let content: Vec<&str> =
        lines.iter().copied().filter(|line| !line.is_empty() && !line.starts_with('#')).collect();
    match text.trim_start().chars().next() {
        None => FileKind::Empty,
        Some('{') => of_json(text),
        Some('<') => of_xml(text),
        Some(_) => of_yaml(&lines)
            .or_else(|| of_words(&content))
            .or_else(|| of_toml(&content))
            .or_else(|| is_json_list(text).then_some(FileKind::Json))
            .or_else(|| of_numbers(text, &content))
            .or_else(|| is_yaml(&content).then_some(FileKind::Yaml))
            .unwrap_or(FileKind::Text),
    }
}

/// The text of the bytes, if they are text; the last character may be truncated. A few bytes may be of another encoding (a comment in
/// Latin-1): the reader of the file then names their line.
fn as_text(head: &[u8]) -> Option<Cow<'_, str>> {
    let is_control = |byte: &u8| *byte < b' ' && !byte.is_ascii_whitespace();
    let text = String::from_utf8_lossy(head);
    let foreign = text.chars().filter(|c| *c == char::REPLACEMENT_CHARACTER).count();
    let is_text = foreign <= 1 + head.len() / MIN_BYTES_A_FOREIGN_ONE && !head.iter().any(is_control);
    is_text.then_some(text)
}

fn of_json(text: &str) -> FileKind {
    let has = |key: &str| text.contains(&format!("\"{key}\""));
    if has("FeatureCollection") {
        FileKind::GeoJson
    } else if has("asset") && (has("meshes") || has("scenes") || has("buffers") || has("version")) {
        FileKind::Gltf
    } else if has("intrinsic_matrix") {
        FileKind::Open3dCamera
    } else {
        FileKind::Json
    }
}

fn of_xml(text: &str) -> FileKind {
    if text.contains("<COLLADA") {
        FileKind::Dae
    } else if text.contains("<sdf") || text.contains("<robot") {
        FileKind::OtherMesh
    } else {
        FileKind::Xml
    }
}

/// Kinds of YAML files by their keys, at any depth.
fn of_yaml(lines: &[&str]) -> Option<FileKind> {
    let has = |key: &str| {
        let is_it = |line: &&str| {
            let rest = line.strip_prefix(key).or_else(|| line.strip_prefix(&format!("\"{key}\"")[..]));
            rest.is_some_and(|rest| rest.trim_start().starts_with(':'))
        };
        lines.iter().any(is_it)
    };
    let any = |keys: &[&str]| keys.iter().any(|key| has(key));
    if has("rosbag2_bagfile_information") {
        Some(FileKind::RosBagMetadata)
    } else if lines.iter().any(|line| line.starts_with("Camera.") || line.starts_with("Camera1.")) {
        Some(FileKind::OrbSlamYaml)
    } else if any(&["cam0", "camera_model", "distortion_coeffs", "sensor_type"]) {
        Some(FileKind::KalibrCameraYaml)
    } else if any(&["camera_matrix", "projection_matrix", "distortion_model", "K", "k"])
        && any(&["image_width", "image_height", "width", "height", "camera_matrix"])
    {
        Some(FileKind::RosCameraYaml)
    } else if has("Camera") && any(&["fx", "fy", "cx", "cy"]) {
        Some(FileKind::StellaVslamYaml)
    } else if MAP_KEYS.iter().filter(|key| has(key)).count() > 1 {
        Some(FileKind::MapYaml)
    } else {
        None
    }
}

fn is_yaml(content: &[&str]) -> bool {
    let is_key = |line: &str| line.split_once(':').is_some_and(|(key, _)| is_bare_key(key.trim()));
    content.first().is_some_and(|line| *line == "---" || line.starts_with("%YAML") || is_key(line))
}

/// Kinds by the first words of their lines.
fn of_words(content: &[&str]) -> Option<FileKind> {
    let first_words = || content.iter().filter_map(|line| line.split_whitespace().next());
    if first_words().any(|word| CARMEN_WORDS.contains(&word)) {
        return Some(FileKind::CarmenLog);
    }
    let first = content.first()?;
    if first.starts_with("trundle-corridors") {
        return Some(FileKind::CorridorProblems);
    }
    if first.starts_with("solid") && content.iter().any(|line| line.starts_with("facet")) {
        return Some(FileKind::Stl);
    }
    let is_vertex =
        |line: &&str| line.strip_prefix("v ").is_some_and(|rest| numbers(rest).is_some_and(|n| n >= 3));
    content.iter().any(is_vertex).then_some(FileKind::Obj)
}

/// TOML: its first line is a table or `key = value`.
fn of_toml(content: &[&str]) -> Option<FileKind> {
    let first = content.first()?;
    let is_table = first.split('#').next().is_some_and(|head| is_table_head(head.trim_end()));
    let is_key =
        |line: &str| line.split_once('=').is_some_and(|(key, _)| is_bare_key(key.trim().trim_matches('"')));
    if !is_table && !is_key(first) {
        return None;
    }
    let has = |key: &str| {
        content.iter().any(|line| line.split_once('=').is_some_and(|(name, _)| name.trim() == key))
    };
    Some(if has("fx") && has("fy") { FileKind::CameraToml } else { FileKind::Toml })
}

/// `[NAME]`, or `[[NAME]]`; a name in quotation marks may be any text.
fn is_table_head(line: &str) -> bool {
    let inner = line.strip_prefix('[').and_then(|line| line.strip_suffix(']'));
    let list = inner.and_then(|line| line.strip_prefix('[')?.strip_suffix(']'));
    let Some(name) = list.or(inner).map(str::trim) else { return false };
    let quoted = name.strip_prefix('"').and_then(|name| name.strip_suffix('"'));
    quoted.map_or_else(|| is_bare_key(&name.replace('"', "")), |name| !name.contains('"'))
}

/// A list of JSON, by its first item.
fn is_json_list(text: &str) -> bool {
    let Some(items) = text.trim_start().strip_prefix('[').map(str::trim_start) else { return false };
    let item = items.split([',', ']', '\n']).next().unwrap_or_default().trim();
    item.parse::<f64>().is_ok() || items.starts_with(['"', '{', '[', ']'])
}

fn is_bare_key(key: &str) -> bool {
    !key.is_empty()
        && key.chars().all(|c| c.is_alphanumeric() || "_-. ".contains(c))
        && key.parse::<f64>().is_err()
}

/// Kinds of number tables by their number of columns; the first line may be a header.
fn of_numbers(text: &str, content: &[&str]) -> Option<FileKind> {
    if is_dbow2(content) {
        return Some(FileKind::Dbow2Vocabulary);
    }
    let rows = || content.iter().take(2);
    let columns = rows().find_map(|line| numbers(line));
    let is_image = |line: &&&str| {
        let mut fields =
            line.split(|c: char| c.is_whitespace() || c == ',').filter(|field| !field.is_empty());
        let stamp = fields.next().is_some_and(|field| field.parse::<f64>().is_ok());
        let is_name = |name: &str| {
            [".png", ".jpg", ".tif", ".pgm", ".exr", ".jpeg", ".tiff"].iter().any(|end| name.ends_with(end))
        };
        stamp && fields.any(|field| is_name(&field.to_ascii_lowercase()))
    };
    if rows().any(|line| is_image(&line)) {
        return Some(FileKind::ImageList);
    }
    let is_csv = content.first().is_some_and(|line| line.contains(',')) && text.contains("timestamp");
    match columns? {
        4 => Some(FileKind::PlanarTrajectory),
        8 if !is_csv => Some(FileKind::TumTrajectory),
        8.. if is_csv => Some(FileKind::EurocTrajectory),
        12 => Some(FileKind::KittiTrajectory),
        _ => None,
    }
}

/// The text format of DBoW2: four numbers of the whole tree, then one line per node: parent, whether it is a leaf, 32 bytes, weight.
fn is_dbow2(content: &[&str]) -> bool {
    let [head, node, ..] = content else { return false };
    numbers(head) == Some(4) && numbers(node) == Some(35)
}

/// The number of numbers in a line; `None` for a line with other content.
fn numbers(line: &str) -> Option<usize> {
    let fields = line.split(|c: char| c.is_whitespace() || c == ',').filter(|field| !field.is_empty());
    fields.map(|field| field.parse::<f64>().ok()).try_fold(0, |count, number| number.map(|_| count + 1))
}
