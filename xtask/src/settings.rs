//! The reference of settings: each key of `robot.toml` with unit, kind and meaning, read from the doc comments of the configuration
//! structs. `trundle config` and `docs/settings.md` are generated from it.

use crate::workspace::Verdict;
use std::collections::BTreeMap;
use std::fmt::Write;
use std::path::Path;
use syn::{Attribute, Fields, GenericArgument, Item, ItemEnum, ItemStruct, PathArguments, Type};

/// The generated list that the program includes: a line `key, unit, kind, documentation` each, parted by tabs.
const LIST: &str = "crates/trundle-runtime/src/settings/reference.tsv";
/// The generated page.
const PAGE: &str = "docs/settings.md";
/// The struct that is the whole robot file.
const ROOT: &str = "RobotConfig";

/// Units in doc comments, and the suffix of the key in the file.
const UNITS: [(&str, &str); 27] = [
    ("m", "_m"),
    ("s", "_s"),
    ("rad", "_rad"),
    ("deg", "_deg"),
    ("m/s", "_m_s"),
    ("rad/s", "_rad_s"),
    ("m/s^2", "_m_s2"),
    ("rad/s^2", "_rad_s2"),
    ("m/s^3", "_m_s3"),
    ("rad/m", "_rad_m"),
    ("1/m", "_per_m"),
    ("1/s", "_per_s"),
    ("px", "_px"),
    ("Hz", "_hz"),
    ("ms", "_ms"),
    ("cells", "_cells"),
    ("m^2", "_m2"),
    ("m/m^2", "_per_m"),
    ("bits", "_bits"),
    ("m/sqrt(m)", "_m_per_sqrt_m"),
    ("m/sqrt(rad)", "_m_per_sqrt_rad"),
    ("m/sqrt(s)", "_m_per_sqrt_s"),
    ("rad/sqrt(rad)", "_rad_per_sqrt_rad"),
    ("rad/sqrt(m)", "_rad_per_sqrt_m"),
    ("rad/sqrt(s)", "_rad_per_sqrt_s"),
    ("rad/s/sqrt(s)", "_rad_s_per_sqrt_s"),
    ("ticks", "_ticks"),
];
/// Words of a doc comment for a number without unit.
const UNITLESS: [&str; 30] = [
    "ratio",
    "count",
    "log-odds",
    "part",
    "fraction",
    "factor",
    "quotient",
    "share",
    "price",
    "probability",
    "relative",
    "sigmas",
    "deviations",
    "tolerances",
    "damping",
    "epsilon",
    "eta",
    "radial",
    "tangential",
    "ticks",
    "score",
    "gain",
    "worth",
    "converged",
    "times",
    "grey",
    "step",
    "constraint",
    "cost",
    "longer",
];

/// A key.
#[derive(Debug, PartialEq)]
struct Setting {
    /// Dotted path of field names.
    path: String,
    /// Unit; empty without a unit.
    unit: String,
    /// `number`, `integer`, `flag`, `list`, or the words of an enum parted by `|`.
    kind: String,
    /// The doc comment, on one line.
    doc: String,
}

/// Writes the list and the page; with `check_only`, only reports whether they are up to date.
pub fn run(root: &Path, check_only: bool) -> Verdict {
    let settings = read(root)?;
    let without_unit = settings.iter().filter(|s| s.unit == "?").map(|s| (s, "unit"));
    let without_source =
        settings.iter().filter(|s| !has_source(&s.doc)).map(|s| (s, "source of the default"));
    let problems: Vec<(&Setting, &str)> = without_unit.chain(without_source).collect();
    for (setting, lack) in &problems {
        println!("{}: no {lack} in '{}'", setting.path, setting.doc);
    }
    let files = [(LIST, list(&settings)), (PAGE, page(&settings))];
    let mut is_current = problems.is_empty();
    for (file, text) in files {
        let path = root.join(file);
        if check_only {
            let same = std::fs::read_to_string(&path).is_ok_and(|old| old == text);
            if !same {
                println!("{file} is not what the doc comments give: cargo xtask settings");
            }
            is_current &= same;
        } else {
            std::fs::write(&path, text).map_err(|e| format!("cannot write {file}: {e}"))?;
        }
    }
    Ok(is_current)
}

