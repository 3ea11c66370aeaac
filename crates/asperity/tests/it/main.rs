//! Tests of the whole: the order of crates and modules, the names of capabilities, the way to the disk, the
//! messages of all of them, and their version.

mod capabilities;
mod circles;
mod files;
mod messages;
mod module_order;
mod support;
mod traits;
mod versions;
