//! Shared by tests of sections and charts: a file for a picture, its pixels, and numbered cells.

use riprap::output::{Array, ImageData};
use riprap_harness::picture::{Plane, Quantity, Slice};
use std::fs::File;
use std::io::BufReader;
use std::path::{Path, PathBuf};

pub type Rgb = [u8; 3];

/// Path of a picture that a test may write.
pub fn file(name: &str) -> PathBuf {
    Path::new(env!("CARGO_TARGET_TMPDIR")).join(name)
}

/// Width, height and pixels of a PNG file.
pub fn read(path: &Path) -> (usize, usize, Vec<Rgb>) {
    let file = BufReader::new(File::open(path).expect("the picture"));
    let mut reader = png::Decoder::new(file).read_info().expect("a PNG file");
    let mut bytes = vec![0; reader.output_buffer_size().expect("a size")];
    let info = reader.next_frame(&mut bytes).expect("whole pixels");
    let pixels = bytes
        .chunks(3)
        .map(|rgb| [rgb[0], rgb[1], rgb[2]])
        .collect();
    (info.width as usize, info.height as usize, pixels)
}

pub fn slice<'a>(quantity: Quantity<'a>, normal: usize, position: f64) -> Slice<'a> {
    Slice {
        title: "test",
        time: 0.0,
        plane: Plane { normal, position },
        quantity,
        label: "pressure",
        unit: "Pa",
        range: None,
        streamlines: false,
        blocks: &[],
    }
}

/// 4 × 2 × 3 cells of 0.5 m whose pressure is their index; the last cell of each row is solid.
pub fn counting() -> ImageData {
    let cells = [4, 2, 3];
    let count = cells.iter().product::<usize>();
    ImageData {
        origin: [0.0; 3],
        spacing: 0.5,
        cells,
        arrays: vec![
            Array {
                name: "pressure".into(),
                components: 1,
                values: (0..count).map(|cell| cell as f32).collect(),
            },
            Array {
                name: "solid".into(),
                components: 1,
                values: (0..count).map(|cell| f32::from(cell % 4 == 3)).collect(),
            },
        ],
    }
}
