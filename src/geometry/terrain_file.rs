//! Files of terrain: XYZ, ESRI ASCII grids, GeoTIFF.

use super::Terrain;
use std::io::Cursor;
use tiff::{
    decoder::{Decoder, DecodingResult},
    tags::Tag,
};

/// Tolerance for the distances between nodes, relative to the spacing.
const REGULAR: f64 = 1e-3;
/// Largest number of grid nodes per node with a height; with more, the points are scattered.
const SPARSE: usize = 100;

/// The text of a file, without a byte order mark.
fn text_of(bytes: &[u8]) -> Result<&str, String> {
    let text =
        std::str::from_utf8(bytes).map_err(|e| format!("it is not text: {e}; export it again"))?;
    Ok(text.strip_prefix('\u{feff}').unwrap_or(text))
}

/// Whether spaces or semicolons separate the numbers of a row, so that commas inside of them are not separators.
fn has_decimal_commas(row: &str) -> bool {
    let words = row.split([' ', '\t', ';']).filter(|word| !word.is_empty());
    let inside = |word: &str| word.trim_end_matches(',').contains(',');
    words.clone().count() > 1 && words.clone().any(inside)
}

/// Reads x, y and z of one node per line, in any order, separated by spaces, commas or semicolons. Lines before the first node
/// that are not numbers are column names; lines that begin with # are comments.
pub(super) fn read_xyz(bytes: &[u8]) -> Result<Terrain, String> {
    let text = text_of(bytes)?;
    let mut points: Vec<[f64; 3]> = Vec::new();
    for (line, row) in (1..).zip(text.lines()) {
        let row = row.trim();
        if row.is_empty() || row.starts_with('#') {
            continue;
        }
        let words = row
            .split([' ', '\t', ',', ';'])
            .filter(|word| !word.is_empty());
        let numbers: Result<Vec<f64>, _> = words.map(str::parse).collect();
        if numbers.is_ok() && has_decimal_commas(row) {
            return Err(format!(
                "line {line} is `{row}`, with decimal commas; write decimal points"
            ));
        }
        match numbers.as_deref() {
            Ok([x, y, z, ..]) if x.is_finite() && y.is_finite() => points.push([*x, *y, *z]),
            Err(_) if points.is_empty() => {}
            _ => return Err(format!("line {line} is `{row}`; each has x, y and z")),
        }
    }
    let lines = |a: usize| {
        let mut all: Vec<f64> = points.iter().map(|p| p[a]).collect();
        all.sort_by(f64::total_cmp);
        let span = all.last().unwrap_or(&0.0) - all.first().unwrap_or(&0.0);
        all.dedup_by(|b, a| *b - *a <= 1e-9 * span);
        all
    };
    let [xs, ys] = [lines(0), lines(1)];
    let axis = |name: &str, all: &[f64]| {
        let gaps = all.windows(2).map(|pair| pair[1] - pair[0]);
        let least = gaps.fold(f64::INFINITY, f64::min);
        let (Some(first), Some(last)) = (all.first(), all.last()) else {
            return Err("it has no points; each line has x, y and z".into());
        };
        if !least.is_finite() {
            return Err(format!(
                "all its points have the same {name}; a surface needs two along x and y"
            ));
        }
        let count = ((last - first) / least).round();
        if count > 1e5 {
            return Err(format!(
                "its points are not on a regular grid: two differ by {least:e} in {name}, of {:e}; resample it",
                last - first
            ));
        }
        // Rows and columns without any point have no heights.
        Ok(((last - first) / count, count as usize + 1))
    };
    let ((dx, nx), (dy, ny)) = (axis("x", &xs)?, axis("y", &ys)?);
    let (x0, y0) = (xs[0], ys[0]);
    if nx * ny > SPARSE * points.len() {
        return Err(format!(
            "its {} points are not on a regular grid: the least distances, {dx} and {dy}, would make one of {nx} × {ny} nodes; resample it",
            points.len()
        ));
    }
    let mut heights = vec![f64::NAN; nx * ny];
    for [x, y, z] in &points {
        let place = |at: f64, first: f64, spacing: f64| {
            let n = ((at - first) / spacing).round();
            ((at - first - n * spacing).abs() < REGULAR * spacing).then_some(n as usize)
        };
        let (Some(i), Some(j)) = (place(*x, x0, dx), place(*y, y0, dy)) else {
            return Err(format!(
                "the point ({x}, {y}) is not on the grid of {dx} and {dy} that the others have; resample it"
            ));
        };
        let height = &mut heights[i + nx * j];
        if height.is_finite() && *height != *z {
            return Err(format!(
                "the point ({x}, {y}) has two heights, {height} and {z}; remove one"
            ));
        }
        *height = *z;
    }
    Ok(Terrain {
        origin: [x0, y0],
        spacing: [dx, dy],
        nodes: [nx, ny],
        heights,
    })
}

