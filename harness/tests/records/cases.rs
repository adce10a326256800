//! Cases of `riprap validate` in their short form: they test themselves.

use riprap_harness::validate::{Args, run};

/// Runs the cases that match `pattern` and prints their results.
fn assert_pass(pattern: &str) {
    let passed = run(Args {
        case: Some(pattern.into()),
        ..Args::default()
    });
    assert!(passed.unwrap(), "{pattern}");
}

#[test]
fn kernels_follow_the_golden_trajectory() {
    assert_pass("kernels/golden");
}

#[test]
fn kernels_with_constants_of_zero_are_the_simpler_ones() {
    assert_pass("kernels/null-models");
}

#[test]
fn the_same_run_gives_the_same_bits() {
    assert_pass("kernels/repeatability");
}

#[test]
fn eddy_viscosity_of_wale() {
    assert_pass("wale/[nps]*");
}

#[test]
fn a_channel_from_an_inlet_to_a_held_pressure() {
    assert_pass("channel/velocity-pressure");
}

#[test]
fn a_channel_from_an_inlet_to_an_outflow() {
    assert_pass("channel/velocity-outflow");
}

#[test]
fn sound_leaves_by_an_outflow() {
    assert_pass("outlet/pulse");
}

#[test]
fn dry_blocks_slide_topple_rebound_and_rotate() {
    assert_pass("rock/[iftw]*");
    assert_pass("rock/rebound");
}

#[test]
fn dry_blocks_at_rest() {
    assert_pass("rock/stack");
    assert_pass("rock/pyramid");
    assert_pass("rock/arch");
}

#[test]
fn contact_or_not() {
    assert_pass("rock/contact-sign");
}

#[test]
fn deformable_blocks() {
    assert_pass("dda/*");
}

#[test]
fn blocks_in_still_water_on_the_lattice() {
    assert_pass("solids/buoyancy");
    assert_pass("solids/neutral");
    assert_pass("solids/turning");
}

#[test]
fn still_free_water() {
    assert_pass("water/still");
}
