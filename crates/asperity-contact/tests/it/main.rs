//! Tests across the modules of contact mechanics, as one program with a module for each subject.

mod adhesion;
mod bounds;
mod closed_forms;
mod conductance;
mod convergence;
mod error_places;
mod flow;
mod friction;
mod in_place;
mod kinematics;
mod laws;
mod line;
mod loading;
mod motion;
mod moving_surfaces;
mod random_motions;
mod random_rolling;
mod response;
mod rolling;
mod running_in;
mod sliding;
mod solver;
mod steady_rolling;
mod sweep;
mod watch;
mod support;
