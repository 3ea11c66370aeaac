//! The cases of `asperity verify`, with one sentence of physics each.

use asperity_contact::verification::{CASES, Check};

/// One test for each case, and one that checks that none is missing.
macro_rules! cases {
    ($($(#[$slow:meta])? $sentence:ident: $name:literal,)*) => {
        $(#[test] $(#[$slow])? fn $sentence() { holds($name) })*

        #[test]
        fn every_case_has_its_sentence() {
            let names: Vec<_> = CASES.iter().map(|case| case.name).collect();
            assert_eq!(names, [$($name),*]);
        }
    };
}

cases! {
    a_loaded_rectangle_sinks_as_its_parts_together: "Love: uniformly loaded rectangle",
    zero_padding_frees_the_surface: "free FFT: the direct sum",
    a_harmonic_pressure_bends_the_surface_into_itself: "periodic FFT: oblique sinusoid",
    an_endless_strip_sinks_as_its_cells_together: "Flamant: uniformly loaded strip",
    a_sphere_is_flattened_over_a_circle: "Hertz: sphere",
    an_ellipsoid_is_flattened_over_an_ellipse: "Hertz: ellipsoid, radii 1 : 4",
    a_cylinder_is_flattened_along_a_line: "Hertz: cylinder, period 32 a",
    a_line_of_contact_without_ends_or_neighbours: "Hertz: cylinder, periodic along it alone",
    a_flat_punch_sinks_in_proportion_to_its_load: "flat punch",
    a_wave_touches_over_a_quarter: "Westergaard: contact of 1/4",
    a_wave_touches_over_a_half: "Westergaard: contact of 1/2",
    a_wave_touches_over_three_quarters: "Westergaard: contact of 3/4",
    a_wave_is_pressed_flat: "Westergaard: p̄/p* = 1.2",
    a_wave_meets_the_layer_or_what_is_under_it: "Coated half-space: harmonics",
    cells_on_a_coated_body_add_up_to_its_waves: "Coated half-space: cells against harmonics",
    a_thick_layer_is_all_that_a_sphere_meets: "Coated half-space: Hertz on a thick layer",
    a_thin_layer_on_a_rigid_body_is_a_foundation: "Coated half-space: thin layer on a rigid body",
    two_thin_layers_on_a_rigid_body_are_foundations_in_series: "Layered body: two thin layers on a rigid body",
    two_thin_layers_are_sheared_in_series_too: "Layered body: a sphere that sticks to two thin layers",
    two_thin_layers_under_a_line_are_foundations_in_series: "Layered body: cylinder on two thin layers, periodic along it alone",
    what_cannot_be_compressed_flows_out_of_the_gap: "Coated half-space: thin incompressible layer on a rigid body",
    what_flows_everywhere_bears_its_hardness: "fully plastic: W = 0.2 H A₀",
    the_bodies_store_the_work_of_the_load: "rough contact: work of the load",
    the_contact_does_not_depend_on_how_it_is_found: "rough contact: three methods, device",
    a_sphere_sticks_by_its_work_of_adhesion_alone: "JKR: sphere, range of the grid",
    a_long_attraction_reaches_beyond_the_contact: "Maugis: sphere, λ = 0.3",
    a_short_attraction_pulls_at_the_edge: "Maugis: sphere, λ = 1",
    a_wave_sticks_to_a_plane: "Johnson: adhesive wave, α = 0.3",
    bodies_that_attract_each_other_store_the_work_of_the_load: "adhesive sphere: work of the load",
    bodies_that_hardly_attract_each_other_press_as_without: "adhesive sphere: w → 0",
    a_wave_takes_the_loss_of_its_frequency: "Viscoelastic body: wave in full contact",
    rubber_resists_a_cylinder_and_lets_it_go_late: "Viscoelastic body: sliding cylinder",
    a_thin_layer_of_rubber_resists_as_a_foundation: "Viscoelastic layer: cylinder sliding on a thin layer",
    rubber_that_a_cylinder_passes_over_soon_resists_it_steadily: "Viscoelastic body: cylinder in a pass",
    a_fast_sphere_meets_the_glassy_body: "Viscoelastic body: fast sphere",
    a_sphere_sinks_in_as_its_bodies_creep: "Viscoelastic body: sphere under a step of load",
    nine_coefficients_spread_the_point_loads_over_a_cell: "nine coefficients: quadrature",
    zero_padding_frees_the_surface_in_all_directions: "coupled free FFT: the direct sum",
    a_wave_of_shear_displaces_along_and_across_its_crests: "coupled periodic FFT: oblique sinusoids",
    a_sphere_pushed_aside_slips_in_a_ring: "Cattaneo–Mindlin: Q = 0.6 μW",
    a_punch_that_sticks_is_softer_sideways: "Mindlin: no slip, ν = 0.3",
    what_is_pushed_to_and_fro_loses_the_area_of_its_loop: "hysteresis: Q = ±0.9 μW",
    a_disc_that_sticks_resists_as_mindlin_says: "tangential stiffness of a disc, ν = 0.3",
    identical_bodies_press_as_without_friction: "identical bodies: uncoupled",
    a_little_difference_changes_the_pressure_by_its_square: "almost identical bodies: W alone",
    a_punch_that_sticks_bears_more: "punch without slip: β = 0.3",
    a_punch_on_another_material_slips_at_its_edge: "Spence's punch after Goodman: β = 0.3",
    less_sticks_where_shear_lifts: "Spence's punch: β = 0.5",
    a_sphere_sticks_over_the_same_share_as_a_punch: "Spence's sphere, in increments: β = 0.3",
    a_driven_wheel_creeps: "Carter: cylinder, period 32 a, c = 5/8 a",
    what_creeps_and_spins_without_slip_is_linear: "Kalker: creepage and spin without slip, ν = 1/4",
    stresses_under_a_rectangle_are_those_of_its_parts: "Love: stress under a loaded rectangle",
    a_sphere_yields_below_its_contact: "Hertz: stress under a sphere",
    a_sliding_sphere_yields_nearer_to_the_surface: "Hamilton: stress under a sliding sphere, friction 0.25",
    a_point_remembers_all_that_a_line_did_to_it: "Dang Van: line contact that passes",
    a_moving_square_is_hottest_behind_its_middle: "moving square: Pe 0, 1, 5, 10, 100",
    a_wave_of_heat_lags_behind_its_source: "periodic heat: oblique sinusoid",
    a_disc_warms_up_as_the_root_of_time_at_first: "heated disc: in time",
    heat_spreads_as_displacement_does: "Hertzian flux at rest",
    a_moving_square_comes_to_its_steady_temperature: "moving square, step by step",
    equal_bodies_share_heat_and_none_is_lost: "heat: divided, and all of it",
    a_spot_conducts_as_its_capacity: "conductance of spots: square, disc, ellipse 2 : 1",
    two_spots_constrict_each_other: "conductance: two spots",
    images_of_a_spot_share_its_spreading: "conductance: free less periodic",
    a_film_makes_the_flux_uniform: "conductance: film on a disc",
    gas_conducts_in_parallel_or_in_series: "conductance: gas in a gap",
    a_spot_spreads_in_the_layer_or_below_it: "conductance: disc on a coated body",
    a_contact_conducts_as_it_is_stiff: "conductance: Barber's relation",
    plates_let_through_the_cube_of_their_gap: "flow: parallel plates",
    grooves_guide_the_flow_or_bar_its_way: "flow: corrugation 1 + 0.6 cos",
    grooves_that_slide_carry_what_lies_in_them: "flow: sliding corrugation 1 + 0.6 cos",
    small_roughness_slows_the_flow_by_its_square: "flow: small roughness of rms height s",
    a_fluid_flows_around_discs_of_contact: "flow: discs of contact, 30 %",
    a_gap_that_opens_from_a_rim_is_of_second_order: "flow: gap ∝ (r − a)^(3/2) beside a contact",
    a_checkerboard_conducts_as_its_geometric_mean: "flow: checkerboard of permeabilities 1 : 4",
    what_flows_in_flows_out_at_any_contrast: "flow: contrast 10¹⁸",
    an_inclined_pad_rides_on_its_wedge: "lubrication: inclined pad",
    a_film_ruptures_where_its_pressure_is_gone: "lubrication: parabola with rupture",
    oil_between_plates_resists_their_approach: "lubrication: squeezed strip",
    a_ball_that_is_carried_by_oil_is_flattened: "lubrication: ball under a full film",
    what_slides_slowly_touches_as_if_it_were_dry: "lubrication: slow sliding",
    what_flows_keeps_the_work: "plastic flow: work over load, unload, reload",
    a_sphere_begins_to_flow_below_the_surface: "plastic flow: onset under a sphere",
    #[ignore = "half a minute"] a_sphere_flows_load_by_load: "plastic flow: sphere, load by load",
    #[ignore = "half a minute"] steps_of_the_load_are_of_the_first_order: "plastic flow: steps of the load",
    #[ignore = "minutes"] a_sphere_pressed_deep_is_borne_by_three_yield_stresses: "plastic flow: fully plastic sphere",
    #[ignore = "half a minute"] a_line_contact_shakes_down_below_four_k: "plastic flow: rolling line contact",
    rolling_leaves_residual_compression: "plastic flow: residual stress of rolling",
    kinematic_hardening_ends_ratchetting: "plastic flow: rolling, kinematic hardening",
    #[ignore = "half a minute"] a_point_contact_shakes_down_below_five_k: "plastic flow: rolling point contact",
    grooves_wear_as_a_power_of_e: "grooves wear: A₀ e^(−(k₁+k₂)E*πs/L)",
    a_film_tends_to_its_steady_thickness: "a film grows",
    grooves_wear_in_place_as_a_power_of_e: "grooves wear in place: A₀ e^(−(k₁+k₂)E*πs/L)",
    grooves_wear_less_under_a_growing_film: "grooves wear in place under a growing film",
    flat_bodies_wear_until_the_pressure_is_even: "flat on flat wears: p̄ everywhere, −p̄ C·1",
    a_ball_wears_to_a_cap: "ball on disc wears: k = 1.33e-13 1/Pa, 640 mm",
    a_ball_wears_only_where_it_slips: "fretting: Q = ±0.8 μW, a cycle of wear",
    cycles_that_stand_for_several_leave_the_scar_of_all: "fretting: a scar of 64 cycles, some computed",
}

fn holds(name: &str) {
    let case = CASES.iter().find(|case| case.name == name).unwrap();
    let checks = (case.checks)().unwrap();
    let failed: Vec<&Check> = checks.iter().filter(|check| !check.passed()).collect();
    assert!(failed.is_empty(), "{name}: {failed:#?}");
}
