//! Pictures in space: what can be seen, and from where.

use crate::blocks::cube;
use crate::{channel, refused};
use riprap::Result;
use riprap::scene::{Axis, Scene, SliceField};

/// A dry scene with a view of these keys.
fn dry(keys: &str) -> Result<Scene> {
    cube(&format!("[[views]]\nname = \"v\"\n{keys}\n"))
}

/// A channel without blocks with a view of these keys.
fn wet(keys: &str) -> Result<Scene> {
    channel(&format!("[[views]]\nname = \"v\"\n{keys}\n"))
}

#[test]
fn cameras_look_at_something() {
    refused(dry("from = [0, 0, 1]"), &["views[0].from", "add `to`"]);
    refused(
        dry("from = [0, 0, 1]\nto = [0, 0, 0]"),
        &["views[0].up", "looks along it"],
    );
    refused(dry("size = [10, 10]"), &["views[0].size[0]", "64 to 8192"]);
}

#[test]
fn views_show_what_there_is() {
    refused(
        wet(""),
        &["views[0]", "there are none", "`slices` or `traces`"],
    );
    for (keys, key) in [
        ("traces = 10", "views[0].traces"),
        (
            "slices = [{ axis = \"y\", field = \"speed\" }]",
            "views[0].slices",
        ),
    ] {
        refused(dry(keys), &[key, "there is none", "add [fluid]"]);
    }
    let scene = wet(
        "traces = 10\nslices = [{ axis = \"y\", position = 0.004, field = \"pressure\", \
         range = [-1, 1] }, { axis = \"z\", field = \"speed\" }]",
    );
    let view = &scene.unwrap().views[0];
    assert!(view.shows_fluid() && view.traces == 10);
    let [first, second] = &view.slices[..] else {
        panic!("{:?}", view.slices);
    };
    assert_eq!((first.axis, first.position), (Axis::Y, Some(0.004)));
    assert_eq!(
        (first.field, first.range),
        (SliceField::Pressure, Some([-1.0, 1.0]))
    );
    assert_eq!((second.position, second.range), (None, None));
}

#[test]
fn slices_and_traces_of_views_can_be_drawn() {
    let slice = |keys: &str| wet(&format!("slices = [{{ axis = \"y\", {keys} }}]"));
    refused(
        slice("field = \"speed\", position = 0.011"),
        &["views[0].slices[0].position", "outside the domain"],
    );
    refused(
        slice("field = \"speed\", range = [1, 1]"),
        &["views[0].slices[0].range", "the first must be the smaller"],
    );
    refused(
        slice("field = \"solid\""),
        &[
            "views[0].slices[0].field",
            "leave solid cells out",
            "output.slices",
        ],
    );
    refused(
        slice("field = \"eddy_viscosity\""),
        &["views[0].slices[0].field", "wale"],
    );
    refused(
        slice("field = \"speed\", streamlines = true"),
        &["streamlines", "range"],
    );
    refused(wet("traces = 1001"), &["views[0].traces", "0 to 1000"]);
}
