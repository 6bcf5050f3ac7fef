//! Writes the Rust structures of an interface.

use super::definition::{Constant, Count, Field, Interface, Kind, Part};
use std::fmt::Write;

/// Largest fixed array supported by serde and `Default`. Longer ones are `FixedArray`. Source: serde and the standard library.
const MAX_PLAIN_ARRAY: usize = 32;
/// Keywords of Rust that are names of fields.
const KEYWORDS: [&str; 4] = ["type", "match", "ref", "move"];

/// Messages with the name of a type in another crate: their Rust names end in `Message`.
const NAMES_OF_OTHER_CRATES: [&str; 6] =
    ["CameraInfo", "Image", "OccupancyGrid", "Odometry", "Path", "Vector3"];

/// The file of one interface.
pub fn file(interface: &Interface) -> String {
    let Interface { package, kind, name, parts } = interface;
    let mut text = format!(
        "//! `{package}/{}/{name}`. Written by `cargo xtask ros-interfaces`.\n\nuse serde::{{Deserialize, Serialize}};\n",
        folder(*kind)
    );
    for (part, suffix) in parts.iter().zip(kind.parts()) {
        text += &structure(package, &format!("{name}{suffix}"), part);
    }
    text += &type_of(interface);
    text
}

/// The list of all interfaces, for the program that prints their bytes.
pub fn list(interfaces: &[Interface]) -> String {
    let mut text = "//! All interfaces. Written by `cargo xtask ros-interfaces`.\n\nuse super::structure::{Structure, action, message, service};\nuse trundle_ros2::generated;\n\n/// The structures of all interfaces.\npub fn structures() -> Vec<Structure> {\n    [\n".to_owned();
    for Interface { package, kind, name, .. } in interfaces {
        let (function, name) = match kind {
            Kind::Message => ("message", type_name(name)),
            Kind::Service => ("service", name.clone()),
            Kind::Action => ("action", name.clone()),
        };
        let _ = writeln!(text, "        {function}::<generated::{package}::{name}>(),");
    }
    text + "    ]\n    .into_iter()\n    .flatten()\n    .collect()\n}\n"
}

/// The implementation of the trait with the type's name.
fn type_of(interface: &Interface) -> String {
    let Interface { package, kind, name, .. } = interface;
    let names = format!("    const PACKAGE: &str = \"{package}\";\n    const NAME: &str = \"{name}\";\n");
    let marker = format!(
        "\n/// `{package}/{}/{name}`.\n#[derive(Debug, Clone, Copy)]\npub enum {name} {{}}\n",
        folder(*kind)
    );
    match kind {
        Kind::Message => {
            format!("\nimpl crate::interface::MessageType for {} {{\n{names}}}\n", type_name(name))
        }
        Kind::Service => format!(
            "{marker}\nimpl crate::interface::ServiceType for {name} {{\n{names}    type Request = {name}Request;\n    type Response = {name}Response;\n}}\n"
        ),
        Kind::Action => format!(
            "{marker}\nimpl crate::interface::ActionType for {name} {{\n{names}    type Goal = {name}Goal;\n    type Result = {name}Result;\n    type Feedback = {name}Feedback;\n}}\n"
        ),
    }
}

fn folder(kind: Kind) -> &'static str {
    match kind {
        Kind::Message => "msg",
        Kind::Service => "srv",
        Kind::Action => "action",
    }
}

fn structure(package: &str, ros_name: &str, part: &Part) -> String {
    let name = type_name(ros_name);
    let mut text = format!(
        "\n/// `{package}`: `{ros_name}`.\n#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]\npub struct {name} {{\n"
    );
    for field in &part.fields {
        let _ = writeln!(
            text,
            "    /// `{}`.\n    pub {}: {},",
            described(field),
            rust_name(&field.name),
            rust_type(package, field)
        );
    }
    if part.fields.is_empty() {
        // An empty structure has one byte on the wire.
        text += "    /// `uint8`: a structure without members has this one on the wire.\n    pub structure_needs_at_least_one_member: u8,\n";
    }
    let _ = writeln!(text, "}}\n\nimpl ros2_client::Message for {name} {{}}");
    if !part.constants.is_empty() {
        let constants: String = part.constants.iter().map(constant).collect();
        let _ = writeln!(text, "\nimpl {name} {{\n{constants}}}");
    }
    text
}

