//! Reads an interface definition: the text of a `.msg`, `.srv` or `.action` file.

/// An interface: a message, a service or an action.
#[derive(Debug, PartialEq)]
pub struct Interface {
    /// Package, as `geometry_msgs`.
    pub package: String,
    /// Kind: `msg`, `srv` or `action`.
    pub kind: Kind,
    /// Name, as `Pose`.
    pub name: String,
    /// The parts between the lines `---`: one of a message, two of a service, three of an action.
    pub parts: Vec<Part>,
}

/// Kind of an interface.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Kind {
    /// A message.
    Message,
    /// A service: request and response.
    Service,
    /// An action: goal, result and feedback.
    Action,
}

impl Kind {
    /// The kind of files in a folder of this name.
    pub fn of_folder(folder: &str) -> Option<Self> {
        match folder {
            "msg" => Some(Self::Message),
            "srv" => Some(Self::Service),
            "action" => Some(Self::Action),
            _ => None,
        }
    }

    /// Names of the parts, appended to the interface's name.
    pub fn parts(self) -> &'static [&'static str] {
        match self {
            Self::Message => &[""],
            Self::Service => &["Request", "Response"],
            Self::Action => &["Goal", "Result", "Feedback"],
        }
    }
}

/// A structure.
#[derive(Debug, Default, PartialEq)]
pub struct Part {
    /// Fields in order.
    pub fields: Vec<Field>,
    /// Constants in order.
    pub constants: Vec<Constant>,
}

/// A field.
#[derive(Debug, PartialEq)]
pub struct Field {
    /// Name.
    pub name: String,
    /// Type of the field or of its elements: `float64`, `string`, `Pose`, `std_msgs/Header`.
    pub element: String,
    /// Whether the field is one value or an array.
    pub count: Count,
}

/// Number of values of a field.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Count {
    /// One value.
    One,
    /// A fixed number.
    Fixed(usize),
    /// Any number.
    Any,
}

/// A constant.
#[derive(Debug, PartialEq)]
pub struct Constant {
    /// Name.
    pub name: String,
    /// Type: `uint8`, `string`.
    pub element: String,
    /// The value as written in the file.
    pub value: String,
}

/// Reads the text of one file.
///
/// # Errors
/// Names the line that is neither a field nor a constant, or a wrong number of parts.
pub fn parse(package: &str, kind: Kind, name: &str, text: &str) -> Result<Interface, String> {
    let mut parts = vec![Part::default()];
    for (i, line) in text.lines().enumerate() {
        let line = line.split('#').next().unwrap_or_default().trim();
        if line == "---" {
            parts.push(Part::default());
        } else if let (false, Some(part)) = (line.is_empty(), parts.last_mut()) {
            add_line(part, line).ok_or_else(|| {
                format!(
                    "{package}/{name}, line {}: '{line}', expected `type name` or `type NAME=value`",
                    i + 1
                )
            })?;
        }
    }
    let expected = kind.parts().len();
    if parts.len() != expected {
        return Err(format!("{package}/{name}: {} parts, expected {expected} parted by `---`", parts.len()));
    }
    Ok(Interface { package: package.to_owned(), kind, name: name.to_owned(), parts })
}

fn add_line(part: &mut Part, line: &str) -> Option<()> {
    let (element, rest) = line.split_once(char::is_whitespace)?;
    let rest = rest.trim();
    if let Some((name, value)) = rest.split_once('=')
        && !element.contains("<=")
    {
        let (name, value) = (name.trim().to_owned(), value.trim().to_owned());
        part.constants.push(Constant { name, element: element.to_owned(), value });
        return Some(());
    }
    let name = rest.split_whitespace().next()?.to_owned();
    let (element, count) = element_and_count(element)?;
    part.fields.push(Field { name, element, count });
    Some(())
}

/// `float64[36]` is 36 of `float64`; bounds (`string<=10`, `uint8[<=4]`) do not affect the encoding.
fn element_and_count(text: &str) -> Option<(String, Count)> {
    let (element, count) = match text.split_once('[') {
        None => (text, Count::One),
        Some((element, rest)) => match rest.strip_suffix(']')? {
            "" => (element, Count::Any),
            bound if bound.starts_with("<=") => (element, Count::Any),
            number => (element, Count::Fixed(number.parse().ok()?)),
        },
    };
    let element = element.split("<=").next()?;
    Some((element.to_owned(), count))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn fields_constants_and_parts_are_read() {
        let text = "# A service.\nuint8 FAST=2 # quick\nstd_msgs/Header header\nfloat64[36] covariance\n---\nuint8[<=4] data\nstring<=9 name \"x\"\n";
        let service = parse("a_msgs", Kind::Service, "Get", text).unwrap();
        let [request, response] = &service.parts[..] else { panic!("{service:?}") };
        assert_eq!(request.constants[0].value, "2");
        assert_eq!(request.fields[0].element, "std_msgs/Header");
        assert_eq!(request.fields[1].count, Count::Fixed(36));
        assert_eq!((response.fields[0].count, response.fields[1].element.as_str()), (Count::Any, "string"));
        assert!(parse("a", Kind::Action, "X", "---\n").unwrap_err().contains("expected 3"));
        assert!(parse("a", Kind::Message, "X", "float64\n").unwrap_err().contains("line 1"));
    }
}
