//! What crosses the modules of the library, as one program: a module for each subject.

mod bad_inputs;
mod bounds;
mod closed_forms;
mod convergence;
mod documents;
mod extremes;
mod friction;
mod good_inputs;
mod hardness;
mod laws;
mod line;
mod loading;
mod messages;
mod module_order;
mod motion;
mod moving_surfaces;
mod random_motions;
mod real_surface;
mod response;
mod sliding;
mod solver;
mod subsurface;
mod sweep;
mod topography_corpus;
mod warnings;
mod support;
