//! Data shared by several operators.

use std::collections::HashMap;
use std::hash::Hash;
use std::sync::{Arc, Mutex, PoisonError};

/// Values that are computed on first use, one for each key.
///
/// A value is computed without the lock. The computation may be parallel, and a waiting thread may perform
/// another task that requests a value too. Under the lock it would wait for itself. Threads with simultaneous
/// requests compute the same value, and one of the results is stored.
#[derive(Debug)]
pub(super) struct Shared<K, V: ?Sized>(Mutex<HashMap<K, Arc<V>>>);

impl<K: Eq + Hash, V: ?Sized> Shared<K, V> {
    /// Returns the value of a `key`, computed by `make` if it is missing.
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
