//! What the faces of blocks show, for ParaView.

use crate::{
    coupling::Coupled,
    geometry::{Form, Pose},
    output::{Array, Surface},
    psm::{FaceLoad, corners},
    rock::Block,
};

/// The faces of the blocks whose loads somebody asks for, with the number of their block, pressure and shear stress
/// (Pa), and the share of them that is wet; NaN for what no fluid lies next to.
pub fn face_surface(coupled: &Coupled<'_>) -> Surface {
    let mut made = Surface::default();
    let mut shown: Vec<(usize, &FaceLoad)> = Vec::new();
    let poses = coupled.blocks().poses();
    let blocks = &coupled.setup().setup.blocks;
    for (number, (block, pose)) in blocks.iter().zip(&poses).enumerate() {
        for load in coupled.face_loads(number) {
            made.polygons.push(polygon(block, load, pose));
            shown.push((number, load));
        }
    }
    let scalar = |name: &str, value: &dyn Fn(&(usize, &FaceLoad)) -> f64| Array {
        name: name.into(),
        components: 1,
        values: shown.iter().map(|of| value(of) as f32).collect(),
    };
    let shear = shown.iter().flat_map(|(_, load)| load.shear().to_array());
    made.arrays = vec![
        scalar("block", &|(block, _)| *block as f64),
        scalar("pressure", &|(_, load)| load.pressure()),
        scalar("wetted", &|(_, load)| load.wetted / load.face.area),
        Array {
            name: "shear".into(),
            components: 3,
            values: shear.map(|x| x as f32).collect(),
        },
    ];
    made
}

fn polygon(block: &Block, load: &FaceLoad, pose: &Pose) -> Vec<[f64; 3]> {
    let part = &block.shape.parts()[load.face.part];
    let Form::Convex(shape) = &part.form else {
        return Vec::new();
    };
    let corners = corners(shape, load.face.face, part.offset, pose);
    corners.iter().map(|x| x.to_array()).collect()
}
