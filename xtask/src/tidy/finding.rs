//! A finding: a place that breaks a rule.

use std::fmt;

/// A violation of a rule.
#[derive(Debug, Clone, PartialEq, Eq, PartialOrd, Ord)]
pub struct Finding {
    /// The file, relative to the workspace.
    pub path: String,
    /// Line of the finding, from 1.
    pub line: usize,
    /// Severity: whether the finding fails the check.
    pub severity: Severity,
    /// The rule, if its findings can be on the allow-list.
    pub rule: Option<Rule>,
    /// The problem.
    pub message: String,
}

/// Severity of a finding.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Severity {
    /// Fails the check.
    Error,
    /// Is printed.
    Warning,
}

/// Rules with an allow-list (`xtask/tidy-allowed.txt`) that may only shrink.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Rule {
    /// A module depends on itself through others.
    ModuleCycle,
    /// A struct has too many fields.
    StructFields,
    /// A type has too many methods.
    ImplMethods,
    /// A type's methods are in too many files.
    ImplFiles,
    /// A file without a sentence on its content.
    FileDoc,
    /// A sentence is too long.
    LongSentence,
    /// A word about how the project is worked on.
    ProcessWord,
    /// A name that the glossary replaces.
    Glossary,
    /// A document names a missing file.
    MissingFile,
    /// Two crates have a public type of one name.
    TypeName,
    /// A constant's name without its quantity.
    ConstantName,
    /// A constant without the source of its value.
    ConstantSource,
}

impl Rule {
    /// All rules with an allow-list.
    pub const ALL: [Self; 12] = [
        Self::ModuleCycle,
        Self::StructFields,
        Self::ImplMethods,
        Self::ImplFiles,
        Self::FileDoc,
        Self::LongSentence,
        Self::ProcessWord,
        Self::Glossary,
        Self::MissingFile,
        Self::TypeName,
        Self::ConstantName,
        Self::ConstantSource,
    ];

    /// The rule's name in the allow-list.
    pub fn name(self) -> &'static str {
        match self {
            Self::ModuleCycle => "module-cycle",
            Self::StructFields => "struct-fields",
            Self::ImplMethods => "impl-methods",
            Self::ImplFiles => "impl-files",
            Self::FileDoc => "file-doc",
            Self::LongSentence => "long-sentence",
            Self::ProcessWord => "process-word",
            Self::Glossary => "glossary",
            Self::MissingFile => "missing-file",
            Self::TypeName => "type-name",
            Self::ConstantName => "constant-name",
            Self::ConstantSource => "constant-source",
        }
    }
}

impl Finding {
    /// An error at a line.
    pub fn error(path: &str, line: usize, message: impl Into<String>) -> Self {
        Self { path: path.to_owned(), line, severity: Severity::Error, rule: None, message: message.into() }
    }

    /// A warning at a line.
    pub fn warning(path: &str, line: usize, message: impl Into<String>) -> Self {
        Self { severity: Severity::Warning, ..Self::error(path, line, message) }
    }

    /// An error of a rule that has an allow-list.
    pub fn ruled(rule: Rule, path: &str, line: usize, message: impl Into<String>) -> Self {
        Self { rule: Some(rule), ..Self::error(path, line, message) }
    }
}

impl fmt::Display for Finding {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { path, line, severity, message, .. } = self;
        match severity {
            Severity::Error => write!(f, "{path}:{line}: {message}"),
            Severity::Warning => write!(f, "{path}:{line}: warning: {message}"),
        }
    }
}
