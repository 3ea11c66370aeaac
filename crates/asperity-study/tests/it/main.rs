//! Tests of case files, runs and results, as one program with a module for each subject.

mod bad_inputs;
mod case_file;
mod common_grid;
mod documents;
mod elasto_plastic;
mod extremes;
mod fretting;
mod good_inputs;
mod hardness;
mod in_place;
mod kinematics;
mod limits;
mod loading;
mod passage;
mod python_keys;
mod real_surface;
mod resume;
mod rolling;
mod smooth_forms;
mod subsurface;
mod support;
mod sweep;
mod viscoelastic;
mod warnings;
mod watch;
mod written;
