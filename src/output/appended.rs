//! Arrays of VTK's XML files, raw binary behind the XML.

use std::fmt::Write as _;
use std::io::{self, Write};

use super::Array;
use super::xml::escape;

/// Bytes in front of each appended array: its length as UInt64.
const LENGTH_BYTES: u64 = size_of::<u64>() as u64;
/// Values converted at a time: 64 KiB, enough to make the calls to the writer few.
const CHUNK: usize = 8 * 1024;

/// Values of one of VTK's types.
pub(super) enum Values<'a> {
    Float32(&'a [f32]),
    Float64(Vec<f64>),
    Int64(Vec<i64>),
    UInt8(Vec<u8>),
}

impl Values<'_> {
    fn kind(&self) -> &'static str {
        match self {
            Self::Float32(_) => "Float32",
            Self::Float64(_) => "Float64",
            Self::Int64(_) => "Int64",
            Self::UInt8(_) => "UInt8",
        }
    }

    fn bytes(&self) -> u64 {
        match self {
            Self::Float32(values) => size_of_val(*values) as u64,
            Self::Float64(values) => size_of_val(values.as_slice()) as u64,
            Self::Int64(values) => size_of_val(values.as_slice()) as u64,
            Self::UInt8(values) => values.len() as u64,
        }
    }

    fn write(&self, writer: &mut dyn Write) -> io::Result<()> {
        match self {
            Self::Float32(values) => little(writer, values, |v| v.to_le_bytes()),
            Self::Float64(values) => little(writer, values, |v| v.to_le_bytes()),
            Self::Int64(values) => little(writer, values, |v| v.to_le_bytes()),
            Self::UInt8(values) => writer.write_all(values),
        }
    }
}

fn little<T: Copy, const N: usize>(
    writer: &mut dyn Write,
    values: &[T],
    bytes: impl Fn(T) -> [u8; N],
) -> io::Result<()> {
    for chunk in values.chunks(CHUNK) {
        let chunk: Vec<u8> = chunk.iter().flat_map(|value| bytes(*value)).collect();
        writer.write_all(&chunk)?;
    }
    Ok(())
}

/// The XML of a file and the arrays behind it.
#[derive(Default)]
pub(super) struct Appended<'a> {
    arrays: Vec<Values<'a>>,
    offset: u64,
}

impl<'a> Appended<'a> {
    /// The element that announces `values`.
    pub fn declare(&mut self, name: &str, components: usize, values: Values<'a>) -> String {
        let element = format!(
            "<DataArray type=\"{}\" Name=\"{}\" NumberOfComponents=\"{components}\" \
             format=\"appended\" offset=\"{}\"/>\n",
            values.kind(),
            escape(name),
            self.offset
        );
        self.offset += LENGTH_BYTES + values.bytes();
        self.arrays.push(values);
        element
    }

    /// The elements that announce the quantities of points or cells.
    pub fn declare_all(&mut self, arrays: &'a [Array]) -> String {
        let mut elements = String::new();
        for array in arrays {
            let values = Values::Float32(&array.values);
            // Writing to a String cannot fail.
            let _ = write!(
                elements,
                "{}",
                self.declare(&array.name, array.components, values)
            );
        }
        elements
    }

    /// Writes a file of `kind` whose content is `xml`, little endian.
    pub fn write(&self, writer: &mut dyn Write, kind: &str, xml: &str) -> io::Result<()> {
        // Version 1.0 is the first that lets header_type be chosen; the old UInt32 ends at 4 GiB.
        write!(
            writer,
            "<?xml version=\"1.0\"?>\n\
             <VTKFile type=\"{kind}\" version=\"1.0\" byte_order=\"LittleEndian\" \
             header_type=\"UInt64\">\n<{kind}>\n{xml}</{kind}>\n\
             <AppendedData encoding=\"raw\">\n_"
        )?;
        self.write_arrays(writer)?;
        writer.write_all(b"\n</AppendedData>\n</VTKFile>\n")
    }

    /// Writes the arrays alone, each with its length in front.
    pub fn write_arrays(&self, writer: &mut dyn Write) -> io::Result<()> {
        for values in &self.arrays {
            writer.write_all(&values.bytes().to_le_bytes())?;
            values.write(writer)?;
        }
        Ok(())
    }
}

/// What is wrong with the sizes of `arrays` of `count` tuples, if anything.
pub(super) fn fault(arrays: &[Array], count: usize, of: &str) -> Option<String> {
    arrays.iter().find_map(|array| {
        let wants = count * array.components;
        (array.values.len() != wants).then(|| {
            format!(
                "array {} has {} values; {count} {of} of {} components need {wants}",
                array.name,
                array.values.len(),
                array.components
            )
        })
    })
}