/// The settings below the root struct, in the order of the fields.
fn read(root: &Path) -> Result<Vec<Setting>, String> {
    let mut types = Types::default();
    let folder = root.join("crates");
    for path in walk(&folder)? {
        let text = std::fs::read_to_string(&path).map_err(|e| format!("{}: {e}", path.display()))?;
        let inner = path.strip_prefix(&folder).unwrap_or(&path);
        let package =
            inner.components().next().map_or(String::new(), |c| c.as_os_str().to_string_lossy().into());
        if text.contains("Deserialize") {
            types.add(&package, syn::parse_file(&text).map_err(|e| format!("{}: {e}", path.display()))?);
        }
    }
    let mut settings = Vec::new();
    types.collect(&("trundle-runtime".to_owned(), ROOT.to_owned()), "", &mut settings)?;
    Ok(settings)
}

fn walk(folder: &Path) -> Result<Vec<std::path::PathBuf>, String> {
    let unreadable = |e: std::io::Error| format!("cannot list {}: {e}", folder.display());
    let mut files = Vec::new();
    for entry in std::fs::read_dir(folder).map_err(unreadable)? {
        let path = entry.map_err(unreadable)?.path();
        if path.is_dir() {
            files.extend(walk(&path)?);
        } else if path.extension().is_some_and(|e| e == "rs")
            && path.components().any(|c| c.as_os_str() == "src")
        {
            files.push(path);
        }
    }
    files.sort();
    Ok(files)
}

/// Package and name of a type.
type TypeKey = (String, String);

/// The structs and enums that files can hold.
#[derive(Default)]
struct Types {
    structs: BTreeMap<TypeKey, ItemStruct>,
    enums: BTreeMap<TypeKey, ItemEnum>,
}

impl Types {
    fn add(&mut self, package: &str, file: syn::File) {
        let key = |name: &syn::Ident| (package.to_owned(), name.to_string());
        for item in file.items {
            match item {
                Item::Struct(item) if derives_deserialize(&item.attrs) => {
                    self.structs.insert(key(&item.ident), item);
                }
                Item::Enum(item) if derives_deserialize(&item.attrs) => {
                    self.enums.insert(key(&item.ident), item);
                }
                _ => {}
            }
        }
    }

    fn collect(&self, key: &TypeKey, prefix: &str, into: &mut Vec<Setting>) -> Result<(), String> {
        let item = self.structs.get(key).ok_or_else(|| format!("no struct {} that files can hold", key.1))?;
        let Fields::Named(fields) = &item.fields else {
            return Err(format!("struct {} has no named fields", key.1));
        };
        for field in &fields.named {
            if serde_words(&field.attrs)
                .split(|c: char| !c.is_alphanumeric() && c != '_')
                .any(|word| word == "skip")
            {
                continue;
            }
            let ident = field.ident.as_ref().map(ToString::to_string).unwrap_or_default();
            let path = if prefix.is_empty() { ident } else { format!("{prefix}.{ident}") };
            let name = inner_type(&field.ty);
            if let Some(inner) = known(&self.structs, &key.0, &name)? {
                self.collect(inner, &path, into)?;
                continue;
            }
            let doc = doc(&field.attrs);
            let kind = self.kind(&key.0, &name)?;
            let unit =
                if ["number", "list"].contains(&kind.as_str()) { unit_of(&doc) } else { unit_or_none(&doc) };
            into.push(Setting { path, unit, kind, doc });
        }
        Ok(())
    }

    fn kind(&self, package: &str, name: &str) -> Result<String, String> {
        Ok(match name {
            "f64" | "f32" => "number".into(),
            "bool" => "flag".into(),
            "u8" | "u16" | "u32" | "u64" | "usize" | "i32" | "i64" | "NonZeroUsize" | "NonZeroU32" => {
                "integer".into()
            }
            other => match known(&self.enums, package, other)? {
                Some(key) => self.enums[key]
                    .variants
                    .iter()
                    .map(|v| snake(&v.ident.to_string()))
                    .collect::<Vec<_>>()
                    .join("|"),
                None => "list".into(),
            },
        })
    }
}

