//! Reads the table of transitions from the sources.

use crate::settings::doc;
use std::collections::BTreeMap;
use std::path::Path;
use syn::{Expr, ImplItem, Item, ItemEnum, Pat};

/// The table of transitions, and the kinds of states.
const TRANSITIONS: &str = "crates/trundle-runtime/src/behaviour/transitions.rs";
/// The reasons for transitions.
const REASONS: &str = "crates/trundle-runtime/src/reason/transition.rs";
/// The states with their data, and how front ends show them.
const STATES: &str = "crates/trundle-runtime/src/behaviour/state.rs";

/// The state machine, as its sources describe it.
pub struct StateTable {
    /// Name and documentation of each state.
    pub states: Vec<(String, String)>,
    /// The published name of each state.
    pub shown: BTreeMap<String, String>,
    /// The states without a goal to reach.
    pub over: Vec<String>,
    /// The states that share the data of a search for a path.
    pub search: Vec<String>,
    /// Documentation of each reason.
    pub reasons: BTreeMap<String, String>,
    pub rows: Vec<Row>,
}

/// A row of the table of transitions.
pub struct Row {
    pub from: From,
    pub reason: String,
    pub to: Vec<String>,
}

/// The states from which a row leads.
#[derive(Clone)]
pub enum From {
    Any,
    Active,
    Of(Vec<String>),
}

impl From {
    /// In words.
    pub fn text(&self) -> String {
        match self {
            Self::Any => "any state".to_owned(),
            Self::Active => "any state with a goal".to_owned(),
            Self::Of(names) => names.join(", "),
        }
    }

    /// The names of the states; none for a superstate.
    pub fn names(&self) -> &[String] {
        match self {
            Self::Any | Self::Active => &[],
            Self::Of(names) => names,
        }
    }
}

impl StateTable {
    /// # Errors
    /// When a source cannot be read or does not have the expected form.
    pub fn read(root: &Path) -> Result<Self, String> {
        let [transitions, reasons, states] =
            [TRANSITIONS, REASONS, STATES].map(|file| parse(root, file).map(|parsed| (file, parsed.items)));
        let (transitions, reasons, states) = (transitions?, reasons?, states?);
        let consts = consts(&transitions.1);
        let value = |name: &str| {
            consts.get(name).copied().ok_or_else(|| format!("{TRANSITIONS}: no constant {name}"))
        };
        let rows = elements(value("TRANSITIONS")?)?.into_iter().map(|row| read_row(row, &consts));
        Ok(Self {
            states: variants(&transitions, "StateKind")?,
            shown: published(&states.1)?,
            over: names(value("OVER")?)?,
            search: names(value("SEARCH")?)?,
            reasons: variants(&reasons, "TransitionReason")?.into_iter().collect(),
            rows: rows.collect::<Result<_, _>>()?,
        })
    }
}

fn parse(root: &Path, file: &str) -> Result<syn::File, String> {
    let text = std::fs::read_to_string(root.join(file)).map_err(|e| format!("cannot read {file}: {e}"))?;
    syn::parse_file(&text).map_err(|e| format!("{file}: {e}"))
}

/// Name and documentation of the variants of an enum.
fn variants((file, items): &(&str, Vec<Item>), name: &str) -> Result<Vec<(String, String)>, String> {
    let found = |item: &Item| match item {
        Item::Enum(ItemEnum { ident, variants, .. }) if ident == name => {
            Some(variants.iter().map(|v| (v.ident.to_string(), doc(&v.attrs))).collect())
        }
        _ => None,
    };
    items.iter().find_map(found).ok_or_else(|| format!("{file}: no enum {name}"))
}

/// The constants by name.
fn consts(items: &[Item]) -> BTreeMap<String, &Expr> {
    items.iter().filter_map(constant).collect()
}

/// Name and value of a constant.
fn constant(item: &Item) -> Option<(String, &Expr)> {
    match item {
        Item::Const(constant) => Some((constant.ident.to_string(), &constant.expr)),
        _ => None,
    }
}

