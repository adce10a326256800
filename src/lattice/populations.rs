//! Shader access to the populations.

use super::{
    Setup, Storage,
    spread::{ELEMENTS, Field, SCALARS, planes, vector},
};

/// Directions of the lattice.
pub const Q: u32 = 27;

/// WGSL functions `read_word(s, e)` and `write_word(s, e, word)` for the word of direction `s` and element `e`.
///
/// The directions are spread over `bindings` buffers, the same number in each but the last.
pub fn accessors(bindings: u32, setup: &Setup) -> String {
    let (word, file) = match (setup.storage, setup.lanes) {
        (Storage::F32, _) => ("Reals", ", $reals"),
        (Storage::F16, 4) if setup.is_wide() => ("u64", ""),
        (Storage::F16, 4) => ("vec2<u32>", ""),
        (Storage::F16, _) => ("u32", ""),
    };
    let field = Field {
        name: "populations",
        binding: 0,
        word: "Word",
        parameters: "e: u32",
        read: Some("read_word"),
        write: Some("write_word"),
    };
    let text = field.text(&planes(Q, bindings), |own| vector(own, ELEMENTS));
    format!("// needs grid{file}\nalias Word = {word};\n{text}")
}

/// `read_scalar(s, n)` and `write_scalar(s, n, value)`: one cell's population, of direction `s` and
/// scalar index `n`, in the same buffers.
///
/// In 16-bit storage two cells share a word: a dispatch writes only the scalars whose index has the
/// parity `half` of the pass, and whoever writes is dispatched once for each, so that no two invocations
/// write one word.
pub fn scalars(bindings: u32, storage: Storage) -> String {
    let (word, shift) = match storage {
        Storage::F32 => ("f32", ""),
        Storage::F16 => ("u32", " >> 1u"),
    };
    let field = Field {
        name: "populations",
        binding: 0,
        word,
        parameters: "e: u32",
        read: Some("read_word"),
        write: Some("write_word"),
    };
    let text = field.text(&planes(Q, bindings), |own| {
        format!("({}){shift}", vector(own, SCALARS))
    });
    let access = match storage {
        Storage::F32 => {
            "fn read_scalar(s: u32, n: u32) -> f32 { return read_word(s, n); }
fn write_scalar(s: u32, n: u32, value: f32) { write_word(s, n, value); }
"
        }
        Storage::F16 => {
            "fn read_scalar(s: u32, n: u32) -> f32 {
    return unpack2x16float(read_word(s, n))[n & 1u] / 32768.0;
}
fn write_scalar(s: u32, n: u32, value: f32) {
    if ((n & 1u) != cell_pass.half) { return; }
    let half = pack_half(vec2(value * 32768.0, 0.0)) & 0xffffu;
    let kept = read_word(s, n) & (0xffff0000u >> (16u * cell_pass.half));
    write_word(s, n, kept | (half << (16u * cell_pass.half)));
}
"
        }
    };
    let needs = match storage {
        Storage::F32 => "",
        Storage::F16 => "half, ",
    };
    format!("// needs {needs}scalar_grid\n{text}{access}")
}
