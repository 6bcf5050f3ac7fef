//! The graph of each crate's modules: no module depends on itself through others.
//!
//! A module is a file. It depends on another module if its code, without re-exports, names an item defined there. For a re-exported item,
//! the defining module counts.

use super::finding::{Finding, Rule};
use super::tree::{Package, Tree};
use super::use_paths::{self, NamedPath};
use std::collections::{BTreeMap, BTreeSet};

/// A module's path below its crate's root; empty for the root.
type ModulePath = Vec<String>;

/// Re-exports that are followed one after the other at the longest. Source: ours.
const MAX_REEXPORTS: usize = 8;

/// Checks the modules of every package.
pub fn check(tree: &Tree) -> Vec<Finding> {
    tree.packages.iter().flat_map(|package| check_package(tree, package)).collect()
}

fn check_package(tree: &Tree, package: &Package) -> Vec<Finding> {
    let modules = Modules::read(tree, package);
    let cycles = cycles(&modules.edges());
    let root = format!("{}/src", package.folder);
    let name = |module: &&ModulePath| if module.is_empty() { "the root".into() } else { module.join("::") };
    cycles
        .into_iter()
        .flat_map(|cycle| {
            let names: Vec<String> = cycle.iter().map(name).collect();
            let message =
                format!("{} modules depend on each other in a cycle: {}", names.len(), names.join(", "));
            names
                .iter()
                .map(|_| Finding::ruled(Rule::ModuleCycle, &root, 1, message.clone()))
                .collect::<Vec<_>>()
        })
        .collect()
}

/// The modules of a crate with the paths in each.
struct Modules {
    named: BTreeMap<ModulePath, Vec<NamedPath>>,
}

impl Modules {
    fn read(tree: &Tree, package: &Package) -> Self {
        let src = format!("{}/src/", package.folder);
        let named = tree
            .sources(package)
            .filter(|source| !is_test_file(&source.file.path))
            .map(|source| (module_path(&source.file.path[src.len()..]), use_paths::paths(source.code.text())))
            .collect();
        Self { named }
    }

    /// Dependencies of each module.
    fn edges(&self) -> BTreeMap<&ModulePath, BTreeSet<&ModulePath>> {
        let targets = |module, paths: &[NamedPath]| -> BTreeSet<&ModulePath> {
            let used = paths.iter().filter(|path| !path.is_exported);
            let resolved = used.filter_map(|path| self.resolve(module, &path.segments, MAX_REEXPORTS));
            resolved.filter(|target| *target != module).collect()
        };
        self.named.iter().map(|(module, paths)| (module, targets(module, paths))).collect()
    }

    /// The module that defines the item of `path`, used in `module`; `None` outside the crate.
    fn resolve(&self, module: &ModulePath, path: &[String], reexports: usize) -> Option<&ModulePath> {
        let (first, mut rest) = path.split_first()?;
        let mut at = match first.as_str() {
            "crate" => ModulePath::new(),
            "self" => module.clone(),
            "super" => parent(module)?,
            name => {
                let child = [module.clone(), vec![name.to_owned()]].concat();
                if self.named.contains_key(&child) {
                    child
                } else {
                    return self.resolve_binding(module, name, rest, reexports);
                }
            }
        };
        while let Some((next, after)) = rest.split_first() {
            let child = [at.clone(), vec![next.clone()]].concat();
            if next == "super" {
                at = parent(&at)?;
            } else if self.named.contains_key(&child) {
                at = child;
            } else {
                let bound = self.resolve_binding(&at, next, after, reexports);
                return bound.or_else(|| self.named.get_key_value(&at).map(|(key, _)| key));
            }
            rest = after;
        }
        self.named.get_key_value(&at).map(|(key, _)| key)
    }

    /// Follows `use path as name` of a module.
    fn resolve_binding(
        &self,
        module: &ModulePath,
        name: &str,
        rest: &[String],
        left: usize,
    ) -> Option<&ModulePath> {
        let left = left.checked_sub(1)?;
        let named = self.named.get(module)?;
        let bound = named.iter().find(|path| path.binds.as_deref() == Some(name))?;
        self.resolve(module, &[&bound.segments[..], rest].concat(), left)
    }
}

fn parent(module: &ModulePath) -> Option<ModulePath> {
    module.split_last().map(|(_, rest)| rest.to_vec())
}

