//! Names of constants: the name of a number holds its quantity, so one word is not enough; a tuple has no one unit; its
//! documentation states quantity and unit.

use super::finding::{Finding, Rule};
use super::tree::Tree;

/// Types of a constant that is a number, or a row of numbers.
pub(super) const NUMBERS: [&str; 13] =
    ["f64", "f32", "u8", "u16", "u32", "u64", "usize", "i8", "i16", "i32", "i64", "isize", "Duration"];

/// Words that name a number by themselves, by use in their field.
const ONE_WORD_NAMES: [&str; 11] =
    ["COLUMNS", "ROWS", "SIDE", "WIDTH", "HEIGHT", "LANES", "UNREACHED", "BLOCK", "LEAF", "FREE", "KERNEL"];

/// Checks the constants of every package at the top level of their modules.
pub fn check(tree: &Tree) -> Vec<Finding> {
    let mut findings = Vec::new();
    for package in &tree.packages {
        for source in tree.sources(package) {
            let found = |(line, fault)| Finding::ruled(Rule::ConstantName, &source.file.path, line, fault);
            let names = source.code.text().lines().enumerate();
            let names = names.filter_map(|(i, line)| Some((i + 1, fault(line)?)));
            let silent = undocumented(source.code.text(), &source.file.text);
            findings.extend(names.chain(silent).map(found));
        }
    }
    findings
}

/// Line and problem of each number without documentation. Constants on adjacent lines share that of the first.
fn undocumented(code: &str, text: &str) -> Vec<(usize, String)> {
    let mut findings = Vec::new();
    let mut is_documented = false;
    for (i, (code, line)) in code.lines().zip(text.lines()).enumerate() {
        let declared = declared(code);
        if let Some((name, _)) = declared.filter(|(_, kind)| is_number(kind) && !is_documented) {
            let message = format!("constant {name} has no documentation: state quantity, unit and source");
            findings.push((i + 1, message));
        }
        let goes_on = declared.is_some() || line.starts_with("#[");
        is_documented = line.starts_with("///") || is_documented && goes_on;
    }
    findings
}

/// Name and type of the constant that a line declares; `None` for a `const fn`.
pub(super) fn declared(line: &str) -> Option<(&str, &str)> {
    let visible = ["pub(crate) ", "pub(super) ", "pub "].iter().find_map(|v| line.strip_prefix(v));
    let (name, rest) = visible.unwrap_or(line).strip_prefix("const ")?.split_once(": ")?;
    (!name.contains(' ')).then_some((name, rest.split(" =").next()?))
}

/// Whether a type is a number, or a row of numbers.
fn is_number(kind: &str) -> bool {
    NUMBERS.contains(&kind) || NUMBERS.iter().any(|number| kind.starts_with(&format!("[{number};")))
}

/// The problem of the constant that a line declares.
fn fault(line: &str) -> Option<String> {
    let (name, kind) = declared(line)?;
    if NUMBERS.iter().any(|number| kind.starts_with(&format!("({number}, "))) {
        let is_one_unit = name.contains("RANGE") || name.contains("BAND") || name.contains("_XY_");
        let is_one_unit =
            is_one_unit || name.contains("SIZE") || name.contains("_PER_") || name.contains("RADII");
        return (!is_one_unit)
            .then(|| format!("constant {name} is a tuple: give each quantity a constant of its own"));
    }
    let is_quantity =
        NUMBERS.contains(&kind) || NUMBERS[..2].iter().any(|f| kind.starts_with(&format!("[{f};")));
    let is_one_word = !name.contains('_') && !ONE_WORD_NAMES.contains(&name);
    (is_quantity && is_one_word)
        .then(|| format!("constant {name} has one word: name its quantity, and its unit if it has one"))
}

#[cfg(test)]
mod tests {
    use super::{fault, undocumented};

    #[test]
    fn a_number_has_documentation_or_follows_one_that_has() {
        let code =
            "/// A [m].\nconst A_M: f64 = 1.0;\nconst B_M: f64 = 2.0;\n\nconst C_M: f64 = 3.0;\nfn f() {}\n";
        let found: Vec<usize> = undocumented(code, code).into_iter().map(|(line, _)| line).collect();
        assert_eq!(found, [5]);
    }

    #[test]
    fn numbers_need_a_quantity_and_tuples_one_unit() {
        assert!(fault("const NEAR: f64 = 0.1;").is_some());
        assert!(fault("pub(super) const REACH: [f64; 2] = [0.1, 0.2];").is_some());
        assert!(fault("const FAR_OFF: (f64, f64) = (0.1, 0.2);").is_some());
        assert!(fault("const TRANSFERS: (usize, usize) = (20, 4096);").is_some());
        assert!(fault("const MAX_RANGE_M: f64 = 8.0;").is_none());
        assert!(fault("const SPEED_RANGE_M_S: (f64, f64) = (0.7, 1.6);").is_none());
        assert!(fault("const MAGIC: &[u8; 4] = b\"abcd\";").is_none());
        assert!(fault("    const A: f64 = 1.0;").is_none(), "inside a function");
    }
}