/// Packages whose types cannot be part of the robot file: they do not belong to the crates below the runtime.
const NOT_BELOW: [&str; 5] =
    ["trundle-sim", "trundle-io", "trundle-viz", "trundle-eval", "trundle-experiments"];

/// The type of this name: the package's own, else the only one among the packages below the runtime.
fn known<'a, T>(
    types: &'a BTreeMap<TypeKey, T>,
    package: &str,
    name: &str,
) -> Result<Option<&'a TypeKey>, String> {
    let named: Vec<&TypeKey> =
        types.keys().filter(|(p, n)| n == name && !NOT_BELOW.contains(&p.as_str())).collect();
    if let Some(own) = named.iter().find(|(p, _)| p == package) {
        return Ok(Some(own));
    }
    match named[..] {
        [] => Ok(None),
        [only] => Ok(Some(only)),
        _ => Err(format!("{package} uses {name}, which several packages define: {named:?}")),
    }
}

fn derives_deserialize(attrs: &[Attribute]) -> bool {
    attrs.iter().any(|a| a.path().is_ident("derive") && quoted(a).contains("Deserialize"))
}

fn serde_words(attrs: &[Attribute]) -> String {
    attrs.iter().filter(|a| a.path().is_ident("serde")).map(quoted).collect()
}

fn quoted(attribute: &Attribute) -> String {
    attribute.meta.require_list().map(|list| list.tokens.to_string()).unwrap_or_default()
}

/// The doc comment, on one line.
pub(crate) fn doc(attrs: &[Attribute]) -> String {
    let line = |a: &Attribute| match &a.meta.require_name_value().ok()?.value {
        syn::Expr::Lit(syn::ExprLit { lit: syn::Lit::Str(text), .. }) => Some(text.value().trim().to_owned()),
        _ => None,
    };
    let lines: Vec<String> = attrs.iter().filter(|a| a.path().is_ident("doc")).filter_map(line).collect();
    plain(lines.join(" ").replace('\t', " ").trim())
}

/// Documentation without the marks of rustdoc: links become their text.
fn plain(doc: &str) -> String {
    let doc = doc.replace("\\[", "[").replace("\\]", "]");
    let mut text = String::new();
    let mut rest = doc.as_str();
    while let Some((before, link)) = rest.split_once("[`") {
        let Some((name, after)) = link.split_once("`]") else { break };
        text.push_str(before);
        let _ = write!(text, "`{}`", name.rsplit("::").next().unwrap_or(name));
        let target = after.strip_prefix('(').and_then(|after| after.split_once(')'));
        rest = target.map_or(after, |(_, after)| after);
    }
    text + rest
}

/// The last name of a type, through `Option`.
fn inner_type(ty: &Type) -> String {
    let Type::Path(path) = ty else { return "list".into() };
    let Some(last) = path.path.segments.last() else { return "list".into() };
    if last.ident == "Option"
        && let PathArguments::AngleBracketed(arguments) = &last.arguments
        && let Some(GenericArgument::Type(inner)) = arguments.args.first()
    {
        return inner_type(inner);
    }
    last.ident.to_string()
}

/// A name in `CamelCase` as `snake_case`.
pub(crate) fn snake(name: &str) -> String {
    let mut snake = String::new();
    for c in name.chars() {
        if c.is_uppercase() && !snake.is_empty() {
            snake.push('_');
        }
        snake.extend(c.to_lowercase());
    }
    snake
}

/// The unit between commas in a doc comment; `?` without a unit and without a word for a unitless number.
fn unit_of(doc: &str) -> String {
    let found = unit_or_none(doc);
    let lower = doc.to_lowercase();
    let is_unitless =
        lower.split(|c: char| !c.is_alphabetic() && c != '-').any(|word| UNITLESS.contains(&word));
    if found.is_empty() && !is_unitless { "?".into() } else { found }
}