fn module_path(file: &str) -> ModulePath {
    let stem = file.trim_end_matches(".rs");
    let stem = stem.strip_suffix("/mod").unwrap_or(stem);
    if ["lib", "main", "mod"].contains(&stem) {
        Vec::new()
    } else {
        stem.split('/').map(str::to_owned).collect()
    }
}

fn is_test_file(path: &str) -> bool {
    path.ends_with("/tests.rs") || path.contains("/tests/") || path.ends_with("/testing.rs")
}

/// The strongly connected components with more than one module.
fn cycles<'a>(edges: &BTreeMap<&'a ModulePath, BTreeSet<&'a ModulePath>>) -> Vec<Vec<&'a ModulePath>> {
    let mut search =
        Search { edges, order: BTreeMap::new(), low: BTreeMap::new(), stack: Vec::new(), found: Vec::new() };
    for module in edges.keys() {
        if !search.order.contains_key(*module) {
            search.visit(module);
        }
    }
    search.found
}

struct Search<'e, 'a> {
    edges: &'e BTreeMap<&'a ModulePath, BTreeSet<&'a ModulePath>>,
    order: BTreeMap<&'a ModulePath, usize>,
    low: BTreeMap<&'a ModulePath, usize>,
    stack: Vec<&'a ModulePath>,
    found: Vec<Vec<&'a ModulePath>>,
}

impl<'a> Search<'_, 'a> {
    fn visit(&mut self, module: &'a ModulePath) {
        let number = self.order.len();
        self.order.insert(module, number);
        self.low.insert(module, number);
        self.stack.push(module);
        let edges = self.edges;
        for &target in edges.get(module).into_iter().flatten() {
            if !self.order.contains_key(target) {
                self.visit(target);
                let low = self.low[target].min(self.low[module]);
                self.low.insert(module, low);
            } else if self.stack.contains(&target) {
                let low = self.order[target].min(self.low[module]);
                self.low.insert(module, low);
            }
        }
        if self.low[module] == number {
            let at = self
                .stack
                .iter()
                .position(|m| *m == module)
                .expect("invariant: visited modules are on the stack");
            let mut component = self.stack.split_off(at);
            if component.len() > 1 {
                component.sort();
                self.found.push(component);
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::tidy::tree::tests::tree;

    fn found(files: &[(&str, &str)]) -> Vec<String> {
        let manifest = ("x/Cargo.toml", "[package]\nname = \"x\"");
        let files: Vec<(&str, &str)> = std::iter::once(manifest).chain(files.iter().copied()).collect();
        check(&tree(&files)).iter().map(|f| f.message.clone()).collect()
    }

    #[test]
    fn a_cycle_through_three_files_is_found() {
        let files = [
            ("x/src/lib.rs", "mod a; mod b; mod c; pub use a::A;"),
            ("x/src/a.rs", "use crate::b::B; pub struct A;"),
            ("x/src/b.rs", "pub struct B(crate::c::C);"),
            ("x/src/c.rs", "use crate::A; pub struct C;"),
        ];
        let found = found(&files);
        assert_eq!(found.len(), 3, "one finding a module");
        assert!(found[0].ends_with("cycle: a, b, c"), "{found:?}");
    }

    #[test]
    fn reexports_make_no_cycle() {
        let files = [
            ("x/src/lib.rs", "mod a;"),
            ("x/src/a/mod.rs", "mod p; mod q; pub use p::P; pub use q::Q;"),
            ("x/src/a/p.rs", "use super::Q; pub struct P;"),
            ("x/src/a/q.rs", "pub struct Q;"),
        ];
        assert!(found(&files).is_empty());
    }

    #[test]
    fn a_child_that_uses_its_parent_is_a_cycle_if_the_parent_uses_the_child() {
        let parent = "mod p; use p::P; pub struct Base; fn f(_: P) {}";
        let files = [("x/src/a.rs", parent), ("x/src/a/p.rs", "use super::Base; pub struct P(Base);")];
        assert!(found(&files)[0].ends_with("cycle: a, a::p"));
        let module_import = [
            ("x/src/a.rs", "use crate::b; fn f() { b::g() }"),
            ("x/src/b.rs", "use crate::a::f; pub fn g() {}"),
        ];
        assert_eq!(found(&module_import).len(), 2);
    }
}
