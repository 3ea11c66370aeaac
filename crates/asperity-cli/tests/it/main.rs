//! The command as its users meet it, as one program: a module for each subject.

mod command;
mod digests;
mod documents;
mod run;
mod study;
#[cfg(unix)]
mod survival;
mod support;