fn unit_or_none(doc: &str) -> String {
    let meaning = doc.split(" Default").next().unwrap_or(doc).replace(" / ", "/");
    let known =
        |piece: &str| UNITS.iter().find(|(unit, _)| *unit == piece).map(|(unit, _)| (*unit).to_owned());
    // The text after the comma: a unit alone, or followed by `of`, `above` or `from`.
    let pieces = meaning.split([',', ';', ':', '.']).skip(1).map(str::trim);
    let heads = pieces.map(|piece| {
        let head = [" of ", " above ", " from ", " on "].iter().find_map(|word| piece.split_once(word));
        head.map_or(piece, |(head, _)| head)
    });
    heads
        .filter_map(|piece| known(piece).or_else(|| known(piece.trim_end_matches(')'))))
        .next()
        .unwrap_or_default()
}

/// Whether the documentation gives the source of the default: a reason after a colon, `ours`, a key of the bibliography, or a page.
fn has_source(doc: &str) -> bool {
    let default =
        ["Default ", "Without the table "].iter().filter_map(|start| doc.rsplit_once(start)).next_back();
    default.is_none_or(|(_, text)| [": ", "(", "[", ", as "].iter().any(|mark| text.contains(mark)))
}

/// The suffix of a key for its unit. Empty if the name already ends in a unit.
fn suffix_after(name: &str, unit: &str) -> &'static str {
    let has_one = UNITS.iter().any(|(_, suffix)| name.ends_with(suffix));
    let suffix = UNITS.iter().find(|(name, _)| *name == unit).map_or("", |(_, suffix)| suffix);
    if has_one { "" } else { suffix }
}

fn list(settings: &[Setting]) -> String {
    let mut text = String::new();
    for Setting { path, unit, kind, doc } in settings {
        let end = suffix_after(path, unit);
        let _ = writeln!(text, "{path}\t{path}{end}\t{unit}\t{kind}\t{doc}");
    }
    text
}

fn page(settings: &[Setting]) -> String {
    let mut text = String::from(
        "# Settings\n\nEvery key of `robot.toml`, by table. Written by `cargo xtask settings` from the doc comments of the configuration structs.\n\
         `trundle config` prints the same with the values.\n\n\
         A key is the name of a field and its unit: `safety.image_timeout_s` is `SafetyConfig::image_timeout`.\n",
    );
    let mut table = None;
    for Setting { path, unit, kind, doc } in settings {
        let (head, key) = path.rsplit_once('.').unwrap_or(("", path));
        if table != Some(head) {
            let title = if head.is_empty() { "The robot".to_owned() } else { format!("`[{head}]`") };
            let _ = write!(text, "\n## {title}\n\n| key | kind | meaning |\n|---|---|---|\n");
            table = Some(head);
        }
        let end = suffix_after(key, unit);
        let _ =
            writeln!(text, "| `{key}{end}` | {} | {} |", kind.replace('|', ", "), doc.replace('|', "&#124;"));
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn units_are_read_from_doc_comments() {
        assert_eq!(unit_of("Radius of the disc, m, above 0. Default 0.1755."), "m");
        assert_eq!(unit_of("Position along the motion, sigma after 1 m, m / sqrt(m), 0 to 1."), "m/sqrt(m)");
        assert_eq!(unit_of("Turn rate, rad/s^2, above 0."), "rad/s^2");
        assert_eq!(unit_of("A part, ratio, 0 to 1."), "");
        assert_eq!(unit_of("Height, m above the floor, 0 to 1. Default 0.3, s."), "m");
        assert_eq!(unit_of("Something, 0 to 1."), "?");
    }

    #[test]
    fn a_default_has_a_source() {
        let sourced = [
            "Default 0.3 (ours).",
            "Default 8 [Rublee11].",
            "Default 2: two cells.",
            "Default 1, as `KOBUKI`.",
        ];
        assert!(sourced.iter().all(|doc| has_source(&format!("Gap: a length, m, 0 (off) to 1. {doc}"))));
        assert!(!has_source("Gap: a length, m, 0 (off) to 1. Default 0.3."));
        assert!(!has_source("Width (of an image), px. Without the table 512."));
    }

    #[test]
    fn the_reference_is_what_the_doc_comments_give() {
        let root = crate::workspace::root();
        assert!(run(&root, true).unwrap(), "run `cargo xtask settings`");
    }
}
