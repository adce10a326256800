//! What the host writes and reads lies as the kernels have it.

use riprap::{
    gpu::{
        bins::{DeviceBox, Level},
        layout::check,
        link::{Linked, Program},
    },
    rock::broadphase::{Header, Search},
};
use std::mem::offset_of;

fn pairs() -> Linked {
    let program = Program::new("pairs").slot("found", "found_count");
    program.link().unwrap()
}

#[test]
fn boxes() {
    let fields = [
        ("min", offset_of!(DeviceBox, min)),
        ("group", offset_of!(DeviceBox, group)),
        ("max", offset_of!(DeviceBox, max)),
        ("tag", offset_of!(DeviceBox, tag)),
    ];
    for entry in ["bin_count", "bin_scatter"] {
        let linked = Program::new(entry).link().unwrap();
        check::<DeviceBox>(&linked.module, "Box", &fields).unwrap();
    }
    check::<DeviceBox>(&pairs().module, "Box", &fields).unwrap();
}

#[test]
fn levels() {
    let fields = [
        ("scale", offset_of!(Level, scale)),
        ("extent", offset_of!(Level, extent)),
    ];
    check::<Level>(&pairs().module, "Level", &fields).unwrap();
}

#[test]
fn searches() {
    let fields = [
        ("levels", offset_of!(Search, levels)),
        ("slices", offset_of!(Search, slices)),
        ("first_pair", offset_of!(Search, first_pair)),
    ];
    check::<Search>(&pairs().module, "Search", &fields).unwrap();
}

#[test]
fn headers() {
    let fields = [
        ("candidates", offset_of!(Header, candidates)),
        ("pairs", offset_of!(Header, pairs)),
    ];
    check::<Header>(&pairs().module, "Header", &fields).unwrap();
}
