//! The command as its users meet it, as one program: a module for each subject.

mod bad_inputs;
mod check;
mod command;
#[cfg(unix)]
mod damage;
mod device;
mod digests;
mod directories;
mod documents;
mod files_of_a_run;
mod friction;
mod limits;
mod pair;
mod passage;
mod resume;
mod study;
mod support;
#[cfg(unix)]
mod survival;
mod terminal;
