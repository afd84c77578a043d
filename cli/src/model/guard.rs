//! Turns a panic inside a foreign reader into an error.

use std::cell::Cell;
use std::panic::{self, UnwindSafe};
use std::sync::Once;

use super::error::{Fault, LoadError};

thread_local! {
    static GUARDED: Cell<bool> = const { Cell::new(false) };
}

/// Runs `read`; should it panic, the file is [`Fault::Incomprehensible`].
pub(super) fn guarded<T>(read: impl FnOnce() -> Result<T, LoadError> + UnwindSafe) -> Result<T, LoadError> {
    caught(read).unwrap_or_else(|| Err(Fault::Incomprehensible.into()))
}

/// What `read` returns, or nothing should it panic.
///
/// The glTF reader unwraps, indexes and subtracts in places that only a damaged file reaches. A bad
/// file is an everyday event and must end in one line, so the panic is caught, and the hook that
/// would print it is silenced: on this thread and during `read` only, so that our own bugs stay loud.
pub fn caught<T>(read: impl FnOnce() -> T + UnwindSafe) -> Option<T> {
    static QUIET_HOOK: Once = Once::new();
    QUIET_HOOK.call_once(|| {
        let loud = panic::take_hook();
        panic::set_hook(Box::new(move |info| {
            if !GUARDED.get() {
                loud(info);
            }
        }));
    });
    GUARDED.set(true);
    let outcome = panic::catch_unwind(read);
    GUARDED.set(false);
    outcome.ok()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_panic_becomes_an_error() {
        let error = guarded::<()>(|| panic!("index out of bounds")).unwrap_err();
        assert!(matches!(error.fault, Fault::Incomprehensible));
    }
}