/// Reads a header of words with numbers, then rows of heights from north to south.
pub(super) fn read_ascii_grid(bytes: &[u8]) -> Result<Terrain, String> {
    let text = text_of(bytes)?;
    let mut words = text.split_whitespace().peekable();
    let mut header = std::collections::BTreeMap::new();
    while let Some(word) = words.next_if(|word| word.parse::<f64>().is_err()) {
        let value = words.next().and_then(|value| value.parse::<f64>().ok());
        let value = value.ok_or_else(|| format!("no number follows `{word}` in its header"))?;
        header.insert(word.to_lowercase(), value);
    }
    let of = |key: &str| {
        header
            .get(key)
            .copied()
            .ok_or_else(|| format!("its header has no `{key}`; export it as an ESRI ASCII grid"))
    };
    let count = |key: &str| match of(key)? {
        n if (1.0..=1e6).contains(&n) => Ok(n as usize),
        n => Err(format!("`{key}` is {n} in its header")),
    };
    let (nx, ny, spacing) = (count("ncols")?, count("nrows")?, of("cellsize")?);
    let first = |axis: &str| match of(&format!("{axis}llcenter")) {
        Ok(centre) => Ok(centre),
        // A corner is half a cell before the first height.
        Err(_) => Ok::<f64, String>(of(&format!("{axis}llcorner"))? + 0.5 * spacing),
    };
    let none = header.get("nodata_value").copied();
    let values: Result<Vec<f64>, _> = words.map(str::parse).collect();
    let values =
        values.map_err(|_| "one of its heights is not a number; export it again".to_owned())?;
    if values.len() != nx * ny {
        return Err(format!(
            "it has {} heights, and its header {ny} rows of {nx}; export it again",
            values.len()
        ));
    }
    Ok(Terrain {
        origin: [first("x")?, first("y")?],
        spacing: [spacing; 2],
        nodes: [nx, ny],
        heights: from_south(&values, nx, none),
    })
}

/// Rows from south to north, with NaN for the no-data value.
fn from_south(values: &[f64], nx: usize, none: Option<f64>) -> Vec<f64> {
    let rows = values.chunks(nx.max(1)).rev().flatten();
    rows.map(|&height| {
        if Some(height) == none {
            f64::NAN
        } else {
            height
        }
    })
    .collect()
}

/// Reads one band of heights, with the position and the size of its pixels (OGC GeoTIFF 1.1, 19-008r4).
pub(super) fn read_tiff(bytes: Vec<u8>) -> Result<Terrain, String> {
    let wrong = |e: tiff::TiffError| format!("not a TIFF file of heights: {e}; export it again");
    let mut file = Decoder::new(Cursor::new(bytes)).map_err(wrong)?;
    let (nx, ny) = file.dimensions().map_err(wrong)?;
    let (nx, ny) = (nx as usize, ny as usize);
    let numbers = |file: &mut Decoder<_>, tag| file.get_tag_f64_vec(tag).ok();
    let scale = numbers(&mut file, Tag::ModelPixelScaleTag);
    let tie = numbers(&mut file, Tag::ModelTiepointTag);
    let (Some([dx, dy, ..]), Some([i, j, _, x, y, ..])) = (scale.as_deref(), tie.as_deref()) else {
        return Err(
            "it gives no pixel positions (ModelPixelScale and ModelTiepoint); export it as a GeoTIFF without a rotation".into(),
        );
    };
    // GTRasterType (1025): 1, or absent, if the tie point is a corner of a pixel; 2 if it is its centre.
    let keys = file
        .get_tag_u16_vec(Tag::GeoKeyDirectoryTag)
        .unwrap_or_default();
    let is_point = keys.chunks(4).any(|key| matches!(key, [1025, 0, _, 2]));
    let shift = if is_point { 0.0 } else { 0.5 };
    // GTModelType (1024): 2 for longitude and latitude.
    if keys.chunks(4).any(|key| matches!(key, [1024, 0, _, 2])) {
        return Err("its positions are degrees of longitude and latitude; project it to metres, as by gdalwarp -t_srs".into());
    }
    let none = file.get_tag_ascii_string(Tag::GdalNodata).ok();
    let none = none.and_then(|word| word.trim_matches(['\0', ' ']).parse::<f64>().ok());
    let values: Vec<f64> = match file.read_image().map_err(wrong)? {
        DecodingResult::F32(all) => all.into_iter().map(f64::from).collect(),
        DecodingResult::F64(all) => all,
        DecodingResult::I16(all) => all.into_iter().map(f64::from).collect(),
        DecodingResult::U16(all) => all.into_iter().map(f64::from).collect(),
        DecodingResult::I32(all) => all.into_iter().map(f64::from).collect(),
        DecodingResult::U32(all) => all.into_iter().map(f64::from).collect(),
        _ => return Err("its heights are neither integers of 16 or 32 bits nor numbers of 32 or 64 bits; convert it".into()),
    };
    if values.len() != nx * ny {
        return Err(format!(
            "it has {} numbers for {nx} × {ny} pixels; give one band of heights",
            values.len()
        ));
    }
    // The no-data value of 32-bit numbers may be written with more digits.
    let none = none.map(|none| {
        values
            .iter()
            .copied()
            .find(|v| *v as f32 == none as f32)
            .unwrap_or(none)
    });
    let (west, north) = (x + (shift - i) * dx, y - (shift - j) * dy);
    Ok(Terrain {
        origin: [west, north - (ny as f64 - 1.0) * dy],
        spacing: [*dx, *dy],
        nodes: [nx, ny],
        heights: from_south(&values, nx, none),
    })
}
