//! Tests of the whole: the order of crates and modules, the names of capabilities, the messages of all of them, and their version.

mod capabilities;
mod circles;
mod messages;
mod module_order;
mod support;
mod versions;
