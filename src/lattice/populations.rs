//! The one piece of shader text that is generated: populations over the bindings of the device.

use super::{Setup, Storage};
use std::fmt::Write;

/// Directions of the lattice.
pub const Q: u32 = 27;

/// Words of direction `s` and element `e` behind `read_word(s, e)` and `write_word(s, e, word)`.
///
/// The directions are spread over `bindings` buffers, the same number in each but the last. After
/// inlining `s` is a literal, so that of the chain of comparisons one access is left.
pub fn accessors(bindings: u32, setup: &Setup) -> String {
    let (word, file) = match (setup.storage, setup.lanes) {
        (Storage::F32, _) => ("Reals", ", $reals"),
        (Storage::F16, 4) if setup.is_wide() => ("u64", ""),
        (Storage::F16, 4) => ("vec2<u32>", ""),
        (Storage::F16, _) => ("u32", ""),
    };
    let each = Q.div_ceil(bindings);
    let used = Q.div_ceil(each);
    let mut text = format!("// needs grid{file}\nalias Word = {word};\n");
    let mut get = String::from("fn read_word(s: u32, e: u32) -> Word {\n");
    let mut put = String::from("fn write_word(s: u32, e: u32, word: Word) {\n");
    let elements = "NX * NY * SLICES";
    for b in 0..used {
        let _ = writeln!(
            text,
            "@group(0) @binding({b}) var<storage, read_write> populations_{b}: array<Word>;"
        );
        let at = format!("populations_{b}[(s - {}u) * ({elements}) + e]", b * each);
        let last = (b + 1) * each;
        if b + 1 < used {
            let _ = writeln!(get, "    if (s < {last}u) {{ return {at}; }}");
            let _ = writeln!(put, "    if (s < {last}u) {{ {at} = word; return; }}");
        } else {
            let _ = writeln!(get, "    return {at};\n}}");
            let _ = writeln!(put, "    {at} = word;\n}}");
        }
    }
    text + &get + &put
}

/// `read_scalar(s, n)` and `write_scalar(s, n, value)`: one cell's population, of direction `s` and
/// scalar index `n`, in the same buffers.
///
/// In 16-bit storage two cells share a word: a dispatch writes only the scalars whose index has the
/// parity `half` of the pass, and whoever writes is dispatched once for each, so that no two invocations
/// write one word.
pub fn scalars(bindings: u32, storage: Storage) -> String {
    let each = Q.div_ceil(bindings);
    let used = Q.div_ceil(each);
    let count = "NX * NY * SLICES * LANES_OF_ELEMENT";
    let (kind, shift) = match storage {
        Storage::F32 => ("f32", ""),
        Storage::F16 => ("u32", " >> 1u"),
    };
    let mut text = String::from("// needs scalar_grid\n");
    let mut read = format!("fn read_word(s: u32, n: u32) -> {kind} {{\n");
    let mut write = format!("fn write_word(s: u32, n: u32, word: {kind}) {{\n");
    for b in 0..used {
        let _ = writeln!(
            text,
            "@group(0) @binding({b}) var<storage, read_write> populations_{b}: array<{kind}>;"
        );
        let at = format!(
            "populations_{b}[((s - {}u) * ({count}) + n){shift}]",
            b * each
        );
        let last = (b + 1) * each;
        if b + 1 < used {
            let _ = writeln!(read, "    if (s < {last}u) {{ return {at}; }}");
            let _ = writeln!(write, "    if (s < {last}u) {{ {at} = word; return; }}");
        } else {
            let _ = writeln!(read, "    return {at};\n}}");
            let _ = writeln!(write, "    {at} = word;\n}}");
        }
    }
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
    let half = pack2x16float(vec2(value * 32768.0, 0.0)) & 0xffffu;
    let kept = read_word(s, n) & (0xffff0000u >> (16u * cell_pass.half));
    write_word(s, n, kept | (half << (16u * cell_pass.half)));
}
"
        }
    };
    text + &read + &write + access
}
