//! Tests of the whole: the order of crates and modules, and the messages of all of them.

mod circles;
mod messages;
mod module_order;
mod support;
