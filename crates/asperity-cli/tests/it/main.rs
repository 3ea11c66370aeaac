//! The command as its users meet it, as one program: a module for each subject.

mod check;
mod command;
#[cfg(unix)]
mod damage;
mod digests;
mod documents;
mod limits;
mod passage;
mod run;
mod study;
#[cfg(unix)]
mod survival;
mod support;
