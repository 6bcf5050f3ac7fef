//! Lists of parameters that fit into a reply.

use crate::generated::rcl_interfaces::{ListParametersRequest, ListParametersResult};
use crate::node::arrives;

/// The requested names. If they do not fit into a reply: those of the upper levels, and the prefixes of the rest.
pub(super) fn list<'n>(
    names: impl Iterator<Item = &'n String>,
    request: &ListParametersRequest,
) -> ListParametersResult {
    let asked: Vec<(&String, usize)> =
        names.filter_map(|name| Some((name, level(name, &request.prefixes)?))).collect();
    let deepest = asked.iter().map(|(_, level)| *level).max().unwrap_or_default();
    let wanted = if request.depth == 0 { deepest } else { deepest.min(request.depth as usize) };
    let mut lists = (0..=wanted).rev().map(|depth| listing(&asked, depth));
    lists.find(arrives).unwrap_or_default()
}

/// Depth of `name` below the prefixes, from 1; 0 if it equals one of them. `None` if no prefix matches.
fn level(name: &str, prefixes: &[String]) -> Option<usize> {
    let below = |prefix: &String| match name.strip_prefix(prefix.as_str())? {
        "" => Some(0),
        rest => Some(rest.strip_prefix('.')?.split('.').count()),
    };
    if prefixes.is_empty() { Some(name.split('.').count()) } else { prefixes.iter().find_map(below) }
}

/// The names down to `depth`, and the prefixes of these and of deeper names.
fn listing(asked: &[(&String, usize)], depth: usize) -> ListParametersResult {
    let names = asked.iter().filter(|(_, level)| *level <= depth).map(|(name, _)| (*name).clone()).collect();
    let prefix = |(name, level): &(&String, usize)| {
        let parts: Vec<&str> = name.split('.').collect();
        let kept = parts.len().saturating_sub(level.saturating_sub(depth).max(1));
        (kept > 0).then(|| parts[..kept].join("."))
    };
    let mut prefixes: Vec<String> = asked.iter().filter_map(prefix).collect();
    prefixes.sort_unstable();
    prefixes.dedup();
    ListParametersResult { names, prefixes }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::collections::BTreeSet;
    use trundle_runtime::settings::reference;

    #[test]
    fn lists_that_have_no_room_in_a_reply_name_their_prefixes_and_these_lead_to_every_parameter() {
        let names: BTreeSet<String> = reference().iter().map(|setting| setting.key.to_owned()).collect();
        let (mut prefixes, mut found, mut asked) = (vec![String::new()], BTreeSet::new(), BTreeSet::new());
        while let Some(prefix) = prefixes.pop() {
            if !asked.insert(prefix.clone()) {
                continue;
            }
            let own = if prefix.is_empty() { Vec::new() } else { vec![prefix.clone()] };
            let list = list(names.iter(), &ListParametersRequest { prefixes: own, depth: 0 });
            assert!(arrives(&list) && list.names.iter().all(|name| name.starts_with(&prefix)), "{prefix}");
            found.extend(list.names);
            prefixes.extend(list.prefixes);
        }
        assert!(names.len() > 100 && found == names, "{} of {}", found.len(), names.len());
        let request = ListParametersRequest { prefixes: vec!["docking".into()], depth: 1 };
        let below = list(names.iter(), &request);
        assert!(!below.names.is_empty() && below.names.iter().all(|name| name.split('.').count() == 2));
    }
}