fn described(field: &Field) -> String {
    match field.count {
        Count::One => field.element.clone(),
        Count::Fixed(n) => format!("{}[{n}]", field.element),
        Count::Any => format!("{}[]", field.element),
    }
}

fn constant(constant: &Constant) -> String {
    let Constant { name, element, value } = constant;
    let (kind, value) = match primitive(element) {
        Some("std::string::String") => ("&'static str", format!("\"{}\"", value.trim_matches(['"', '\'']))),
        Some("bool") => ("bool", matches!(value.as_str(), "1" | "true" | "True").to_string()),
        Some(kind @ ("f32" | "f64")) if !value.contains(['.', 'e']) => (kind, format!("{value}.0")),
        Some(kind) => (kind, value.clone()),
        None => ("?", value.clone()),
    };
    format!("    /// `{element}`.\n    pub const {name}: {kind} = {value};\n")
}

fn rust_name(name: &str) -> String {
    if KEYWORDS.contains(&name) { format!("r#{name}") } else { name.to_owned() }
}

fn rust_type(package: &str, field: &Field) -> String {
    let element = match primitive(&field.element) {
        Some(primitive) => primitive.to_owned(),
        None => match field.element.rsplit_once('/') {
            Some((other, name)) => path(other.trim_end_matches("/msg"), name),
            None if field.element == "Header" => path("std_msgs", "Header"),
            None => path(package, &field.element),
        },
    };
    match field.count {
        Count::One => element,
        Count::Any if element == "u8" => "crate::wire::Bytes".to_owned(),
        Count::Any => format!("Vec<{element}>"),
        Count::Fixed(n) if n <= MAX_PLAIN_ARRAY => format!("[{element}; {n}]"),
        Count::Fixed(n) => format!("crate::wire::FixedArray<{element}, {n}>"),
    }
}

fn path(package: &str, name: &str) -> String {
    format!("crate::generated::{package}::{}", type_name(name))
}

/// The Rust name of a structure.
fn type_name(name: &str) -> String {
    if NAMES_OF_OTHER_CRATES.contains(&name) { format!("{name}Message") } else { name.to_owned() }
}

fn primitive(element: &str) -> Option<&'static str> {
    Some(match element {
        "bool" => "bool",
        "byte" | "char" | "uint8" => "u8",
        "int8" => "i8",
        "int16" => "i16",
        "uint16" => "u16",
        "int32" => "i32",
        "uint32" => "u32",
        "int64" => "i64",
        "uint64" => "u64",
        "float32" => "f32",
        "float64" => "f64",
        "string" => "std::string::String",
        _ => return None,
    })
}

#[cfg(test)]
mod tests {
    use super::super::definition::parse;
    use super::*;

    #[test]
    fn a_message_becomes_a_structure() {
        let text = "float64[36] covariance\nPose[] poses\nstd_msgs/Header header\nuint8[] data\nuint8 A=1\nstring type\n";
        let file = file(&parse("x_msgs", Kind::Message, "Thing", text).unwrap());
        for line in [
            "pub covariance: crate::wire::FixedArray<f64, 36>,",
            "pub poses: Vec<crate::generated::x_msgs::Pose>,",
            "pub header: crate::generated::std_msgs::Header,",
            "pub data: crate::wire::Bytes,",
            "pub const A: u8 = 1;",
            "pub r#type: std::string::String,",
        ] {
            assert!(file.contains(line), "{line} is not in\n{file}");
        }
    }

    #[test]
    fn a_message_with_the_name_of_a_type_of_another_crate_ends_in_message() {
        let file = file(&parse("x_msgs", Kind::Message, "Image", "Vector3 size\n").unwrap());
        for line in [
            "pub struct ImageMessage {",
            "pub size: crate::generated::x_msgs::Vector3Message,",
            "impl crate::interface::MessageType for ImageMessage {",
            "const NAME: &str = \"Image\";",
        ] {
            assert!(file.contains(line), "{line} is not in\n{file}");
        }
    }
}