fn read_row(row: &Expr, consts: &BTreeMap<String, &Expr>) -> Result<Row, String> {
    let Expr::Struct(row) = row else { return Err(format!("{TRANSITIONS}: a row is no struct")) };
    let field = |name: &str| {
        let is_named = |field: &&syn::FieldValue| matches!(&field.member, syn::Member::Named(n) if n == name);
        let field = row.fields.iter().find(is_named);
        field.map(|field| &field.expr).ok_or_else(|| format!("{TRANSITIONS}: a row has no {name}"))
    };
    Ok(Row {
        from: sources(field("from")?, consts)?,
        reason: last(field("reason")?)?,
        to: names(field("to")?)?,
    })
}

/// The sources of a row: a superstate, a list, or a constant with a list.
fn sources(expr: &Expr, consts: &BTreeMap<String, &Expr>) -> Result<From, String> {
    if let Expr::Call(call) = expr {
        let list = call.args.first().ok_or_else(|| format!("{TRANSITIONS}: a source without a list"))?;
        return list_of(list, consts).map(From::Of);
    }
    match last(expr)?.as_str() {
        "Any" => Ok(From::Any),
        "Active" => Ok(From::Active),
        name => match consts.get(name) {
            Some(constant) => sources(constant, consts),
            None => Err(format!("{TRANSITIONS}: unknown source {name}")),
        },
    }
}

fn list_of(list: &Expr, consts: &BTreeMap<String, &Expr>) -> Result<Vec<String>, String> {
    match list {
        Expr::Path(_) => {
            let name = last(list)?;
            names(consts.get(&name).copied().ok_or_else(|| format!("{TRANSITIONS}: no constant {name}"))?)
        }
        _ => names(list),
    }
}

/// The elements of `&[...]`.
fn elements(expr: &Expr) -> Result<Vec<&Expr>, String> {
    match expr {
        Expr::Reference(reference) => elements(&reference.expr),
        Expr::Array(array) => Ok(array.elems.iter().collect()),
        _ => Err(format!("{TRANSITIONS}: a list of names is expected")),
    }
}

fn names(expr: &Expr) -> Result<Vec<String>, String> {
    elements(expr)?.into_iter().map(last).collect()
}

/// The last name of a path.
fn last(expr: &Expr) -> Result<String, String> {
    let path = match expr {
        Expr::Path(path) => &path.path,
        Expr::Struct(item) => &item.path,
        _ => return Err(format!("{TRANSITIONS}: a name is expected")),
    };
    path.segments.last().map(|s| s.ident.to_string()).ok_or_else(|| "an empty path".to_owned())
}

/// The published name of each state, from the arms of `State::published`.
fn published(items: &[Item]) -> Result<BTreeMap<String, String>, String> {
    let methods = items.iter().filter_map(|item| match item {
        Item::Impl(item) => Some(&item.items),
        _ => None,
    });
    let is_published = |item: &&ImplItem| matches!(item, ImplItem::Fn(f) if f.sig.ident == "published");
    let Some(ImplItem::Fn(method)) = methods.flatten().find(is_published) else {
        return Err(format!("{STATES}: no method published"));
    };
    let Some(syn::Stmt::Expr(Expr::Match(arms), _)) = method.block.stmts.last() else {
        return Err(format!("{STATES}: published is no match"));
    };
    let mut shown = BTreeMap::new();
    for arm in &arms.arms {
        let name = crate::settings::snake(&last(&arm.body)?).replace('_', " ");
        shown.extend(patterns(&arm.pat).into_iter().map(|state| (state, name.clone())));
    }
    Ok(shown)
}

/// The variants that a pattern matches.
fn patterns(pattern: &Pat) -> Vec<String> {
    let path = match pattern {
        Pat::Or(or) => return or.cases.iter().flat_map(patterns).collect(),
        Pat::Path(path) => &path.path,
        Pat::TupleStruct(tuple) => &tuple.path,
        Pat::Struct(item) => &item.path,
        _ => return Vec::new(),
    };
    path.segments.last().map(|s| s.ident.to_string()).into_iter().collect()
}
