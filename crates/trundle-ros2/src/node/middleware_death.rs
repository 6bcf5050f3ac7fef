//! Whether a thread of the middleware has died.
//!
//! RustDDS has no interface for this condition: its threads end by a panic, while sockets and topics remain and are silent.

use std::collections::BTreeSet;
use std::panic::{self, PanicHookInfo};
use std::sync::{Mutex, Once, PoisonError};

/// Prefix of the middleware's thread names.
const THREAD_PREFIX: &str = "RustDDS";

/// Names of threads that died by a panic.
static DEAD: Mutex<BTreeSet<String>> = Mutex::new(BTreeSet::new());

/// Notes panics of named threads from here on. The hook that was set before is called too.
pub(super) fn watch() {
    static HOOK: Once = Once::new();
    HOOK.call_once(|| {
        let before = panic::take_hook();
        panic::set_hook(Box::new(move |info: &PanicHookInfo<'_>| {
            if let Some(name) = std::thread::current().name().filter(|name| name.contains(THREAD_PREFIX)) {
                DEAD.lock().unwrap_or_else(PoisonError::into_inner).insert(name.to_owned());
            }
            before(info);
        }));
    });
}

/// The name of a thread of the middleware that has died.
pub(super) fn dead_thread() -> Option<String> {
    dead_thread_of(THREAD_PREFIX)
}

fn dead_thread_of(prefix: &str) -> Option<String> {
    let dead = DEAD.lock().unwrap_or_else(PoisonError::into_inner);
    dead.iter().find(|name| name.starts_with(prefix)).cloned()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_thread_that_panics_is_named_and_others_are_not() {
        watch();
        let died = |name: &str| {
            let thread = std::thread::Builder::new().name(name.to_owned());
            thread.spawn(|| panic!("as a test wants it")).unwrap().join().unwrap_err();
        };
        // A unique prefix: other tests of this process have nodes.
        died("test of RustDDS 1");
        died("something else");
        assert_eq!(dead_thread_of("test of "), Some("test of RustDDS 1".to_owned()));
        assert_eq!(dead_thread_of("something"), None);
        assert_eq!(dead_thread(), None);
    }
}
