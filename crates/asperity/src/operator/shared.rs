//! What several operators share.

use std::collections::HashMap;
use std::hash::Hash;
use std::sync::{Arc, Mutex, PoisonError};

/// Values that are made when they are first asked for, one for each key.
///
/// A value is made without the lock. Its maker may work in parallel, and a thread that waits for the others may take up a
/// task meanwhile that asks for a value, too: under the lock it would wait for itself. Threads that ask at the same time make
/// the same value, of which one is kept.
#[derive(Debug)]
pub(super) struct Shared<K, V: ?Sized>(Mutex<HashMap<K, Arc<V>>>);

impl<K: Eq + Hash, V: ?Sized> Shared<K, V> {
    /// The value of a `key`, which `make` makes if it is not there.
    pub(super) fn get(&self, key: K, make: impl FnOnce() -> Arc<V>) -> Arc<V> {
        let known = self.lock(|values| values.get(&key).cloned());
        known.unwrap_or_else(|| {
            let made = make();
            self.lock(|values| Arc::clone(values.entry(key).or_insert(made)))
        })
    }

    fn lock<R>(&self, of: impl FnOnce(&mut HashMap<K, Arc<V>>) -> R) -> R {
        of(&mut self.0.lock().unwrap_or_else(PoisonError::into_inner))
    }
}

impl<K, V: ?Sized> Default for Shared<K, V> {
    fn default() -> Self {
        Self(Mutex::default())
    }
}
