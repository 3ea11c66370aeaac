//! Tests of the whole: the order of crates and modules, the names of capabilities, and the messages of all of them.

mod capabilities;
mod circles;
mod messages;
mod module_order;
mod support;
